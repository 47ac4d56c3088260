//! What would separate confounded parameters, by the rows that it would add to the
//! Jacobian.

use super::candidates::{ExpectedErrors, Kind, USUAL_PRELOAD_N, Way, expected, pushed};
use super::contacts::three_for_two;
use super::joint::CurveProblem;
use super::model::Model;
use super::problem::MeasuredCurve;
use crate::data::{Data, Observable};
use crate::free::Form;
use crate::identify::{Determined, Scaled, sized};
use crate::least_squares::{JUMPING, jacobian_at};
use crate::{Fit, ModelError, Parameter, Prior, Problem};
use hertzchain_measure::signal::Estimate;

/// What could be done where data leave combinations of the parameters open.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    /// How many combinations there are.
    pub combinations: usize,
    /// What the data so far determine.
    pub now: Prospect,
    /// What would be determined with each of several measurements more, the most
    /// promising first.
    pub prospects: Vec<Prospect>,
    /// With all of them together; `None` if none could be evaluated.
    pub together: Option<Prospect>,
    /// What to free or to fix instead.
    pub instead: String,
}

/// What data would determine, linearly around a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Prospect {
    /// What was measured besides.
    pub measure: String,
    /// How many combinations of the parameters are determined.
    pub determined: usize,
    /// Standard error of the combination that is known worst, in units of the
    /// parameters' sizes; infinite if nothing is known of it.
    pub worst: f64,
    /// Standard errors of the parameters in their units; infinite if undetermined.
    pub sd: Vec<f64>,
}

impl Advice {
    /// One sentence a line, most useful first.
    pub fn words(&self) -> Vec<String> {
        let (helpful, idle): (Vec<&Prospect>, Vec<&Prospect>) =
            (self.prospects.iter()).partition(|prospect| prospect.determined > self.now.determined);
        let mut words = Vec::new();
        let together = self.together.as_ref();
        let helps = together.is_some_and(|all| all.determined > self.now.determined);
        if !helps {
            words.push(self.instead.clone());
        }
        words.extend(helpful.iter().map(|prospect| self.of(prospect)));
        match (&idle[..], together) {
            ([], _) | (_, None) => {}
            (_, Some(all)) if !helps => words.push(self.of_no_use(&idle, all)),
            (_, Some(all)) if helpful.is_empty() => words.push(self.of(all)),
            _ => words.push(format!("of no use by themselves: {}", names(&idle))),
        }
        if helps {
            words.push(format!("or else {}", self.instead));
        }
        words
    }

    fn of(&self, prospect: &Prospect) -> String {
        let which = match prospect.determined == self.combinations {
            true => format!("all {}", self.combinations),
            false => format!("{} of {}", prospect.determined, self.combinations),
        };
        format!(
            "measure {}: {which} combinations would be determined, the worst known to {} (now {})",
            prospect.measure,
            share(prospect.worst),
            share(self.now.worst)
        )
    }

    fn of_no_use(&self, idle: &[&Prospect], all: &Prospect) -> String {
        format!(
            "no further data of this kind: {}; with all of it together still {} of {} combinations \
             would be determined, the worst known to {} (now {})",
            names(idle),
            all.determined,
            self.combinations,
            share(all.worst),
            share(self.now.worst)
        )
    }
}

fn names(prospects: &[&Prospect]) -> String {
    let names: Vec<&str> = prospects.iter().map(|p| p.measure.as_str()).collect();
    names.join("; ")
}

fn share(standard_error: f64) -> String {
    match 100.0 * standard_error {
        percent if percent.is_infinite() => "no digit".to_owned(),
        percent if percent < 1.0 => format!("{percent:.1} %"),
        percent => format!("{percent:.0} %"),
    }
}

/// A measurement more: its name, and the Jacobian of all data with it.
type Evaluated = (String, Scaled);

impl CurveProblem {
    /// What could be measured or fixed so that the data determine more: candidates
    /// are evaluated by the derivatives that they would add at a fit's optimum. Those
    /// whose curves cannot be computed are left out.
    pub fn suggested_measurements(&self, fit: &Fit) -> Advice {
        let sized = sized(self.parameters(), &fit.point);
        let own = Scaled::of(&sized, &fit.jacobian);
        let prospect = |name: &str, found: Determined| Prospect {
            measure: name.to_owned(),
            determined: found.count,
            worst: found.worst,
            sd: (found.sd.iter().zip(&sized)).map(|(sd, of)| sd * of.scale).collect(),
        };
        let errors = ExpectedErrors::like(self.data());
        let beside = self.other_readings(fit, &errors);
        let apart = self.apart(fit, &errors);
        let mut evaluated: Vec<Evaluated> = beside.clone();
        evaluated.extend(apart.iter().map(|(name, rows)| (name.clone(), own.and(rows))));
        let mut prospects: Vec<Prospect> =
            (evaluated.iter()).map(|(name, rows)| prospect(name, rows.determined())).collect();
        prospects.sort_by(|a, b| {
            let count = b.determined.cmp(&a.determined);
            count.then(a.worst.total_cmp(&b.worst))
        });
        // The last of those at the same speeds has all of them, where there are several.
        let full = beside.last().map_or(&own, |(_, rows)| rows);
        let all = apart.iter().fold(full.clone(), |sum, (_, rows)| sum.and(rows));
        let named: Vec<&Prospect> = prospects.iter().collect();
        let name = format!("all of this: {}", names(&named));
        let together = (!named.is_empty()).then(|| prospect(&name, all.determined()));
        Advice {
            combinations: self.parameters().len(),
            now: prospect("nothing more", own.determined()),
            prospects,
            together,
            instead: self.instead(),
        }
    }

    /// More read from the same shots, with the Jacobian of all that is then known;
    /// the last with everything.
    fn other_readings(&self, fit: &Fit, errors: &ExpectedErrors) -> Vec<Evaluated> {
        use Observable::{Incident, Reflected, ReturningOverPassing, WallOverPassing};
        let peaks = format!(
            "ratios of peaks at the same speeds to {} (--use with wall-ratio,returning-ratio)",
            errors.ratio
        );
        let sets: [(&str, &[Observable]); 4] = [
            ("incident times at the same speeds", &[Incident]),
            ("reflected times at the same speeds", &[Reflected]),
            (&peaks, &[WallOverPassing, ReturningOverPassing]),
            ("all times and ratios at the same speeds", &Observable::ALL),
        ];
        let missing = |of: &Observable| self.data().rows.iter().any(|row| row.value(*of).is_none());
        let wanted = sets.into_iter().filter(|(_, set)| set.iter().any(missing));
        let evaluated = wanted.filter_map(|(name, set)| {
            let data = self.with_more(fit, set, errors).ok()?;
            let rows = self.rows(self.model().clone(), data, fit).ok()?;
            Some((name.to_owned(), rows))
        });
        let mut all: Vec<Evaluated> = evaluated.collect();
        if let [_, _] = &all[..] {
            // One set and that of everything: the same.
            all.pop();
        }
        all
    }

    /// These data with further observables, as they would be at the fit.
    fn with_more(
        &self,
        fit: &Fit,
        more: &[Observable],
        errors: &ExpectedErrors,
    ) -> Result<Data, ModelError> {
        let curve = self.curves()[0].predicted(std::slice::from_ref(&fit.point)).remove(0)?;
        let mut data = self.data().clone();
        for (row, predicted) in data.rows.iter_mut().zip(curve) {
            for of in more {
                let sigma = errors.of(*of);
                let would_be = predicted[of.index()].map(|value| Estimate { value, sigma });
                let known = &mut row.values[of.index()];
                *known = known.or(would_be);
            }
        }
        Ok(data)
    }

    /// Further shots, with the rows that they would add.
    fn apart(&self, fit: &Fit, errors: &ExpectedErrors) -> Vec<Evaluated> {
        let own = self.data().speeds_m_s();
        let each = |form: Form| form == Form::EachSpeed;
        let numbers = self.model().numbers().as_slice();
        let any_speed = !numbers.iter().any(|number| each(number.form()));
        let experiment = self.model().experiment();
        let wider = wider(&own);
        let ends = [wider.first(), wider.last()].map(|end| end.copied().unwrap_or(f64::NAN));
        let spread = format!("at {} speeds from {:.2} to {:.2} m/s", wider.len(), ends[0], ends[1]);
        let pushed = pushed(experiment);
        let mut ways = Vec::new();
        if any_speed {
            ways.push((spread, experiment.clone(), wider));
        }
        ways.extend(pushed.map(|chain| {
            let name = format!("at the same speeds with a push of {USUAL_PRELOAD_N} N on bead 1");
            (name, chain, own)
        }));
        let evaluated = ways.into_iter().filter_map(|(name, experiment, speeds)| {
            let model = Model::new(&experiment, self.model().numbers().clone()).ok()?;
            let model = model.with_accuracy(self.model().accuracy);
            let has = |of: &Observable| self.data().has(*of);
            let way = Way {
                kind: Kind::Incident,
                cost: 1.0,
                name: name.clone(),
                experiment,
                observables: Observable::ALL.into_iter().filter(has).collect(),
            };
            let data = expected(&model, fit, &way, &speeds, errors).ok()?;
            Some((name, self.rows(model, data, fit).ok()?))
        });
        evaluated.collect()
    }

    /// The Jacobian of data that might be measured.
    fn rows(&self, model: Model, data: Data, fit: &Fit) -> Result<Scaled, ModelError> {
        let flat = |of: Parameter| of.with_prior(Prior::Flat);
        let sized = sized(self.parameters(), &fit.point).into_iter();
        let parameters: Vec<Parameter> = sized.map(flat).collect();
        let problem =
            Self::unchecked(parameters, vec![MeasuredCurve::new(model.for_slopes(), data)]);
        let jacobian = jacobian_at(&problem, fit)?;
        Ok(Scaled::with_doubt(problem.parameters(), &jacobian, JUMPING))
    }

    fn instead(&self) -> String {
        three_for_two(self.model()).unwrap_or_else(|| {
            let names: Vec<&str> = self.parameters().iter().map(|p| p.name.as_str()).collect();
            format!(
                "keep some of {} fixed, or say what is known of them (--prior)",
                names.join(", ")
            )
        })
    }
}

/// Eight speeds in equal ratios over twice the range to either side.
fn wider(speeds_m_s: &[f64]) -> Vec<f64> {
    let lowest = speeds_m_s.iter().copied().fold(f64::INFINITY, f64::min) / BEYOND;
    let highest = speeds_m_s.iter().copied().fold(0.0, f64::max) * BEYOND;
    let steps = 7;
    let speed = |at: i32| lowest * (highest / lowest).powf(f64::from(at) / f64::from(steps));
    (0..=steps).map(speed).collect()
}

/// How far beyond the data's speeds others are thought of, as a factor.
const BEYOND: f64 = 2.0;

//! Measurements that would determine more combinations of the parameters.

use super::candidates::{Choices, ExpectedErrors, ways};
use super::contacts::three_for_two;
use super::joint::CurveProblem;
use crate::identify::{Determined, Scaled, sized};
use crate::{Candidate, Fit, InferError, Parameter, Problem};

/// What could be done where data leave combinations of the parameters undetermined.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    /// How many combinations there are.
    pub combinations: usize,
    /// What the data so far determine.
    pub now: Prospect,
    /// What would be determined with each of several measurements more, the most promising first.
    pub prospects: Vec<Prospect>,
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
    /// One statement a line, most useful first.
    pub fn words(&self) -> Vec<String> {
        let is_helpful = |prospect: &&Prospect| prospect.determined > self.now.determined;
        let helpful = self.prospects.iter().filter(is_helpful).map(|prospect| {
            format!(
                "measure {}: {} of {} combinations would be determined, the worst known to {} (now {})",
                prospect.measure,
                prospect.determined,
                self.combinations,
                share(prospect.worst),
                share(self.now.worst)
            )
        });
        let mut words: Vec<String> = helpful.collect();
        match (words.is_empty(), &self.prospects[..]) {
            (false, _) => words.push(format!("or else {}", self.instead)),
            (true, tried) => {
                words.push(self.instead.clone());
                let names: Vec<&str> = tried.iter().map(|of| of.measure.as_str()).collect();
                words.extend(
                    (!tried.is_empty())
                        .then(|| format!("no further data of this kind: {}", names.join("; "))),
                );
            }
        }
        words
    }
}

fn share(standard_error: f64) -> String {
    match 100.0 * standard_error {
        percent if percent.is_infinite() => "no digit".to_owned(),
        percent if percent < 1.0 => format!("{percent:.1} %"),
        percent => format!("{percent:.0} %"),
    }
}

impl CurveProblem {
    /// What could be measured or fixed so that the data determine more: the [`ways`] to measure at
    /// eight speeds each, by the derivatives that they would add at a fit's optimum. Those whose
    /// curves cannot be computed are left out.
    pub fn suggested_measurements(&self, fit: &Fit) -> Advice {
        let sized = sized(self.parameters(), &fit.point);
        let own = Scaled::of(&sized, &fit.jacobian);
        let prospect = |name: &str, found: Determined| Prospect {
            measure: name.to_owned(),
            determined: found.count,
            worst: found.worst,
            sd: (found.sd.iter().zip(&sized)).map(|(sd, of)| sd * of.scale).collect(),
        };
        let speeds = wider(&self.data().speeds_m_s());
        let (from, to) = (speeds[0], speeds[speeds.len() - 1]);
        let errors = ExpectedErrors::like(self.data());
        let evaluated = |way| -> Result<Prospect, InferError> {
            let candidates = self.candidates(fit, std::slice::from_ref(&way), &speeds, &errors)?;
            let with = |sum: Scaled, one: &Candidate| {
                sum.and(&Scaled::of_rows(&sized, &one.rows, &one.doubts))
            };
            let all = candidates.iter().fold(own.clone(), with);
            let name =
                format!("{} at {} speeds from {from:.2} to {to:.2} m/s", way.name, speeds.len());
            Ok(prospect(&name, all.determined()))
        };
        let ways = ways(&self.model().experiment, &Choices::default()).unwrap_or_default();
        let found = ways.into_iter().map(evaluated);
        let mut prospects: Vec<Prospect> = found.filter_map(Result::ok).collect();
        prospects.sort_by(|a, b| {
            let count = b.determined.cmp(&a.determined);
            count.then(a.worst.total_cmp(&b.worst))
        });
        Advice {
            combinations: self.parameters().len(),
            now: prospect("nothing more", own.determined()),
            prospects,
            instead: three_for_two(self.model()).unwrap_or_else(|| fewer(self.parameters())),
        }
    }
}

fn fewer(parameters: &[Parameter]) -> String {
    let names: Vec<&str> = parameters.iter().map(|p| p.name.as_str()).collect();
    format!("keep some of {} fixed, or say what is known of them (--prior)", names.join(", "))
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

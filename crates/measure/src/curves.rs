//! Shots into curves: means a speed, ratios, power laws.

use crate::ambiguous::resolve_ambiguous;
use crate::correlation::{Pairs, correlation, of_ratios, shared_s2};
use crate::signal::{
    Estimate, FitError, Flight, Picked, Point, PowerLaw, PulseKind, Ratio, Summary, groups,
    mean_systematic, pool, power_law, power_law_both_errors, ratios_at_common, summary,
    without_systematic,
};
use crate::{Example, Measurement, Shot};
use indexmap::IndexMap;
use rayon::prelude::*;

/// How shots are grouped into curves.
#[derive(Clone, Debug, PartialEq)]
pub struct Grouping {
    /// Largest difference, in m/s, of speeds that count as one; shots whose programmed speed is
    /// known are grouped by that.
    pub gap_m_s: f64,
    /// The case that others are divided by.
    pub reference: String,
    /// Whether clipped shots, those of doubtful order and those that may miss a pulse count.
    pub keep_dubious: bool,
}

impl Default for Grouping {
    fn default() -> Self {
        Self { gap_m_s: 0.01, reference: "dry".to_owned(), keep_dubious: false }
    }
}

/// Means over the shots of one case at one speed.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedRow {
    /// Mean speed in m/s. Its error is that of the measured speeds if it is
    /// known, else their scatter's.
    pub speed_m_s: Estimate,
    /// Shots from whose scatter that error comes; 0 if it is that of measuring, and known.
    pub speed_error_shots: usize,
    /// Shots that count, and shots of this speed that do not: those with grave flags, and those
    /// without a time or a speed of their own.
    pub shots: (usize, usize),
    /// Of those that count, shots whose reflected pulse has an ambiguous maximum: their reflected
    /// times do not count.
    pub returns_undecided: usize,
    /// Of those that count, shots without a reflected pulse. Where fewer than half of them have one,
    /// it may be noise, and none counts.
    pub returns_missing: usize,
    /// Incident time of flight in s.
    pub incident_s: Summary,
    /// Reflected time of flight in s.
    pub reflected_s: Option<Summary>,
    /// Systematic parts in s of the errors of both, which their standard errors do not hold: what
    /// lies under pulses in a summed channel shifts all shots by the same.
    pub shared_s: [f64; 2],
    /// Incident and reflected time of flight in s at the mean speed, each shot's
    /// taken there by its own measured speed, with all errors: what power laws and ratios are
    /// made of.
    pub at_mean_speed_s: [Option<Estimate>; 2],
    /// Correlation of the standard errors of both plain means; `None` without both.
    pub correlation: Option<f64>,
    /// Correlation of the errors of both times at the mean speed: they share the wall's pick.
    pub correlation_at_mean_speed: Option<f64>,
    /// Wall's peak over incident peak.
    pub wall_over_incident: Summary,
    /// Reflected peak over incident peak.
    pub reflected_over_incident: Option<Summary>,
    /// Full widths at half maximum in s: incident, wall, reflected.
    pub widths_s: [Option<Summary>; 3],
}

/// Power laws of both times of flight against speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Laws {
    /// Of the incident one.
    pub incident: Result<PowerLaw, FitError>,
    /// Of the reflected one.
    pub reflected: Result<PowerLaw, FitError>,
}

/// The curve of one case.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Its name; empty if it has none.
    pub name: String,
    /// Rows by speed.
    pub rows: Vec<SpeedRow>,
    /// Fits.
    pub laws: Laws,
}

/// Ratios of one case to the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct WetOverDry {
    /// The case's name.
    pub case: String,
    /// Of incident times.
    pub incident: Vec<Ratio>,
    /// Of reflected times.
    pub reflected: Vec<Ratio>,
    /// Correlation of each incident ratio's error with that of the reflected one at its speed.
    pub correlations: Vec<Option<f64>>,
}

/// A speed of a case at which no shot has a time of flight that counts.
#[derive(Clone, Debug, PartialEq)]
pub struct UnmeasuredSpeed {
    /// The case's name; empty if it has none.
    pub case: String,
    /// Programmed speed in m/s if it is known, else the first shot's own.
    pub speed_m_s: f64,
    /// Shots of this speed.
    pub shots: usize,
}

/// Curves of all cases and their ratios.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curves {
    /// Cases in the order in which they first came.
    pub cases: Vec<Case>,
    /// Ratios of all others to the reference.
    pub ratios: Vec<WetOverDry>,
    /// Speeds at which no shot counts, in the order of cases and speeds.
    pub unmeasured: Vec<UnmeasuredSpeed>,
    /// Whether dubious shots count.
    pub keep_dubious: bool,
    /// Numbers from 0 of shots that count by themselves, but in no mean: which maximum is that of their
    /// incident or wall pulse is open to all shots of their speed.
    undecided: Vec<usize>,
}

/// How times of flight change with speed between neighbouring speeds: a Hertz chain's exponent,
/// −1/5 [Nesterenko1983].
const EXPONENT: f64 = -0.2;

impl Curves {
    /// Reduces shots; those without a speed or a time are left out.
    pub fn of(shots: &[Shot], grouping: &Grouping) -> Self {
        let mut by_name: IndexMap<&str, Vec<(usize, &Shot)>> = IndexMap::new();
        for (number, shot) in shots.iter().enumerate() {
            by_name.entry(&shot.case).or_default().push((number, shot));
        }
        let mut curves = Self { keep_dubious: grouping.keep_dubious, ..Self::default() };
        for (name, shots) in by_name {
            curves.add_case(name, &shots, grouping);
        }
        curves.ratios = ratios(&curves.cases, grouping);
        curves
    }

    fn add_case(&mut self, name: &str, shots: &[(usize, &Shot)], grouping: &Grouping) {
        let gap_m_s = grouping.gap_m_s;
        let timed = shots.iter().filter_map(|shot| Timed::new(*shot, grouping));
        let timed: Vec<Timed<'_>> = timed.collect();
        let untimed = shots.iter().filter(|shot| Timed::new(**shot, grouping).is_none());
        let mut untimed: Vec<GroupSpeed> =
            untimed.filter_map(|(_, shot)| GroupSpeed::new(shot)).collect();
        let (mut rows, mut none) = (Vec::new(), Vec::<(GroupSpeed, usize)>::new());
        for group in grouped(&timed, |shot| shot.group, gap_m_s) {
            let before = untimed.len();
            untimed.retain(|at| !group.iter().any(|shot| shot.group.is_same(at, gap_m_s)));
            let all = group.len() + before - untimed.len();
            let counted: Vec<Timed<'_>> =
                group.iter().filter(|shot| shot.counts).copied().collect();
            let resolved = resolved(&counted, grouping.keep_dubious);
            let both = counted.iter().zip(&resolved);
            let undecided = both.filter(|(_, resolved)| resolved.is_none());
            self.undecided.extend(undecided.map(|(shot, _)| shot.number));
            match row(&counted, resolved, all, grouping.keep_dubious) {
                Some(row) => rows.push(row),
                None => none.extend(group.first().map(|one| (one.group, all))),
            }
        }
        for at in untimed {
            match none.iter_mut().find(|(other, _)| other.is_same(&at, gap_m_s)) {
                Some((_, shots)) => *shots += 1,
                None => none.push((at, 1)),
            }
        }
        none.sort_by(|a, b| a.0.m_s.total_cmp(&b.0.m_s));
        self.unmeasured.extend(none.into_iter().map(|(at, shots)| UnmeasuredSpeed {
            case: name.to_owned(),
            speed_m_s: at.m_s,
            shots,
        }));
        self.cases.extend((!rows.is_empty()).then(|| Case::new(name, rows)));
    }
}

/// The speed by which a shot is grouped: the programmed one, if it is known.
#[derive(Clone, Copy)]
struct GroupSpeed {
    m_s: f64,
    is_programmed: bool,
}

impl GroupSpeed {
    fn new(shot: &Shot) -> Option<Self> {
        let own = shot.true_speed().map(|speed| speed.value);
        Some(Self {
            m_s: shot.programmed_speed_m_s.or(own)?,
            is_programmed: shot.programmed_speed_m_s.is_some(),
        })
    }

    fn is_same(&self, other: &Self, gap_m_s: f64) -> bool {
        let gap_m_s = if self.is_programmed { 0.0 } else { gap_m_s };
        self.is_programmed == other.is_programmed && (self.m_s - other.m_s).abs() <= gap_m_s
    }
}

#[derive(Clone, Copy)]
struct Timed<'a> {
    number: usize,
    group: GroupSpeed,
    speed: Estimate,
    flight: &'a Flight,
    counts: bool,
}

impl<'a> Timed<'a> {
    fn new((number, shot): (usize, &'a Shot), grouping: &Grouping) -> Option<Self> {
        Some(Self {
            number,
            group: GroupSpeed::new(shot)?,
            speed: shot.true_speed()?,
            flight: shot.flight.as_ref().ok()?,
            counts: shot.own_reasons(grouping.keep_dubious).is_empty(),
        })
    }
}

const SPEEDS_UNKNOWN: &str = "errors of speeds are not known and were taken for 0";

impl Case {
    fn new(name: &str, mut rows: Vec<SpeedRow>) -> Self {
        rows.sort_by(|a, b| a.speed_m_s.value.total_cmp(&b.speed_m_s.value));
        let laws = Laws { incident: law(&points(&rows, 0)), reflected: law(&points(&rows, 1)) };
        Self { name: name.to_owned(), rows, laws }
    }

    /// Whether points follow a power law of this case within their errors, as
    /// [`PowerLaw::is_supported`].
    ///
    /// # Errors
    /// Why that is not known: it does not hold within the errors of times alone, and those
    /// of speeds are not known.
    pub fn supports(&self, law: &PowerLaw) -> Result<Option<bool>, &'static str> {
        let speeds_known = self.rows.iter().all(|row| row.speed_m_s.sigma > 0.0);
        match law.is_supported() {
            Some(false) if !speeds_known => Err(SPEEDS_UNKNOWN),
            supported => Ok(supported),
        }
    }
}

/// Shots of one programmed speed, then those that have none by their speeds.
fn grouped<T: Copy>(all: &[T], speed: impl Fn(&T) -> GroupSpeed, gap_m_s: f64) -> Vec<Vec<T>> {
    let by = |programmed: bool, gap_m_s: f64| -> Vec<Vec<T>> {
        let of = all.iter().filter(|one| speed(one).is_programmed == programmed);
        let of: Vec<T> = of.copied().collect();
        let speeds: Vec<f64> = of.iter().map(|one| speed(one).m_s).collect();
        let pick = |group: Vec<usize>| group.iter().map(|index| of[*index]).collect();
        groups(&speeds, gap_m_s).into_iter().map(pick).collect()
    };
    [by(true, 0.0), by(false, gap_m_s)].concat()
}

/// Of shots whose pulses were all picked by hand where none was found.
const NO_HEIGHTS: Summary = Summary {
    count: 0,
    mean: f64::NAN,
    deviation: f64::NAN,
    error: f64::NAN,
    weighted: Estimate { value: f64::NAN, sigma: f64::NAN },
    chi_square: f64::NAN,
};

/// Flights of one speed's shots as they enter its means: `None` enters none.
fn resolved(counted: &[Timed<'_>], keep_dubious: bool) -> Vec<Option<Flight>> {
    let own = counted.iter().map(|shot| shot.flight);
    match keep_dubious {
        true => own.map(|flight| Some(*flight)).collect(),
        false => resolve_ambiguous(&own.collect::<Vec<_>>()),
    }
}

fn has_return(flight: &Flight) -> bool {
    flight.reflected_s.is_some()
}

/// Where fewer than half of the shots have a return, none counts.
fn drop_few_returns(resolved: &mut [Option<Flight>]) {
    let now = resolved.iter().flatten();
    if 2 * now.clone().filter(|flight| has_return(flight)).count() < now.count() {
        let flights = resolved.iter_mut().flatten();
        flights.for_each(|flight| *flight = flight.without_return());
    }
}

/// Of the shots of one speed that count by themselves, of so many in `all`.
fn row(
    counted: &[Timed<'_>],
    mut resolved: Vec<Option<Flight>>,
    all: usize,
    keep_dubious: bool,
) -> Option<SpeedRow> {
    let ambiguous = counted.iter().zip(&resolved).filter(|(own, now)| {
        let without = now.as_ref().is_some_and(|now| !has_return(now));
        without && has_return(own.flight)
    });
    let returns_undecided = ambiguous.count();
    if !keep_dubious {
        drop_few_returns(&mut resolved);
    }
    let pairs = counted.iter().zip(&resolved);
    let counted: Vec<Timed<'_>> = pairs
        .filter_map(|(shot, flight)| flight.as_ref().map(|flight| Timed { flight, ..*shot }))
        .collect();
    let returns = counted.iter().filter(|shot| has_return(shot.flight)).count();
    let of = |value: &dyn Fn(&Flight) -> Option<Estimate>| {
        let values = counted.iter().filter_map(|shot| value(shot.flight));
        summary(&values.collect::<Vec<_>>())
    };
    let width = |kind: PulseKind| {
        of(&|flight| {
            let value = flight.picks.pulse(kind)?.width_s;
            Some(Estimate { value, sigma: 0.0 })
        })
    };
    let ratio = |kind: PulseKind| {
        let mut ratio = of(&|flight| flight.over_incident(kind))?;
        let shared = counted.iter().filter_map(|shot| shot.flight.shared_height(kind));
        ratio.share(shared.sum::<f64>() / ratio.count as f64);
        Some(ratio)
    };
    let speeds: Vec<Estimate> = counted.iter().map(|shot| shot.speed).collect();
    let speed_m_s = mean_speed(&speeds)?;
    let moved = [0, 1].map(|time| at_speed(&counted, speed_m_s, time));
    let shared_s = [0, 1].map(|time| shared_s(&counted, time));
    let mut incident_s = of(&|flight| Some(flight.incident_s))?;
    incident_s.share(shared_s[0]);
    let mut reflected_s = of(&|flight| flight.reflected_s);
    reflected_s.iter_mut().for_each(|back| back.share(shared_s[1]));
    let errors = |back: Summary| [incident_s.error, back.error];
    let plain = |back| both_times(&counted, None).of_means(errors(back), shared_of_both(&counted));
    Some(SpeedRow {
        speed_m_s,
        speed_error_shots: if are_known(&speeds) { 0 } else { speeds.len() },
        shared_s,
        at_mean_speed_s: moved.map(|of| of.map(TimeAtSpeed::estimate)),
        correlation: reflected_s.and_then(plain),
        correlation_at_mean_speed: correlation_at_speed(&counted, speed_m_s, moved),
        shots: (counted.len(), all - counted.len()),
        returns_undecided,
        returns_missing: counted.len() - returns - returns_undecided,
        incident_s,
        reflected_s,
        wall_over_incident: ratio(PulseKind::Wall).unwrap_or(NO_HEIGHTS),
        reflected_over_incident: ratio(PulseKind::Reflected),
        widths_s: PulseKind::ALL.map(width),
    })
}

/// The mean of measured speeds is the mean of these very shots' speeds, whatever
/// their scatter: only the errors of measuring make it uncertain.
fn mean_speed(speeds: &[Estimate]) -> Option<Estimate> {
    let all = summary(speeds)?;
    let squares: f64 = speeds.iter().map(|speed| speed.sigma.powi(2)).sum();
    Some(Estimate {
        value: all.mean,
        sigma: match are_known(speeds) {
            true => squares.sqrt() / all.count as f64,
            false => all.error,
        },
    })
}

fn are_known(speeds: &[Estimate]) -> bool {
    speeds.iter().all(|speed| speed.sigma > 0.0)
}

/// Systematic error of the mean of this time over all shots that have it.
fn shared_s(shots: &[Timed<'_>], time: usize) -> f64 {
    let flights = shots.iter().map(|shot| shot.flight);
    let own = flights.filter(|flight| flight.times_s()[time].is_some());
    mean_systematic(&own.map(|flight| flight.systematic()[time]).collect::<Vec<_>>())
}

/// Mean of times that are taken to one speed, and the parts of its error.
#[derive(Clone, Copy)]
struct TimeAtSpeed {
    mean_s: f64,
    /// Variance in s² by the errors of picking, as far as shots do not share them.
    picking_s2: f64,
    /// What scatters besides, less what errors of measured speeds account for.
    excess_s2: f64,
    shared_s: f64,
    of_speed_s: f64,
}

impl TimeAtSpeed {
    fn estimate(self) -> Estimate {
        let alone = (self.picking_s2 + self.excess_s2).sqrt();
        Estimate { value: self.mean_s, sigma: alone.hypot(self.shared_s) }
    }
}

/// What a time is multiplied by to be that at another speed.
fn to_speed(shot: &Timed<'_>, speed_m_s: Estimate) -> f64 {
    (speed_m_s.value / shot.speed.value).powf(EXPONENT)
}

/// Mean of times that are taken to one speed, with the error of what scatters besides
/// measured speeds: their errors are the mean speed's, and count there. At least
/// that of picking; and what all shots share on top.
fn at_speed(shots: &[Timed<'_>], speed_m_s: Estimate, time: usize) -> Option<TimeAtSpeed> {
    let moved = |shot: &Timed<'_>| {
        let of = shot.flight.times_s()[time]?;
        let factor = to_speed(shot, speed_m_s);
        Some(Estimate {
            value: factor * of.value,
            sigma: factor * without_systematic(of.sigma, shot.flight.systematic()[time]),
        })
    };
    let moved: Vec<Estimate> = shots.iter().filter_map(moved).collect();
    let summary = summary(&moved)?;
    let squares: f64 = moved.iter().map(|one| one.sigma.powi(2)).sum();
    let picking_s2 = squares / (summary.count as f64).powi(2);
    let of_speed_s = EXPONENT * summary.mean * speed_m_s.sigma / speed_m_s.value;
    let besides = summary.error.powi(2) - of_speed_s.powi(2);
    Some(TimeAtSpeed {
        mean_s: summary.mean,
        picking_s2,
        excess_s2: (besides - picking_s2).max(0.0),
        shared_s: shared_s(shots, time),
        of_speed_s,
    })
}

/// Shots that have both times: as measured, or taken to one speed.
fn both_times(shots: &[Timed<'_>], speed_m_s: Option<Estimate>) -> Pairs {
    let pair = |shot: &Timed<'_>| {
        let factor = speed_m_s.map_or(1.0, |speed_m_s| to_speed(shot, speed_m_s));
        let times = [shot.flight.incident_s, shot.flight.reflected_s?];
        let covariance = match speed_m_s {
            Some(_) => shot.flight.random_covariance_s2(),
            None => shot.flight.covariance_s2,
        };
        let times = times.map(|time| factor * time.value);
        Some((times, factor.powi(2) * covariance))
    };
    let both: Vec<_> = shots.iter().filter_map(pair).collect();
    Pairs::new(&both, shots.len())
}

/// What shots with both times share of the covariance of both means in s².
fn shared_of_both(shots: &[Timed<'_>]) -> f64 {
    let returned = shots.iter().map(|shot| shot.flight);
    let returned: Vec<&Flight> = returned.filter(|f| f.reflected_s.is_some()).collect();
    shared_s2(&returned)
}

/// Correlation of the errors of both times at the mean speed, part by part.
fn correlation_at_speed(
    shots: &[Timed<'_>],
    speed_m_s: Estimate,
    moved: [Option<TimeAtSpeed>; 2],
) -> Option<f64> {
    let [forth, back] = [moved[0]?, moved[1]?];
    let pairs = both_times(shots, Some(speed_m_s));
    let of_speed = forth.of_speed_s * back.of_speed_s;
    let excess = pairs.excess(of_speed, [forth.excess_s2, back.excess_s2]);
    let covariance = pairs.picking + excess + shared_of_both(shots);
    correlation(covariance, [forth, back].map(|of| of.estimate().sigma))
}

fn points(rows: &[SpeedRow], time: usize) -> Vec<Point> {
    let point =
        |row: &SpeedRow| Some(Point { speed: row.speed_m_s, value: row.at_mean_speed_s[time]? });
    rows.iter().filter_map(point).collect()
}

/// Weighted by all errors where every point has one, else unweighted.
fn law(points: &[Point]) -> Result<PowerLaw, FitError> {
    let column = |of: &dyn Fn(&Point) -> f64| points.iter().map(of).collect::<Vec<f64>>();
    let speeds = column(&|point| point.speed.value);
    let values = column(&|point| point.value.value);
    let sound = |sigma: f64| sigma.is_finite() && sigma > 0.0;
    match points.iter().all(|point| sound(point.value.sigma) && point.speed.sigma.is_finite()) {
        true => power_law_both_errors(
            &speeds,
            &column(&|point| point.speed.sigma),
            &values,
            &column(&|point| point.value.sigma),
        ),
        false => power_law(&speeds, &values, None),
    }
}

fn ratios(cases: &[Case], grouping: &Grouping) -> Vec<WetOverDry> {
    let Some(dry) = cases.iter().find(|case| case.name == grouping.reference) else {
        return Vec::new();
    };
    let over = |case: &Case, time: usize| {
        let (upper, lower) = (points(&case.rows, time), points(&dry.rows, time));
        ratios_at_common(&upper, &lower, grouping.gap_m_s, EXPONENT)
    };
    let wet = cases.iter().filter(|case| case.name != grouping.reference);
    wet.map(|case| {
        let (incident, reflected) = (over(case, 0), over(case, 1));
        let rows = (&case.rows[..], &dry.rows[..]);
        WetOverDry {
            case: case.name.clone(),
            correlations: of_ratios(rows, (&incident, &reflected), EXPONENT),
            incident,
            reflected,
        }
    })
    .collect()
}

impl Measurement {
    /// Reduces shots to curves, after their maxima are picked again with one shape for all shots of a
    /// case and a speed that count. Noise leaves the shape of one pulse open and that of many less: at
    /// 40 dB times of 20 shots are two to three times as exact as each alone.
    pub fn curves(&mut self, grouping: &Grouping) -> Curves {
        // Names need not tell shots apart.
        let number = |example: &Example| self.shots.iter().position(|shot| *shot == example.shot);
        let examples = self.examples.iter().chain(&self.flagged);
        let numbers: Vec<Option<usize>> = examples.map(number).collect();
        pick_with_common_shapes(&mut self.shots, grouping);
        let curves = Curves::of(&self.shots, grouping);
        self.shots.iter_mut().for_each(|shot| shot.undecided = false);
        curves.undecided.iter().for_each(|number| self.shots[*number].undecided = true);
        let examples = self.examples.iter_mut().chain(&mut self.flagged);
        for (Example { shot, .. }, number) in examples.zip(numbers) {
            if let Some(number) = number {
                let Shot { flight, undecided, .. } = &self.shots[number];
                (shot.flight, shot.undecided) = (flight.clone(), *undecided);
            }
        }
        curves
    }
}

/// Picks maxima of all shots of a case and a speed again, as [`Measurement::curves`] does.
fn pick_with_common_shapes(shots: &mut [Shot], grouping: &Grouping) {
    let mut cases: IndexMap<&str, Vec<(usize, GroupSpeed)>> = IndexMap::new();
    for (number, shot) in
        shots.iter().enumerate().filter(|(_, shot)| shot.own_reasons(false).is_empty())
    {
        let speed = GroupSpeed::new(shot).map(|speed| (number, speed));
        cases.entry(&shot.case).or_default().extend(speed);
    }
    let groups = cases.values().flat_map(|case| grouped(case, |one| one.1, grouping.gap_m_s));
    let groups: Vec<Vec<usize>> =
        groups.map(|group| group.into_iter().map(|one| one.0).collect()).collect();
    let picked: Vec<(usize, PulseKind, Picked)> = groups
        .par_iter()
        .flat_map_iter(|group| PulseKind::ALL.map(|kind| picked(shots, group, kind)))
        .flatten_iter()
        .collect();
    for (number, kind, picked) in picked {
        if let Ok(flight) = &mut shots[number].flight {
            let mut picks = flight.picks;
            let time_s = picked.time_s - skew_s(flight, kind);
            picks.set(kind, Picked { time_s, ..picked });
            *flight = picks.flight().with_interval_error(flight.interval_error);
        }
    }
}

/// New picks of these shots' pulses, on the clock of their channel.
fn picked(shots: &[Shot], group: &[usize], kind: PulseKind) -> Vec<(usize, PulseKind, Picked)> {
    let own = |number: &usize| {
        let shot = &shots[*number];
        let flight = shot.flight.as_ref().ok()?;
        let own = flight.picks.pulse(kind)?;
        let time_s = own.time_s + skew_s(flight, kind);
        Some((*number, (shot.samples[kind as usize].as_deref()?, Picked { time_s, ..own })))
    };
    let (numbers, pulses): (Vec<usize>, Vec<_>) = group.iter().filter_map(own).unzip();
    let picks = numbers.into_iter().zip(pool(&pulses));
    picks.filter_map(|(number, picked)| Some((number, kind, picked?))).collect()
}

fn skew_s(flight: &Flight, kind: PulseKind) -> f64 {
    if kind == PulseKind::Wall { flight.picks.calibration.skew_s } else { 0.0 }
}

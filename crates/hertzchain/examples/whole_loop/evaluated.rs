//! Recordings of virtual campaigns: each shot's times as measured, as they were, and as the
//! model has them, of a chain in equilibrium and of the very chain that was shot at.

use hertzchain_chain::observe::Passages;
use hertzchain_chain::settle::State;
use hertzchain_chain::wave::{self, Limits, Method};
use hertzchain_experiment::Experiment;
use hertzchain_measure::records::truth;
use hertzchain_measure::signal::{ChiSquare, Estimate, Flight, chi_square};
use hertzchain_measure::{Curves, Grouping, Options, Shot, measure, resolve_ambiguous};
use hertzchain_sim::Shard;
use hertzchain_sim::rig::{Case, Plan, campaign};
use hertzchain_sim::{Batch, BatchOptions};
use std::collections::HashMap;
use std::error::Error;
use std::fs;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// Incident and reflected, in this order, here and below.
pub(crate) const TIMES: [&str; 2] = ["incident", "reflected"];

/// A row of −1/5 nearly: what an error of the speed does to a time \[Nesterenko1983\].
const EXPONENT: f64 = 0.2;

/// One shot.
pub(crate) struct Evaluated {
    /// The case of the campaign.
    pub case: String,
    /// The shot as measured.
    pub shot: Shot,
    /// Speed by the photogate in m/s.
    pub speed_m_s: Estimate,
    /// Times of flight in s, as measured.
    pub measured_s: [Option<Estimate>; 2],
    /// The recorded shot's own in s.
    pub true_s: [f64; 2],
    /// Those of the same chain in equilibrium at the measured speed, in s.
    pub compact_s: [f64; 2],
    /// The recorded shot's own, taken to the measured speed, in s: of the chain as it stood, with
    /// the loads that friction held on it. No second computation: what departs from them is of
    /// measuring.
    pub own_s: [f64; 2],
    /// Those of the model at the measured speed, in s, of a chain with the gaps and loads that the
    /// recorded one had before the shot, from the group of true values.
    pub held_s: [f64; 2],
}

/// What measured times are held to.
pub(crate) type Curve = fn(&Evaluated) -> [f64; 2];

/// The model's curve, of the chain in equilibrium.
pub(crate) const COMPACT: Curve = |shot| shot.compact_s;
/// The recorded shots' own times.
pub(crate) const OWN: Curve = |shot| shot.own_s;
/// The model's curve, of chains with the recorded ones' own gaps and loads.
pub(crate) const HELD: Curve = |shot| shot.held_s;

impl Evaluated {
    /// Speed that the striker was reported, in m/s.
    pub(crate) fn programmed_m_s(&self) -> f64 {
        self.shot.programmed_speed_m_s.unwrap_or_default()
    }

    /// Measured less true time, with the stated error of picking.
    pub(crate) fn error(&self, time: usize) -> Option<Estimate> {
        let measured = self.measured_s[time]?;
        let value = measured.value - self.true_s[time];
        value.is_finite().then_some(Estimate { value, ..measured })
    }

    /// Measured time less what it is held to, by all of its stated error: of picking and of the speed.
    pub(crate) fn pull(&self, time: usize, curve: Curve) -> f64 {
        let Some(measured) = self.measured_s[time] else {
            return f64::NAN;
        };
        let model_s = curve(self)[time];
        (measured.value - model_s) / measured.sigma.hypot(self.of_speed(model_s))
    }

    /// What the error of the speed makes of a time.
    fn of_speed(&self, time_s: f64) -> f64 {
        EXPONENT * time_s * self.speed_m_s.sigma / self.speed_m_s.value
    }
}

/// Shots of one speed: what `measure` determines of their mean, less what they are held to.
pub(crate) struct Speed {
    /// Programmed speed in m/s.
    pub speed_m_s: f64,
    /// How many shots have this time.
    pub count: usize,
    /// Departure at the mean speed in s, with the error that `measure` states of the mean time and
    /// what that of the mean speed makes of it.
    pub departure_s: Estimate,
    /// Part of that error in s that shots share.
    pub shared_s: f64,
}

/// Means a speed of one case, less what they are held to.
pub(crate) fn by_speed(shots: &[&Evaluated], time: usize, curve: Curve) -> Vec<Speed> {
    let mut speeds: Vec<f64> = shots.iter().map(|shot| shot.programmed_m_s()).collect();
    speeds.sort_by(f64::total_cmp);
    speeds.dedup();
    let of_speed = |speed_m_s: f64| {
        let own = shots.iter().filter(|s| s.programmed_m_s() == speed_m_s);
        let own: Vec<&Evaluated> = own.copied().collect();
        of_mean(&own, time, curve)
    };
    speeds.into_iter().filter_map(of_speed).collect()
}

/// Chi-square of means against no departure at all.
pub(crate) fn agreement(rows: &[Speed]) -> Option<ChiSquare> {
    let means: Vec<Estimate> = rows.iter().map(|row| row.departure_s).collect();
    chi_square(&means, &vec![0.0; means.len()], 0)
}

/// The row of `speeds.csv` that shots of one speed give, held against the mean of the curve over
/// those whose time is in it, each taken to the mean speed as `measure` takes times there.
fn of_mean(shots: &[&Evaluated], time: usize, curve: Curve) -> Option<Speed> {
    let all: Vec<Shot> = shots.iter().map(|shot| shot.shot.clone()).collect();
    let curves = Curves::of(&all, &Grouping::default());
    let row = curves.cases.first()?.rows.first()?;
    let mean_s = row.at_mean_speed_s[time]?;
    let summary = [Some(row.incident_s), row.reflected_s][time]?;
    let speed_m_s = row.speed_m_s;
    let counted: Vec<(&Evaluated, &Flight)> = shots
        .iter()
        .filter(|shot| !shot.shot.is_dubious())
        .filter_map(|shot| Some((*shot, shot.shot.flight.as_ref().ok()?)))
        .collect();
    let flights: Vec<&Flight> = counted.iter().map(|(_, flight)| *flight).collect();
    let timed = resolve_ambiguous(&flights).into_iter().zip(&counted);
    let timed = timed.filter(|(flight, _)| {
        let has = |flight: &Flight| time == 0 || flight.reflected_s.is_some();
        flight.as_ref().is_some_and(has)
    });
    let held_s: Vec<f64> = timed
        .map(|(_, (shot, _))| {
            let to_mean = (shot.speed_m_s.value / speed_m_s.value).powf(EXPONENT);
            curve(shot)[time] * to_mean
        })
        .collect();
    let held_s = held_s.iter().sum::<f64>() / held_s.len() as f64;
    let of_speed_s = EXPONENT * held_s * speed_m_s.sigma / speed_m_s.value;
    let departure_s =
        Estimate { value: mean_s.value - held_s, sigma: mean_s.sigma.hypot(of_speed_s) };
    Some(Speed {
        speed_m_s: shots.first()?.programmed_m_s(),
        count: summary.count,
        departure_s,
        shared_s: row.shared_s[time],
    })
}

/// Runs a campaign file once a seed, each into a folder of its own.
pub(crate) fn run(
    text: &str,
    seeds: RangeInclusive<u64>,
    under: &Path,
) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let experiment = Experiment::from_text("campaign.toml", text)?;
    seeds
        .map(|seed| {
            let folder = under.join(seed.to_string());
            let plan = Plan::new(&experiment, Some(seed))?;
            campaign(&plan, &folder, Shard::WHOLE, &|_| {})?;
            Ok(folder)
        })
        .collect()
}

/// Measures the recordings of a campaign's folder, and holds every shot against
/// its true values and the model.
pub(crate) fn evaluate(folder: &Path, options: &Options) -> Result<Vec<Evaluated>, Box<dyn Error>> {
    let text = fs::read_to_string(folder.join("campaign.toml"))?;
    let plan = Plan::new(&Experiment::from_text("campaign.toml", &text)?, None)?;
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        files.push(entry?.path());
    }
    files.retain(|file| file.extension().is_some_and(|ending| ending == "h5"));
    files.sort();
    let shots = measure(&files, options, &()).shots;
    let mut evaluated = Vec::new();
    for case in &plan.cases {
        evaluated.extend(of_case(case, &shots)?);
    }
    Ok(evaluated)
}

fn of_case(case: &Case, shots: &[Shot]) -> Result<Vec<Evaluated>, Box<dyn Error>> {
    let own: Vec<&Shot> = shots.iter().filter(|shot| shot.case == case.name).collect();
    let speeds: Vec<Estimate> = own.iter().filter_map(|shot| shot.speed_m_s).collect();
    let models = models(&case.experiment, &speeds)?;
    let mut known = HashMap::new();
    let mut evaluated = Vec::new();
    for ((shot, speed_m_s), compact_s) in own.into_iter().zip(speeds).zip(models) {
        if !known.contains_key(&shot.file) {
            let columns: HashMap<String, Vec<f64>> = truth(&shot.file)?.into_iter().collect();
            known.insert(shot.file.clone(), columns);
        }
        let row = shot.shot.unwrap_or_default() as usize;
        let true_of = |name: &str| known[&shot.file][name][row];
        let true_s = [true_of("incident_tof_s"), true_of("reflected_tof_s")];
        let to_measured = (true_of("speed_m_s") / speed_m_s.value).powf(EXPONENT);
        let contacts = case.experiment.beads();
        let overlaps_m = &known[&shot.file]["overlap_before_m"][row * contacts..][..contacts];
        let flight = shot.flight.as_ref().ok();
        evaluated.push(Evaluated {
            case: case.name.clone(),
            shot: shot.clone(),
            speed_m_s,
            measured_s: [
                flight.map(|flight| flight.incident_s),
                flight.and_then(|flight| flight.reflected_s),
            ],
            true_s,
            compact_s,
            own_s: true_s.map(|time_s| time_s * to_measured),
            held_s: held(&case.experiment, overlaps_m, speed_m_s.value)?,
        });
    }
    Ok(evaluated)
}

/// Longest wave in s.
const LONGEST_S: f64 = 0.02;

/// A hundredth of the rig's own error per step.
const TOLERANCE: f64 = 1e-10;

/// The model's incident and reflected times in s of a chain whose contacts from 1 on have these
/// overlaps in m at rest, negative across a gap. Beads must be alike: their sizes are in no file.
fn held(
    experiment: &Experiment,
    overlaps_m: &[f64],
    speed_m_s: f64,
) -> Result<[f64; 2], Box<dyn Error>> {
    let (system, _) = experiment.system(Some(speed_m_s))?;
    // Contact 0 is the striker's, which is put against bead 1.
    let mut gaps_m = vec![0.0];
    gaps_m.extend(overlaps_m.iter().map(|overlap| -overlap));
    let mut state = State::laid(&system, &gaps_m);
    state.strike(&system, speed_m_s);
    let shot = system.from_state(&state)?;
    let mut passages = Passages::new(experiment.sensor_bead(), shot.beads(), true);
    let method = Method::dormand_prince(TOLERANCE);
    let limits = Limits::until(LONGEST_S);
    wave::run(&shot, &method, limits, &mut [&mut passages])?;
    let (incident, wall, reflected) = passages.peaks()?;
    let reflected_s = reflected.map_or(f64::NAN, |peak| peak.time_s - wall.time_s);
    Ok([wall.time_s - incident.time_s, reflected_s])
}

/// The model's incident and reflected times at every speed, in s.
fn models(experiment: &Experiment, speeds: &[Estimate]) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
    let speeds: Vec<f64> = speeds.iter().map(|speed| speed.value).collect();
    let batch = Batch::new(experiment, speeds, BatchOptions::of(experiment))?;
    let flights = batch.run(Shard::WHOLE, &|| {}).rows.flights();
    let times = |(_, incident_s, reflected_s): (f64, f64, Option<f64>)| {
        [incident_s, reflected_s.unwrap_or(f64::NAN)]
    };
    match flights.len() == batch.shots() {
        true => Ok(flights.into_iter().map(times).collect()),
        false => Err("the wave does not reach the wall".into()),
    }
}

//! From shots to the numbers that claims are judged on.

use super::ReproduceError;
use super::memory::Memory;
use crate::claims::{Curve, Evidence, Oil, Point};
use crate::{Plan, Shot, shoot, shoot_checked};
use hertzchain_chain::observe::Passage;
use hertzchain_chain::{Chain, Sensor};
use hertzchain_experiment::{Experiment, Reading, preset};
use rayon::prelude::*;

/// The paper's chains, in the order of the tables.
pub const CASES: [&str; 6] = [
    "hertz",
    "hertz-viscoelastic",
    "dry",
    "pump",
    "gear",
    "motor",
];

/// The wet ones.
pub const OILS: [&str; 3] = ["pump", "gear", "motor"];

/// The dry chain held together by the paper's spring force, for the claim
/// about loosening.
pub const HELD: &str = "dry-held";

/// How the paper's chains are shot.
#[derive(Clone, Debug)]
pub struct Gathering<'a> {
    /// What the paper leaves open.
    pub reading: Reading,
    /// Speeds of the striker in m/s.
    pub speeds_m_s: &'a [f64],
    /// Relative accuracy asked of ToFs.
    pub accuracy: f64,
    /// Whether every shot is run again at a tenth of the tolerance.
    pub checked: bool,
}

/// Changes a chain of a case, hit at a speed, before it is shot.
pub type Change<'a> = &'a (dyn Fn(&str, f64, &mut Chain) + Sync);

/// The paper's chains in one reading.
#[derive(Clone, Debug)]
pub struct Cases(Vec<(&'static str, Experiment)>);

impl Cases {
    /// All of them, and the dry chain held together.
    ///
    /// # Errors
    /// A reading that leaves something outside a chain.
    pub fn new(reading: &Reading) -> Result<Self, ReproduceError> {
        let held = reading
            .with("preload", "constant")
            .map_err(ReproduceError::Reading)?;
        let named = CASES.map(|case| (case, case, *reading));
        let all = named.into_iter().chain([(HELD, "dry", held)]);
        let open = |(case, file, reading): (&'static str, &str, Reading)| {
            let experiment = preset(file).map_err(ReproduceError::Preset)?;
            Ok((case, experiment.with_reading(&reading)?))
        };
        all.map(open)
            .collect::<Result<_, ReproduceError>>()
            .map(Self)
    }

    /// The experiment of a case.
    #[must_use]
    pub fn get(&self, case: &str) -> Option<&Experiment> {
        let found = self.0.iter().find(|(name, _)| *name == case);
        found.map(|(_, experiment)| experiment)
    }

    /// The liquids as printed.
    #[must_use]
    pub fn oils(&self) -> Vec<Oil> {
        let oil = |case: &&str| {
            let liquid = self.get(case)?.liquid()?;
            Some(Oil {
                case: (*case).to_owned(),
                kinematic_viscosity_m2_s: liquid.kinematic_viscosity_m2_s?,
                density_kg_m3: liquid.density_kg_m3?,
            })
        };
        OILS.iter().filter_map(oil).collect()
    }
}

/// Shoots all cases at all speeds, on all cores; `done` is called after each
/// shot, from any thread. The result does not depend on their number.
///
/// # Errors
/// The first shot that can't be computed, in the order of the tables.
pub fn gather(
    how: &Gathering<'_>,
    change: Change<'_>,
    done: &(dyn Fn() + Sync),
) -> Result<Evidence, ReproduceError> {
    gathered(how, change, None, done)
}

/// The same without changes, looking into a memory before shooting.
///
/// # Errors
/// As [`gather`].
pub fn gather_remembering(
    how: &Gathering<'_>,
    memory: &Memory,
) -> Result<Evidence, ReproduceError> {
    gathered(how, &|_, _, _| {}, Some(memory), &|| {})
}

fn gathered(
    how: &Gathering<'_>,
    change: Change<'_>,
    memory: Option<&Memory>,
    done: &(dyn Fn() + Sync),
) -> Result<Evidence, ReproduceError> {
    let cases = Cases::new(&how.reading)?;
    let jobs: Vec<(usize, f64)> = (0..cases.0.len())
        .flat_map(|case| how.speeds_m_s.iter().map(move |speed| (case, *speed)))
        .collect();
    let shoot = |&(case, speed): &(usize, f64)| {
        let (name, experiment) = &cases.0[case];
        let point = point((name, experiment), speed, how, change, memory);
        done();
        point
    };
    let points: Vec<Point> = jobs.par_iter().map(shoot).collect::<Result<_, _>>()?;
    let curves = points.chunks(how.speeds_m_s.len().max(1));
    let curves = cases.0.iter().zip(curves).map(|((case, _), points)| Curve {
        case: (*case).to_owned(),
        points: points.to_vec(),
    });
    Ok(Evidence {
        curves: curves.collect(),
        oils: cases.oils(),
        viscosity_over_modulus_s: viscosity_over_modulus(&cases, change)?,
        digitised: Vec::new(),
    })
}

/// η/Y of the dry balls in s.
fn viscosity_over_modulus(cases: &Cases, change: Change<'_>) -> Result<f64, ReproduceError> {
    let Some(dry) = cases.get("dry") else {
        return Ok(f64::NAN);
    };
    let (mut chain, _) = dry.chain(Some(1.0))?;
    change("dry", 1.0, &mut chain);
    let material = chain.beads.first().map(|bead| bead.material);
    Ok(material.map_or(f64::NAN, |m| m.shear_viscosity_pa_s / m.young_modulus_pa))
}

/// The sensor bead is sampled this often to see small returning maxima, in s:
/// ten samples in the narrowest pulse of the paper's speeds.
const SAMPLED_S: f64 = 5e-6;

fn point(
    (case, experiment): (&str, &Experiment),
    speed_m_s: f64,
    how: &Gathering<'_>,
    change: Change<'_>,
    memory: Option<&Memory>,
) -> Result<Point, ReproduceError> {
    let plan = plan(case, experiment, speed_m_s, how.accuracy, change)?;
    let (n, beads) = (plan.sensor_bead, plan.chain.beads.len());
    let sensors = vec![
        Sensor::Bead(n),
        Sensor::Position(1),
        Sensor::Position(beads),
    ];
    let plan = plan.watching(sensors, Some(SAMPLED_S));
    let compute = || {
        let shot = if how.checked {
            shoot_checked(&plan)
        } else {
            shoot(&plan)
        };
        let shot = shot.map_err(|error| failed(case, speed_m_s, error))?;
        Ok(read_off(&plan, speed_m_s, &shot))
    };
    match memory {
        Some(memory) => memory.point(&plan, compute),
        None => compute(),
    }
}

/// The plan of a shot of a case.
pub(super) fn plan(
    case: &str,
    experiment: &Experiment,
    speed_m_s: f64,
    accuracy: f64,
    change: Change<'_>,
) -> Result<Plan, ReproduceError> {
    // The cases' ν above 1/2 is the paper's and said in the reading.
    let (mut plan, _warnings) = Plan::from_experiment(experiment, Some(speed_m_s))?;
    change(case, speed_m_s, &mut plan.chain);
    plan.accuracy = accuracy;
    Ok(plan)
}

pub(super) fn failed(case: &str, speed_m_s: f64, error: crate::StudyError) -> ReproduceError {
    ReproduceError::Shot {
        case: case.to_owned(),
        speed_m_s,
        error: Box::new(error),
    }
}

fn read_off(plan: &Plan, speed_m_s: f64, shot: &Shot) -> Point {
    let passage = shot.passage.as_ref().ok();
    let or_nan = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let reflected = passage.and_then(|p| p.reflected);
    let tof_reflected_s = shot.flight.and_then(|f| f.reflected_s);
    let rebound = shot.rebound;
    Point {
        speed_m_s,
        tof_incident_s: or_nan(shot.flight.map(|f| f.incident_s)),
        tof_reflected_s: or_nan(tof_reflected_s),
        sensor_peak_n: or_nan(passage.map(|p| p.incident.value)),
        wall_peak_n: or_nan(passage.map(|p| p.wall.value)),
        returning_peak_n: or_nan(reflected.map(|peak| peak.value)),
        second_returning_peak_n: or_nan(passage.and_then(|p| second_return(plan, shot, p))),
        widths_s: [
            or_nan(passage.and_then(|p| p.incident_width_s)),
            or_nan(passage.and_then(|p| p.wall_width_s)),
            or_nan(passage.and_then(|p| p.reflected_width_s)),
        ],
        striker_separation_m_s: or_nan(rebound.and_then(|r| r.first).map(|(_, v)| v)),
        striker_rebound_m_s: or_nan(rebound.and_then(|r| r.end_m_s)),
        loosened_m: or_nan(loosened(shot)),
        accuracy_reached: shot.accuracy_reached.unwrap_or(shot.accuracy_asked),
    }
}

/// Largest returning maximum beside the first. What comes later than twice the
/// way from the sensor bead to the near end takes may be an echo from there.
fn second_return(plan: &Plan, shot: &Shot, passage: &Passage) -> Option<f64> {
    let (first, width) = (passage.reflected?, passage.reflected_width_s?);
    let back = passage.tof_reflected_s()?;
    let (n, beads) = (plan.sensor_bead as f64, plan.chain.beads.len() as f64);
    let until = first.time_s + 2.0 * n / (beads - n) * back;
    let trace = shot.trace.as_ref()?;
    let samples = trace.columns.first()?;
    let tops = samples
        .windows(3)
        .zip(trace.time_s.iter().skip(1))
        .filter_map(|(w, time)| {
            let [left, middle, right] = [w.first()?, w.get(1)?, w.get(2)?];
            let other = *time > passage.wall.time_s
                && *time < until
                && (time - first.time_s).abs() > 0.25 * width;
            (other && middle > left && middle >= right).then_some(top(*left, *middle, *right))
        });
    Some(tops.fold(0.0, f64::max))
}

/// Top of the parabola through three samples.
fn top(left: f64, middle: f64, right: f64) -> f64 {
    let bend = left - 2.0 * middle + right;
    match bend < 0.0 {
        true => middle - (right - left).powi(2) / (8.0 * bend),
        false => middle,
    }
}

/// By how much beads 1 and N stand farther apart than at rest, in m, at the end
/// of the time in which the returning pulse is looked for.
fn loosened(shot: &Shot) -> Option<f64> {
    let (trace, passage) = (shot.trace.as_ref()?, shot.passage.as_ref().ok()?);
    let until = passage.wall.time_s + 3.0 * passage.tof_incident_s();
    let seen = trace.time_s.partition_point(|time| *time <= until);
    let at = |column: usize| {
        trace
            .columns
            .get(column)?
            .get(seen.checked_sub(1)?)
            .copied()
    };
    Some(at(2)? - at(1)?)
}

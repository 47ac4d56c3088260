//! From shots to the numbers that claims are judged on.

use super::ReproduceError;
use crate::claims::{Curve, Evidence, Oil, Point};
use crate::{Plan, Shot, shoot, shoot_checked};
use hertzchain_chain::observe::{Maximum, Passage};
use hertzchain_chain::{Chain, Sensor, System};
use hertzchain_experiment::{Experiment, Reading, preset};
use rayon::prelude::*;

/// The paper's chains, in the order of the tables.
pub const CASES: [&str; 6] = ["hertz", "hertz-viscoelastic", "dry", "pump", "gear", "motor"];

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
        let held = reading.with("preload", "constant").map_err(ReproduceError::Reading)?;
        let named = CASES.map(|case| (case, case, *reading));
        let all = named.into_iter().chain([(HELD, "dry", held)]);
        let open = |(case, file, reading): (&'static str, &str, Reading)| {
            let experiment = preset(file).map_err(ReproduceError::Preset)?;
            Ok((case, experiment.with_reading(&reading)?))
        };
        all.map(open).collect::<Result<_, ReproduceError>>().map(Self)
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
    let cases = Cases::new(&how.reading)?;
    let jobs: Vec<(usize, f64)> = (0..cases.0.len())
        .flat_map(|case| how.speeds_m_s.iter().map(move |speed| (case, *speed)))
        .collect();
    let shoot = |&(case, speed): &(usize, f64)| {
        let (name, experiment) = &cases.0[case];
        let point = point(name, experiment, speed, how, change);
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

/// Positions are looked at this often to see the gaps at the end, in s.
const GLANCE_S: f64 = 5e-5;

fn point(
    case: &str,
    experiment: &Experiment,
    speed_m_s: f64,
    how: &Gathering<'_>,
    change: Change<'_>,
) -> Result<Point, ReproduceError> {
    let plan = plan(case, experiment, speed_m_s, how.accuracy, change)?;
    let beads = plan.chain.beads.len();
    let positions = (1..=beads).map(Sensor::Position).collect();
    let plan = plan.watching(positions, Some(GLANCE_S));
    let shot = if how.checked { shoot_checked(&plan) } else { shoot(&plan) };
    let shot = shot.map_err(|error| failed(case, speed_m_s, error))?;
    Ok(read_off(&plan, speed_m_s, &shot))
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
        second_returning_peak_n: or_nan(passage.and_then(|p| second_return(plan, p))),
        widths_s: [
            or_nan(passage.and_then(|p| p.incident_width_s)),
            or_nan(passage.and_then(|p| p.wall_width_s)),
            or_nan(passage.and_then(|p| p.reflected_width_s)),
        ],
        striker_separation_m_s: or_nan(rebound.and_then(|r| r.first).map(|(_, v)| v)),
        striker_rebound_m_s: or_nan(rebound.map(|r| r.end_m_s)),
        gaps_m: gaps(plan, shot),
        accuracy_reached: shot.accuracy_reached.unwrap_or(shot.accuracy_asked),
    }
}

/// Second largest returning maximum. What comes later than twice the way from
/// the sensor bead to the near end takes may be an echo from there.
fn second_return(plan: &Plan, passage: &Passage) -> Option<f64> {
    let first = passage.reflected?;
    let back = passage.tof_reflected_s()?;
    let (n, beads) = (plan.sensor_bead as f64, plan.chain.beads.len() as f64);
    let until = first.time_s + 2.0 * n / (beads - n) * back;
    let other = |peak: &&Maximum| {
        peak.time_s > passage.wall.time_s && peak.time_s < until && **peak != first
    };
    let others = passage.sensor_maxima.iter().filter(other);
    Some(others.map(|peak| peak.value).fold(0.0, f64::max))
}

/// Sum of the gaps between beads where the shot was last looked at, in m.
fn gaps(plan: &Plan, shot: &Shot) -> f64 {
    let (Some(trace), Ok(system)) = (&shot.trace, System::new(&plan.chain)) else {
        return f64::NAN;
    };
    let last: Vec<f64> = trace.columns.iter().filter_map(|c| c.last().copied()).collect();
    let gap = |(i, pair): (usize, &[f64])| match pair {
        // Contact i + 1 joins beads i + 1 and i + 2.
        [left, right] => (right - left - system.static_contact(i + 1).overlap_m).max(0.0),
        _ => 0.0,
    };
    last.windows(2).enumerate().map(gap).sum()
}

//! One shot from its plan to its numbers.

use crate::error::StudyError;
use crate::other_picks::OtherPick;
use crate::plan::Plan;
use crate::prepared::{Check, PreparedShot};
use hertzchain_chain::observe::{
    Competing, Maximum, Passage, PassageError, Passages, Pulse, Signal, Trace,
};
use hertzchain_chain::wave::{Budget, Work};
use hertzchain_experiment::Pick;
use hertzchain_measure::signal::delay_by_cross_correlation;

/// How long the pulse took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// Incident time of flight in s: from the sensor bead to the wall.
    pub incident_s: f64,
    /// Reflected time of flight in s: from the wall back to the sensor bead.
    pub reflected_s: Option<f64>,
}

/// The striker's velocity after the impact, negative away from the chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rebound {
    /// When it first let go of bead 1, in s, and its velocity then, in m/s.
    pub first: Option<(f64, f64)>,
    /// Its velocity in m/s when it last let go of bead 1, before it was away for good or six times the time that
    /// the pulse took to the wall had passed, or before a later end that was asked for; at that time, if it was
    /// in contact then.
    /// `None` when the plan does not follow it, or when a duration that was asked for was over before.
    pub end_m_s: Option<f64>,
    /// When it had that velocity, in s.
    pub end_s: Option<f64>,
}

/// What one shot gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// Times of flight as picked; `None` when no pulse was seen to pass.
    pub flight: Option<Flight>,
    /// The same as the plan's other picks time them.
    pub compared: Vec<Option<Flight>>,
    /// Peaks and widths, or why there are none.
    pub passage: Result<Passage, PassageError>,
    /// Maxima of the sensor bead above 5 % of its largest, seen with or
    /// without a pulse at the wall.
    pub sensor_maxima: Vec<Maximum>,
    /// Beads per second between sensor bead and wall contact: N − n + 1/2 over the incident
    /// time of flight, as the plan picks it.
    pub pulse_speed_beads_s: Option<f64>,
    /// The striker afterwards; `None` without a striker.
    pub rebound: Option<Rebound>,
    /// The contact of the highest Hertz pressure and its force in N at its largest overlap, when a budget was
    /// asked for.
    pub hardest: Option<(usize, f64)>,
    /// Energy at the end, when a budget was asked for.
    pub budget: Option<Budget>,
    /// What was sampled, when that was asked for.
    pub trace: Option<Trace>,
    /// Duration in s.
    pub duration_s: f64,
    /// Whether the shot came to its own end before its longest duration.
    pub finished: bool,
    /// Velocities of all bodies at the end in m/s.
    pub velocity_m_s: Vec<f64>,
    /// What the (last) run cost.
    pub work: Work,
    /// Relative accuracy asked of times of flight.
    pub accuracy_asked: f64,
    /// A bound on the relative error of the times of flight (of the sensor's largest
    /// peak time or the final velocities, where there are none), from runs that are
    /// looser or tighter, or from twice or half the fixed step: [`shoot_estimated`],
    /// [`shoot_checked`]; `None` from [`shoot`]. In an ensemble, always, from the
    /// changes to steps 1.3 and 1.69 times as long. `work` does not count those shots.
    pub accuracy_reached: Option<f64>,
    /// How it was computed.
    pub solver: String,
    /// Tolerance per step of the adaptive solver.
    pub tolerance: Option<f64>,
    /// Step of a fixed-step solver in s.
    pub step_s: Option<f64>,
    /// How well its times of flight are conditioned; known with equal steps only.
    pub(crate) conditioning: Conditioning,
    /// Maxima that errors of heights could make a pulse's peak instead.
    pub(crate) other_picks: Vec<OtherPick>,
    /// What a reader of the numbers must know.
    pub notes: Vec<String>,
}

/// Relative changes of times of flight, the larger of both.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Conditioning {
    /// By a relative error 1 of the forces that acts for a step: it moves a peak by
    /// 1/(step · sharpness).
    pub forces: f64,
    /// By an interpolation of the peaks through fewer samples.
    pub interpolation: f64,
}

/// Times of flight after the wall's peak from which on a shot of a given duration may have a return: no
/// pulse comes back faster than it went, and the sensor bead rattles before.
const WAITED: f64 = 1.5;

impl Shot {
    /// The pulses as a plan picks them, from what its sensors showed.
    pub(crate) fn picked(
        plan: &Plan,
        seen: &Passages,
        passage: Result<Passage, PassageError>,
        duration_s: f64,
        solver: &str,
    ) -> Self {
        let passage = passage.map(|mut passage| {
            let way_s = passage.tof_incident_s();
            if plan.duration_s.is_some() && duration_s < passage.wall.time_s + WAITED * way_s {
                passage.drop_return();
            }
            passage
        });
        let passed = passage.as_ref().ok();
        let picked = |pick| Flight::picked(pick, seen, passed?);
        let between = (plan.chain.beads.len() - plan.sensor_bead) as f64 + 0.5;
        let flight = picked(plan.pick);
        Self {
            pulse_speed_beads_s: flight.map(|flight| between / flight.incident_s),
            flight,
            compared: plan.compare.iter().map(|&pick| picked(pick)).collect(),
            sensor_maxima: reported(seen.sensor().maxima()),
            passage,
            rebound: None,
            hardest: None,
            budget: None,
            trace: None,
            duration_s,
            finished: true,
            velocity_m_s: Vec::new(),
            work: Work::default(),
            accuracy_asked: plan.accuracy,
            accuracy_reached: None,
            solver: solver.to_owned(),
            tolerance: None,
            step_s: None,
            conditioning: Conditioning::default(),
            other_picks: Vec::new(),
            notes: Vec::new(),
        }
    }

    /// The wall's peak, with or without an incident one.
    pub fn wall(&self) -> Option<Maximum> {
        match &self.passage {
            Ok(passage) => Some(passage.wall),
            Err(PassageError::NoIncidentPulse { wall }) => Some(*wall),
            Err(PassageError::NoWallPulse { .. }) => None,
        }
    }

    /// The highest maximum, over its pulse's peak, that could be the incident or the
    /// wall's peak instead.
    pub fn competing_arrival(&self) -> Option<Maximum> {
        self.competing(&[Pulse::Incident, Pulse::Wall])
    }

    /// The same of the reflected pulse.
    pub fn competing_reflected(&self) -> Option<Maximum> {
        self.competing(&[Pulse::Reflected])
    }

    fn competing(&self, pulses: &[Pulse]) -> Option<Maximum> {
        let passage = self.passage.as_ref().ok()?;
        passage.highest_competing(pulses).map(|other| other.maximum)
    }

    /// Largest relative difference of two computations of one shot.
    pub(crate) fn change(&self, other: &Self) -> f64 {
        if let Some(change) = self.flights_change(other) {
            return change;
        }
        match (highest(&self.sensor_maxima), highest(&other.sensor_maxima)) {
            (Some(one), Some(two)) => relative(one.time_s, two.time_s),
            _ => velocity_change(&self.velocity_m_s, &other.velocity_m_s),
        }
    }

    /// Largest difference of the heights of incident and wall peak over the higher; infinite
    /// where one computation has none.
    pub(crate) fn height_change(&self, other: &Self) -> f64 {
        match (&self.passage, &other.passage) {
            (Ok(one), Ok(two)) => {
                let incident = (one.incident.value - two.incident.value).abs();
                let wall = (one.wall.value - two.wall.value).abs();
                incident.max(wall) / one.incident.value.max(one.wall.value)
            }
            (Err(_), Err(_)) => 0.0,
            _ => f64::INFINITY,
        }
    }

    /// Largest difference of the times of the three peaks, over the shortest time of flight.
    pub(crate) fn times_change(&self, other: &Self) -> f64 {
        let (Ok(one), Ok(two)) = (&self.passage, &other.passage) else {
            return 0.0;
        };
        let off_s = |one: Maximum, two: Maximum| (one.time_s - two.time_s).abs();
        let arrival_s = off_s(one.incident, two.incident).max(off_s(one.wall, two.wall));
        let back = one.reflected.zip(two.reflected);
        let flight_s = two.tof_reflected_s().unwrap_or(f64::INFINITY).min(two.tof_incident_s());
        back.map_or(arrival_s, |(one, two)| arrival_s.max(off_s(one, two))) / flight_s
    }

    /// The peaks of both computations, pulse by pulse; `None` where one has none.
    fn peak_pairs(&self, other: &Self) -> Option<[[Maximum; 2]; 3]> {
        let (one, two) = (self.passage.as_ref().ok()?, other.passage.as_ref().ok()?);
        Some([[one.incident, two.incident], [one.wall, two.wall], [one.reflected?, two.reflected?]])
    }

    /// Whether two computations have all peaks within some steps of this one.
    pub(crate) fn has_peaks_of(&self, other: &Self, steps: f64) -> bool {
        let within_s = steps * self.step_s.unwrap_or(0.0);
        let same = |[one, two]: [Maximum; 2]| (one.time_s - two.time_s).abs() <= within_s;
        let peaks = self.peak_pairs(other);
        peaks.is_some_and(|peaks| peaks.into_iter().all(same))
    }

    /// Largest relative difference of the heights of peaks.
    pub(crate) fn peaks_change(&self, other: &Self) -> f64 {
        let changes = self.peak_pairs(other).into_iter().flatten();
        let changes = changes.map(|[one, two]| relative(one.value, two.value));
        changes.fold(0.0, f64::max)
    }

    /// Largest relative difference of times of flight, however picked; `None`
    /// where neither computation has any.
    fn flights_change(&self, other: &Self) -> Option<f64> {
        let all = |shot: &Self| std::iter::once(shot.flight).chain(shot.compared.clone());
        let changes = all(self).zip(all(other)).filter_map(|pair| match pair {
            (Some(one), Some(two)) => Some(one.change(&two)),
            (None, None) => None,
            _ => Some(f64::INFINITY),
        });
        changes.reduce(f64::max)
    }
}

fn highest(maxima: &[Maximum]) -> Option<&Maximum> {
    maxima.iter().reduce(|best, peak| if peak.value > best.value { peak } else { best })
}

/// Largest difference of velocities over the largest velocity.
fn velocity_change(one: &[f64], two: &[f64]) -> f64 {
    let most = two.iter().fold(f64::MIN_POSITIVE, |most, v| most.max(v.abs()));
    let pairs = one.iter().zip(two);
    pairs.fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs())) / most
}

/// Runs a shot, once.
///
/// Fixed-step solvers without a step start from a twentieth of the contact
/// time and halve it until times of flight change by less than the accuracy.
///
/// # Errors
/// See [`StudyError`].
pub fn shoot(plan: &Plan) -> Result<Shot, StudyError> {
    PreparedShot::new(plan)?.run(Check::Unchecked)
}

/// Runs a shot with an estimate of its error.
///
/// With an energy budget, which asks for tight steps, two runs for times of flight
/// alone at looser tolerances estimate it; else two at a tenth and a hundredth of the tolerance,
/// as [`shoot_checked`]; a fixed step by one of twice its length. A shot whose estimate is above the accuracy asked is computed
/// more tightly.
///
/// # Errors
/// See [`StudyError`].
pub fn shoot_estimated(plan: &Plan) -> Result<Shot, StudyError> {
    PreparedShot::new(plan)?.run(Check::Estimated)
}

/// Runs a shot and again at a tenth and a hundredth of the tolerance (or at half the
/// fixed step), to learn which accuracy was reached.
///
/// # Errors
/// See [`StudyError`].
pub fn shoot_checked(plan: &Plan) -> Result<Shot, StudyError> {
    PreparedShot::new(plan)?.run(Check::Again)
}

/// Runs a shot of which a computation by another method is known: where both agree, once and at
/// a tenth of the tolerance; else as [`shoot_checked`].
///
/// # Errors
/// See [`StudyError`].
pub(crate) fn shoot_confirmed(plan: &Plan, other: &Shot) -> Result<Shot, StudyError> {
    PreparedShot::new(plan)?.run(Check::By(other))
}

/// Errors of peaks over the accuracy asked of times, at most.
pub const OF_PEAKS: f64 = 50.0;

/// Pulses whose peak could be another maximum: as high as far as the accuracy allows to
/// know, so that the next computation may pick the other, or at the sensor bead or the
/// wall on the way in.
pub(crate) fn ambiguous(passage: &Passage, accuracy: f64) -> Vec<String> {
    let note = |pulse: Pulse| {
        let of_pulse = |other: &&Competing| other.pulse == pulse;
        let others = || passage.competing.iter().filter(of_pulse);
        let highest = others().max_by(|a, b| a.share.total_cmp(&b.share))?;
        let Competing { share, maximum, .. } = highest;
        let (name, time) = (pulse.name(), maximum.time_s);
        if (1.0 - share).abs() <= OF_PEAKS * accuracy {
            return Some(format!(
                "the {name} pulse has two maxima whose heights differ by less than an accuracy of {accuracy:e} \
                 resolves: its time is that of the higher, the other is at t = {time:.6e}"
            ));
        }
        let count = others().count();
        (pulse != Pulse::Reflected).then(|| {
            format!(
                "the arrival is ambiguous: the {name} pulse has {count} other maxim{}, the highest {share:.3} times \
                 as high as its peak, at t = {time:.6e}",
                if count == 1 { "um" } else { "a" },
            )
        })
    };
    let pulses = [Pulse::Incident, Pulse::Wall, Pulse::Reflected];
    pulses.into_iter().filter_map(note).collect()
}

fn reported(maxima: &[Maximum]) -> Vec<Maximum> {
    let most = highest(maxima).map_or(0.0, |peak| peak.value);
    let large = |peak: &&Maximum| most > 0.0 && peak.value >= 0.05 * most;
    maxima.iter().filter(large).copied().collect()
}

/// Pulses are correlated over this many incident widths to either side.
const WIDTHS: f64 = 2.0;

/// Samples in one incident width.
const SAMPLES: f64 = 100.0;

impl Flight {
    fn picked(pick: Pick, seen: &Passages, passage: &Passage) -> Option<Self> {
        match pick {
            Pick::Peak => Some(Self {
                incident_s: passage.tof_incident_s(),
                reflected_s: passage.tof_reflected_s(),
            }),
            Pick::Flank10 | Pick::Flank50 => {
                let fraction = if pick == Pick::Flank10 { 0.1 } else { 0.5 };
                let [sensor, wall, back] = seen.flanks(passage, fraction);
                let wall = wall?;
                // Where the signal does not fall below the flank between two pulses, it is that of
                // the one before.
                let reflected_s = back.map(|back| back - wall).filter(|time_s| *time_s > 0.0);
                Some(Self { incident_s: wall - sensor?, reflected_s })
            }
            Pick::CrossCorrelation => correlated(seen, passage),
        }
    }

    /// Largest relative difference of two flights; infinite if only one has a
    /// reflected pulse.
    pub fn change(&self, other: &Self) -> f64 {
        let incident = relative(self.incident_s, other.incident_s);
        match (self.reflected_s, other.reflected_s) {
            (Some(one), Some(two)) => incident.max(relative(one, two)),
            (None, None) => incident,
            _ => f64::INFINITY,
        }
    }
}

fn relative(one: f64, two: f64) -> f64 {
    if one == two { 0.0 } else { ((one - two) / two).abs() }
}

fn correlated(seen: &Passages, passage: &Passage) -> Option<Flight> {
    let width = passage.incident_width_s?;
    let incident = sampled(seen.sensor(), passage.incident.time_s, width);
    let wall = sampled(seen.wall(), passage.wall.time_s, width);
    let lag = |one: &[f64], two: &[f64]| delay_by_cross_correlation(one, two, width / SAMPLES);
    let reflected_s = passage.reflected.and_then(|peak| {
        let back = sampled(seen.sensor(), peak.time_s, width);
        Some(peak.time_s - passage.wall.time_s + lag(&wall, &back)?)
    });
    Some(Flight { incident_s: passage.tof_incident_s() + lag(&incident, &wall)?, reflected_s })
}

/// A signal around a time, which is the middle sample.
fn sampled(signal: &Signal, middle_s: f64, width_s: f64) -> Vec<f64> {
    let half = (WIDTHS * SAMPLES) as i32;
    let at = |i: i32| signal.at(middle_s + f64::from(i) * width_s / SAMPLES);
    (-half..=half).map(at).collect()
}

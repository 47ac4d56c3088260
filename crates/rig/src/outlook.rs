//! What a campaign's recorder will not see, told before any shot is fired.

use crate::error::RigError;
use crate::plan::{Case, Plan};
use hertzchain_chain::observe::Passage;
use hertzchain_experiment::{Campaign, Recorder, Trigger};
use hertzchain_study::{Settings, sweep};

/// Relative accuracy of the shots that are looked at: records are longer or shorter by much more.
const ACCURACY: f64 = 1e-3;

/// Samples across a pulse's half maximum from which on its time is told as well as its
/// noise allows.
const ENOUGH: f64 = 10.0;

/// Fewer samples there, and no pulse is recorded as one.
const LEAST: f64 = 2.0;

/// Full widths at half maximum after a pulse's maximum until it is over.
const OVER: f64 = 1.5;

/// Standard deviations of speed and place by which a striker may be late.
const LATE: f64 = 3.0;

/// What the recorder will miss of the model's own shots, chains in equilibrium, at the slowest and at
/// the fastest speed of every case.
///
/// # Errors
/// A sampling rate that leaves no pulses: fewer than two samples across the half maximum of
/// the narrowest.
pub fn outlook(plan: &Plan) -> Result<Vec<String>, RigError> {
    let mut told = Vec::new();
    for case in &plan.cases {
        let speeds_m_s = &plan.experiment.campaign().speeds_m_s;
        let slowest = speeds_m_s.iter().copied().reduce(f64::min);
        let fastest = speeds_m_s.iter().copied().reduce(f64::max);
        for (speed_m_s, passage) in passages(case, slowest.into_iter().chain(fastest).collect()) {
            let seen = Seen {
                what: format!("case `{}` at {speed_m_s:.4} m/s", case.name),
                speed_m_s,
                passage,
            };
            told.extend(seen.rate(plan)?);
            told.extend(seen.length(plan));
        }
    }
    told.dedup();
    Ok(told)
}

/// The model's own shots in which a pulse reaches the wall. What can't be computed, the
/// campaign itself will tell.
fn passages(case: &Case, mut speeds_m_s: Vec<f64>) -> Vec<(f64, Passage)> {
    speeds_m_s.dedup();
    let settings = Settings {
        adjust: &|plan| *plan = plan.clone().with_accuracy(ACCURACY),
        ..Settings::default()
    };
    let points = sweep(&case.experiment, &speeds_m_s, &settings).points;
    let shots = points
        .into_iter()
        .filter_map(|point| Some((point.speed_m_s, point.shot.ok()?.passage.ok()?)));
    shots.collect()
}

/// A shot of the model.
struct Seen {
    what: String,
    speed_m_s: f64,
    passage: Passage,
}

impl Seen {
    fn rate(&self, plan: &Plan) -> Result<Option<String>, RigError> {
        let sampling_hz = recorder(plan).sampling_hz;
        let widths_s = [self.passage.incident_width_s, self.passage.wall_width_s];
        let Some(narrowest_s) = widths_s.into_iter().flatten().reduce(f64::min) else {
            return Ok(None);
        };
        let samples = narrowest_s * sampling_hz;
        let text = format!(
            "{}: sampled at {} kHz, its narrowest pulse, {:.1} µs wide at half its height, has {samples:.1} \
             samples there; sampling = \"{:.0} kHz\" gives ten",
            self.what,
            1e-3 * sampling_hz,
            1e6 * narrowest_s,
            (1e-3 * ENOUGH / narrowest_s).ceil(),
        );
        match samples {
            few if few < LEAST => Err(RigError::Unsuited(text)),
            few => Ok((few < ENOUGH).then_some(text)),
        }
    }

    fn length(&self, plan: &Plan) -> Option<String> {
        let (recorder, passage) = (recorder(plan), &self.passage);
        let trigger_s = match recorder.trigger {
            Trigger::Photogate => -self.way_s(plan.experiment.campaign()),
            // It is passed on the way up.
            Trigger::Level(_) => passage.incident.time_s,
        };
        let ends_s = trigger_s + recorder.record_s - recorder.before_s;
        let width_s = passage.incident_width_s.unwrap_or(0.0);
        let over_s = |time_s: f64| time_s + OVER * width_s;
        let wall_s = over_s(passage.wall.time_s);
        let back_s = passage.reflected.map(|peak| over_s(peak.time_s));
        let needed_s = back_s.unwrap_or(wall_s) - trigger_s + recorder.before_s;
        let missed = match back_s {
            _ if ends_s < wall_s => {
                "before the wave is at the wall, so that no time of flight can be told"
            }
            Some(back_s) if ends_s < back_s => {
                "before the wave is back at the sensor bead, so that no reflected time can be told"
            }
            _ => return None,
        };
        Some(format!(
            "{}: the record ends {:.2} ms after its trigger, {missed}; record = \"{:.1} ms\" is enough",
            self.what,
            1e3 * (recorder.record_s - recorder.before_s),
            (1e4 * needed_s).ceil() / 10.0,
        ))
    }

    /// From the gate to the touch, of a late striker.
    fn way_s(&self, campaign: &Campaign) -> f64 {
        let (gate, actuator) = (&campaign.photogate, &campaign.actuator);
        let slow_m_s = self.speed_m_s - LATE * actuator.spread_m_s;
        (gate.way_m + LATE * actuator.placing_m) / slow_m_s.max(0.5 * self.speed_m_s)
    }
}

fn recorder(plan: &Plan) -> &Recorder {
    &plan.experiment.campaign().recorder
}

//! Forecast of what a campaign's recorder will miss, before any shot is run.

use crate::rig::{Case, Plan, RigError};
use crate::{Batch, BatchOptions, Shard};
use hertzchain_chain::observe::Passage;
use hertzchain_experiment::{Campaign, Experiment, Recorder, Trigger};

/// Relative accuracy of the shots that are looked at: records are longer or shorter by much more.
const ACCURACY: f64 = 1e-3;

/// Samples across a pulse's half maximum from which on its time is as good as its
/// noise allows.
const ENOUGH: f64 = 10.0;

/// Fewer samples there, and no pulse is recorded as one.
const LEAST: f64 = 2.0;

/// Standard deviations of noise above no signal at all that it hardly ever passes: once in
/// three million samples.
const QUIET: f64 = 5.0;

/// Steps of the converter in its smallest pulse from which on rounding is nothing beside noise.
const STEPS: f64 = 32.0;

/// Full widths at half maximum after a pulse's maximum until it is over.
const OVER: f64 = 1.5;

/// Standard deviations of speed and place by which a striker may be late.
const LATE: f64 = 3.0;

/// What the recorder will miss of the model's own shots, chains in equilibrium, at the slowest and at
/// the fastest speed of every case, as the actuator spreads them.
///
/// # Errors
/// A sampling rate that leaves no pulses: fewer than two samples across the half maximum of
/// the narrowest.
pub fn forecast(plan: &Plan) -> Result<Vec<String>, RigError> {
    let mut warnings = Vec::from_iter(at_last_bead(&plan.experiment));
    let Campaign { speeds_m_s, actuator, .. } = plan.experiment.campaign();
    let off_m_s = LATE * actuator.spread_m_s;
    let slowest = speeds_m_s.iter().copied().reduce(f64::min).map(|v| (v - off_m_s).max(0.5 * v));
    let fastest = speeds_m_s.iter().copied().reduce(f64::max).map(|v| v + off_m_s);
    for case in &plan.cases {
        for (speed_m_s, passage) in passages(case, slowest.into_iter().chain(fastest).collect()) {
            let seen = SeenPulses {
                what: format!("case `{}` at {speed_m_s:.4} m/s", case.name),
                speed_m_s,
                passage,
            };
            warnings.extend(seen.rate(plan)?);
            warnings.extend(seen.length(plan));
            warnings.extend(seen.level(plan));
            warnings.extend(seen.range(plan));
        }
    }
    warnings.dedup();
    Ok(warnings)
}

/// Of a sensor bead that touches the wall, whose pulses lie on the wall's.
fn at_last_bead(experiment: &Experiment) -> Option<String> {
    let (bead, beads) = (experiment.sensor_bead(), experiment.beads());
    (bead == beads).then(|| {
        format!(
            "sensor bead {bead} is the last: its pulses lie on the wall's, and no time between them can be \
             measured; bead = {} or less in [sensors] leaves some",
            beads.saturating_sub(3).max(1)
        )
    })
}

/// The model's own shots in which a pulse reaches the wall. What can't be computed, the
/// campaign itself will report.
fn passages(case: &Case, mut speeds_m_s: Vec<f64>) -> Vec<(f64, Passage)> {
    speeds_m_s.dedup();
    let options =
        BatchOptions { accuracy: ACCURACY, rebound: true, ..BatchOptions::of(&case.experiment) };
    let mut passages = Vec::new();
    if let Ok(batch) = Batch::new(&case.experiment, speeds_m_s, options) {
        let _ = batch.run_each(Shard::WHOLE, &|| {}, |it| {
            let passage = it.shot.ok().and_then(|shot| shot.passage.ok());
            passages.extend(passage.map(|passage| (it.speed_m_s, passage)));
        });
    }
    passages
}

/// A shot of the model.
struct SeenPulses {
    what: String,
    speed_m_s: f64,
    passage: Passage,
}

impl SeenPulses {
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
                "before the wave is at the wall, so that there is no time of flight"
            }
            Some(back_s) if ends_s < back_s => {
                "before the wave is back at the sensor bead, so that there is no reflected time of flight"
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

    /// Voltages of the incident, the wall and the reflected pulse above the offset.
    fn peaks_v(&self, plan: &Plan) -> [Option<f64>; 3] {
        let amplifier = &plan.experiment.campaign().amplifier;
        let volts = |charge_c_n: f64, force_n: f64| amplifier.gain_v_c * charge_c_n * force_n;
        let back = self.passage.reflected;
        [
            Some(volts(amplifier.sensitivity_c_n, self.passage.incident.value)),
            Some(volts(amplifier.wall_sensitivity_c_n, self.passage.wall.value)),
            back.map(|peak| volts(amplifier.sensitivity_c_n, peak.value)),
        ]
    }

    fn level(&self, plan: &Plan) -> Option<String> {
        let recorder = recorder(plan);
        let Trigger::Level(level_v) = recorder.trigger else {
            return None;
        };
        let incident_v = self.peaks_v(plan)[0]?;
        let noise_v = plan.experiment.campaign().amplifier.noise_v;
        let asked_v = level_v - recorder.offset_v;
        let what = &self.what;
        let better_v = recorder.offset_v + (0.5 * incident_v).max(QUIET * noise_v);
        if asked_v > incident_v {
            return Some(format!(
                "{what}: its incident pulse of {incident_v:.3} V about {} V never passes the trigger's \
                 level of {level_v} V; level = \"{better_v:.3} V\" would be passed",
                recorder.offset_v
            ));
        }
        (asked_v < QUIET * noise_v).then(|| {
            format!(
                "{what}: the trigger's level of {level_v} V is within the noise, {noise_v} V about {} V, \
                 which passes it without a shot or never from below; level = \"{better_v:.3} V\" is \
                 half way up the incident pulse or above the noise",
                recorder.offset_v
            )
        })
    }

    fn range(&self, plan: &Plan) -> Option<String> {
        let recorder = recorder(plan);
        let peaks_v = self.peaks_v(plan);
        let largest_v = peaks_v.into_iter().flatten().fold(0.0, f64::max);
        let smallest_v = peaks_v.into_iter().flatten().reduce(f64::min)?;
        let (top_v, what) = (recorder.offset_v + largest_v, &self.what);
        if top_v > recorder.range_v {
            return Some(format!(
                "{what}: its largest pulse goes to {top_v:.3} V and is clipped at the converter's range \
                 of ± {} V; range = \"{:.2} V\" or a lower `gain` is enough",
                recorder.range_v,
                (120.0 * top_v).ceil() / 100.0
            ));
        }
        let step_v = recorder.range_v / f64::from(1u32 << (recorder.bits.clamp(2, 16) - 1));
        let steps = smallest_v / step_v;
        let noise_v = plan.experiment.campaign().amplifier.noise_v;
        (steps < STEPS && noise_v < 0.5 * step_v).then(|| {
            format!(
                "{what}: its smallest pulse of {smallest_v:.2e} V has {steps:.1} steps of the converter; a \
                 smaller `range`, more `bits` or a higher `gain` gives more",
            )
        })
    }

    /// From the gate to the touch, of a late striker.
    fn way_s(&self, campaign: &Campaign) -> f64 {
        let (gate, actuator) = (&campaign.photogate, &campaign.actuator);
        (gate.way_m + LATE * actuator.placing_m) / self.speed_m_s
    }
}

fn recorder(plan: &Plan) -> &Recorder {
    &plan.experiment.campaign().recorder
}

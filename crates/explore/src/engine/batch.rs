//! Times of flight against speed.

use super::{Refusal, effort, outline};
use hertzchain_measure::signal::PowerLaw;
use hertzchain_sim::{Batch, BatchOptions, Column, Plan, Shard};
use serde::{Deserialize, Serialize};

/// Speeds of the striker, spread evenly in the logarithm.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Speeds {
    /// Slowest, in m/s.
    pub from_m_s: f64,
    /// Fastest, in m/s.
    pub to_m_s: f64,
    /// How many.
    pub count: usize,
}

/// Most speeds of a curve.
const MOST_SPEEDS: usize = 1000;

/// Times of flight against speed; null where a speed has none.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BatchReply {
    /// Speeds in m/s.
    pub speed_m_s: Vec<f64>,
    /// Incident times of flight in s.
    pub tof_incident_s: Vec<Option<f64>>,
    /// Reflected times of flight in s.
    pub tof_reflected_s: Vec<Option<f64>>,
    /// Power law of the incident ones.
    pub power_law_incident: Option<PowerLawReply>,
    /// Power law of the reflected ones.
    pub power_law_reflected: Option<PowerLawReply>,
    /// Speeds that failed, and why.
    pub failed: Vec<(f64, String)>,
}

/// Time of flight = prefactor · speed^exponent, by least squares in the logarithms.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PowerLawReply {
    /// Time of flight at 1 m/s, in s.
    pub prefactor_s: f64,
    /// Exponent.
    pub exponent: f64,
    /// Its standard error, from the scatter about the law; null for two speeds.
    pub exponent_error: Option<f64>,
}

impl Speeds {
    fn all(self) -> Result<Vec<f64>, Refusal> {
        let Self { from_m_s, to_m_s, count } = self;
        let ordered = from_m_s > 0.0 && from_m_s < to_m_s && to_m_s.is_finite();
        if !ordered || !(2..=MOST_SPEEDS).contains(&count) {
            return Err(Refusal::Error(format!(
                "{count} speeds from {from_m_s} to {to_m_s} m/s: expected 2 to {MOST_SPEEDS} speeds, the first above 0 and \
                 below the last"
            )));
        }
        let ratio = to_m_s / from_m_s;
        let last = (count - 1) as f64;
        Ok((0..count).map(|at| from_m_s * ratio.powf(at as f64 / last)).collect())
    }
}

/// Returns times of flight against speed.
pub(super) fn batch(text: &str, speeds: &Speeds) -> Result<BatchReply, Refusal> {
    let experiment = outline::experiment(text)?;
    let speeds = speeds.all()?;
    let of_study = |error| Refusal::of_study(text, error);
    let of_text = |mistakes| Refusal::of_text(text, &mistakes);
    let (plan, _warnings) = Plan::from_experiment(&experiment, None).map_err(of_text)?;
    effort::check_time(&plan, speeds.len())?;
    let options = BatchOptions::of(&experiment);
    let batch = Batch::new(&experiment, speeds, options).map_err(of_study)?;
    let result = batch.run(Shard::WHOLE, &|| {});
    let column = |of| {
        let numbers = result.rows.column(of).iter();
        numbers.map(|number| number.is_finite().then_some(*number)).collect()
    };
    let speed_m_s = result.rows.column(Column::Speed).to_vec();
    let law = |of| law(result.rows.law(of, result.accuracy).0.ok());
    let failed = result.rows.failed.iter();
    Ok(BatchReply {
        tof_incident_s: column(Column::Incident),
        tof_reflected_s: column(Column::Reflected),
        power_law_incident: law(Column::Incident),
        power_law_reflected: law(Column::Reflected),
        failed: failed
            .filter_map(|failed| Some((*speed_m_s.get(failed.place)?, failed.why.clone())))
            .collect(),
        speed_m_s,
    })
}

fn law(law: Option<PowerLaw>) -> Option<PowerLawReply> {
    law.map(|law| PowerLawReply {
        prefactor_s: law.prefactor,
        exponent: law.exponent,
        exponent_error: law.exponent_error.is_finite().then_some(law.exponent_error),
    })
}

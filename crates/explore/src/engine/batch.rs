//! Times of flight against speed.

use super::{Refusal, effort, outline};
use hertzchain_measure::signal::PowerLaw;
use hertzchain_sim::{Batch, BatchOptions, Column, Plan, Rows, Shard};
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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

/// Returns times of flight against speed, of a shard by its number from 1 and how many there are.
pub(super) fn batch(
    text: &str,
    speeds: &Speeds,
    shard: Option<(usize, usize)>,
) -> Result<BatchReply, Refusal> {
    let experiment = outline::experiment(text)?;
    let speeds = speeds.all()?;
    let of_study = |error| Refusal::of_study(text, error);
    let of_text = |mistakes| Refusal::of_text(text, &mistakes);
    let shard = shard.map_or(Ok(Shard::WHOLE), |(number, of)| Shard::new(number, of));
    let shard = shard.map_err(of_study)?;
    let (plan, _warnings) = Plan::from_experiment(&experiment, None).map_err(of_text)?;
    effort::check_time(&plan, speeds.len())?;
    let options = BatchOptions::of(&experiment);
    let batch = Batch::new(&experiment, speeds.clone(), options).map_err(of_study)?;
    let rows = batch.run(shard, &|| {}).rows;
    let failed = rows.failed.iter();
    let failed = failed.filter_map(|one| Some((*speeds.get(one.place)?, one.why.clone())));
    Ok(BatchReply::of(&rows, failed.collect()))
}

/// Returns the curve whose shards these are, the first one first.
pub(super) fn join(shards: &[BatchReply]) -> BatchReply {
    let rows: Vec<Rows> = shards.iter().map(BatchReply::rows).collect();
    let mut failed: Vec<_> = shards.iter().flat_map(|shard| shard.failed.clone()).collect();
    failed.sort_by(|one, other| one.0.total_cmp(&other.0));
    BatchReply::of(&Rows::dealt(&rows), failed)
}

impl BatchReply {
    fn of(rows: &Rows, failed: Vec<(f64, String)>) -> Self {
        let column = |of| {
            let numbers = rows.column(of).iter();
            numbers.map(|number| number.is_finite().then_some(*number)).collect()
        };
        // Accuracies are not asked for with the law.
        let law = |of| law(rows.law(of, f64::NAN).0.ok());
        Self {
            speed_m_s: rows.column(Column::Speed).to_vec(),
            tof_incident_s: column(Column::Incident),
            tof_reflected_s: column(Column::Reflected),
            power_law_incident: law(Column::Incident),
            power_law_reflected: law(Column::Reflected),
            failed,
        }
    }

    /// Its columns as the library has them.
    fn rows(&self) -> Rows {
        let mut rows = Rows::default();
        let numbers = |of: &[Option<f64>]| of.iter().map(|one| one.unwrap_or(f64::NAN)).collect();
        rows.columns[Column::Speed as usize].clone_from(&self.speed_m_s);
        rows.columns[Column::Incident as usize] = numbers(&self.tof_incident_s);
        rows.columns[Column::Reflected as usize] = numbers(&self.tof_reflected_s);
        // A law takes an accuracy for each time, known or not.
        rows.columns[Column::Accuracy as usize] = vec![f64::NAN; self.speed_m_s.len()];
        rows
    }
}

fn law(law: Option<PowerLaw>) -> Option<PowerLawReply> {
    law.map(|law| PowerLawReply {
        prefactor_s: law.prefactor,
        exponent: law.exponent,
        exponent_error: law.exponent_error.is_finite().then_some(law.exponent_error),
    })
}

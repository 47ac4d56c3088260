//! Records in memory, measured as recordings on disk are.

use crate::failure::Failure;
use crate::measure::{self, MeasureResult};
use crate::options::MeasureOptions;
pub use hertzchain_measure::records::{Channel, Record};

/// Measures times of flight on records in memory: each is a shot, or holds several that are cut.
///
/// ```
/// use hertzchain::prelude::*;
///
/// // A computed shot, sampled at 1 MHz by the sensors of the bead and of the wall.
/// let row = preset("dry")?;
/// let options = ShotOptions::at(0.5);
/// let mut prepared = PreparedShot::new(&row, &options)?;
/// prepared.plan = prepared.plan.watching(row.sensors(), Some(1e-6));
/// let shot = prepared.run()?;
/// let columns = &shot.trace.as_ref().expect("sensors are watched").columns;
/// let channel = |volts: &Vec<f64>| Channel { volts: volts.clone(), ..Channel::default() };
/// let record = Record {
///     file: "shot 1".into(),
///     interval_s: 1e-6,
///     channels: columns.iter().map(channel).collect(),
///     speed_m_s: Some(0.5),
///     ..Record::default()
/// };
/// let measured = measure_records(vec![record], &MeasureOptions::default())?;
/// let picked = measured.shots.shots[0].flight.as_ref().expect("both pulses are there");
/// let incident_s = shot.flight.expect("the pulse reaches the wall").incident_s;
/// // A tenth of a sample.
/// assert!((picked.incident_s.value - incident_s).abs() < 1e-7);
/// # Ok::<(), hertzchain::Failure>(())
/// ```
///
/// # Errors
/// Options that do not go together, or that no record takes.
pub fn measure_records(
    records: Vec<Record>,
    options: &MeasureOptions,
) -> Result<MeasureResult, Failure> {
    let how = measure::options(options, measure::rig(options)?.as_ref())?;
    let shots = hertzchain_measure::measure_records(records, &how, &());
    MeasureResult::new(shots, options)
}

//! Whether speeds are in another unit than m/s, by what times of flight they make.

use super::model::Speeds;
use super::problem::MeasuredCurve;
use crate::data::Observable;
use hertzchain_measure::signal::median;

/// A smaller unit of speed, and how many make 1 m/s.
const SMALLER: [(&str, f64); 2] = [("cm/s", 100.0), ("mm/s", 1000.0)];

/// How far ln(measured/predicted) may be where speeds are taken in the right unit, in the
/// middle of a curve: materials and pushes move times by less than units do, a hundred times
/// the speed by about its fifth root.
const NEAR: f64 = 0.2;

impl MeasuredCurve {
    /// The unit that speeds seem to be in, if it is not m/s: the model, where its parameters
    /// start, has the measured times of flight at speeds that many times slower, and not at
    /// those that stand in the table.
    pub fn other_unit_of_speed(&self, start: &[f64]) -> Option<&'static str> {
        let near =
            |factor: f64| self.middle_miss(start, factor).is_some_and(|miss| miss.abs() < NEAR);
        if near(1.0) {
            return None;
        }
        let of = SMALLER.iter().find(|(_, factor)| near(*factor));
        of.map(|(unit, _)| *unit)
    }

    /// Median of ln(measured/predicted) of incident times at speeds so many times slower.
    fn middle_miss(&self, start: &[f64], factor: f64) -> Option<f64> {
        let speeds: Vec<f64> = self.data.speeds_m_s().iter().map(|v| v / factor).collect();
        let curve = self.model.curve(&self.own(start), &Speeds::of_rows(&speeds)).ok()?;
        let miss = |(row, predicted): (&crate::DataRow, &super::Predicted)| {
            let measured = row.value(Observable::Incident)?.value;
            Some((measured / predicted[Observable::Incident.index()]?).ln())
        };
        let rows = self.data.rows.iter().zip(&curve);
        median(&rows.filter_map(miss).collect::<Vec<_>>())
    }
}

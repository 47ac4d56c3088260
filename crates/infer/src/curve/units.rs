//! Whether speeds are in another unit than m/s, by what times of flight they make.

use super::problem::CurveProblem;
use crate::data::Observable;
use crate::problem::Problem;

/// A smaller unit of speed, and how many make 1 m/s.
const SMALLER: [(&str, f64); 2] = [("cm/s", 100.0), ("mm/s", 1000.0)];

/// d ln(time of flight)/d ln(speed) of waves in beads that touch with hardly a push, −1/5:
/// the speed of a solitary wave of Hertz contacts goes as the fifth root of the striker's.
const SLOPE: f64 = -0.2;

/// How far ln(measured/predicted) may be from what a unit makes of it: a quarter of what is
/// between the units.
const NEAR: f64 = 0.115;

impl CurveProblem {
    /// The unit that speeds seem to be in, if it is not m/s: times of flight are longer than
    /// the model's, where its parameters start, by as much as speeds that many times slower
    /// make them.
    #[must_use]
    pub fn other_unit_of_speed(&self) -> Option<&'static str> {
        let start: Vec<f64> = self.parameters().iter().map(|p| p.start).collect();
        let curve = self.curves(&[start]).pop()?.ok()?;
        let miss = |(row, predicted): (&crate::DataRow, &super::Predicted)| {
            let measured = row.value(Observable::Incident)?.value;
            Some((measured / predicted[Observable::Incident.index()]?).ln())
        };
        let rows = self.data().rows.iter().zip(&curve);
        let mut misses: Vec<f64> = rows.filter_map(miss).collect();
        misses.sort_by(f64::total_cmp);
        let middle = *misses.get(misses.len() / 2)?;
        let near = |(_, factor): &&(&str, f64)| (middle + SLOPE * factor.ln()).abs() < NEAR;
        SMALLER.iter().find(near).map(|(unit, _)| *unit)
    }
}

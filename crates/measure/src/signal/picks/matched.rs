//! A shape fitted to the whole pulse.

use super::normal::{Descent, MOST, Normal, descend};
use super::{Moved, Picked, Shape, Sight};
use crate::signal::Pulse;
use crate::signal::error::SignalError;

/// Height, time in samples, width in samples, offset.
#[derive(Clone, Copy)]
struct Model {
    height: f64,
    time: f64,
    width: f64,
    offset: f64,
}

/// Parameters of a model.
const PARAMETERS: usize = 4;

/// Time in samples: Levenberg–Marquardt's least squares of four parameters;
/// covariance noise² (JᵀJ)⁻¹. Clipped samples tell nothing and are left out.
pub(super) fn pick(
    sight: &Sight<'_>,
    pulse: &Pulse,
    shape: &Shape,
    width: f64,
) -> Result<Picked, SignalError> {
    let no_fit = || SignalError::NoPick {
        place: pulse.place,
        what: "fit of the shape",
    };
    let data = Data::about(sight, pulse, width);
    let found = data.fit(pulse, shape).ok_or_else(no_fit)?;
    let solution = found.normal.solve().ok_or_else(no_fit)?;
    let model = found.model;
    let noise = sight.broad_noise(pulse);
    let sigma = |k: usize| noise * solution.inverse[k][k].sqrt();
    let freedom = data.points.len().saturating_sub(PARAMETERS).max(1);
    Ok(Picked {
        time_s: model.time,
        sigma_s: sigma(1),
        moved: Moved::default(),
        height: model.height,
        height_sigma: sigma(0),
        width_s: model.width,
        misfit: sight.misfit(pulse, (found.left / freedom as f64).sqrt()),
    })
}

/// Samples to be fitted: their numbers and heights.
struct Data {
    points: Vec<(f64, f64)>,
}

impl Data {
    fn about(sight: &Sight<'_>, pulse: &Pulse, width: f64) -> Self {
        let half = (0.5 * width * pulse.width_samples).max(3.0);
        let at = pulse.at as f64;
        let (first, heights) = sight.window(at - half, at + half);
        let raw = sight.samples[first..first + heights.len()].iter();
        let free = |x: &f64| sight.rails.is_none_or(|rails| !rails.hold(*x));
        let points = heights.iter().zip(raw).enumerate();
        let points = points.filter(|(i, (_, raw))| free(raw) && !pulse.is_clipped(first + i));
        let points = points.map(|(i, (height, _))| ((first + i) as f64, *height));
        Self {
            points: points.collect(),
        }
    }

    /// The best model.
    fn fit(&self, pulse: &Pulse, shape: &Shape) -> Option<Descent<Model>> {
        let start = Model {
            height: pulse.height,
            time: pulse.at as f64,
            width: pulse.width_samples,
            offset: 0.0,
        };
        descend(
            start,
            |model| model.sound(pulse).then(|| self.normal(model, shape)),
            Model::moved,
            |before, after| (after.time - before.time).abs() < 1e-9 * pulse.width_samples,
        )
    }

    /// Normal equations of a step from a model, and the model's sum of squares.
    fn normal(&self, model: &Model, shape: &Shape) -> (Normal, f64) {
        let mut normal = Normal::new(PARAMETERS);
        let mut squares = 0.0;
        for (at, height) in &self.points {
            let z = (at - model.time) / model.width;
            let (value, slope) = shape.value_slope(z);
            let miss = height - model.offset - model.height * value;
            let by_time = -model.height * slope / model.width;
            let mut row = [0.0; MOST];
            row[..PARAMETERS].copy_from_slice(&[value, by_time, by_time * z, 1.0]);
            normal.add(&row, miss);
            squares += miss * miss;
        }
        (normal, squares)
    }
}

impl Model {
    fn moved(&self, step: &[f64; MOST]) -> Self {
        let [height, time, width, offset, ..] = *step;
        Self {
            height: self.height + height,
            time: self.time + time,
            width: self.width + width,
            offset: self.offset + offset,
        }
    }

    /// Still the same pulse: upright, near where it was, not out of all proportion.
    fn sound(&self, pulse: &Pulse) -> bool {
        let widths = self.width / pulse.width_samples;
        let moved = (self.time - pulse.at as f64).abs();
        self.height > 0.0 && (0.2..5.0).contains(&widths) && moved < pulse.width_samples
    }
}

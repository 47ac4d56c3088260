//! Times of pulses found, by four methods, each with its uncertainty.

mod amplifier;
mod bell;
mod bound;
mod cap;
mod correlation;
mod flanks;
mod local_model;
mod matched;
pub(crate) mod normal;
mod onset;
pub(crate) mod polynomial;
mod shape;
mod under;

pub use amplifier::Bandwidth;
pub use bound::{cramer_rao_of_samples_s, cramer_rao_s};
pub(crate) use cap::clipped_top;
pub use shape::Shape;

use crate::signal::error::SignalError;
use crate::signal::{Channels, Estimate, Found, Place, Pulse, Rails, Upright};

/// How a pulse's time is told. What each is worth: docs/measuring.md.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Method {
    /// Time of the maximum of a bell whose logarithm is a polynomial of degree 10,
    /// fitted over 1.1 widths of the steeper flank. Coefficients beyond a Gaussian's are those of
    /// computed rows ± 0.2 before the samples are looked at, so noise does not bend it.
    ///
    /// *Bias:* none for symmetric pulses; of skewed ones, less than the stated
    /// error, which holds what the shape leaves open. Where noise hides the bell's
    /// maximum, as for [`Method::LocalModel`].
    #[default]
    Maximum,
    /// Time of the maximum of a polynomial fitted about the largest sample.
    ///
    /// *Bias:* none for symmetric pulses; of a skewed one, what the polynomial
    /// leaves over: less with higher degree or smaller width. The only method
    /// that means the maximum whatever the shape. Where noise leaves this fit no
    /// maximum, degree 4 over 1.2 widths is tried, then a parabola over 0.8.
    LocalModel {
        /// Degree of the polynomial, 2 to 8.
        degree: usize,
        /// Full width of the fit, in full widths at half maximum of the pulse.
        width: f64,
    },
    /// Time at which the rising flank passes a share of the maximum.
    ///
    /// *Bias:* against maxima, the difference of the two pulses' rise times
    /// from that share: first order in a difference of widths. A drifting
    /// baseline shifts it.
    Onset {
        /// Share of the maximum, between 0 and 1.
        fraction: f64,
    },
    /// Time at which a template fits best, by its correlation with the signal.
    ///
    /// *Bias:* none for pulses that differ in height alone, nor for symmetric
    /// ones of different widths; for pulses of different skewness a share of
    /// the width.
    CrossCorrelation(Template),
    /// Time of a shape fitted with its height, width and offset free.
    ///
    /// *Bias:* none if both pulses have the shape, whatever their widths; for
    /// skewed pulses a share of the width that is the same for both only if
    /// their skewness is.
    MatchedShape {
        /// The shape.
        shape: Shape,
        /// Full width of the fit, in full widths at half maximum of the pulse.
        width: f64,
    },
}

/// What signals are correlated with.
#[derive(Clone, Debug, PartialEq)]
pub enum Template {
    /// The passing pulse itself.
    Passing,
    /// A shape, as wide at half maximum as the passing pulse is.
    Shape(Shape),
    /// A shape of a given full width at half maximum in s.
    Fixed(Shape, f64),
}

/// A pulse as picked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    /// Its time, in s after the first sample.
    pub time_s: f64,
    /// Standard deviation of that: by the record's noise and, of maxima, by what a
    /// shape leaves open and what lies under a pulse. Other biases are not in it.
    pub sigma_s: f64,
    /// The part of that which alike shots share.
    pub moved: Moved,
    /// Height above the baseline, or above the fit's own offset, in the samples' unit.
    pub height: f64,
    /// Standard deviation of that by the record's noise.
    pub height_sigma: f64,
    /// Full width at half maximum in s.
    pub width_s: f64,
    /// What the fit leaves over noise: near 1 if the model describes the
    /// pulse. `None` if nothing was fitted or there is no noise.
    pub misfit: Option<f64>,
}

/// Another maximum of a pulse as picked, which could be the largest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickedRival {
    /// It.
    pub picked: Picked,
    /// How much lower it is than the one that was picked, in the samples' unit.
    pub lower: Estimate,
}

impl PickedRival {
    /// How likely noise alone made it the lower: the normal distribution's tail.
    #[must_use]
    pub fn chance(&self) -> f64 {
        let Estimate { value, sigma } = self.lower;
        match value == 0.0 {
            true => 0.5,
            false => 0.5 * libm::erfc(value / sigma / std::f64::consts::SQRT_2),
        }
    }
}

/// What may have moved a maximum in all alike shots by the same, so that no mean over them makes
/// it smaller. 0 of other methods.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moved {
    /// How far in s what lies under the pulse in a summed channel may have moved it, with its sign.
    pub under_s: f64,
    /// What the samples leave open of the pulse's shape, in s; and of the interval between them.
    pub shape_s: f64,
}

/// One channel with what turns it upright, as pickers see it.
pub(crate) struct Sight<'a> {
    pub(crate) samples: &'a [f64],
    pub(crate) upright: Upright,
    pub(crate) rails: Option<Rails>,
    /// Whether both sensors are in this channel.
    pub(crate) summed: bool,
    /// Sample of the wall's maximum, for the pulse that comes back from there.
    pub(crate) wall: Option<usize>,
    /// Coefficients of the inverse of the amplifier's low-pass; 0 where none is taken out.
    pub(crate) inverse: [f64; 2],
}

impl Sight<'_> {
    /// Heights from sample `from` to `to`, clipped to the record, and the first's number.
    fn window(&self, from: f64, to: f64) -> (usize, Vec<f64>) {
        let end = self.samples.len();
        let first = (from.floor().max(0.0) as usize).min(end);
        let last = ((to.ceil().max(0.0) as usize).saturating_add(1)).clamp(first, end);
        let heights = self.samples[first..last].iter();
        let heights = heights.map(|x| self.upright.height(*x)).collect();
        (first, heights)
    }

    /// Noise of one sample; at least a digitiser's rounding, which a quiet
    /// stretch between two of its steps does not show.
    fn noise(&self, pulse: &Pulse) -> f64 {
        let rounding = self.upright.rounding(pulse.height);
        self.upright.level.noise.max(rounding)
    }

    /// As [`Self::noise`], for what averages over many samples.
    fn broad_noise(&self, pulse: &Pulse) -> f64 {
        let broad = self.upright.level.broad_noise();
        broad.max(self.upright.rounding(pulse.height))
    }

    /// `left` over the noise, if there is noise.
    fn misfit(&self, pulse: &Pulse, left: f64) -> Option<f64> {
        let noise = self.noise(pulse);
        (noise > 0.0).then(|| left / noise)
    }
}

/// The three pulses of a shot as picked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picks {
    /// At the sensor bead, on the way in.
    pub passing: Picked,
    /// At the wall.
    pub wall: Picked,
    /// At the sensor bead, on the way back, if it was found and could be picked.
    pub returning: Option<Picked>,
    /// Other maxima of the three, in this order, that are nearly as high.
    pub rivals: [Option<PickedRival>; 3],
}

/// Picks the pulses that were found, given the digitiser's range, where it is known, in the
/// channels that hold the sensor's and the wall's pulses.
///
/// # Errors
/// No passing or no wall's pulse; no maximum or crossing where one of these is;
/// options out of range. A return that cannot be picked is left out.
pub fn pick(
    channels: Channels<'_>,
    interval_s: f64,
    found: &Found,
    method: &Method,
    rails: [Option<Rails>; 2],
) -> Result<Picks, SignalError> {
    pick_before(channels, interval_s, found, method, (rails, None))
}

/// As [`pick`], with maxima as they were before an amplifier's low-pass; of other methods' times it
/// takes nothing out.
pub(crate) fn pick_before(
    channels: Channels<'_>,
    interval_s: f64,
    found: &Found,
    method: &Method,
    (rails, amplifier): ([Option<Rails>; 2], Option<Bandwidth>),
) -> Result<Picks, SignalError> {
    SignalError::positive("sampling interval in s", interval_s)?;
    method.check()?;
    let need = |pulse: &Option<Pulse>, place| pulse.ok_or(SignalError::Missing { place });
    let passing = need(&found.passing, Place::Passing)?;
    let wall = need(&found.wall, Place::Wall)?;
    let inverse = amplifier.map(|amplifier| amplifier.inverse(interval_s));
    let inverse = inverse.transpose()?.filter(|_| *method == Method::Maximum);
    let sensor = Sight {
        samples: channels.sensor(),
        inverse: inverse.unwrap_or_default(),
        upright: found.sensor,
        rails: rails[0],
        summed: matches!(channels, Channels::Summed(_)),
        wall: None,
    };
    let at_wall = Sight {
        samples: channels.wall(),
        upright: found.wall_channel,
        rails: rails[1],
        ..sensor
    };
    let coming_back = Sight {
        wall: Some(wall.at),
        ..sensor
    };
    let picker = Picker::new(method, &sensor, &passing, interval_s)?;
    let finish = |picked: Picked| picked.in_seconds(interval_s);
    let picked = |pulse: Pulse| picker.pick(&coming_back, &pulse).ok();
    let returning = found.returning.and_then(picked);
    let rival = |place, sight: &Sight<'_>| {
        let rival = found
            .rivals
            .iter()
            .find(|rival| rival.pulse.place == place)?;
        Some(PickedRival {
            picked: finish(picker.pick(sight, &rival.pulse).ok()?),
            lower: rival.lower,
        })
    };
    Ok(Picks {
        passing: finish(picker.pick(&sensor, &passing)?),
        wall: finish(picker.pick(&at_wall, &wall)?),
        returning: returning.map(finish),
        rivals: [
            rival(Place::Passing, &sensor),
            rival(Place::Wall, &at_wall),
            rival(Place::Returning, &coming_back).filter(|_| returning.is_some()),
        ],
    })
}

/// A pulse's maximum as the samples about it tell, in samples.
pub(crate) fn fitted(sight: &Sight<'_>, pulse: &Pulse) -> Option<Picked> {
    Picker::Maximum.pick(sight, pulse).ok()
}

impl Picked {
    /// From samples to s.
    fn in_seconds(self, interval_s: f64) -> Self {
        Self {
            time_s: self.time_s * interval_s,
            sigma_s: self.sigma_s * interval_s,
            moved: Moved {
                under_s: self.moved.under_s * interval_s,
                shape_s: self.moved.shape_s * interval_s,
            },
            width_s: self.width_s * interval_s,
            ..self
        }
    }
}

impl Method {
    fn check(&self) -> Result<(), SignalError> {
        let within = |name, value: f64, low: f64, high: f64, expected| {
            let good = value >= low && value <= high;
            good.then_some(()).ok_or(SignalError::Option {
                name,
                value,
                expected,
            })
        };
        let wide = "a number from 0.2 to 4";
        match self {
            Self::LocalModel { degree, width } => {
                let degree = *degree as f64;
                within("degree of the local model", degree, 2.0, 8.0, "2 to 8")?;
                within("width of the local model", *width, 0.2, 4.0, wide)
            }
            Self::Onset { fraction } => {
                let expected = "a share of the maximum from 0.02 to 0.95";
                within("threshold", *fraction, 0.02, 0.95, expected)
            }
            Self::CrossCorrelation(Template::Fixed(_, width_s)) => {
                SignalError::positive("width of the template in s", *width_s)
            }
            Self::Maximum | Self::CrossCorrelation(_) => Ok(()),
            Self::MatchedShape { width, .. } => within("width of the fit", *width, 0.2, 4.0, wide),
        }
    }
}

/// A method made ready for one shot; times in samples.
enum Picker<'a> {
    Maximum,
    Local { degree: usize, width: f64 },
    Onset(f64),
    Correlation(correlation::Correlator),
    Matched(&'a Shape, f64),
}

impl<'a> Picker<'a> {
    fn new(
        method: &'a Method,
        sensor: &Sight<'_>,
        passing: &Pulse,
        interval_s: f64,
    ) -> Result<Self, SignalError> {
        Ok(match method {
            Method::Maximum => Self::Maximum,
            Method::LocalModel { degree, width } => Self::Local {
                degree: *degree,
                width: *width,
            },
            Method::Onset { fraction } => Self::Onset(*fraction),
            Method::MatchedShape { shape, width } => Self::Matched(shape, *width),
            Method::CrossCorrelation(Template::Passing) if passing.clipped.is_some() => {
                return Err(SignalError::NoPick {
                    place: passing.place,
                    what: "top to be a template, clipped as it is,",
                });
            }
            Method::CrossCorrelation(template) => Self::Correlation(correlation::Correlator::new(
                template, sensor, passing, interval_s,
            )?),
        })
    }

    fn pick(&self, sight: &Sight<'_>, pulse: &Pulse) -> Result<Picked, SignalError> {
        if pulse.clipped.is_some() {
            return self.clipped(sight, pulse);
        }
        match self {
            Self::Maximum => {
                bell::pick(sight, pulse).map_or_else(|| local_model::in_noise(sight, pulse), Ok)
            }
            Self::Local { degree, width } => local_model::pick(sight, pulse, *degree, *width),
            Self::Onset(fraction) => onset::pick(sight, pulse, *fraction),
            Self::Correlation(correlator) => correlator.pick(sight, pulse),
            Self::Matched(shape, width) => matched::pick(sight, pulse, shape, *width),
        }
    }

    /// Of a pulse whose top is clipped there are the flanks.
    fn clipped(&self, sight: &Sight<'_>, pulse: &Pulse) -> Result<Picked, SignalError> {
        let none = |what| SignalError::NoPick {
            place: pulse.place,
            what,
        };
        let top = bell::from_flanks(sight, pulse);
        let top = top.ok_or_else(|| none("maximum that its flanks tell, clipped as it is,"))?;
        match self {
            Self::Maximum | Self::Local { .. } => Ok(top),
            Self::Onset(fraction) => onset::of_clipped(sight, pulse, *fraction, top),
            Self::Matched(shape, width) => {
                let whole = Pulse {
                    height: top.height,
                    width_samples: top.width_s,
                    ..*pulse
                };
                matched::pick(sight, &whole, shape, *width)
            }
            Self::Correlation(_) => Err(none("top to correlate, clipped as it is,")),
        }
    }
}

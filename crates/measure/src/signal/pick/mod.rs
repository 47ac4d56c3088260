//! Times of the pulses found, by four methods, each with its uncertainty.

mod clipping;
mod common_bell;
mod correlation;
mod log_polynomial;
mod polynomial;
mod pooled;
mod shape;
mod superposition;

pub use self::{correlation::delay_by_cross_correlation, pooled::PulseSamples, shape::Shape};
pub(crate) use {clipping::clipped_top, pooled::pool};

use crate::error::{MeasureError, Result};
use crate::signal::{
    Bandwidth, Channels, DigitiserRange, Estimate, Found, MOST_POLES, Normalisation, Pulse,
    PulseKind, SensorCalibration,
};
use correlation::Correlator;

/// How a pulse's time is defined. Bias and spread of each: docs/explanation/picking.md.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Method {
    /// Time of the maximum of a bell whose logarithm is a polynomial of degree 10, fitted over 1.1
    /// widths of the steeper flank. Coefficients beyond a Gaussian's have those of computed rows,
    /// ± 0.2, as prior, so noise does not bend it.
    ///
    /// *Bias:* none for symmetric pulses; of skewed ones, less than the stated error, which holds
    /// what the shape leaves open. Where noise hides the maximum, a quartic over 1.2 widths is tried,
    /// then a parabola over 0.8.
    #[default]
    Maximum,
    /// Time at which the rising flank passes a share of the maximum.
    ///
    /// *Bias:* against maxima, the difference of the two pulses' rise times from that share: first
    /// order in a difference of widths. A drifting baseline shifts it.
    Onset {
        /// Share of the maximum, between 0 and 1.
        fraction: f64,
    },
    /// Time at which the incident pulse fits best, by its correlation with the signal.
    ///
    /// *Bias:* none for pulses that differ in height alone, nor for symmetric ones of different
    /// widths; for pulses of different skewness a share of the width.
    CrossCorrelation,
    /// Time of a shape fitted with its height, width and offset free.
    ///
    /// *Bias:* none if both pulses have the shape, whatever their widths; for skewed pulses a share
    /// of the width that is the same for both only if their skewness is.
    MatchedShape {
        /// The shape.
        shape: Shape,
        /// Full width of the fit, in full widths at half maximum of the pulse.
        width: f64,
    },
}

/// A picked pulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    /// Its time, in s after the first sample.
    pub time_s: f64,
    /// Standard deviation of that: by the record's noise and, of maxima, by what a shape leaves open
    /// and what lies under a pulse. Other biases are not in it.
    pub sigma_s: f64,
    /// The part of that which equal shots share.
    pub systematic: Systematic,
    /// Height above the baseline, or above the fit's own offset, in the samples' unit.
    pub height: f64,
    /// Standard deviation of that by the record's noise.
    pub height_sigma: f64,
    /// Full width at half maximum in s.
    pub width_s: f64,
    /// Height over the noise of a sample; infinite without noise.
    pub signal_to_noise: f64,
    /// Residuals of the fit over noise: near 1 if the model describes the pulse. `None` if nothing
    /// was fitted or there is no noise.
    pub misfit: Option<f64>,
}

/// Errors of a maximum that equal shots share, so that no mean over them makes them smaller. Those of
/// times are 0 of other methods.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Systematic {
    /// Shift in s, with its sign, by what lies under the pulse in a summed channel.
    pub superposition_s: f64,
    /// Error in s by what the samples leave open of the pulse's shape, and of the interval between
    /// them.
    pub shape_s: f64,
    /// Error of the height, in the samples' unit, by what lies under the pulse in a summed channel.
    pub height: f64,
}

/// Another maximum of a pulse as picked, which could be the largest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompetingPick {
    /// The maximum.
    pub picked: Picked,
    /// How much lower it is than the one that was picked, in the samples' unit.
    pub lower: Estimate,
    /// Standard deviation of the part of that which lies under a reflected pulse in a summed channel
    /// and is the same in equal shots.
    pub superposition: f64,
}

impl CompetingPick {
    /// Probability that it is the higher but for noise and what lies under both: the normal
    /// distribution's tail.
    pub(crate) fn p_value(&self) -> f64 {
        let Estimate { value, sigma } = self.lower;
        match value == 0.0 {
            true => 0.5,
            false => {
                let sigma = sigma.hypot(self.superposition);
                0.5 * libm::erfc(value / sigma / std::f64::consts::SQRT_2)
            }
        }
    }
}

/// The three pulses of a shot as picked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picks {
    /// At the sensor bead, on the way to the wall.
    pub incident: Picked,
    /// At the wall.
    pub wall: Picked,
    /// At the sensor bead, on the way back, if it was found and could be picked.
    pub reflected: Option<Picked>,
    /// Other maxima of the three, in this order, that are nearly as high.
    pub competing: [Option<CompetingPick>; 3],
    /// Calibration that times and ratios contain.
    pub calibration: SensorCalibration,
}

pub(crate) struct ChannelView<'a> {
    samples: &'a [f64],
    normalisation: Normalisation,
    range: Option<DigitiserRange>,
    summed: bool,
    /// Sample of the wall's maximum, for the reflected pulse.
    wall: Option<usize>,
    /// Sample of the incident maximum.
    incident: usize,
    /// How far below the baseline signals of both sensors come.
    opened: f64,
    /// Coefficients of the inverse of the amplifier's low-pass; 0 where none is corrected.
    inverse: [f64; MOST_POLES],
}

impl<'a> ChannelView<'a> {
    pub(crate) fn new(
        channels: Channels<'a>,
        kind: PulseKind,
        normalisation: Normalisation,
    ) -> Self {
        Self {
            samples: channels.of(kind),
            normalisation,
            range: None,
            summed: channels.is_summed(),
            wall: None,
            incident: 0,
            opened: 0.0,
            inverse: [0.0; MOST_POLES],
        }
    }

    /// The same with the wall's maximum, under whose fall the reflected pulse lies.
    pub(crate) fn after(self, wall: &Pulse) -> Self {
        Self { wall: Some(wall.at), ..self }
    }

    fn height(&self, sample: usize) -> Option<f64> {
        let sample = self.samples.get(sample);
        sample.map(|x| self.normalisation.height(*x))
    }

    /// Heights from sample `from` to `to`, clipped to the record, and the first's number.
    fn window(&self, from: f64, to: f64) -> (usize, Vec<f64>) {
        let end = self.samples.len();
        let first = (from.floor().max(0.0) as usize).min(end);
        let last = ((to.ceil().max(0.0) as usize).saturating_add(1)).clamp(first, end);
        let heights = self.samples[first..last].iter();
        let heights = heights.map(|x| self.normalisation.height(*x)).collect();
        (first, heights)
    }

    /// First and last sample about a pulse's maximum above a height, single ones below it aside.
    fn run_above(&self, pulse: &Pulse, height: f64) -> (usize, usize) {
        let is_above = |at: usize| self.height(at).is_some_and(|x| x > height);
        let (mut first, mut last) = (pulse.at, pulse.at);
        while first > 1 && (is_above(first - 1) || is_above(first - 2)) {
            first -= 1;
        }
        while is_above(last + 1) || is_above(last + 2) {
            last += 1;
        }
        (first, last)
    }

    /// Noise of one sample; at least a digitiser's rounding, which a quiet stretch between two of
    /// its steps does not show.
    fn noise(&self, pulse: &Pulse) -> f64 {
        let rounding = self.normalisation.rounding(pulse.height);
        self.normalisation.baseline.noise.max(rounding)
    }

    /// As [`Self::noise`], for averages over many samples.
    fn broad_noise(&self, pulse: &Pulse) -> f64 {
        let broad = self.normalisation.baseline.broad_noise();
        broad.max(self.normalisation.rounding(pulse.height))
    }

    /// Of a maximum whose top noise hides: anywhere within its width, in samples.
    fn hidden_top(&self, pulse: &Pulse, height_sigma: f64) -> Picked {
        Picked {
            time_s: pulse.at as f64,
            sigma_s: pulse.width_samples / 12.0_f64.sqrt(),
            systematic: Systematic::default(),
            height: pulse.height,
            height_sigma,
            width_s: pulse.width_samples,
            signal_to_noise: pulse.height / self.noise(pulse),
            misfit: None,
        }
    }

    fn misfit(&self, pulse: &Pulse, residual: f64) -> Option<f64> {
        let noise = self.noise(pulse);
        (noise > 0.0).then(|| residual / noise)
    }
}

/// Picks the pulses that were found, given the digitiser's range, where it is known, in the
/// channels that hold the sensor's and the wall's pulses. Maxima are corrected for an amplifier's
/// low-pass; times of other methods are not. A reflected pulse that cannot be picked is left out.
pub(crate) fn pick(
    channels: Channels<'_>,
    interval_s: f64,
    found: &Found,
    method: &Method,
    (ranges, amplifier): ([Option<DigitiserRange>; 2], Option<Bandwidth>),
) -> Result<(Picks, [Option<Box<PulseSamples>>; 3])> {
    MeasureError::positive("sampling interval in s", interval_s)?;
    method.check()?;
    let need = |pulse: &Option<Pulse>, kind| pulse.ok_or(MeasureError::Missing(kind));
    let incident = need(&found.incident, PulseKind::Incident)?;
    let wall = need(&found.wall, PulseKind::Wall)?;
    let widest = found.pulses().map(|pulse| pulse.width_samples).fold(0.0, f64::max);
    let inverse = amplifier.map(|amplifier| amplifier.inverse(interval_s, widest));
    let inverse = inverse.transpose()?.filter(|_| *method == Method::Maximum);
    let view = |kind: PulseKind| ChannelView {
        range: ranges[usize::from(kind == PulseKind::Wall)],
        wall: (kind == PulseKind::Reflected).then_some(wall.at),
        incident: incident.at,
        inverse: inverse.unwrap_or_default(),
        ..ChannelView::new(channels, kind, *found.normalisation(kind))
    };
    let mut views = PulseKind::ALL.map(view);
    let last = found.reflected.unwrap_or(wall);
    let opened = views[last.kind as usize].opened_until(&last);
    views.iter_mut().for_each(|view| view.opened = opened);
    let picker = Picker::new(method, &views[0], &incident)?;
    let pick = |pulse: &Pulse| {
        let view = &views[pulse.kind as usize];
        let picked = picker.pick(view, pulse)?;
        let under = view.level_under(pulse, picked.time_s);
        let has_offset = matches!(method, Method::MatchedShape { .. });
        let picked = if has_offset { picked } else { picked.above(under) };
        let few = if *method == Method::Maximum { of_few_samples(picked.width_s) } else { 0.0 };
        Ok::<Picked, MeasureError>(picked.widened(few).in_seconds(interval_s))
    };
    let reflected = found.reflected.and_then(|pulse| pick(&pulse).ok());
    let competing = |kind| {
        let all = &found.competing;
        let other = all.iter().find(|other| other.pulse.kind == kind)?;
        let top = || views[kind as usize].hidden_top(&other.pulse, other.lower.sigma);
        let picked = pick(&other.pulse).unwrap_or_else(|_| top().in_seconds(interval_s));
        Some(CompetingPick { picked, lower: other.lower, superposition: other.superposition })
    };
    let mut competing = PulseKind::ALL.map(competing);
    competing[2] = competing[2].filter(|_| reflected.is_some());
    let calibration = SensorCalibration::default();
    let picks =
        Picks { incident: pick(&incident)?, wall: pick(&wall)?, reflected, competing, calibration };
    let samples = PulseKind::ALL.map(|kind| {
        let picked = picks.pulse(kind).filter(|_| *method == Method::Maximum)?;
        let pulse = [found.incident, found.wall, found.reflected][kind as usize]?;
        let time = picked.time_s / interval_s;
        PulseSamples::new(&views[kind as usize], &pulse, time, interval_s)
            .filter(|_| picks.competing[kind as usize].is_none())
            .map(Box::new)
    });
    Ok((picks, samples))
}

/// A pulse's maximum by a fit to the samples about it, in samples.
pub(crate) fn maximum_by_fit(view: &ChannelView<'_>, pulse: &Pulse) -> Option<Picked> {
    Picker { method: &Method::Maximum, correlator: None }.pick(view, pulse).ok()
}

/// Error of a maximum in samples where a pulse has so few across its half maximum: shots of the dry row at 1.2 m/s,
/// sampled at 150, 200, 250 and 300 kHz (6 to 12 samples), are alike off by 0.07, 0.037, 0.011 and 0.004.
pub(crate) fn of_few_samples(width: f64) -> f64 {
    (0.012 * (10.0 / width).powf(5.5)).min(0.07)
}

impl Picked {
    /// What is known of a pulse that was not found.
    pub(crate) const UNKNOWN: Self = Self {
        time_s: f64::NAN,
        sigma_s: f64::NAN,
        systematic: Systematic { superposition_s: 0.0, shape_s: 0.0, height: 0.0 },
        height: f64::NAN,
        height_sigma: f64::NAN,
        width_s: f64::NAN,
        signal_to_noise: f64::NAN,
        misfit: None,
    };

    /// The same with a time of another method, of no systematic error.
    pub(crate) fn by_fit(self, time_s: f64, sigma_s: f64, misfit: Option<f64>) -> Self {
        let systematic = Systematic { height: self.systematic.height, ..Systematic::default() };
        Self { time_s, sigma_s, systematic, misfit, ..self }
    }

    /// With another error of the shape, in the time's unit.
    pub(crate) fn widened(self, shape: f64) -> Self {
        let systematic =
            Systematic { shape_s: self.systematic.shape_s.hypot(shape), ..self.systematic };
        Self { sigma_s: self.sigma_s.hypot(shape), systematic, ..self }
    }

    fn in_seconds(self, interval_s: f64) -> Self {
        Self {
            time_s: self.time_s * interval_s,
            sigma_s: self.sigma_s * interval_s,
            systematic: Systematic {
                superposition_s: self.systematic.superposition_s * interval_s,
                shape_s: self.systematic.shape_s * interval_s,
                ..self.systematic
            },
            width_s: self.width_s * interval_s,
            ..self
        }
    }
}

impl Method {
    fn check(&self) -> Result<()> {
        let within = |name, value: f64, low: f64, high: f64, expected| {
            MeasureError::require(value >= low && value <= high, name, value, expected)
        };
        match self {
            Self::Onset { fraction } => {
                let expected = "a share of the maximum from 0.02 to 0.95";
                within("threshold", *fraction, 0.02, 0.95, expected)
            }
            Self::MatchedShape { width, .. } => {
                within("width of the fit", *width, 0.2, 4.0, "a number from 0.2 to 4")
            }
            Self::Maximum | Self::CrossCorrelation => Ok(()),
        }
    }
}

/// A method prepared for one shot; times in samples.
struct Picker<'a> {
    method: &'a Method,
    correlator: Option<Correlator>,
}

impl<'a> Picker<'a> {
    fn new(method: &'a Method, sensor: &ChannelView<'_>, incident: &Pulse) -> Result<Self> {
        let correlates = *method == Method::CrossCorrelation;
        let correlator = correlates.then(|| Correlator::new(sensor, incident)).transpose()?;
        Ok(Self { method, correlator })
    }

    fn pick(&self, view: &ChannelView<'_>, pulse: &Pulse) -> Result<Picked> {
        if pulse.clipped.is_some() {
            return self.pick_clipped(view, pulse);
        }
        match (self.method, &self.correlator) {
            (_, Some(correlator)) => correlator.pick(view, pulse),
            (Method::Onset { fraction }, _) => {
                let top = polynomial::pick_roughly(view, pulse)?;
                polynomial::pick_onset(view, pulse, *fraction, top)
            }
            (Method::MatchedShape { shape, width }, _) => shape::pick(view, pulse, shape, *width),
            (Method::Maximum | Method::CrossCorrelation, _) => log_polynomial::pick(view, pulse)
                .map_or_else(|| polynomial::pick_in_noise(view, pulse), Ok),
        }
    }

    fn pick_clipped(&self, view: &ChannelView<'_>, pulse: &Pulse) -> Result<Picked> {
        let none = |what| MeasureError::NoPick(pulse.kind, what);
        let top = log_polynomial::pick_from_flanks(view, pulse);
        let top =
            top.ok_or_else(|| none("maximum that follows from its flanks, clipped as it is,"))?;
        match self.method {
            Method::Maximum => Ok(top),
            Method::Onset { fraction } => polynomial::pick_onset(view, pulse, *fraction, top),
            Method::MatchedShape { shape, width } => {
                let whole = Pulse { height: top.height, width_samples: top.width_s, ..*pulse };
                shape::pick(view, &whole, shape, *width)
            }
            Method::CrossCorrelation => Err(none("top to correlate, clipped as it is,")),
        }
    }
}

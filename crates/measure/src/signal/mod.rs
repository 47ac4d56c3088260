//! Pulses in sampled slices: finding, picking, times of flight, power laws.
//!
//! Independent of chains and files: functions take plain slices and, where time matters, a sampling
//! interval in s. From samples to a curve:
//!
//! 1. [`measure`] conditions a shot, finds its [`pulses`], picks them and
//!    returns a [`Flight`] with its uncertainty and [`QualityFlag`]s.
//! 2. [`groups`], [`summary`], [`power_law`], [`power_law_both_errors`], [`chi_square`] and
//!    [`coverage`] reduce shots to curves.
//!
//! ```
//! use hertzchain_measure::signal::{Channels, Shape, SignalOptions, measure};
//!
//! // Incident at 1 ms, wall at 1.7 ms, reflected at 2.45 ms, at 1 MS/s.
//! let shape = Shape::cos_power(6.0);
//! let pulse = |at: f64, t: f64| shape.value((t - at) / 60e-6);
//! let samples: Vec<f64> = (0..4000)
//!     .map(|i| f64::from(i) * 1e-6)
//!     .map(|t| pulse(1e-3, t) + 1.6 * pulse(1.7e-3, t) + 0.4 * pulse(2.45e-3, t))
//!     .collect();
//! let shot = measure(Channels::Summed(&samples), 1e-6, &SignalOptions::default())?;
//! let flight = shot.flight?;
//! assert!(shot.found.flags.is_empty());
//! assert!((flight.incident_s.value - 0.7e-3).abs() < 1e-8);
//! # Ok::<(), hertzchain_measure::MeasureError>(())
//! ```

mod baseline;
mod drift;
mod filters;
mod find;
mod flight;
mod linear;
mod pick;
mod power_law;
mod spikes;
mod statistics;
mod tones;

pub use self::{
    baseline::{Baseline, baseline},
    filters::{Bandwidth, LowPass},
    find::{
        Channels, CompetingMaximum, DigitiserRange, FindOptions, Found, Normalisation, Polarity,
        Pulse, PulseKind, PulseLimits, QualityFlag, normalisation, pulses,
    },
    flight::{Flight, Measured, SensorCalibration, SignalOptions, measure, without_systematic},
    pick::{
        CompetingPick, Method, Picked, Picks, PulseSamples, Shape, Systematic,
        delay_by_cross_correlation,
    },
    power_law::{FitError, PowerLaw, Uncertainty, power_law, power_law_both_errors, uncertainty},
    spikes::without_spikes,
    statistics::{
        ChiSquare, Coverage, Estimate, Point, Ratio, Summary, chi_square, coverage, groups, median,
        summary,
    },
};
pub(crate) use self::{
    filters::{MOST_POLES, invert_high_pass},
    flight::mean_systematic,
    pick::pool,
    statistics::extremes,
    statistics::ratios_at_common,
};

//! Pulses in sampled slices: finding, picking, times of flight, curves.
//!
//! Knows nothing of chains or files: everything takes plain slices and, where
//! time matters, a sampling interval in s. From samples to a curve:
//!
//! 1. [`Cutter`] tells where the shots of a recording are that is given piece by piece.
//! 2. [`measure`] conditions a shot, finds its [`pulses`], [`pick`]s them and
//!    makes a [`Flight`] of them, with an uncertainty of its own and [`Doubt`]s.
//! 3. [`groups`], [`summary`], [`ratios_at_common`], [`power_law`],
//!    [`power_law_both_errors`], [`chi_square`] and [`coverage`] reduce shots
//!    to curves and say how far to believe them.
//!
//! ```
//! use hertzchain_measure::signal::{Channels, Measuring, Shape, measure};
//!
//! // Passing at 1 ms, wall at 1.7 ms, returning at 2.45 ms, at 1 MS/s.
//! let bell = Shape::cos_power(6.0);
//! let pulse = |at: f64, t: f64| bell.value((t - at) / 60e-6);
//! let samples: Vec<f64> = (0..4000)
//!     .map(|i| f64::from(i) * 1e-6)
//!     .map(|t| pulse(1e-3, t) + 1.6 * pulse(1.7e-3, t) + 0.4 * pulse(2.45e-3, t))
//!     .collect();
//! let shot = measure(Channels::Summed(&samples), 1e-6, &Measuring::default())?;
//! let flight = shot.flight?;
//! assert!(shot.found.doubts.is_empty());
//! assert!((flight.incident_s.value - 0.7e-3).abs() < 1e-8);
//! # Ok::<(), hertzchain_measure::signal::SignalError>(())
//! ```

mod cutter;
mod delay;
mod droop;
mod error;
mod find;
mod flight;
mod level;
mod measure;
mod picks;
mod power_law;
mod reduce;
mod running;
mod saturation;
mod spikes;
mod zero_phase;

pub use cutter::{Cutter, Segment, Trigger};
pub use delay::delay_by_cross_correlation;
pub use droop::undroop;
pub use error::SignalError;
pub use find::{
    Channels, Doubt, Finding, Found, Place, Polarity, Pulse, Rival, Upright, pulses, upright,
};
pub use flight::{Estimate, Flight};
pub use level::{Level, level, median};
pub use measure::{Measured, Measuring, measure};
pub use picks::{
    Bandwidth, Method, Moved, Picked, PickedRival, Picks, Shape, Template, cramer_rao_of_samples_s,
    cramer_rao_s, pick,
};
pub use power_law::{
    FitError, PowerLaw, Uncertainty, power_law, power_law_both_errors, uncertainty,
};
pub use reduce::{
    ChiSquare, Coverage, Point, Ratio, Summary, alone, chi_square, coverage, groups,
    ratios_at_common, shared, summary,
};
pub use saturation::Rails;
pub use spikes::without_spikes;
pub use zero_phase::LowPass;

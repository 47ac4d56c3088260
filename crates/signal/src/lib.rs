//! Pulses in sampled slices: picks, delays, power laws.
//!
//! Knows nothing of chains or files: everything takes plain slices and, where
//! time matters, a sampling interval in s.
//!
//! ```
//! // Two equal bumps, the second 2.5 samples later.
//! let bump = |at: f64| -> Vec<f64> {
//!     (0..60).map(|i| (-((f64::from(i) - at) / 4.0).powi(2)).exp()).collect()
//! };
//! let delay_s = hertzchain_signal::delay_by_cross_correlation(&bump(30.0), &bump(32.5), 1e-6);
//! assert!((delay_s.unwrap() - 2.5e-6).abs() < 1e-10);
//! ```

mod delay;
mod pick;
mod power_law;

pub use delay::delay_by_cross_correlation;
pub use pick::{Peak, largest_peak, onset_s};
pub use power_law::{FitError, PowerLaw, Uncertainty, power_law, uncertainty};

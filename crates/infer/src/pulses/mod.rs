//! Whole pulses, sample by sample, against a model's.
//!
//! Where a shot's times of flight and ratios of peaks use three maxima, here every
//! sample around the pulses is a measured number. What a record says of neither
//! chain nor contacts is taken out of each by itself: the offset of a channel, the
//! moment of the impact, and by how much the striker's speed was mistaken.

mod align;
mod problem;
mod record;

pub use self::{
    problem::{PulseProblem, Respond},
    record::Pulses,
};

//! Chance: one stream of random numbers for each purpose and shot.

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Exp1, StandardNormal};

/// Random numbers of one purpose, from a seed; the same whatever else is
/// drawn, and in whatever order.
#[derive(Clone, Debug)]
pub struct Chance(ChaCha8Rng);

/// What random numbers are for. Each purpose has streams of its own, so that
/// another number of taps leaves the noise as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Laying the chain before a series.
    Laying,
    /// Draws of series in the claims' error bars.
    Resampling,
    /// Taps and striker of a shot, by its number from 0.
    Shot(u32),
    /// Noise of a shot's record.
    Noise(u32),
}

/// Shots of one series that have streams of their own.
pub(super) const MOST_SHOTS: usize = 1 << 30;

impl Purpose {
    /// Number of the stream within a series: two of its own, then two a shot.
    fn stream(self) -> u64 {
        match self {
            Self::Laying => 0,
            Self::Resampling => 1,
            Self::Shot(shot) => 2 * u64::from(shot) + 2,
            Self::Noise(shot) => 2 * u64::from(shot) + 3,
        }
    }
}

impl Chance {
    /// The stream of a purpose in a series of a campaign.
    #[must_use]
    pub fn new(seed: u64, series: u32, purpose: Purpose) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream((u64::from(series) << 32) | purpose.stream());
        Self(generator)
    }

    /// A number of the standard normal distribution.
    pub fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// A positive number of the exponential distribution with mean 1.
    pub fn exponential(&mut self) -> f64 {
        Exp1.sample(&mut self.0)
    }

    /// A number from 0 up to but not including 1, all equally likely.
    pub fn uniform(&mut self) -> f64 {
        self.0.random()
    }

    /// What the stream gives next, as bits.
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }
}

//! Chance: one stream of random numbers for each purpose.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Random numbers of one purpose, from a seed; the same whatever else is drawn.
pub(crate) struct Chance(ChaCha8Rng);

/// What random numbers are for.
#[derive(Clone, Copy)]
pub(crate) enum Purpose {
    /// Where descents start, by number.
    Start(u32),
    /// Which points are left out together.
    Folds,
    /// Where walkers start, by ensemble.
    Ball(u32),
    /// At which curves a surrogate is fitted.
    Surrogate,
    /// One half step of the sampler, by number.
    HalfStep(u64),
}

impl Purpose {
    fn stream(self) -> u64 {
        match self {
            Self::Start(start) => u64::from(start),
            Self::Folds => 1 << 32,
            Self::Ball(ensemble) => (2 << 32) | u64::from(ensemble),
            Self::Surrogate => 3 << 32,
            Self::HalfStep(number) => (1 << 63) | number,
        }
    }
}

impl Chance {
    pub(crate) fn new(seed: u64, purpose: Purpose) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(purpose.stream());
        Self(generator)
    }

    /// A number of the standard normal distribution.
    pub(crate) fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// A number from 0 up to but not including 1.
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0.random()
    }

    /// A whole number below `count`, which is positive.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        self.0.random_range(0..count)
    }
}

//! Seeded streams of random numbers, one for each purpose.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

#[derive(Clone, Copy)]
pub(crate) enum Purpose {
    /// Start of a descent, by number.
    Start(u32),
    Folds,
    /// Starts of walkers, by ensemble.
    Walkers(u32),
    Surrogate,
    /// Half step of the sampler, by number.
    HalfStep(u64),
}

/// Random numbers of one purpose: the same whatever else is drawn.
pub(crate) struct RandomStream(ChaCha8Rng);

impl RandomStream {
    pub(crate) fn new(seed: u64, purpose: Purpose) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(match purpose {
            Purpose::Start(start) => u64::from(start),
            Purpose::Folds => 1 << 32,
            Purpose::Walkers(ensemble) => (2 << 32) | u64::from(ensemble),
            Purpose::Surrogate => 3 << 32,
            Purpose::HalfStep(number) => (1 << 63) | number,
        });
        Self(generator)
    }

    pub(crate) fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// Uniform in [0, 1).
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0.random()
    }

    /// Uniform integer below `count`, which is positive.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        self.0.random_range(0..count)
    }
}

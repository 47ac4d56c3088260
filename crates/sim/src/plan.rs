//! What is to be computed.

use crate::error::StudyError;
use hertzchain_chain::{Chain, ChainError, Sensor, Start, System};
use hertzchain_experiment::{Experiment, Method, Mistakes, Pick, Solver, Warning};
use std::ops::{Deref, DerefMut};
use std::sync::{Arc, OnceLock};

/// What to sample while a shot runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Watch {
    /// Sensors, one column each.
    pub sensors: Vec<Sensor>,
    /// Sampling interval in s; a tenth of the contact time when `None`.
    pub interval_s: Option<f64>,
}

/// A chain, and its system in static equilibrium, which is computed once, when it is first
/// asked for, and anew after a change of the chain.
#[derive(Clone, Debug)]
pub struct PreparedChain {
    chain: Chain,
    system: OnceLock<Result<Arc<System>, ChainError>>,
}

impl PreparedChain {
    /// The chain at rest.
    ///
    /// # Errors
    /// A chain that can't be set up.
    pub fn system(&self) -> Result<Arc<System>, ChainError> {
        let system = || Ok(Arc::new(System::new(&self.chain)?));
        self.system.get_or_init(system).clone()
    }
}

impl From<Chain> for PreparedChain {
    fn from(chain: Chain) -> Self {
        let system = OnceLock::new();
        Self { chain, system }
    }
}

impl Deref for PreparedChain {
    type Target = Chain;

    fn deref(&self) -> &Chain {
        &self.chain
    }
}

impl DerefMut for PreparedChain {
    fn deref_mut(&mut self) -> &mut Chain {
        self.system.take();
        &mut self.chain
    }
}

/// One shot to be computed.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The chain with whatever sets it in motion.
    pub chain: PreparedChain,
    /// Bead whose signal times the passing pulses.
    pub sensor_bead: usize,
    /// Relative accuracy asked of times of flight.
    pub accuracy: f64,
    /// How the motion is computed.
    pub method: Method,
    /// Step in s of a fixed-step method; without one it is halved until the accuracy is reached.
    pub step_s: Option<f64>,
    /// Duration in s; when `None` the shot ends once the reflected pulse has
    /// passed the sensor bead and the striker is away for good, or all bodies
    /// fly apart.
    pub duration_s: Option<f64>,
    /// Follow the striker until it is away for good; without, a shot ends once
    /// the reflected pulse has passed and reports no rebound.
    pub rebound: bool,
    /// Where pulses are timed.
    pub pick: Pick,
    /// Other ways to time the same pulses, to compare with.
    pub compare: Vec<Pick>,
    /// Keep an energy budget.
    pub budget: bool,
    /// What to sample.
    pub watch: Option<Watch>,
}

impl Plan {
    /// A shot of a chain: peaks, the adaptive solver, an accuracy of 1e-6, no
    /// budget, nothing sampled.
    pub fn new(chain: Chain, sensor_bead: usize) -> Self {
        Self {
            chain: chain.into(),
            sensor_bead,
            accuracy: Solver::DEFAULT_ACCURACY,
            method: Method::Adaptive,
            step_s: None,
            duration_s: None,
            rebound: true,
            pick: Pick::Peak,
            compare: Vec::new(),
            budget: false,
            watch: None,
        }
    }

    /// The shot of an experiment, at its own speed or another in m/s, with
    /// what is odd about it.
    ///
    /// # Errors
    /// A speed that the experiment can't have, with its place in the file.
    pub fn from_experiment(
        experiment: &Experiment,
        speed_m_s: Option<f64>,
    ) -> Result<(Self, Vec<Warning>), Mistakes> {
        // What the physics refuses is reported at its place in the file.
        let (chain, system, warnings) = experiment.chain_and_system(speed_m_s)?;
        let asked = experiment.solver();
        let mut plan = Self {
            accuracy: asked.accuracy,
            method: asked.method,
            step_s: asked.step_s,
            duration_s: asked.duration_s,
            pick: experiment.pick(),
            ..Self::new(chain, experiment.sensor_bead())
        };
        plan.chain.system = Ok(Arc::new(system)).into();
        Ok((plan, warnings))
    }

    /// This plan with its chain struck at another speed in m/s; `None` where the chain has no
    /// striker or can't be struck so.
    pub(crate) fn at_speed(&self, speed_m_s: f64) -> Option<Self> {
        let system = self.chain.system().ok()?.at_speed(speed_m_s).ok()?;
        let mut plan = self.clone();
        if let Start::Striker { speed_m_s: own, .. } = &mut plan.chain.start {
            *own = speed_m_s;
        }
        plan.chain.system = Ok(Arc::new(system)).into();
        Some(plan)
    }

    /// This plan for times of flight alone, without the striker's rebound.
    pub fn for_flights(mut self) -> Self {
        self.rebound = false;
        self
    }

    /// This plan, timed by peaks, with all other ways to compare with.
    pub fn comparing_picks(mut self) -> Self {
        self.pick = Pick::Peak;
        self.compare = vec![Pick::Flank10, Pick::Flank50, Pick::CrossCorrelation];
        self
    }

    /// Ways to time the pulses, the plan's own first.
    pub fn picks(&self) -> impl Iterator<Item = Pick> + '_ {
        std::iter::once(self.pick).chain(self.compare.iter().copied())
    }

    /// This plan with an energy budget.
    pub fn with_budget(mut self) -> Self {
        self.budget = true;
        self
    }

    /// This plan at another accuracy.
    pub fn with_accuracy(mut self, accuracy: f64) -> Self {
        self.accuracy = accuracy;
        self
    }

    /// This plan with sensors sampled; a trace of more than
    /// [`Tracer::MOST_NUMBERS`](hertzchain_chain::observe::Tracer::MOST_NUMBERS)
    /// numbers is refused while the shot runs, since only then its end is known.
    pub fn watching(mut self, sensors: Vec<Sensor>, interval_s: Option<f64>) -> Self {
        self.watch = Some(Watch { sensors, interval_s });
        self
    }

    pub(crate) fn check(&self) -> Result<(), StudyError> {
        let beads = self.chain.beads.len();
        if !(1..=beads).contains(&self.sensor_bead) {
            return refused(format!(
                "sensor bead {} is outside the chain of {beads} beads",
                self.sensor_bead
            ));
        }
        if !(1e-13..=1e-2).contains(&self.accuracy) {
            return refused(format!(
                "an accuracy of {} makes no sense; expected a number between 1e-13 and 1e-2",
                self.accuracy
            ));
        }
        positive("the step", self.step_s)?;
        positive("the duration", self.duration_s)?;
        let interval = self.watch.as_ref().and_then(|watch| watch.interval_s);
        positive("the sampling interval", interval)
    }
}

fn refused(why: String) -> Result<(), StudyError> {
    Err(StudyError::Refused(why))
}

fn positive(what: &str, time_s: Option<f64>) -> Result<(), StudyError> {
    match time_s {
        Some(value) if !(value > 0.0 && value.is_finite()) => {
            refused(format!("{what} = {value} s must be positive and finite"))
        }
        _ => Ok(()),
    }
}

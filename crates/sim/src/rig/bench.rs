//! The chain on its track, from impact to impact.

use crate::StudyError;
use crate::rig::chance::Chance;
use crate::rig::laying;
use hertzchain_chain::settle::{Rest, SlowPhase, State, settle};
use hertzchain_chain::{Chain, System};
use hertzchain_experiment::Experiment;

/// How far away the striker waits, in m: out of everything's way.
const STRIKER_WAITS_M: f64 = 0.01;

/// A laid chain with the state in which the last impact has left it.
#[derive(Clone, Debug)]
pub struct Bench<'a> {
    experiment: &'a Experiment,
    sizes: Vec<f64>,
    slow: SlowPhase,
    /// The chain as taps find it: materials may depend on the speed.
    tapped: System,
    state: State,
}

impl<'a> Bench<'a> {
    /// Lays the chain with random sizes and gaps, and lets it come to rest.
    ///
    /// # Errors
    /// A chain that can't be built or does not come to rest.
    pub fn lay(experiment: &'a Experiment, chance: &mut Chance) -> Result<Self, StudyError> {
        let campaign = experiment.campaign();
        let beads = experiment.beads();
        let sizes = laying::sizes(&campaign.laying, beads, chance);
        let tapped = System::new(&chain(experiment, &sizes, campaign.tap_speed_m_s)?)?;
        let gaps_m = laying::gaps_m(&campaign.laying, beads, chance);
        let mut state = State::laid(&tapped, &gaps_m);
        state.displacement_m[0] -= STRIKER_WAITS_M;
        let mut bench = Self {
            slow: SlowPhase {
                friction_coefficient: experiment.friction_coefficient(),
                ..SlowPhase::default()
            },
            experiment,
            sizes,
            tapped,
            state,
        };
        settle(
            &bench.tapped,
            &mut bench.state,
            &bench.slow,
            &mut |_, _, _| {},
        )?;
        bench.hold_wall();
        Ok(bench)
    }

    /// One tap with a speed in m/s, until rest.
    ///
    /// # Errors
    /// A chain that does not come to rest.
    pub fn tap(&mut self, speed_m_s: f64) -> Result<Rest, StudyError> {
        self.state.strike(&self.tapped, speed_m_s);
        let rest = settle(&self.tapped, &mut self.state, &self.slow, &mut |_, _, _| {})?;
        self.hold_wall();
        Ok(rest)
    }

    /// The chain for a shot of this speed in m/s as it would be in its own
    /// equilibrium, and as it is: the striker touches bead 1.
    ///
    /// # Errors
    /// A chain that can't be built at this speed.
    pub fn aim(&self, speed_m_s: f64) -> Result<(System, System), StudyError> {
        let system = System::new(&chain(self.experiment, &self.sizes, speed_m_s)?)?;
        let mut state = self.state.clone();
        state.strike(&system, speed_m_s);
        let shot = system.from_state(&state)?;
        Ok((system, shot))
    }

    /// Goes on from where a shot has left the bodies, until rest; `seen` gets
    /// the time in s from there and the forces of contacts 0..=N in N.
    ///
    /// # Errors
    /// A chain that does not come to rest.
    pub fn rest_after(
        &mut self,
        system: &System,
        state: State,
        seen: &mut dyn FnMut(f64, &[f64]),
    ) -> Result<Rest, StudyError> {
        self.state = state;
        let mut seen = |time_s: f64, _: &State, forces_n: &[f64]| seen(time_s, forces_n);
        let rest = settle(system, &mut self.state, &self.slow, &mut seen)?;
        self.hold_wall();
        Ok(rest)
    }

    /// Gaps in m of contacts 1..=N; 0 where closed.
    #[must_use]
    pub fn gaps_m(&self) -> Vec<f64> {
        let contacts = 1..self.tapped.contacts();
        let overlap_m = |contact| self.state.overlap_m(&self.tapped, contact);
        contacts
            .map(|contact| (-overlap_m(contact)).max(0.0))
            .collect()
    }

    /// Where all bodies are.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// A stop that an impact has pushed a little is held where it belongs
    /// before the next one, and the chain with it.
    fn hold_wall(&mut self) {
        let pushed_m = self.state.displacement_m.last().copied().unwrap_or(0.0);
        for displacement_m in &mut self.state.displacement_m {
            *displacement_m -= pushed_m;
        }
    }
}

/// The chain at a speed with the sizes of its beads.
fn chain(experiment: &Experiment, sizes: &[f64], speed_m_s: f64) -> Result<Chain, StudyError> {
    let (mut chain, _) = experiment.chain(Some(speed_m_s))?;
    laying::resize(&mut chain, sizes);
    Ok(chain)
}

//! A chain made ready for the loop: one column of numbers a quantity.

mod assemble;
mod check;
mod contact;
mod pairs;
mod resume;
mod scales;
mod statics;

pub(crate) use contact::TouchColumns;

use crate::chain::{Chain, ChainError, Tension};
use crate::laws::{Closed, Columns, Law};
use crate::material::BeadPair;
use crate::motion::Motion;
use crate::sensor::Sensor;
use std::ops::Range;
use std::sync::Arc;

/// Overlaps below this are treated as 0, so that the double-exponential
/// forerunner of a wave never reaches denormal numbers. In m (or the unit of
/// length of a dimensionless chain).
pub(crate) const FLUSH: f64 = 1e-150;

/// One term of the force over the contacts of a section.
#[derive(Clone, Debug)]
pub(crate) struct TermColumns {
    pub law: Arc<dyn Law>,
    pub columns: Columns,
}

#[derive(Clone, Debug)]
pub(crate) struct SectionColumns {
    pub contacts: Range<usize>,
    pub gated: Vec<TermColumns>,
    pub ungated: Vec<TermColumns>,
    /// A liquid bridge: outside the sum that is gated and cut.
    pub bridge: Option<TermColumns>,
}

impl SectionColumns {
    /// All terms but the bridge.
    pub(crate) fn terms(&self) -> impl Iterator<Item = &TermColumns> {
        self.gated.iter().chain(&self.ungated)
    }
}

/// How bead 1's spring changes its push as bead 1 moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spring {
    pub force_n: f64,
    pub stiffness_n_m: f64,
}

/// Characteristic scales of a chain in motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// Speed in m/s of whatever sets the chain in motion.
    pub speed_m_s: f64,
    /// Contact time in s: overlap at which a pair stops, over the speed.
    pub time_s: f64,
    /// Forces in N below this are rounding of the static forces, or nine
    /// orders below those of the impact: no signal.
    pub silent_force_n: f64,
    /// Momentum in N s of the lightest body at that speed.
    pub momentum_n_s: f64,
    /// About how long in s the wave takes from one end of the chain to the other:
    /// contact by contact with the momentum that sets it in motion.
    pub crossing_s: f64,
}

/// A chain at static equilibrium, ready to be set in motion.
///
/// Bodies are 0..=N+1: 0 the striker or driven end, N+1 the far end.
#[derive(Clone, Debug)]
pub struct System {
    pub(crate) mass_kg: Arc<[f64]>,
    pub(crate) inverse_mass: Arc<[f64]>,
    /// Static overlap in m, minus the gap where open, −∞ where no contact is.
    pub(crate) offset_m: Arc<[f64]>,
    pub(crate) static_force_n: Arc<[f64]>,
    pub(crate) sections: Arc<[SectionColumns]>,
    pub(crate) section_of: Arc<[u32]>,
    pub(crate) tension: Tension,
    pub(crate) spring: Option<Spring>,
    pub(crate) push_n: f64,
    pub(crate) slope_m_s2: f64,
    /// Acceleration with which a body presses on the track.
    pub(crate) normal_m_s2: f64,
    pub(crate) pendulum_per_s2: f64,
    pub(crate) motion: Option<Motion>,
    pub(crate) periodic: bool,
    pub(crate) has_striker: bool,
    pub(crate) stop_mass_kg: Option<f64>,
    pub(crate) has_memory: bool,
    /// Whether a law has a state of its own in each contact.
    pub(crate) has_states: bool,
    /// Contacts that a liquid bridge would join before the shot, whether or not their section
    /// has one; empty where no section has.
    pub(crate) bridged: Vec<bool>,
    pub(crate) displacement_m: Vec<f64>,
    pub(crate) velocity_m_s: Vec<f64>,
    /// Where displacements begin, seen from the chain's own static equilibrium.
    pub(crate) origin_m: Arc<[f64]>,
    pub(crate) scales: Scales,
    /// Contacts unlike their left neighbours with what they join: the scales
    /// of another speed follow from them.
    kinds: Arc<[(usize, BeadPair)]>,
}

impl System {
    /// Solves the static equilibrium and lays the chain out in columns.
    ///
    /// # Errors
    /// See [`ChainError`].
    pub fn new(chain: &Chain) -> Result<Self, ChainError> {
        assemble::assemble(chain)
    }

    /// The same chain struck at another speed in m/s, at a fraction of the
    /// cost of setting it up anew.
    ///
    /// # Errors
    /// A chain without a striker, or a speed that is not positive and finite.
    pub fn at_speed(&self, speed_m_s: f64) -> Result<Self, ChainError> {
        if !self.has_striker {
            let what = "only a chain with a striker has a speed to change";
            return Err(ChainError::Layout(what.to_owned()));
        }
        check::positive(|| "the striker's speed in m/s".to_owned(), speed_m_s)?;
        let mut struck = self.clone();
        struck.velocity_m_s[0] = speed_m_s;
        struck.scales = scales::scales(&struck, &self.kinds);
        Ok(struck)
    }

    /// Number of bodies, N + 2.
    pub fn bodies(&self) -> usize {
        self.mass_kg.len()
    }

    /// Number of beads N.
    pub fn beads(&self) -> usize {
        self.mass_kg.len() - 2
    }

    /// Number of contacts, N + 1; the last is the wall's.
    pub fn contacts(&self) -> usize {
        self.offset_m.len()
    }

    /// Whether a contact has a body on both sides.
    pub fn has_contact(&self, contact: usize) -> bool {
        self.offset_m.get(contact).is_some_and(|offset| offset.is_finite())
    }

    /// Whether the chain has a place for a sensor.
    pub(crate) fn has(&self, sensor: Sensor) -> bool {
        let bead = |n: usize| (1..=self.beads()).contains(&n);
        match sensor {
            Sensor::Bead(n) | Sensor::BeadPlusWall(n) => bead(n),
            Sensor::Contact(c) => self.has_contact(c),
            Sensor::Position(i) | Sensor::Velocity(i) => i < self.bodies(),
        }
    }

    /// Whether two chains differ in numbers alone, so that they can run side
    /// by side.
    pub fn has_shape_of(&self, other: &Self) -> bool {
        fn names(terms: &[TermColumns]) -> impl Iterator<Item = &str> {
            terms.iter().map(|term| term.law.info().name)
        }
        let alike = |(one, two): (&SectionColumns, &SectionColumns)| {
            one.contacts == two.contacts
                && names(&one.gated).eq(names(&two.gated))
                && names(&one.ungated).eq(names(&two.ungated))
        };
        self.bodies() == other.bodies()
            && self.sections.len() == other.sections.len()
            && (Arc::ptr_eq(&self.sections, &other.sections)
                || self.sections.iter().zip(other.sections.iter()).all(alike))
            && self.tension == other.tension
            && self.periodic == other.periodic
            && self.has_striker == other.has_striker
            && self.spring.is_some() == other.spring.is_some()
            && (self.slope_m_s2 != 0.0) == (other.slope_m_s2 != 0.0)
            && (self.pendulum_per_s2 > 0.0) == (other.pendulum_per_s2 > 0.0)
    }

    pub(crate) fn ends_fixed(&self) -> bool {
        let last = self.bodies() - 1;
        !self.periodic && self.inverse_mass[last] == 0.0 && self.velocity_m_s[last] == 0.0
    }

    /// Whether two chains are one, set in motion in two ways: what does not
    /// move is the same in both.
    pub(crate) fn is_chain_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.sections, &other.sections)
            && Arc::ptr_eq(&self.offset_m, &other.offset_m)
            && Arc::ptr_eq(&self.inverse_mass, &other.inverse_mass)
            && Arc::ptr_eq(&self.static_force_n, &other.static_force_n)
            && self.push_n == other.push_n
            && self.slope_m_s2 == other.slope_m_s2
            && self.pendulum_per_s2 == other.pendulum_per_s2
            && self.spring.is_none()
            && other.spring.is_none()
            && self.motion.is_none()
            && other.motion.is_none()
    }

    /// Characteristic speed and time.
    pub fn scales(&self) -> Scales {
        self.scales
    }

    /// Whether a body would hang on a thread: the beads and the striker.
    pub(crate) fn hangs(&self, body: usize) -> bool {
        body < self.bodies() - 1 && (body > 0 || self.has_striker)
    }

    /// Acceleration in m/s² of a displaced body by what is not a contact: the
    /// striker's weight, the spring on bead 1, threads.
    pub(crate) fn pushed(&self, body: usize, x_m: f64) -> f64 {
        let mut a = 0.0;
        if body == 0 && self.has_striker {
            a += self.slope_m_s2;
        }
        if let Some(spring) = self.spring.filter(|_| body == 1) {
            // Against the force at rest; a spring never pulls.
            a += (-spring.stiffness_n_m * x_m).max(-spring.force_n) * self.inverse_mass[1];
        }
        if self.hangs(body) {
            a -= self.pendulum_per_s2 * x_m;
        }
        a
    }

    /// (K/R*)² of each contact, its Hertz pressure's square at one overlap, over the square of its yield strength
    /// in the largest known one, at which those that are not known are taken; 0 where no contact is.
    pub(crate) fn pressure_factors(&self) -> Vec<f64> {
        let known = self.kinds.iter().filter_map(|(_, pair)| pair.yield_strength_pa());
        let strongest_pa = known.fold(0.0, f64::max);
        let weakness = |pair: &BeadPair| {
            pair.yield_strength_pa().map_or(1.0, |own| (strongest_pa / own).powi(2))
        };
        let (mut kinds, mut factor) = (self.kinds.iter().peekable(), 0.0);
        let of_contact = |contact: usize| {
            if let Some((_, pair)) = kinds.next_if(|(first, _)| *first <= contact) {
                let found = (pair.hertz_stiffness() / pair.radius_m).powi(2) * weakness(pair);
                factor = if found.is_finite() { found } else { 0.0 };
            }
            if self.has_contact(contact) { factor } else { 0.0 }
        };
        (0..self.contacts()).map(of_contact).collect()
    }

    /// Signals of a sensor up to this are none.
    pub(crate) fn silence(&self, sensor: Sensor) -> f64 {
        match sensor {
            Sensor::Position(_) | Sensor::Velocity(_) => 0.0,
            _ => self.scales.silent_force_n,
        }
    }

    /// What the losses of the first contact add to its elastic force, over that force: at the shot's speed and the
    /// overlap at which the elastic force alone stops it.
    pub fn damping_share(&self) -> f64 {
        let Scales { speed_m_s, time_s, .. } = self.scales;
        let force_n = |rate| self.unclipped_force(0, Closed::new(speed_m_s * time_s, rate));
        force_n(speed_m_s) / force_n(0.0) - 1.0
    }

    /// Whether bodies without contact fly on straight lines at constant speed.
    pub fn flies_free(&self) -> bool {
        self.slope_m_s2 == 0.0
            && self.pendulum_per_s2 == 0.0
            && self.push_n == 0.0
            && self.spring.is_none()
            && !self.periodic
            && self.motion.is_none()
            && self.static_force_n.iter().all(|&force| force == 0.0)
            && self.bridged.is_empty()
            && self.sections.iter().all(|section| section.ungated.is_empty())
    }
}

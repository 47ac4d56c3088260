//! Tracker pulses and the striker to the end of a shot.

use crate::duration::{End, RETURNS, has_wall};
use crate::plan::Plan;
use hertzchain_chain::observe::{Apart, Passages};
use hertzchain_chain::wave::{Flow, Observer, Piece};
use hertzchain_chain::{FarEnd, Start};

/// Pulses past the sensor bead and the wall, and the striker until it is away
/// for good.
#[derive(Clone, Debug)]
pub(crate) struct Tracker {
    passages: Passages,
    end: End,
    sensor_bead: usize,
    bead_over_striker: f64,
    wall: bool,
    /// When energy alone showed that nothing can change any more, in s.
    decided_s: Option<f64>,
    looked: u64,
    last_word: Option<(f64, f64)>,
    /// By body after the striker: the speed that bead 1 has with the whole energy
    /// of this one, over the speed of this one.
    handed_on: Vec<f64>,
}

impl Tracker {
    /// Of a plan's sensor bead, wall and striker.
    pub(crate) fn new(plan: &Plan, end: &End) -> Self {
        let wall = has_wall(&plan.chain.far);
        Self {
            passages: Passages::new(plan.sensor_bead, plan.chain.beads.len(), wall),
            end: *end,
            sensor_bead: plan.sensor_bead,
            bead_over_striker: bead_over_striker(plan),
            wall,
            decided_s: None,
            handed_on: match end.striker {
                true => handed_on(plan),
                false => Vec::new(),
            },
            looked: 0,
            last_word: None,
        }
    }

    pub(crate) fn passages(&self) -> &Passages {
        &self.passages
    }

    /// When the striker was away for good, or was followed for the longest time, in s,
    /// and its velocity then in m/s.
    pub(crate) fn last_word(&self) -> Option<(f64, f64)> {
        self.last_word
    }

    /// When energy alone showed that nothing can change any more, in s; the shot
    /// ended with that step.
    pub(crate) fn decided_s(&self) -> Option<f64> {
        self.decided_s
    }

    /// Looks at every multiple of the interval within a piece.
    fn look(&mut self, piece: &Piece<'_>, returned: bool) {
        let end_s = piece.time_s(1.0);
        while self.decided_s.is_none() {
            let at_s = (self.looked + 1) as f64 * self.end.look_every_s;
            if at_s > end_s {
                break;
            }
            self.looked += 1;
            let theta = ((at_s - piece.start_s()) / piece.step_s()).clamp(0.0, 1.0);
            if self.end.when_decided && self.is_decided(piece, theta) {
                self.decided_s = Some(at_s);
            }
            let over = self.decided_s.is_some() || returned || !self.wall;
            if over && self.awaits_striker() && self.is_away(piece, theta) {
                self.last_word = Some((piece.time_s(theta), piece.body(0, theta).1));
            }
        }
        let wall_s = self.passages.wall_peak_s().unwrap_or(0.0);
        let waited_s = RETURNS * wall_s;
        if returned && self.awaits_striker() && waited_s <= end_s {
            let theta = ((waited_s - piece.start_s()) / piece.step_s()).clamp(0.0, 1.0);
            self.last_word = Some((piece.time_s(theta), piece.body(0, theta).1));
        }
    }

    fn awaits_striker(&self) -> bool {
        self.end.striker && self.last_word.is_none()
    }

    fn is_away(&self, piece: &Piece<'_>, theta: f64) -> bool {
        self.decided_s.is_some() || is_away(piece, theta, &self.handed_on)
    }

    /// Whether the reflected pulse has been seen, and all that is left in the chain
    /// has neither the energy to press the sensor bead harder nor, all of it in
    /// bead 1, to reach the striker.
    fn is_decided(&self, piece: &Piece<'_>, theta: f64) -> bool {
        let Ok((_, _, Some(reflected))) = self.passages.peaks() else {
            return false;
        };
        let Some(left_j) = piece.energy_beyond_striker_j(theta) else {
            return false;
        };
        let leaves = self.bead_over_striker * piece.leaving_energy_j(theta) > left_j;
        let contacts = [self.sensor_bead - 1, self.sensor_bead];
        let most_n: f64 = contacts.map(|contact| piece.most_force_n(contact, left_j)).iter().sum();
        leaves && 0.5 * most_n < reflected.value
    }
}

impl Observer for Tracker {
    fn step(&mut self, piece: &Piece<'_>) -> Flow {
        let returned = self.passages.step(piece) == Flow::Finished;
        if self.end.when_decided || self.awaits_striker() {
            self.look(piece, returned);
        }
        let over = returned || self.decided_s.is_some();
        match self.end.at_reflection && over && !self.awaits_striker() {
            true => Flow::Finished,
            false => Flow::Continue,
        }
    }
}

/// m₁/m₀ of a struck chain; 0, which decides nothing, of others.
fn bead_over_striker(plan: &Plan) -> f64 {
    match (&plan.chain.start, plan.chain.beads.first()) {
        (Start::Striker { bead, .. }, Some(first)) => first.mass_kg / bead.mass_kg,
        _ => 0.0,
    }
}

/// √(m/m₁) of all beads and of the stop.
fn handed_on(plan: &Plan) -> Vec<f64> {
    let beads = plan.chain.beads.iter().map(|bead| bead.mass_kg);
    let stop = match plan.chain.far {
        FarEnd::Stop { mass_kg, .. } | FarEnd::PlaneStop { mass_kg, .. } => Some(mass_kg),
        _ => None,
    };
    let first = plan.chain.beads.first().map_or(1.0, |bead| bead.mass_kg);
    let shares = beads.chain(stop).map(|mass| (mass / first).sqrt());
    shares.collect()
}

/// Whether nothing can reach the striker any more: no contact is closed, and
/// all bodies fly apart or the striker flies off faster than bead 1 would with
/// the whole energy of any one body.
fn is_away(piece: &Piece<'_>, theta: f64, handed_on: &[f64]) -> bool {
    let system = piece.system();
    let speed_m_s = -piece.body(0, theta).1;
    let leaves = piece.leaving_energy_j(theta) > 0.0;
    let mut contacts = (0..system.contacts()).filter(|contact| system.has_contact(*contact));
    let mut others = handed_on.iter().zip(1..);
    contacts.all(|contact| piece.overlap(contact, theta).0 <= 0.0)
        && (leaves
            && others.all(|(share, body)| speed_m_s > share * piece.body(body, theta).1.abs())
            || Apart.step(piece) == Flow::Finished)
}

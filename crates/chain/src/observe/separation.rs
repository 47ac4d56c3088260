//! When bodies let go of each other.

use crate::wave::{Flow, Observer, Piece, bracketed_root};

/// A contact that has opened by more than it does in this share of a step did so within the step.
const WITHIN: f64 = 1e-3;

/// Notes when body 0 first and last separates from bead 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Separation {
    pressed: bool,
    first: Option<(f64, f64)>,
    last: Option<(f64, f64)>,
    /// The same at the end of the last step, if it left the contact open: a shot that
    /// ends there has no step after it.
    at_end: Option<(f64, f64)>,
}

impl Separation {
    /// Time in s of the first separation and the velocity of body 0 then in
    /// m/s, negative away from the chain.
    pub fn first(&self) -> Option<(f64, f64)> {
        self.first.or(self.at_end)
    }

    /// The same of the last one; `None` while the two are in contact.
    pub fn last(&self) -> Option<(f64, f64)> {
        self.at_end.or(self.last.filter(|_| !self.pressed))
    }

    fn note(&mut self, seen: (f64, f64)) {
        self.first = self.first.or(Some(seen));
        self.last = Some(seen);
        self.pressed = false;
    }
}

impl Observer for Separation {
    fn step(&mut self, piece: &Piece<'_>) -> Flow {
        let at = |theta: f64| (piece.time_s(theta), piece.body(0, theta).1);
        if self.pressed && piece.is_open(0) {
            self.note((piece.start_s(), piece.body(0, 0.0).1));
        }
        if piece.is_open(0) && !self.pressed {
            self.at_end = None;
            return Flow::Continue;
        }
        let [before, (overlap, rate)] = [0.0, 1.0].map(|theta| piece.overlap(0, theta));
        self.pressed |= !piece.is_open(0) && (self.first.is_none() || before.0.max(overlap) > 0.0);
        let opened = self.pressed && overlap < 0.0;
        self.at_end = opened.then(|| at(1.0));
        // Where a force has ended before the contact opens, a step need not end at the opening.
        let passed = piece.has_given_length() || overlap < WITHIN * rate * piece.step_s();
        if opened && passed && before.0 > 0.0 {
            self.note(at(bracketed_root(|theta| -piece.overlap(0, theta).0, 0.0, 1.0, 1e-9)));
            self.at_end = None;
        }
        Flow::Continue
    }
}

/// Ends a shot when no contact is closed or closing, in a chain on which
/// nothing but contacts acts: from then on every body flies alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Apart;

impl Observer for Apart {
    fn step(&mut self, piece: &Piece<'_>) -> Flow {
        let system = piece.system();
        let flying = |contact: usize| {
            let (overlap, rate) = piece.overlap(contact, 1.0);
            !system.has_contact(contact) || (overlap < 0.0 && rate <= 0.0)
        };
        match (0..system.contacts()).all(flying) && system.flies_free() {
            true => Flow::Finished,
            false => Flow::Continue,
        }
    }
}

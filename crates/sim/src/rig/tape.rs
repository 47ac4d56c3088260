//! Forces of both sensors on a fine grid of times.

use hertzchain_chain::Sensor;
use hertzchain_chain::wave::{Flow, Observer, Piece};

/// Forces in N of sensor bead and wall at equal times; none before the first
/// touch at t = 0.
#[derive(Clone, Debug)]
pub struct Tape {
    start_s: f64,
    interval_s: f64,
    length: usize,
    forces_n: Vec<[f64; 2]>,
    last: (f64, [f64; 2]),
}

impl Tape {
    /// An empty tape of `length` times from `start_s` on.
    #[must_use]
    pub fn new(start_s: f64, interval_s: f64, length: usize) -> Self {
        let mut tape = Self {
            start_s,
            interval_s,
            length,
            forces_n: Vec::with_capacity(length),
            last: (0.0, [0.0; 2]),
        };
        tape.note(0.0, [0.0; 2]);
        tape
    }

    /// The next time to be taped, in s; `None` once the tape is full.
    fn next_s(&self) -> Option<f64> {
        let next = self.forces_n.len();
        (next < self.length).then_some(self.start_s + next as f64 * self.interval_s)
    }

    /// Forces at a time in s: straight lines from the time before.
    pub fn note(&mut self, time_s: f64, forces_n: [f64; 2]) {
        let (before_s, before_n) = self.last;
        while let Some(next_s) = self.next_s().filter(|next_s| *next_s <= time_s) {
            let whole = time_s - before_s;
            let part = if whole > 0.0 {
                ((next_s - before_s) / whole).clamp(0.0, 1.0)
            } else {
                1.0
            };
            let between = |at: usize| before_n[at] + part * (forces_n[at] - before_n[at]);
            self.forces_n.push([between(0), between(1)]);
        }
        self.last = (time_s, forces_n);
    }

    /// The whole tape; after the last force noted nothing changes any more.
    #[must_use]
    pub fn into_forces_n(mut self) -> Vec<[f64; 2]> {
        let (_, forces_n) = self.last;
        self.forces_n.resize(self.length, forces_n);
        self.forces_n
    }
}

/// Tapes a wave as it runs.
#[derive(Debug)]
pub(super) struct Taping<'a> {
    /// The tape.
    pub tape: &'a mut Tape,
    /// Sensor bead and wall.
    pub sensors: [Sensor; 2],
}

impl Observer for Taping<'_> {
    fn step(&mut self, piece: &Piece<'_>) -> Flow {
        let end_s = piece.time_s(1.0);
        let forces = |theta: f64| self.sensors.map(|sensor| piece.signal(sensor, theta));
        while let Some(time_s) = self.tape.next_s().filter(|time_s| *time_s < end_s) {
            let theta = (time_s - piece.start_s()) / piece.step_s();
            let forces_n = forces(theta.clamp(0.0, 1.0));
            self.tape.forces_n.push(forces_n);
        }
        self.tape.last = (end_s, forces(1.0));
        Flow::Continue
    }
}

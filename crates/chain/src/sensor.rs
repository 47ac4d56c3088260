//! Where a chain is watched.

/// One signal of a chain, as a function of time.
///
/// Forces are dynamic: the static force is subtracted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensor {
    /// Mid-plane force of a split bead, (F_{n−1} + F_n)/2, in N.
    Bead(usize),
    /// Force of one contact in N; contact N is the wall signal.
    Contact(usize),
    /// Displacement of a body from static equilibrium in m.
    Position(usize),
    /// Velocity of a body in m/s.
    Velocity(usize),
    /// One channel that adds a bead sensor and the wall, as the paper records it, in N.
    BeadPlusWall(usize),
}

//! Velocity Verlet, as discrete-element codes use it.

use super::table::{Table, hermite};

/// Velocity Verlet [Swope1982]; forces that depend on velocity see the
/// half-step velocity, so that one force pass a step is enough; with them it
/// is of order 1 only.
pub(crate) fn verlet() -> Table {
    Table {
        nodes: vec![0.0, 1.0],
        velocity: vec![vec![], vec![0.5], vec![0.5, 0.5]],
        position: vec![vec![], vec![0.5], vec![0.5, 0.0]],
        error: None,
        dense_velocity: hermite(&[0.5, 0.5], 1.0, &[0.0, 1.0]),
        dense_position: hermite(&[0.5, 0.0], 0.0, &[0.5, 0.5]),
        last_is_end: false,
        order: 2.0,
        bends: false,
    }
}

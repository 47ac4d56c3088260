//! The classical fixed-step Runge–Kutta method, as the paper used it.

use super::table::{Table, hermite};

/// The classical method of order 4 [Kutta1901], with a cubic between steps.
pub(crate) fn rk4() -> Table {
    let end = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];
    let rows: [&[f64]; 5] = [&[], &[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0], &end];
    let weights = [end[0], end[1], end[2], end[3], 0.0];
    let dense = hermite(&weights, 1.0, &[0.0, 0.0, 0.0, 0.0, 1.0]);
    let mut table = Table::from_runge_kutta(&rows, None, dense, 4.0);
    let mut moved = table.end().1.to_vec();
    moved.push(0.0);
    table.dense_position = hermite(&moved, 0.0, &weights);
    table
}

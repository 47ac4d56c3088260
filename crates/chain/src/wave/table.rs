//! Explicit one-step methods for x″ = a(x, x′) as tables of numbers.

pub(crate) const DEGREE: usize = 5;

/// A method in position–velocity form: with accelerations A_j of the stages,
/// stage s is V = v + h Σ velocity[s][j] A_j and
/// X = x + h c_s v + h² Σ position[s][j] A_j; the last two rows give the end
/// of the step.
#[derive(Clone, Debug)]
pub struct Table {
    pub(crate) nodes: Vec<f64>,
    /// Velocity weights of the stages, then of the end.
    pub(crate) velocity: Vec<Vec<f64>>,
    /// Position weights of the stages, then of the end.
    pub(crate) position: Vec<Vec<f64>>,
    /// Weights of the velocity's and the position's error estimate; empty for fixed steps.
    pub(crate) error: Option<[Vec<f64>; 2]>,
    /// Coefficients of θ, θ², … of every stage in the velocity's dense output.
    pub(crate) dense_velocity: Vec<[f64; DEGREE]>,
    /// The same for the position, whose step is h².
    pub(crate) dense_position: Vec<[f64; DEGREE]>,
    /// The last stage is evaluated at the end of the step.
    pub(crate) last_is_end: bool,
    pub(crate) order: f64,
    /// The dense output needs forces within the step, as it is of a lower order than the step.
    pub(crate) bends: bool,
}

impl Table {
    pub(crate) fn stages(&self) -> usize {
        self.nodes.len()
    }

    /// From a Runge–Kutta method whose last stage is the end of the step:
    /// `rows[s]` are its weights, `error` the difference to the embedded
    /// method, `dense[j]` the polynomial of stage j.
    pub(crate) fn from_runge_kutta(
        rows: &[&[f64]],
        error: Option<&[f64]>,
        dense: Vec<[f64; DEGREE]>,
        order: f64,
    ) -> Self {
        let velocity: Vec<Vec<f64>> = rows.iter().map(|row| row.to_vec()).collect();
        let position = rows
            .iter()
            .map(|row| {
                let mut weights = twice(row, rows);
                weights.truncate(row.len());
                weights
            })
            .collect();
        let columns: Vec<Vec<f64>> =
            (0..DEGREE).map(|p| dense.iter().map(|row| row[p]).collect()).collect();
        let twice_dense: Vec<Vec<f64>> = columns.iter().map(|row| twice(row, rows)).collect();
        let dense_position =
            (0..rows.len()).map(|j| std::array::from_fn(|p| twice_dense[p][j])).collect();
        Self {
            nodes: rows.iter().map(|row| row.iter().sum()).collect(),
            error: error.map(|weights| [weights.to_vec(), twice(weights, rows)]),
            position,
            velocity,
            dense_velocity: dense,
            dense_position,
            last_is_end: true,
            order,
            bends: false,
        }
    }

    /// From an embedded pair whose last stage is the end of the step, with the quintic between steps that
    /// has positions, velocities and accelerations of both ends.
    pub(crate) fn between_both_ends(rows: &[&[f64]], error: &[f64], order: f64) -> Self {
        let no_dense = vec![[0.0; DEGREE]; rows.len()];
        let mut table =
            Self { bends: true, ..Self::from_runge_kutta(rows, Some(error), no_dense, order) };
        let (velocity, position) = table.end();
        let last = rows.len() - 1;
        let weight = |of: &[f64], j: usize| of.get(j).copied().unwrap_or(0.0);
        let quintics: Vec<[f64; 4]> = (0..rows.len())
            .map(|j| {
                let (moved, sped) = (weight(position, j), weight(velocity, j));
                let first = if j == 0 { 1.0 } else { 0.0 };
                let end = if j == last { 1.0 } else { 0.0 };
                [
                    0.5 * first,
                    10.0 * moved - 4.0 * sped + 0.5 * end - 1.5 * first,
                    -15.0 * moved + 7.0 * sped - end + 1.5 * first,
                    6.0 * moved - 3.0 * sped + 0.5 * end - 0.5 * first,
                ]
            })
            .collect();
        let quintic = quintics.iter();
        table.dense_velocity =
            quintic.clone().map(|[b, c, d, e]| [2.0 * b, 3.0 * c, 4.0 * d, 5.0 * e, 0.0]).collect();
        table.dense_position = quintic.map(|&[b, c, d, e]| [0.0, b, c, d, e]).collect();
        table
    }

    /// Weights of the end of the step for velocity and position.
    pub(crate) fn end(&self) -> (&[f64], &[f64]) {
        let last = self.velocity.len() - 1;
        (&self.velocity[last], &self.position[last])
    }
}

/// Σ_j weights[j] rows[j][·]: what a sum over stage velocities is as a sum
/// over stage accelerations. As long as there are stages.
fn twice(weights: &[f64], rows: &[&[f64]]) -> Vec<f64> {
    let mut sums = vec![0.0; rows.len()];
    for (weight, row) in weights.iter().zip(rows) {
        for (sum, value) in sums.iter_mut().zip(*row) {
            *sum += weight * value;
        }
    }
    sums
}

/// The cubic in θ that has the right values and slopes at both ends: slope
/// of the first stage, of the last stage, and the step's own weights.
pub(crate) fn hermite(end: &[f64], first_slope: f64, last_slope: &[f64]) -> Vec<[f64; DEGREE]> {
    end.iter()
        .zip(last_slope)
        .enumerate()
        .map(|(j, (b, slope))| {
            let first = if j == 0 { first_slope } else { 0.0 };
            [first, 3.0 * b - 2.0 * first - slope, first + slope - 2.0 * b, 0.0, 0.0]
        })
        .collect()
}

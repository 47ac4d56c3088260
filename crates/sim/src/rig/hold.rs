//! A linear system between samples, exactly, for inputs that are straight
//! lines from sample to sample.

/// ẋ = A x + B u over one step: x(h) = Φ x(0) + γ u(0) + δ (u(h) − u(0)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hold<const STATES: usize> {
    transition: [[f64; STATES]; STATES],
    input: [f64; STATES],
    change: [f64; STATES],
}

impl<const STATES: usize> Hold<STATES> {
    /// Of A in 1/s and B in 1/s, over a step in s.
    #[must_use]
    pub(super) fn new(a: &[[f64; STATES]; STATES], b: &[f64; STATES], step_s: f64) -> Self {
        // exp of the system with u and its change as states of their own:
        // u̇ = change/step, so that over a step of length 1 it is the change.
        let size = STATES + 2;
        let mut square = vec![vec![0.0; size]; size];
        for row in 0..STATES {
            for column in 0..STATES {
                square[row][column] = a[row][column] * step_s;
            }
            square[row][STATES] = b[row] * step_s;
        }
        square[STATES][STATES + 1] = 1.0;
        let whole = exponential(&square);
        Self {
            transition: std::array::from_fn(|x| std::array::from_fn(|y| whole[x][y])),
            input: std::array::from_fn(|x| whole[x][STATES]),
            change: std::array::from_fn(|x| whole[x][STATES + 1]),
        }
    }

    /// The state a step later; the input goes from `from` to `to`.
    #[must_use]
    #[inline]
    pub(super) fn step(&self, state: &[f64; STATES], from: f64, to: f64) -> [f64; STATES] {
        let change = to - from;
        std::array::from_fn(|row| {
            let rows = self.transition[row].iter().zip(state);
            let own: f64 = rows.map(|(factor, x)| factor * x).sum();
            own + self.input[row] * from + self.change[row] * change
        })
    }
}

type Square = Vec<Vec<f64>>;

/// Terms of the series for a matrix of norm up to 1/2: (1/2)^18/18! < 1e-21.
const TERMS: u32 = 18;

/// exp of a matrix: a Taylor series of a part, squared again and again.
fn exponential(matrix: &Square) -> Square {
    let norm = matrix
        .iter()
        .map(|row| row.iter().map(|x| x.abs()).sum::<f64>())
        .fold(0.0, f64::max);
    let halvings = (norm.max(0.5).log2() + 1.0).ceil().clamp(0.0, 1000.0) as i32;
    let part = scaled(matrix, 0.5f64.powi(halvings));
    let mut sum = identity(matrix.len());
    for term in (1..=TERMS).rev() {
        sum = product(&scaled(&part, f64::from(term).recip()), &sum);
        for (at, row) in sum.iter_mut().enumerate() {
            row[at] += 1.0;
        }
    }
    (0..halvings).fold(sum, |root, _| product(&root, &root))
}

fn identity(size: usize) -> Square {
    let row = |at: usize| (0..size).map(|k| f64::from(u8::from(k == at))).collect();
    (0..size).map(row).collect()
}

fn scaled(matrix: &Square, factor: f64) -> Square {
    let row = |row: &Vec<f64>| row.iter().map(|x| factor * x).collect();
    matrix.iter().map(row).collect()
}

fn product(left: &Square, right: &Square) -> Square {
    let size = left.len();
    let entry = |row: usize, column: usize| -> f64 {
        let terms = (0..size).map(|k| left[row][k] * right[k][column]);
        terms.sum()
    };
    let row = |row: usize| (0..size).map(|column| entry(row, column)).collect();
    (0..size).map(row).collect()
}

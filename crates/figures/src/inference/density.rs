//! Densities from samples.

/// Weights of one pass of smoothing, nearly a bell.
const BELL: [f64; 5] = [1.0 / 16.0, 0.25, 0.375, 0.25, 1.0 / 16.0];

/// Cell of each value between two ends; none outside.
fn cell(value: f64, (from, to): (f64, f64), cells: usize) -> Option<usize> {
    let place = ((value - from) / (to - from) * cells as f64).floor();
    (place >= 0.0 && place < cells as f64).then_some(place as usize)
}

pub(super) fn histogram(samples: &[f64], range: (f64, f64), cells: usize) -> Vec<f64> {
    let mut counts = vec![0.0; cells];
    let found = samples.iter().filter_map(|x| cell(*x, range, cells));
    found.for_each(|i| counts[i] += 1.0);
    smoothed(&counts)
}

fn smoothed(counts: &[f64]) -> Vec<f64> {
    let at = |i: usize| {
        let weigh = |(k, weight): (usize, &f64)| {
            // Mirrored at the ends, where bounds may be.
            let place = (i + k).abs_diff(2).min(2 * counts.len() + 1 - i - k);
            weight * counts.get(place).copied().unwrap_or(0.0)
        };
        BELL.iter().enumerate().map(weigh).sum()
    };
    (0..counts.len()).map(at).collect()
}

/// Smoothed counts of pairs over equal cells, row by row upward.
pub(super) fn joint(
    pairs: impl Iterator<Item = (f64, f64)>,
    (x, y): ((f64, f64), (f64, f64)),
    cells: usize,
) -> Vec<Vec<f64>> {
    let mut rows = vec![vec![0.0; cells]; cells];
    for (a, b) in pairs {
        if let (Some(i), Some(j)) = (cell(a, x, cells), cell(b, y, cells)) {
            rows[j][i] += 1.0;
        }
    }
    // Rows and columns in turn: each smooths along rows and swaps both. A pass widens by the
    // square of one cell, all together by 2 % of the range.
    for _ in 0..2 * (cells * cells / 2500) {
        let smooth: Vec<Vec<f64>> = rows.iter().map(|row| smoothed(row)).collect();
        rows = (0..cells).map(|i| smooth.iter().map(|row| row[i]).collect()).collect();
    }
    rows
}

/// The value above which the densest cells, taken together, hold a share of the whole.
pub(super) fn level(rows: &[Vec<f64>], share: f64) -> f64 {
    let mut all: Vec<f64> = rows.iter().flatten().copied().collect();
    all.sort_by(|a, b| b.total_cmp(a));
    let goal = share * all.iter().sum::<f64>();
    let mut sum = 0.0;
    let passes = |value: &f64| {
        sum += value;
        sum >= goal
    };
    all.into_iter().find(passes).unwrap_or(0.0)
}

#[cfg(test)]
#[path = "tests/level.rs"]
mod tests;

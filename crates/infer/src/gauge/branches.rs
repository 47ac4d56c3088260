//! Which solution of each row to take.

/// The solution of a row to take, and whether every other way bends much more.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Chosen {
    pub(super) pair: usize,
    pub(super) is_clear: bool,
}

/// ln speed and ln A of a row's solutions.
pub(super) type Row = (f64, Vec<f64>);

/// Rows that make three bends: of fewer, chance alone makes a way straight.
pub(super) const ENOUGH: usize = 5;
/// Odds against every other way where one is clear.
const ODDS: f64 = 1000.0;
/// Least ratio of two sums of squares that means anything.
const LEAST_RATIO: f64 = 4.0;

/// For each row the solution to take: contacts change smoothly with speed, and solutions that belong
/// to nothing do not. Of all ways to take them that with the least sum of squared changes of the
/// slope d ln A/d ln v from speed to speed; the first of each row where there are fewer than three.
///
/// Of n bends that are normal with one unknown variance, a way with the sum S of squares has the
/// likelihood S^(−n/2): odds of a thousand to one are a factor 1000^(2/n). Bends that are errors of
/// A are not independent of their neighbours, so that many of them say less than that.
pub(super) fn smoothest(rows: &[Row]) -> Vec<Chosen> {
    let Some((least, way)) = straightest(rows) else {
        return vec![Chosen::default(); rows.len()];
    };
    let bends = rows.len().saturating_sub(2).max(1) as f64;
    let much_more = ODDS.powf(2.0 / bends).max(LEAST_RATIO);
    let others = |row: usize| {
        let mut others = rows.to_vec();
        others[row].1.remove(way[row]);
        straightest(&others).map_or(f64::INFINITY, |(cost, _)| cost)
    };
    let chosen = |row: usize| Chosen {
        pair: way[row],
        is_clear: rows[row].1.len() == 1 || rows.len() >= ENOUGH && others(row) > much_more * least,
    };
    (0..rows.len()).map(chosen).collect()
}

/// Distance in ln speed by which two rows of one speed count as apart.
const USUALLY_APART: f64 = 0.1;

/// The way of least cost, and that (dynamic programming over neighbours); `None` of fewer than three
/// rows, or where one has no solution.
fn straightest(rows: &[Row]) -> Option<(f64, Vec<usize>)> {
    if rows.len() < 3 || rows.iter().any(|(_, pairs)| pairs.is_empty()) {
        return None;
    }
    let slope = |row: usize, before: usize, at: usize| {
        let [(v0, from), (v1, to)] = [&rows[row - 1], &rows[row]];
        let apart = if v1 > v0 { v1 - v0 } else { USUALLY_APART };
        (to[at] - from[before]) / apart
    };
    let numbers = |row: usize| 0..rows[row].1.len();
    let first = numbers(0).flat_map(|a| numbers(1).map(move |b| (0.0, vec![a, b])));
    let mut ways: Vec<(f64, Vec<usize>)> = first.collect();
    for row in 2..rows.len() {
        let mut next: Vec<(f64, Vec<usize>)> = Vec::new();
        for (cost, way) in &ways {
            for number in numbers(row) {
                let [a, b] = [way[row - 2], way[row - 1]];
                let bend = slope(row, b, number) - slope(row - 1, a, b);
                let longer = (cost + bend * bend, [&way[..], &[number]].concat());
                // Only the last two matter for what follows.
                let same = |other: &&mut (f64, Vec<usize>)| other.1[row - 1..] == [b, number];
                match next.iter_mut().find(same) {
                    Some(known) if known.0 <= longer.0 => {}
                    Some(known) => *known = longer,
                    None => next.push(longer),
                }
            }
        }
        ways = next;
    }
    ways.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
#[path = "tests/branches.rs"]
mod tests;

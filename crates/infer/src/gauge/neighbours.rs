//! Which of several pairs of K and A goes on from those of neighbouring speeds.
//!
//! One row alone can't tell. But contacts change smoothly with speed, and the pairs that
//! belong to nothing do not: they come near the true ones at some speed and part from them.

/// The pair of a row to take, and whether that is clear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Chosen {
    /// Its number.
    pub pair: usize,
    /// Whether every way through another pair of the row bends much more.
    pub is_clear: bool,
}

/// Rows given as ln speed and ln A of their pairs.
type Row = (f64, Vec<f64>);

/// For each row the pair to take: of all ways to take them that with the least sum of
/// squared changes of the slope d ln A/d ln v from speed to speed. The first of each row
/// where there are fewer than three.
pub(super) fn smoothest(rows: &[Row]) -> Vec<Chosen> {
    let Some((least, way)) = straightest(rows) else {
        return vec![Chosen::default(); rows.len()];
    };
    let others = |row: usize| {
        let mut others = rows.to_vec();
        others[row].1.remove(way[row]);
        straightest(&others).map_or(f64::INFINITY, |(cost, _)| cost)
    };
    let enough = rows.len() >= ENOUGH;
    let chosen = |row: usize| Chosen {
        pair: way[row],
        is_clear: rows[row].1.len() == 1 || enough && others(row) > much_more(rows.len()) * least,
    };
    (0..rows.len()).map(chosen).collect()
}

/// Rows that make three bends: of fewer, chance alone makes a way straight.
const ENOUGH: usize = 5;

/// How many times larger the sum of squared bends S of every other way is where one is clear.
///
/// Of n bends that are normal with one unknown variance, a way has the likelihood S^(−n/2): odds
/// of a thousand to one are a factor 1000^(2/n). Bends that are errors of A are not
/// independent of their neighbours, so that many of them tell less than that: at least
/// [`LEAST`].
fn much_more(rows: usize) -> f64 {
    let bends = rows.saturating_sub(2).max(1) as f64;
    ODDS.powf(2.0 / bends).max(LEAST)
}

/// Odds against every other way where one is clear.
const ODDS: f64 = 1000.0;

/// Least ratio of two sums of squares that means anything.
const LEAST: f64 = 4.0;

/// The way of least cost, and that (dynamic programming over neighbours); `None` of fewer
/// than three rows, or where one has no pair.
fn straightest(rows: &[Row]) -> Option<(f64, Vec<usize>)> {
    if rows.len() < 3 || rows.iter().any(|(_, pairs)| pairs.is_empty()) {
        return None;
    }
    let slope = |row: usize, before: usize, at: usize| {
        let [(v0, from), (v1, to)] = [&rows[row - 1], &rows[row]];
        (to[at] - from[before]) / (v1 - v0)
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
#[path = "tests/neighbours.rs"]
mod tests;

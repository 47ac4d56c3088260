//! Which of several pairs of K and A goes on from those of neighbouring speeds.
//!
//! One row alone can't tell. But contacts change smoothly with speed, and the pairs that
//! belong to nothing do not: they come near the true ones at some speed and part from them.

/// For each row, given as ln speed and ln A of its pairs, the number of the pair to take:
/// of all ways to take them that with the least sum of squared changes of the slope
/// d ln A/d ln v from speed to speed (dynamic programming over neighbours). The first of
/// each row where there are fewer than three.
pub(super) fn smoothest(rows: &[(f64, Vec<f64>)]) -> Vec<usize> {
    if rows.len() < 3 || rows.iter().any(|(_, pairs)| pairs.is_empty()) {
        return vec![0; rows.len()];
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
    let best = ways.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or_else(|| vec![0; rows.len()], |(_, way)| way)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight line and a bent one that crosses it: sorted by size, the line is the
    /// second pair first and the first pair later.
    #[test]
    fn a_line_is_followed_through_a_crossing() {
        let row = |at: usize| {
            let x = at as f64 / 4.0;
            let mut pairs = vec![2.0 - x, 1.0 + (x - 1.0).powi(3)];
            pairs.sort_by(f64::total_cmp);
            (x, pairs)
        };
        let rows: Vec<(f64, Vec<f64>)> = (0..9).map(row).collect();
        let taken = smoothest(&rows);
        for ((x, pairs), number) in rows.iter().zip(&taken) {
            // One subtraction, twice the same.
            assert_eq!(pairs[*number], 2.0 - x, "{taken:?}");
        }
        assert_eq!((taken[0], taken[8]), (1, 0));
        assert_eq!(smoothest(&rows[..2]), [0, 0]);
    }
}

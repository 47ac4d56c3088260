//! Densities from samples, and their lines of equal density.

use std::collections::BTreeMap;

/// Weights of one pass of smoothing, nearly a bell.
const BELL: [f64; 5] = [1.0 / 16.0, 0.25, 0.375, 0.25, 1.0 / 16.0];

/// Cell of each value between two ends; none outside.
fn cell(value: f64, (from, to): (f64, f64), cells: usize) -> Option<usize> {
    let place = ((value - from) / (to - from) * cells as f64).floor();
    (place >= 0.0 && place < cells as f64).then_some(place as usize)
}

/// Smoothed counts in equal cells.
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

/// Smoothed counts of pairs over equal cells.
pub(super) fn joint(
    pairs: impl Iterator<Item = (f64, f64)>,
    (x, y): ((f64, f64), (f64, f64)),
    cells: usize,
) -> Field {
    let mut rows = vec![vec![0.0; cells]; cells];
    for (a, b) in pairs {
        if let (Some(i), Some(j)) = (cell(a, x, cells), cell(b, y, cells)) {
            rows[j][i] += 1.0;
        }
    }
    for _ in 0..2 {
        rows = rows.iter().map(|row| smoothed(row)).collect();
        let columns: Vec<Vec<f64>> = (0..cells)
            .map(|i| smoothed(&rows.iter().map(|row| row[i]).collect::<Vec<f64>>()))
            .collect();
        rows = (0..cells).map(|j| columns.iter().map(|column| column[j]).collect()).collect();
    }
    Field { rows, x, y }
}

/// Values at the middles of equal cells, row by row upward.
pub(super) struct Field {
    pub rows: Vec<Vec<f64>>,
    /// Outer edges of the first and last column.
    pub x: (f64, f64),
    /// Outer edges of the first and last row.
    pub y: (f64, f64),
}

/// An edge between neighbouring middles: the lower left one, and whether it goes up.
type Edge = (usize, usize, bool);

impl Field {
    /// The value above which a share of the whole lies: where the densest
    /// cells, taken together, first hold it.
    pub(super) fn level(&self, share: f64) -> f64 {
        let mut all: Vec<f64> = self.rows.iter().flatten().copied().collect();
        all.sort_by(|a, b| b.total_cmp(a));
        let goal = share * all.iter().sum::<f64>();
        let mut sum = 0.0;
        let passes = |value: &f64| {
            sum += value;
            sum >= goal
        };
        all.into_iter().find(passes).unwrap_or(0.0)
    }

    fn value(&self, i: usize, j: usize) -> f64 {
        self.rows[j][i]
    }

    /// Lines at a level by marching squares, joined end to end; pieces are
    /// parted by a point that is not a number.
    pub(super) fn contour(&self, level: f64) -> (Vec<f64>, Vec<f64>) {
        let mut links: BTreeMap<Edge, Vec<Edge>> = BTreeMap::new();
        for (a, b) in self.segments(level) {
            links.entry(a).or_default().push(b);
            links.entry(b).or_default().push(a);
        }
        let (mut xs, mut ys) = (Vec::new(), Vec::new());
        // Open lines first, from an end.
        while let Some(start) = end(&links) {
            for edge in walked(&mut links, start) {
                let (x, y) = self.crossing(edge, level);
                xs.push(x);
                ys.push(y);
            }
            xs.push(f64::NAN);
            ys.push(f64::NAN);
        }
        (xs, ys)
    }

    /// Pairs of edges that a line joins, square by square.
    fn segments(&self, level: f64) -> Vec<(Edge, Edge)> {
        let mut all = Vec::new();
        for j in 1..self.rows.len() {
            for i in 1..self.rows[j].len() {
                let (left, low) = (i - 1, j - 1);
                let edges =
                    [(left, low, false), (i, low, true), (left, j, false), (left, low, true)];
                let crossed: Vec<Edge> =
                    (edges.into_iter()).filter(|edge| self.is_crossed(*edge, level)).collect();
                // Saddles: two lines, each about one corner.
                all.extend(crossed.chunks_exact(2).map(|pair| (pair[0], pair[1])));
            }
        }
        all
    }

    fn ends(&self, (i, j, up): Edge) -> (f64, f64) {
        let other = if up { self.value(i, j + 1) } else { self.value(i + 1, j) };
        (self.value(i, j), other)
    }

    fn is_crossed(&self, edge: Edge, level: f64) -> bool {
        let (a, b) = self.ends(edge);
        (a > level) != (b > level)
    }

    /// Where a line crosses an edge, straight between its ends' values.
    fn crossing(&self, edge: Edge, level: f64) -> (f64, f64) {
        let (a, b) = self.ends(edge);
        let share = (level - a) / (b - a);
        let (i, j, up) = edge;
        let (right, above) = if up { (0.0, share) } else { (share, 0.0) };
        let place = |cell: f64, (from, to): (f64, f64), cells: usize| {
            from + (to - from) * (cell + 0.5) / cells as f64
        };
        let columns = self.rows.first().map_or(0, Vec::len);
        (place(i as f64 + right, self.x, columns), place(j as f64 + above, self.y, self.rows.len()))
    }
}

/// An edge to start from: the end of a line if there is one.
fn end(links: &BTreeMap<Edge, Vec<Edge>>) -> Option<Edge> {
    let open = links.iter().find(|(_, next)| next.len() == 1);
    open.or_else(|| links.iter().next()).map(|(edge, _)| *edge)
}

/// Follows a line to its end or round, and forgets it.
fn walked(links: &mut BTreeMap<Edge, Vec<Edge>>, start: Edge) -> Vec<Edge> {
    let mut line = vec![start];
    let mut at = start;
    while let Some(next) = links.get_mut(&at).and_then(Vec::pop) {
        if let Some(back) = links.get_mut(&next) {
            let own = back.iter().position(|edge| *edge == at);
            own.map(|place| back.remove(place));
        }
        line.push(next);
        at = next;
    }
    links.retain(|_, next| !next.is_empty());
    line
}

#[cfg(test)]
#[path = "tests/contour.rs"]
mod tests;

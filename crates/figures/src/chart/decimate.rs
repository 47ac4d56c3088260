//! Thinning of long series: what falls into one printed pixel column is
//! replaced by its ends and extremes, which look the same.

use std::collections::BTreeSet;

use crate::draw::Point;

/// Width of a column in points: a pixel at 300 dpi.
const COLUMN: f64 = 0.24;
/// Shorter lines are drawn as they are.
const FEW: usize = 2000;

/// Thins one unbroken line.
pub(crate) fn line(points: Vec<Point>) -> Vec<Point> {
    if points.len() <= FEW {
        return points;
    }
    let column = |p: &Point| (p.x / COLUMN).floor();
    let runs = points.chunk_by(|a, b| column(a) == column(b));
    runs.flat_map(ends_and_extremes).collect()
}

/// First, lowest, highest and last point in their order along the line.
fn ends_and_extremes(run: &[Point]) -> Vec<Point> {
    let mut keep = BTreeSet::from([0, run.len() - 1]);
    let by_y = |a: &(usize, &Point), b: &(usize, &Point)| a.1.y.total_cmp(&b.1.y);
    keep.extend(run.iter().enumerate().min_by(by_y).map(|(i, _)| i));
    keep.extend(run.iter().enumerate().max_by(by_y).map(|(i, _)| i));
    keep.into_iter()
        .filter_map(|i| run.get(i).copied())
        .collect()
}

/// Drops points that a printed pixel cannot distinguish from an earlier one.
pub(crate) fn scatter(points: Vec<Point>) -> Vec<Point> {
    if points.len() <= FEW {
        return points;
    }
    let mut seen = BTreeSet::new();
    let pixel = |v: f64| (v / COLUMN).round() as i64;
    points
        .into_iter()
        .filter(|p| seen.insert((pixel(p.x), pixel(p.y))))
        .collect()
}

#[cfg(test)]
#[path = "tests/decimate.rs"]
mod tests;

//! A posterior, parameter by parameter and pair by pair.

use crate::{Chart, Colour, ColourMap, Dash, Figure, HeatMap, Panel, Series};
use std::f64::consts::TAU;

/// Samples of several parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner<'a> {
    /// Labels of the parameters, with units.
    pub labels: &'a [String],
    /// Samples of each parameter, all of one length.
    pub samples: &'a [Vec<f64>],
    /// The best fit, to be marked; empty for none.
    pub marks: &'a [f64],
    /// Covariance around it, row by row, to be drawn beside the samples; empty for none.
    pub covariance: &'a [Vec<f64>],
}

const CELLS: usize = 50;
/// Cells of a pair: finer, since smoothing widens narrow valleys.
const FINE: usize = 160;
/// Radii, in standard errors, of the ellipses that hold as much of a normal pair.
const RADII: [f64; 2] = [2.482, 1.515];
/// Shares of the samples within the shaded areas.
const SHARES: [f64; 2] = [0.954, 0.683];
/// Share of the samples outside of a panel, at either end.
const OUTSIDE: f64 = 0.001;
/// Most parameters that fit on a page.
const MOST: usize = 8;

impl Corner<'_> {
    /// Densities on the diagonal, below it areas that hold 68 and 95 % of each
    /// pair's samples. The first eight parameters are drawn.
    pub fn figure(&self) -> Figure {
        let count = self.labels.len().min(self.samples.len()).min(MOST);
        let ranges: Vec<(f64, f64)> = self.samples[..count].iter().map(|s| range(s)).collect();
        let empty = match count {
            0..=2 => Figure::single_column(82.0),
            _ => Figure::double_column(168.0),
        };
        let empty = empty.columns(count);
        let places = (0..count * count).map(|place| (place / count, place % count));
        let figure = places.fold(empty, |figure, (row, column)| match row.cmp(&column) {
            std::cmp::Ordering::Less => figure.panel(Panel::Empty),
            std::cmp::Ordering::Equal => figure.panel(self.alone(row, count, ranges[row])),
            std::cmp::Ordering::Greater => {
                figure.panel(self.pair(row, column, count, (ranges[column], ranges[row])))
            }
        });
        figure.title("Posterior of the parameters").caption(
            "Diagonal: density of each parameter, its middle 68 % shaded. Below: areas that hold 68 and 95 % \
             of the samples of each pair. Dashed: the best fit, and the same by its covariance.",
        )
    }

    fn empty(&self, row: usize, column: usize, count: usize, x: (f64, f64)) -> Chart {
        let mut chart = Chart::new(&self.labels[column], &self.labels[row]).x_range(x.0, x.1);
        chart.legend = false;
        chart.x.unlabelled = row + 1 != count;
        chart.y.unlabelled = column != 0 || row == 0;
        match self.marks.get(column) {
            Some(mark) => chart.v_line(*mark, ""),
            None => chart,
        }
    }

    fn alone(&self, k: usize, count: usize, range: (f64, f64)) -> Chart {
        let density = histogram(&self.samples[k], range, CELLS);
        let top = density.iter().copied().fold(0.0, f64::max);
        let step = (range.1 - range.0) / CELLS as f64;
        let x: Vec<f64> = (0..CELLS).map(|i| range.0 + step * (i as f64 + 0.5)).collect();
        let y: Vec<f64> = density.iter().map(|d| d / top).collect();
        let mut chart = self.empty(k, k, count, range).y_range(0.0, 1.15);
        chart.y.unlabelled = true;
        let [low, high] = [0.16, 0.84].map(|share| quantile(&self.samples[k], share));
        let inside = |x: &f64| low <= *x && *x <= high;
        let shaded: Vec<f64> =
            (x.iter().zip(&y)).map(|(x, y)| if inside(x) { *y } else { f64::NAN }).collect();
        let [sampled, normal] = match k {
            0 => ["posterior", "covariance"],
            _ => [""; 2],
        };
        if k == 0 {
            chart.legend = true;
        }
        let chart = chart
            .with(
                Series::band("", &x, &vec![0.0; CELLS], &shaded)
                    .colour(Colour::BLUE.mixed(Colour::WHITE, 0.7)),
            )
            .with(Series::line(sampled, &x, &y).colour(Colour::BLUE).dash(Dash::Solid));
        match self.bell(k, &x) {
            Some(bell) => chart.with(by_covariance(normal, &x, &bell)),
            None => chart,
        }
    }

    /// The best fit's normal distribution over its maximum.
    fn bell(&self, k: usize, x: &[f64]) -> Option<Vec<f64>> {
        let (best, variance) = (self.marks.get(k)?, self.covariance.get(k)?.get(k)?);
        let height = |x: &f64| (-0.5 * (x - best).powi(2) / variance).exp();
        Some(x.iter().map(height).collect())
    }

    /// The best fit's ellipse at a radius in standard errors.
    fn ellipse(&self, row: usize, column: usize, radius: f64) -> Option<(Vec<f64>, Vec<f64>)> {
        let (x, y) = (self.marks.get(column)?, self.marks.get(row)?);
        let entry = |i: usize, j: usize| self.covariance.get(i)?.get(j).copied();
        let sd = entry(column, column)?.sqrt();
        // Cholesky's factor of both parameters' covariance.
        let slope = entry(row, column)? / sd;
        let rest = (entry(row, row)? - slope * slope).max(0.0).sqrt();
        let place = |step: i32| {
            let (sin, cos) = (TAU * f64::from(step) / 120.0).sin_cos();
            (x + radius * sd * cos, y + radius * (slope * cos + rest * sin))
        };
        Some((0..=120).map(place).unzip())
    }

    fn pair(
        &self,
        row: usize,
        column: usize,
        count: usize,
        ranges: ((f64, f64), (f64, f64)),
    ) -> Chart {
        let pairs = self.samples[column].iter().zip(&self.samples[row]);
        let rows = joint(pairs.map(|(x, y)| (*x, *y)), ranges, FINE);
        let levels = SHARES.map(|share| level(&rows, share));
        let depth = |value: &f64| levels.iter().filter(|level| value >= level).count() as f64;
        let depths: Vec<f64> = rows.iter().flatten().map(depth).collect();
        let areas = HeatMap {
            x_edges: ranges.0,
            y_edges: ranges.1,
            colours: ColourMap::Blues,
            limits: Some((0.0, 2.0)),
            ..HeatMap::new(FINE, FINE, &depths)
        };
        let mut chart = self.empty(row, column, count, ranges.0).heat(areas);
        chart = chart.y_range(ranges.1.0, ranges.1.1);
        if let Some(mark) = self.marks.get(row) {
            chart = chart.h_line(*mark, "");
        }
        for (x, y) in (RADII.iter()).filter_map(|radius| self.ellipse(row, column, *radius)) {
            chart = chart.with(by_covariance("", &x, &y));
        }
        chart
    }
}

fn by_covariance(name: &str, x: &[f64], y: &[f64]) -> Series {
    Series::line(name, x, y).colour(Colour::VERMILION).dash(Dash::Dashed).width(0.7)
}

fn quantile(samples: &[f64], share: f64) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = share * sorted.len().saturating_sub(1) as f64;
    sorted.get(place.round() as usize).copied().unwrap_or(f64::NAN)
}

/// Where a parameter's panels begin and end.
fn range(samples: &[f64]) -> (f64, f64) {
    let (from, to) = (quantile(samples, OUTSIDE), quantile(samples, 1.0 - OUTSIDE));
    let margin = 0.06 * (to - from);
    if to > from { (from - margin, to + margin) } else { (from - 1.0, from + 1.0) }
}

/// Weights of one pass of smoothing, nearly a bell.
const BELL: [f64; 5] = [1.0 / 16.0, 0.25, 0.375, 0.25, 1.0 / 16.0];

/// Cell of each value between two ends; none outside.
fn cell(value: f64, (from, to): (f64, f64), cells: usize) -> Option<usize> {
    let place = ((value - from) / (to - from) * cells as f64).floor();
    (place >= 0.0 && place < cells as f64).then_some(place as usize)
}

fn histogram(samples: &[f64], range: (f64, f64), cells: usize) -> Vec<f64> {
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
fn joint(
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
fn level(rows: &[Vec<f64>], share: f64) -> f64 {
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

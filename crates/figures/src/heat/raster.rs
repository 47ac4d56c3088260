//! The map as a picture embedded in the SVG.

use super::HeatMap;
use crate::axis::Scale;
use crate::chart::Plot;
use crate::draw::{ColourMap, Svg};
use crate::png_image::indexed_png;

/// Size of a pixel in points: 300 dpi.
const PIXEL: f64 = 0.24;
/// Palette entry of missing values.
const MISSING: u8 = 255;

/// Draws the map over the frame of `plot`.
pub(crate) fn draw(svg: &mut Svg, map: &HeatMap, plot: &Plot) {
    let width = pixels(plot.frame.width());
    let height = pixels(plot.frame.height());
    let columns = cells(&plot.x, map.x, map.columns, width);
    let mut rows = cells(&plot.y, map.y, map.rows, height);
    rows.reverse();
    let (lo, hi) = map.range();
    let mut data = Vec::with_capacity(width * height);
    for row in &rows {
        let line = columns
            .iter()
            .map(|column| level(map.strongest(column, row), lo, hi));
        data.extend(line);
    }
    // Encoding fails only if memory cannot hold it; the frame then stays empty.
    if let Some(png) = indexed_png(width, height, &palette(map.map), &data) {
        svg.image(&plot.frame, &png);
    }
}

fn pixels(length: f64) -> usize {
    ((length / PIXEL).round() as usize).clamp(1, 20_000)
}

fn level(value: f64, lo: f64, hi: f64) -> u8 {
    let share = (value - lo) / (hi - lo);
    if share.is_nan() {
        MISSING
    } else {
        (share.clamp(0.0, 1.0) * 254.0).round() as u8
    }
}

/// 255 colours, so that a diverging map has one in the exact middle, and the missing one.
fn palette(map: ColourMap) -> Vec<u8> {
    let share = |i: u8| {
        if i == MISSING {
            f64::NAN
        } else {
            f64::from(i) / 254.0
        }
    };
    let colours = (0..=255).map(|i| map.colour(share(i)));
    colours.flat_map(|c| [c.0, c.1, c.2]).collect()
}

/// For each pixel along an axis the grid cells it covers, at least one if any.
fn cells(
    scale: &Scale,
    edges: (f64, f64),
    count: usize,
    pixels: usize,
) -> Vec<std::ops::Range<usize>> {
    let index = |pixel: usize| {
        let value = scale.value(pixel as f64 / pixels as f64);
        (value - edges.0) / (edges.1 - edges.0) * count as f64
    };
    let cells = |pixel: usize| {
        let (a, b) = (index(pixel), index(pixel + 1));
        let (from, to) = (a.min(b), a.max(b));
        let middle = 0.5 * (from + to);
        if !(0.0..count as f64).contains(&middle) {
            return 0..0;
        }
        let first = (from + 0.5).floor().max(0.0) as usize;
        let last = ((to + 0.5).floor() as usize).min(count);
        if first < last {
            first..last
        } else {
            middle as usize..middle as usize + 1
        }
    };
    (0..pixels).map(cells).collect()
}

impl HeatMap {
    /// Of all values under a pixel the one of largest size, so that a narrow
    /// pulse stays visible.
    fn strongest(&self, columns: &std::ops::Range<usize>, rows: &std::ops::Range<usize>) -> f64 {
        let mut best = f64::NAN;
        for row in rows.clone() {
            let start = row.saturating_mul(self.columns);
            let line = self
                .values
                .get(start.saturating_add(columns.start)..start.saturating_add(columns.end));
            for value in line.unwrap_or(&[]) {
                if best.is_nan() || value.abs() > best.abs() {
                    best = *value;
                }
            }
        }
        best
    }
}

#[cfg(test)]
#[path = "tests/raster.rs"]
mod tests;

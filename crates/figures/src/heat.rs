//! Maps of a quantity over two axes, as in a space-time diagram.

use crate::axis::{Room, Scale, Ticks, ticks};
use crate::chart::{FRAME, LABEL, Plot, SMALL};
use crate::draw::{Canvas, Colour, ColourMap, Item, Paint, PathData, Point, Raster, Rect};
use crate::text::{Anchor, TextLine};
use std::ops::Range;

/// Gap between frame and colour bar, and width of the bar, in points.
const GAP: f64 = 6.0;
const BAR: f64 = 8.0;
/// Size of a pixel in points: 300 dpi.
const PIXEL: f64 = 0.24;
/// Palette entry of missing values.
const MISSING: u8 = 255;

/// Values on a regular grid, to be shown as colours.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    /// Values a row.
    pub columns: usize,
    /// Rows, the first at the lower end of the y axis.
    pub rows: usize,
    /// Values row by row; missing ones are not a number.
    pub values: Vec<f64>,
    /// Outer edges of the first and last column on the x axis.
    pub x_edges: (f64, f64),
    /// Outer edges of the first and last row on the y axis.
    pub y_edges: (f64, f64),
    /// The colour map; sequential by default.
    pub colours: ColourMap,
    /// Values at the ends of the colour bar; by default those of the data,
    /// symmetric about zero for a diverging map.
    pub limits: Option<(f64, f64)>,
    /// Label of the colour bar; without one there is no bar.
    pub label: String,
}

impl HeatMap {
    /// `values` row by row: `rows` rows of `columns` values each. The first row
    /// lies at the lower end of the y axis. Missing values count as not a number.
    pub fn new(columns: usize, rows: usize, values: &[f64]) -> Self {
        let number = |n: usize| n as f64;
        Self {
            columns,
            rows,
            values: values.to_vec(),
            x_edges: (0.0, number(columns.max(1))),
            y_edges: (0.0, number(rows.max(1))),
            colours: ColourMap::Sequential,
            limits: None,
            label: String::new(),
        }
    }

    fn range(&self) -> (f64, f64) {
        let asked = self.limits.filter(|(a, b)| a.is_finite() && b.is_finite() && a < b);
        asked.unwrap_or_else(|| self.data_range())
    }

    fn data_range(&self) -> (f64, f64) {
        let finite = self.values.iter().copied().filter(|v| v.abs() <= 1e300);
        let (lo, hi) =
            finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| (lo.min(v), hi.max(v)));
        let largest = lo.abs().max(hi.abs());
        if lo > hi || largest < 1e-290 {
            (0.0, 1.0)
        } else if self.colours == ColourMap::Diverging {
            (-largest, largest)
        } else if hi - lo <= 1e-8 * largest {
            (lo - 0.5 * largest, hi + 0.5 * largest)
        } else {
            (lo, hi)
        }
    }

    fn scale(&self) -> Scale {
        let (lo, hi) = self.range();
        Scale { lo, hi, log: false }
    }

    fn bar_ticks(&self, height: f64) -> Ticks {
        let room = Room { length: height, font: SMALL, side_by_side: false };
        ticks(&self.scale(), &room)
    }

    /// Room for bar, numbers and label: right of the frame, and above it.
    pub(crate) fn bar_room(&self, height: f64) -> (f64, f64) {
        if self.label.is_empty() {
            return (0.0, 0.0);
        }
        let label = TextLine::new(&self.label, LABEL);
        let found = self.bar_ticks(height);
        let above = found.exponent.map_or(0.0, |_| 1.5 * SMALL);
        (GAP + BAR + 3.0 + found.widest(SMALL) + label.height() + 3.0, above)
    }

    /// Draws bar, ticks, numbers and label right of `frame`.
    pub(crate) fn draw_bar(&self, canvas: &mut Canvas, frame: &Rect) {
        if self.label.is_empty() {
            return;
        }
        let bar = Rect::sized(frame.x1 + GAP, frame.y0, BAR, frame.height());
        let palette = (0..=255).map(|i| self.colours.colour(1.0 - f64::from(i) / 255.0)).collect();
        let shades = Raster { width: 1, height: 256, palette, pixels: (0..=255).collect() };
        canvas.items.push(Item::Image(bar, shades));
        let (found, scale, ink) = (self.bar_ticks(bar.height()), self.scale(), Colour::BLACK);
        let mut path = PathData::default();
        path.rect(&bar);
        for tick in &found.major {
            let y = bar.y1 - scale.share(tick.value).unwrap_or(0.0) * bar.height();
            path.segment(Point::new(bar.x1 - 2.5, y), Point::new(bar.x1, y));
            let line = TextLine::new(&tick.label, SMALL);
            line.draw(canvas, Point::new(bar.x1 + 2.5, y), Anchor::LEFT_MIDDLE, ink);
        }
        canvas.path(&path, &Paint::line(ink, FRAME));
        if let Some(factor) = found.factor(SMALL) {
            let at = Point::new(bar.x0, bar.y0 - 0.6 * SMALL);
            factor.draw(canvas, at, Anchor::LEFT, ink);
        }
        let label = TextLine::new(&self.label, LABEL).shrunk_to(frame.height());
        let x = bar.x1 + 6.0 + found.widest(SMALL) + label.ascent();
        label.draw_turned(canvas, Point::new(x, bar.centre().y), Anchor::CENTRE, ink, 90.0);
    }

    /// Draws the map over the frame of `plot`.
    pub(crate) fn draw(&self, canvas: &mut Canvas, plot: &Plot) {
        let (width, height) = (count(plot.frame.width()), count(plot.frame.height()));
        let columns = cells(&plot.x, self.x_edges, self.columns, width);
        let mut rows = cells(&plot.y, self.y_edges, self.rows, height);
        rows.reverse();
        let (lo, hi) = self.range();
        let mut pixels = Vec::with_capacity(width * height);
        for row in &rows {
            pixels.extend(columns.iter().map(|column| level(self.strongest(column, row), lo, hi)));
        }
        let map = Raster { width, height, palette: palette(self.colours), pixels };
        canvas.items.push(Item::Image(plot.frame, map));
    }

    /// The largest of all values under a pixel, so that a narrow pulse stays visible.
    fn strongest(&self, columns: &Range<usize>, rows: &Range<usize>) -> f64 {
        let mut best = f64::NAN;
        for row in rows.clone() {
            let start = row.saturating_mul(self.columns);
            let line = start.saturating_add(columns.start)..start.saturating_add(columns.end);
            for value in self.values.get(line).unwrap_or(&[]) {
                if best.is_nan() || value.abs() > best.abs() {
                    best = *value;
                }
            }
        }
        best
    }
}

/// Pixels along a length in points.
fn count(length: f64) -> usize {
    ((length / PIXEL).round() as usize).clamp(1, 20_000)
}

fn level(value: f64, lo: f64, hi: f64) -> u8 {
    let share = (value - lo) / (hi - lo);
    if share.is_nan() { MISSING } else { (share.clamp(0.0, 1.0) * 254.0).round() as u8 }
}

/// 255 colours, so that a diverging map has one in the exact middle, and the missing one.
fn palette(map: ColourMap) -> Vec<Colour> {
    let share = |i: u8| {
        if i == MISSING { f64::NAN } else { f64::from(i) / 254.0 }
    };
    (0..=255).map(|i| map.colour(share(i))).collect()
}

/// For each pixel along an axis the grid cells it covers, at least one if any.
fn cells(scale: &Scale, edges: (f64, f64), count: usize, pixels: usize) -> Vec<Range<usize>> {
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
        if first < last { first..last } else { middle as usize..middle as usize + 1 }
    };
    (0..pixels).map(cells).collect()
}

#[cfg(test)]
#[path = "heat/tests/raster.rs"]
mod tests;

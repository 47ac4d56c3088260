//! Legends.

use super::config::Chart;
use super::markers;
use super::series::{Dash, Kind, Marker};
use super::style::Style;
use crate::draw::{Colour, Paint, Point, Rect, Svg};
use crate::text::{Anchor, TextLine};

/// Length of the sample left of a name, in font sizes.
const SAMPLE: f64 = 2.6;
/// Distance of lines in font sizes.
const LEADING: f64 = 1.4;

/// Distance of columns in font sizes.
const GAP: f64 = 1.2;

/// The names of a chart's series beside samples of their look.
pub(crate) struct LegendBox {
    entries: Vec<(usize, TextLine)>,
    columns: usize,
    font: f64,
}

impl LegendBox {
    /// One name below the other, none wider than `widest`.
    pub(crate) fn stacked(chart: &Chart, style: &Style, widest: f64) -> Self {
        let font = style.small;
        let room = widest - (SAMPLE + 1.2) * font;
        let named = chart.series.iter().enumerate();
        let entries = named
            .filter(|(_, s)| !s.name.is_empty())
            .map(|(i, s)| (i, TextLine::new(&s.name, font).shrunk_to(room)))
            .collect();
        Self {
            entries,
            columns: 1,
            font,
        }
    }

    /// As few rows as `widest` allows, their columns aligned.
    pub(crate) fn flat(chart: &Chart, style: &Style, widest: f64) -> Self {
        let mut legend = Self::stacked(chart, style, widest);
        let pitch = legend.cell() + GAP * legend.font;
        let most = ((widest + GAP * legend.font) / pitch).floor().max(1.0) as usize;
        let rows = legend.entries.len().div_ceil(most).max(1);
        legend.columns = legend.entries.len().div_ceil(rows).max(1);
        legend
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Width of one entry.
    fn cell(&self) -> f64 {
        let widths = self.entries.iter().map(|(_, name)| name.width());
        widths.fold(0.0, f64::max) + (SAMPLE + 1.0) * self.font
    }

    pub(crate) fn width(&self) -> f64 {
        let columns = self.columns as f64;
        columns * self.cell() + (columns - 1.0) * GAP * self.font
    }

    pub(crate) fn height(&self) -> f64 {
        let rows = self.entries.len().div_ceil(self.columns);
        (rows as f64 * LEADING + 0.5) * self.font
    }

    /// Draws at `place`; a veil of paper keeps it legible over data.
    pub(crate) fn draw(
        &self,
        svg: &mut Svg,
        chart: &Chart,
        style: &Style,
        place: &Rect,
        veil: bool,
    ) {
        svg.open_legend(&place.grown(-0.2 * self.font));
        if veil {
            svg.rect(place, &Paint::fill(Colour::WHITE).opacity(0.85));
        }
        let pitch = self.cell() + GAP * self.font;
        for (number, (index, name)) in self.entries.iter().enumerate() {
            let (column, row) = (number % self.columns, number / self.columns);
            let left = place.x0 + 0.2 * self.font + column as f64 * pitch;
            let y = place.y0 + (0.25 + (row as f64 + 0.5) * LEADING) * self.font;
            self.sample(svg, chart, style, *index, Point::new(left, y));
            let at = Point::new(left + (SAMPLE + 0.5) * self.font, y);
            name.draw(svg, at, Anchor::LEFT_MIDDLE, Colour::BLACK);
        }
        svg.close();
    }

    fn sample(&self, svg: &mut Svg, chart: &Chart, style: &Style, index: usize, left: Point) {
        let Some(series) = chart.series.get(index) else {
            return;
        };
        let colour = chart.colour_of(index);
        let right = Point::new(left.x + SAMPLE * self.font, left.y);
        let middle = Point::new(0.5 * (left.x + right.x), left.y);
        if series.is_band() {
            let area = Rect::sized(
                left.x,
                left.y - 0.4 * self.font,
                right.x - left.x,
                0.8 * self.font,
            );
            svg.rect(&area, &band_paint(colour));
        }
        if series.has_line() {
            svg.segment(left, right, &line_paint(chart, style, index));
        }
        if let Some(marker) = marker_of(chart, index) {
            markers::draw(svg, marker, &[middle], style.marker, colour);
        }
    }
}

/// Shading of an area, with an edge for grey print.
pub(crate) fn band_paint(colour: Colour) -> Paint {
    let edge = colour.mixed(Colour::WHITE, 0.25);
    Paint::fill(colour.mixed(Colour::WHITE, 0.72)).outlined(edge, 0.4)
}

/// Stroke of a line series.
pub(crate) fn line_paint(chart: &Chart, style: &Style, index: usize) -> Paint {
    let series = chart.series.get(index);
    let automatic = series.is_none_or(|s| s.colour.is_none());
    let lines_before = chart
        .series
        .iter()
        .take(index)
        .filter(|s| s.has_line())
        .count();
    let fallback = if automatic {
        Dash::of_index(lines_before)
    } else {
        Dash::Solid
    };
    let dash = series.and_then(|s| s.dash).unwrap_or(fallback);
    let width = series.map_or(1.0, |s| s.width) * style.line;
    Paint::dashed(chart.colour_of(index), width, dash.pattern())
}

/// Marker of a series, if it has one.
pub(crate) fn marker_of(chart: &Chart, index: usize) -> Option<Marker> {
    match chart.series.get(index)?.kind {
        Kind::Points(chosen) => Some(chosen.unwrap_or_else(|| Marker::of_index(index))),
        Kind::LinePoints(marker) => Some(marker),
        Kind::Line | Kind::Band(_) => None,
    }
}

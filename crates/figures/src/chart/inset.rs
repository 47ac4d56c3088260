//! A small chart inside a chart.

use super::config::Chart;
use super::occupancy::Occupancy;
use super::prepare::Prepared;
use super::style::Style;
use crate::draw::{Colour, Paint, Rect, Svg};

/// Share of the outer frame that an inset takes, labels included.
const WIDTH: f64 = 0.47;
const HEIGHT: f64 = 0.47;
/// Smallest legible inset, points.
const SMALLEST: (f64, f64) = (62.0, 44.0);

/// Chooses the freest corner and marks it as taken.
pub(crate) fn place(chart: &Chart, frame: &Rect, taken: &mut Occupancy) -> Option<Rect> {
    chart.inset.as_ref()?;
    let inner = frame.grown(-6.0);
    let corners = super::occupancy::places(&inner, WIDTH * frame.width(), HEIGHT * frame.height());
    let (found, _) = taken.freest(corners.get(..4).unwrap_or(&corners))?;
    taken.mark_rect(&found, 9);
    Some(found)
}

/// Draws the inset with all its labels within `area`; too small an area stays empty.
pub(crate) fn draw(svg: &mut Svg, inset: &Chart, area: &Rect) {
    if area.width() < SMALLEST.0 || area.height() < SMALLEST.1 {
        return;
    }
    let prepare = |size: (f64, f64)| Prepared::new(inset, Style::INSET, size, None);
    let mut size = (0.7 * area.width(), 0.7 * area.height());
    let mut margins = prepare(size).margins(inset, size);
    for _ in 0..3 {
        let frame = area.inside(margins);
        size = (frame.width(), frame.height());
        margins = margins.union(prepare(size).margins(inset, size));
    }
    let frame = area.inside(margins);
    svg.rect(area, &Paint::fill(Colour::WHITE));
    prepare((frame.width(), frame.height())).draw(svg, inset, &frame);
}

//! A small chart inside a chart.

use super::config::Chart;
use super::occupancy::Occupancy;
use super::prepare::Prepared;
use super::style::Style;
use crate::draw::{Colour, Paint, Rect, Svg};

/// Share of the outer frame that an inset takes, labels included.
const WIDTH: f64 = 0.47;
const HEIGHT: f64 = 0.47;

/// Chooses the freest corner and marks it as taken.
pub(crate) fn place(chart: &Chart, frame: &Rect, taken: &mut Occupancy) -> Option<Rect> {
    chart.inset.as_ref()?;
    let inner = frame.grown(-6.0);
    let corners = super::occupancy::places(&inner, WIDTH * frame.width(), HEIGHT * frame.height());
    let (found, _) = taken.freest(corners.get(..4).unwrap_or(&corners))?;
    taken.mark_rect(&found, 9);
    Some(found)
}

/// Draws the inset with all its labels within `area`.
pub(crate) fn draw(svg: &mut Svg, inset: &Chart, area: &Rect) {
    let size = (0.7 * area.width(), 0.7 * area.height());
    let guess = Prepared::new(inset, Style::INSET, size.0, size.1);
    let frame = area.inside(guess.margins(inset, size));
    let prepared = Prepared::new(inset, Style::INSET, frame.width(), frame.height());
    let frame = area.inside(prepared.margins(inset, (frame.width(), frame.height())));
    svg.rect(area, &Paint::fill(Colour::WHITE));
    prepared.draw(svg, inset, &frame);
}

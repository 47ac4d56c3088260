//! Horizontal and vertical reference lines with labels that avoid the data.

use super::config::Reference;
use super::occupancy::Occupancy;
use super::plot::Plot;
use super::style::Style;
use crate::draw::{Colour, Paint, Point, Rect, Svg};
use crate::text::{Anchor, TextLine};

const DASH: &[f64] = &[2.2, 1.8];

/// Draws the line itself, below the data.
pub(crate) fn draw_line(svg: &mut Svg, plot: &Plot, reference: &Reference) {
    if let Some((a, b)) = ends(plot, reference) {
        svg.segment(a, b, &Paint::dashed(Colour::GREY, 0.6, DASH));
    }
}

fn ends(plot: &Plot, reference: &Reference) -> Option<(Point, Point)> {
    let frame = plot.frame;
    if reference.vertical {
        let x = plot
            .x_at(reference.value)
            .filter(|_| plot.x.holds(reference.value))?;
        Some((Point::new(x, frame.y0), Point::new(x, frame.y1)))
    } else {
        let y = plot
            .y_at(reference.value)
            .filter(|_| plot.y.holds(reference.value))?;
        Some((Point::new(frame.x0, y), Point::new(frame.x1, y)))
    }
}

/// Draws the label beside its line where it hides least.
pub(crate) fn draw_label(
    svg: &mut Svg,
    plot: &Plot,
    style: &Style,
    reference: &Reference,
    taken: &mut Occupancy,
) {
    let Some((a, b)) = ends(plot, reference).filter(|_| !reference.label.is_empty()) else {
        return;
    };
    let length = if reference.vertical {
        b.y - a.y
    } else {
        b.x - a.x
    };
    let line = TextLine::new(&reference.label, style.small).fitted(0.9 * length);
    let places = places(plot, &line, reference.vertical, a);
    let Some((place, _)) = taken.freest(&places) else {
        return;
    };
    taken.mark_rect(&place, 4);
    let angle = if reference.vertical { 90.0 } else { 0.0 };
    line.draw_turned(svg, place.centre(), Anchor::MIDDLE, Colour::grey(70), angle);
}

/// Both sides of the line, at its ends and along it.
fn places(plot: &Plot, line: &TextLine, vertical: bool, start: Point) -> Vec<Rect> {
    let (frame, gap) = (plot.frame, 6.0);
    let (long, thick) = (line.width(), line.size());
    let along = |share: f64, length: f64| gap + share * (length - long - 2.0 * gap).max(0.0);
    let mut found = Vec::new();
    for share in [1.0, 0.0, 0.5, 0.75, 0.25] {
        for side in [-1.0, 1.0] {
            let offset = side * 0.8 * thick - 0.5 * thick;
            found.push(if vertical {
                let y = frame.y0 + along(1.0 - share, frame.height());
                Rect::sized(start.x + offset, y, thick, long)
            } else {
                let x = frame.x0 + along(share, frame.width());
                Rect::sized(x, start.y + offset, long, thick)
            });
        }
    }
    found.retain(|r| r.y0 >= frame.y0 && r.y1 <= frame.y1 && r.x0 >= frame.x0 && r.x1 <= frame.x1);
    found
}

/// Marks the line as taken, though less so than data.
pub(crate) fn mark(taken: &mut Occupancy, plot: &Plot, reference: &Reference) {
    if let Some((a, b)) = ends(plot, reference) {
        taken.mark_line(&[a, b], 1);
    }
}

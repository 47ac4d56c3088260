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
    let line = TextLine::new(&reference.label, style.small).shrunk_to(0.9 * length);
    let places = places(plot, &line, reference.vertical, a);
    let Some((place, _)) = taken.freest(&places) else {
        return;
    };
    taken.mark_rect(&place, 4);
    let angle = if place.height() > place.width() {
        90.0
    } else {
        0.0
    };
    line.draw_turned(svg, place.centre(), Anchor::MIDDLE, Colour::grey(70), angle);
}

/// Both sides of the line, at its ends and along it; beside a vertical line
/// the text is turned, or level where that is freer.
fn places(plot: &Plot, line: &TextLine, vertical: bool, start: Point) -> Vec<Rect> {
    let (frame, gap) = (plot.frame, 6.0);
    let (long, thick) = (line.width(), line.size());
    let along =
        |share: f64, length: f64, own: f64| gap + share * (length - own - 2.0 * gap).max(0.0);
    let (mut turned, mut level) = (Vec::new(), Vec::new());
    for share in [1.0, 0.0, 0.5, 0.75, 0.25, 0.875, 0.125, 0.625, 0.375] {
        for side in [-1.0, 1.0] {
            let offset = side * 0.8 * thick - 0.5 * thick;
            let x = frame.x0 + along(share, frame.width(), long);
            let y = |own: f64| frame.y0 + along(1.0 - share, frame.height(), own);
            if vertical {
                turned.push(Rect::sized(start.x + offset, y(long), thick, long));
                let left = start.x + if side < 0.0 { -long - 3.0 } else { 3.0 };
                level.push(Rect::sized(left, y(thick), long, thick));
            } else {
                level.push(Rect::sized(x, start.y + offset, long, thick));
            }
        }
    }
    turned.append(&mut level);
    turned.retain(|r| r.y0 >= frame.y0 && r.y1 <= frame.y1 && r.x0 >= frame.x0 && r.x1 <= frame.x1);
    turned
}

/// Marks the line as taken, though less so than data.
pub(crate) fn mark(taken: &mut Occupancy, plot: &Plot, reference: &Reference) {
    if let Some((a, b)) = ends(plot, reference) {
        taken.mark_line(&[a, b], 1);
    }
}

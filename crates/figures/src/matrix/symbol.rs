//! One coloured cell with its symbol, drawn rather than typed so that it does
//! not depend on what a font offers.

use super::Verdict;
use crate::draw::{Colour, Paint, PathData, Point, Rect, Svg};
use crate::text::{Anchor, LEAST_SIZE, TextLine};

/// Fills `cell` and draws the symbol of a verdict in its middle.
pub(super) fn draw_symbol(svg: &mut Svg, verdict: Verdict, cell: &Rect) {
    svg.rect(cell, &Paint::fill(verdict.colour()));
    let (c, r) = (
        cell.centre(),
        0.3 * cell.width().min(cell.height()).min(11.0),
    );
    let at = |dx: f64, dy: f64| Point::new(c.x + dx * r, c.y + dy * r);
    let white = Paint::line(Colour::WHITE, 0.42 * r);
    match verdict {
        Verdict::Holds => {
            let tick = [at(-0.9, 0.05), at(-0.25, 0.75), at(0.95, -0.8)];
            svg.path(PathData::new().polyline(&tick), &white);
        }
        Verdict::Fails => {
            let mut cross = PathData::new();
            cross.segment(at(-0.75, -0.75), at(0.75, 0.75));
            cross.segment(at(-0.75, 0.75), at(0.75, -0.75));
            svg.path(&cross, &white);
        }
        Verdict::InPart => draw_half_circle(svg, c, 0.8 * r),
        Verdict::NotDecidable => {
            let mark = TextLine::bold("?", (2.6 * r).max(LEAST_SIZE));
            mark.draw(svg, c, Anchor::MIDDLE, Colour::grey(90));
        }
    }
}

fn draw_half_circle(svg: &mut Svg, c: Point, r: f64) {
    let ink = Colour::grey(60);
    svg.circle(c, r, &Paint::line(ink, 0.25 * r));
    let mut half = PathData::new();
    half.move_to(Point::new(c.x, c.y + r))
        .arc_to(r, false, true, Point::new(c.x, c.y - r))
        .close();
    svg.path(&half, &Paint::fill(ink));
}

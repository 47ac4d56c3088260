//! Labels with upright leaders that keep clear of each other.

use super::stack::{Stack, stacked};
use super::{FONT, INK, WIDTH};
use crate::draw::{Colour, Paint, PathData, Point, Svg};
use crate::text::{Anchor, TextLine, wrap};

/// Distance of the lines of one label.
const LEADING: f64 = 8.2;
/// From the lower edge of a line's room to its baseline.
const FOOT: f64 = 2.1;
/// Widest line.
const WIDEST: f64 = 122.0;

struct Label {
    anchor: Point,
    lines: Vec<TextLine>,
    colour: Colour,
}

impl Label {
    fn width(&self) -> f64 {
        self.lines.iter().map(TextLine::width).fold(0.0, f64::max)
    }

    fn height(&self) -> f64 {
        LEADING * self.lines.len() as f64
    }
}

/// The labels of a drawing, above and below the row.
#[derive(Default)]
pub(super) struct Labels {
    above: Vec<Label>,
    below: Vec<Label>,
}

impl Labels {
    pub(super) fn above(&mut self, anchor: Point, text: &str) {
        self.above.push(label(anchor, text, Colour::BLACK));
    }

    pub(super) fn below(&mut self, anchor: Point, text: &str) {
        self.coloured(anchor, text, Colour::BLACK);
    }

    pub(super) fn coloured(&mut self, anchor: Point, text: &str, colour: Colour) {
        self.below.push(label(anchor, text, colour));
    }

    /// The labels with their places.
    pub(super) fn arranged(self) -> Arranged {
        Arranged {
            upper: arranged(&self.above),
            lower: arranged(&self.below),
            labels: self,
        }
    }
}

/// Labels with their places.
pub(super) struct Arranged {
    labels: Labels,
    upper: Stack,
    lower: Stack,
}

impl Arranged {
    /// Room that the labels take above and below the row.
    pub(super) fn heights(&self) -> (f64, f64) {
        (self.upper.height, self.lower.height)
    }

    /// Draws the labels beyond the two lines that bound the row.
    pub(super) fn draw(&self, svg: &mut Svg, upper: f64, lower: f64) {
        for (label, place) in self.labels.above.iter().zip(&self.upper.places) {
            let edge = upper - place.offset;
            draw_label(svg, label, place.left, edge - label.height(), edge);
        }
        for (label, place) in self.labels.below.iter().zip(&self.lower.places) {
            let edge = lower + place.offset;
            draw_label(svg, label, place.left, edge, edge);
        }
    }
}

fn arranged(labels: &[Label]) -> Stack {
    let sizes = |label: &Label| (label.anchor.x, label.width(), label.height());
    stacked(&labels.iter().map(sizes).collect::<Vec<_>>(), WIDTH)
}

fn label(anchor: Point, text: &str, colour: Colour) -> Label {
    Label {
        anchor,
        lines: wrap(text, FONT, WIDEST, 3),
        colour,
    }
}

/// A label whose text begins at `left` and `top`, its leader ending at `edge`.
fn draw_label(svg: &mut Svg, label: &Label, left: f64, top: f64, edge: f64) {
    let mut path = PathData::new();
    path.segment(label.anchor, Point::new(label.anchor.x, edge));
    svg.path(&path, &Paint::line(INK, 0.45));
    svg.circle(label.anchor, 0.9, &Paint::fill(INK));
    let width = label.width();
    // Lines stand on the side of the leader.
    let across = ((label.anchor.x - left) / width.max(1.0)).clamp(0.0, 1.0);
    let across = match across {
        share if share < 0.25 => 0.0,
        share if share > 0.75 => 1.0,
        _ => 0.5,
    };
    for (i, line) in label.lines.iter().enumerate() {
        let baseline = top + LEADING * (i + 1) as f64 - FOOT;
        let at = Point::new(left + across * width, baseline);
        line.draw(svg, at, Anchor { across, up: 0.0 }, label.colour);
    }
}

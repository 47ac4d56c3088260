//! Labels with leader lines that keep clear of each other.

use super::{FONT, INK, WIDTH};
use crate::draw::{Colour, Paint, PathData, Point, Svg};
use crate::text::{Anchor, TextLine, wrap};

const LEADING: f64 = 8.4;
const GAP: f64 = 6.0;
const WIDEST: f64 = 74.0;

/// Lowest line of labels above the row; leaders bend here.
const ABOVE: f64 = 34.0;
/// First line of labels below the row.
const BELOW: f64 = 140.0;
/// Leaders below the row run straight down to here.
const ELBOW: f64 = 126.0;

struct Label {
    anchor: Point,
    lines: Vec<TextLine>,
    centre: f64,
}

impl Label {
    fn width(&self) -> f64 {
        self.lines.iter().map(TextLine::width).fold(0.0, f64::max)
    }
}

/// The labels of a drawing, in two rows.
#[derive(Default)]
pub(super) struct Labels {
    above: Vec<Label>,
    below: Vec<Label>,
}

impl Labels {
    pub(super) fn above(&mut self, anchor: Point, text: &str) {
        self.above.push(label(anchor, text));
    }

    pub(super) fn below(&mut self, anchor: Point, text: &str) {
        self.below.push(label(anchor, text));
    }

    pub(super) fn draw(mut self, svg: &mut Svg) {
        arrange(&mut self.above);
        arrange(&mut self.below);
        for label in &self.above {
            let top = ABOVE - LEADING * (label.lines.len() as f64 - 1.0);
            let bend = Point::new(label.centre, ABOVE + 4.0);
            draw_label(svg, label, top, &[bend, label.anchor]);
        }
        for label in &self.below {
            let bend = Point::new(label.centre, BELOW - 7.5);
            let elbow = Point::new(label.anchor.x, ELBOW.max(label.anchor.y));
            draw_label(svg, label, BELOW, &[bend, elbow, label.anchor]);
        }
    }
}

fn label(anchor: Point, text: &str) -> Label {
    Label {
        anchor,
        lines: wrap(text, FONT, WIDEST, 3),
        centre: anchor.x,
    }
}

fn draw_label(svg: &mut Svg, label: &Label, top: f64, leader: &[Point]) {
    let mut path = PathData::new();
    path.polyline(leader);
    svg.path(&path, &Paint::line(INK, 0.45));
    svg.circle(label.anchor, 0.9, &Paint::fill(INK));
    for (i, line) in label.lines.iter().enumerate() {
        let at = Point::new(label.centre, top + LEADING * i as f64);
        line.draw(svg, at, Anchor::CENTRE, Colour::BLACK);
    }
}

/// Moves labels sideways, in the order of what they name, until none overlap.
fn arrange(labels: &mut [Label]) {
    labels.sort_by(|a, b| a.anchor.x.total_cmp(&b.anchor.x));
    let widths: Vec<f64> = labels.iter().map(Label::width).collect();
    let mut centres: Vec<f64> = labels.iter().map(|l| l.anchor.x).collect();
    spread(&mut centres, &widths);
    labels
        .iter_mut()
        .zip(centres)
        .for_each(|(label, x)| label.centre = x);
}

/// Moves texts of the given widths apart, keeping their order, and onto the page.
pub(super) fn spread(centres: &mut [f64], widths: &[f64]) {
    let mut left = 0.0;
    for (centre, width) in centres.iter_mut().zip(widths) {
        *centre = centre.max(left + 0.5 * width);
        left = *centre + 0.5 * width + GAP;
    }
    let mut right = WIDTH;
    for (centre, width) in centres.iter_mut().zip(widths).rev() {
        *centre = centre.min(right - 0.5 * width);
        right = *centre - 0.5 * width - GAP;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crowded_labels_are_spread_without_overlap() {
        let at = |x: f64| label(Point::new(x, 50.0), "steel stop");
        let mut labels = vec![at(490.0), at(480.0), at(485.0), at(10.0)];
        arrange(&mut labels);
        for pair in labels.windows(2) {
            let gap = pair[1].centre - pair[0].centre;
            // Rounding of a sum of a few lengths.
            assert!(gap >= 0.5 * (pair[0].width() + pair[1].width()) + GAP - 1e-9);
        }
        assert!(labels[3].centre + 0.5 * labels[3].width() <= WIDTH);
    }
}

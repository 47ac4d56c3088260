//! Labels above and below a drawing, with upright leaders that keep clear of each other.
//!
//! A label may lie centred on its leader or on either side of it. If its text
//! reaches over another leader, it must lie beyond that leader's label. Of all
//! choices that allow this, the lowest stack is taken.

use crate::draw::{Colour, Paint, Point, Svg};
use crate::rig::{FONT, INK, WIDTH};
use crate::text::{Anchor, TextLine, wrap};

/// Distance of the lines of one label.
const LEADING: f64 = 8.2;
/// From the lower edge of a line's room to its baseline.
const FOOT: f64 = 2.1;
/// Widest line.
const WIDEST: f64 = 122.0;
/// Free paper between texts, across and along.
const GAP: f64 = 5.0;
const AIR: f64 = 1.2;
/// How far a text at the side of its leader reaches back over it.
const BACK: f64 = 1.0;
/// Free paper between a text and another leader.
const CLEAR: f64 = 1.4;
/// More labels than this are not searched but piled up.
const MOST: usize = 8;

struct Label {
    anchor: Point,
    lines: Vec<TextLine>,
    colour: Colour,
}

impl Label {
    fn new(anchor: Point, text: &str, colour: Colour) -> Self {
        let lines = wrap(text, FONT, WIDEST, 3);
        Self { anchor, lines, colour }
    }

    /// x of its leader, width and height of its text.
    fn size(&self) -> Size {
        let width = self.lines.iter().map(TextLine::width).fold(0.0, f64::max);
        (self.anchor.x, width, LEADING * self.lines.len() as f64)
    }

    /// Draws a label whose text begins at `left` and `top`, its leader ending at `edge`.
    fn draw(&self, svg: &mut Svg, left: f64, top: f64, edge: f64) {
        let (x, width, _) = self.size();
        svg.segment(self.anchor, Point::new(x, edge), &Paint::line(INK, 0.45));
        svg.circle(self.anchor, 0.9, &Paint::fill(INK));
        // Lines stand on the side of the leader.
        let across = match (x - left) / width.max(1.0) {
            share if share < 0.25 => 0.0,
            share if share > 0.75 => 1.0,
            _ => 0.5,
        };
        for (i, line) in self.lines.iter().enumerate() {
            let baseline = top + LEADING * (i + 1) as f64 - FOOT;
            let at = Point::new(left + across * width, baseline);
            line.draw(svg, at, Anchor { across, up: 0.0 }, self.colour);
        }
    }
}

/// The labels of a drawing, above and below the row.
#[derive(Default)]
pub(crate) struct Labels {
    above: Vec<Label>,
    below: Vec<Label>,
}

impl Labels {
    pub(crate) fn above(&mut self, anchor: Point, text: &str) {
        self.above.push(Label::new(anchor, text, Colour::BLACK));
    }

    pub(crate) fn below(&mut self, anchor: Point, text: &str) {
        self.coloured(anchor, text, Colour::BLACK);
    }

    pub(crate) fn coloured(&mut self, anchor: Point, text: &str, colour: Colour) {
        self.below.push(Label::new(anchor, text, colour));
    }

    pub(crate) fn stacked(self) -> Stacked {
        let stack = |labels: &[Label]| {
            let sizes: Vec<Size> = labels.iter().map(Label::size).collect();
            stacked(&sizes, WIDTH)
        };
        let (upper, lower) = (stack(&self.above), stack(&self.below));
        Stacked { labels: self, upper, lower }
    }
}

/// Labels with their places.
pub(crate) struct Stacked {
    labels: Labels,
    upper: Stack,
    lower: Stack,
}

impl Stacked {
    /// Room that the labels take above and below the row.
    pub(crate) const fn heights(&self) -> (f64, f64) {
        (self.upper.height, self.lower.height)
    }

    /// Draws the labels beyond the two lines that bound the row.
    pub(crate) fn draw(&self, svg: &mut Svg, upper: f64, lower: f64) {
        for (label, (left, offset)) in self.labels.above.iter().zip(&self.upper.places) {
            let edge = upper - offset;
            label.draw(svg, *left, edge - label.size().2, edge);
        }
        for (label, (left, offset)) in self.labels.below.iter().zip(&self.lower.places) {
            let edge = lower + offset;
            label.draw(svg, *left, edge, edge);
        }
    }
}

/// Places of all labels of one side.
#[derive(Debug, Clone, PartialEq, Default)]
struct Stack {
    /// Left end of each text, and the distance from the row to its near edge.
    places: Vec<(f64, f64)>,
    /// From the row to the far edge of the outermost text.
    height: f64,
}

/// A label: x of its leader, width and height of its text.
type Size = (f64, f64, f64);

/// The lowest stack on a page of the given width.
fn stacked(labels: &[Size], page: f64) -> Stack {
    // Left ends that a label may have: centred, to the right, to the left.
    let options = labels.iter().map(|(x, width, _)| {
        let last = (page - width).max(0.0);
        let sides = [x - BACK, x + BACK - width].into_iter();
        let sides = sides.filter(|left| (0.0..=last).contains(left));
        let centred = (x - 0.5 * width).clamp(0.0, last);
        std::iter::once(centred).chain(sides).collect::<Vec<f64>>()
    });
    // Every way to choose one option each.
    let extended = |before: Vec<Vec<f64>>, own: Vec<f64>| -> Vec<Vec<f64>> {
        let with = |chosen: &Vec<f64>, left: &f64| [&chosen[..], &[*left]].concat();
        before.iter().flat_map(|chosen| own.iter().map(move |left| with(chosen, left))).collect()
    };
    let choices = match labels.len() <= MOST {
        true => options.fold(vec![Vec::new()], extended),
        false => Vec::new(),
    };
    let stacks = choices.iter().filter_map(|lefts| Stack::new(labels, lefts));
    let best = stacks.min_by(|a, b| a.cost(labels).total_cmp(&b.cost(labels)));
    best.unwrap_or_else(|| Stack::pile(labels, page))
}

impl Stack {
    /// The labels at these left ends as near to the row as nothing crosses; `None`
    /// if two of them reach over each other's leaders.
    fn new(labels: &[Size], lefts: &[f64]) -> Option<Self> {
        let span = |i: usize, air: f64| (lefts[i] - air, lefts[i] + labels[i].1 + air);
        let mut offsets: Vec<Option<f64>> = vec![None; labels.len()];
        for _ in labels {
            let free = |i: &usize| {
                let (from, to) = span(*i, CLEAR);
                let under = |j: &usize| j != i && (from..=to).contains(&labels[*j].0);
                let mut under = (0..labels.len()).filter(under);
                offsets[*i].is_none() && under.all(|j| offsets[j].is_some())
            };
            let i = (0..labels.len()).find(free)?;
            let (from, to) = span(i, GAP);
            let meets = |j: &usize| lefts[*j] < to && lefts[*j] + labels[*j].1 > from;
            let ends = (0..labels.len()).filter(meets);
            let ends = ends.filter_map(|j| Some(offsets[j]? + labels[j].2 + AIR));
            offsets[i] = Some(ends.fold(0.0, f64::max));
        }
        Some(Self::of(labels, lefts, offsets.into_iter().flatten()))
    }

    /// One label beyond the other: nothing touches, but leaders may cross texts.
    fn pile(labels: &[Size], page: f64) -> Self {
        let left = |(x, width, _): &Size| (x - 0.5 * width).clamp(0.0, (page - width).max(0.0));
        let lefts: Vec<f64> = labels.iter().map(left).collect();
        let offsets = labels.iter().scan(0.0, |end, (_, _, height)| {
            let offset = *end;
            *end += height + AIR;
            Some(offset)
        });
        Self::of(labels, &lefts, offsets)
    }

    fn of(labels: &[Size], lefts: &[f64], offsets: impl Iterator<Item = f64>) -> Self {
        let places: Vec<(f64, f64)> = lefts.iter().copied().zip(offsets).collect();
        let ends = labels.iter().zip(&places).map(|(label, (_, offset))| offset + label.2);
        Self { height: ends.fold(0.0, f64::max), places }
    }

    /// Low stacks first, then short leaders, then centred texts.
    fn cost(&self, labels: &[Size]) -> f64 {
        let offsets: f64 = self.places.iter().map(|(_, offset)| offset).sum();
        let aside = self.places.iter().zip(labels);
        let aside: f64 =
            aside.map(|((left, _), (x, width, _))| (left + 0.5 * width - x).abs()).sum();
        10.0 * self.height + offsets + 0.05 * aside
    }
}

#[cfg(test)]
#[path = "rig/tests/labels.rs"]
mod tests;

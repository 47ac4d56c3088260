//! Axes: from a data range to positions, ticks and tick labels.

mod label;
mod linear;
mod log;
mod scale;

pub(crate) use scale::{Extent, Scale};

use crate::text::TextLine;

/// A labelled tick.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tick {
    pub(crate) value: f64,
    pub(crate) label: String,
}

/// All ticks of one axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Ticks {
    pub(crate) major: Vec<Tick>,
    pub(crate) minor: Vec<f64>,
    /// Labels are to be multiplied by this power of ten.
    pub(crate) exponent: Option<i32>,
}

impl Ticks {
    /// Those at whole numbers, for an axis that counts.
    pub(crate) fn whole(mut self) -> Self {
        self.minor.clear();
        self.major.retain(|tick| tick.value.fract() == 0.0);
        for tick in &mut self.major {
            tick.label = format!("{}", tick.value);
        }
        self
    }
}

/// The room an axis offers its labels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Room {
    /// Length of the axis, points.
    pub(crate) length: f64,
    /// Font size of the labels, points.
    pub(crate) font: f64,
    /// Labels stand side by side (an x axis) or above each other (a y axis).
    pub(crate) side_by_side: bool,
}

impl Room {
    /// More labels than this crowd an axis even if they fit.
    fn most(&self) -> usize {
        let pitch = if self.side_by_side { 3.6 } else { 2.1 } * self.font;
        ((self.length / pitch) as usize).clamp(2, 8)
    }

    /// Whether no two neighbouring labels touch.
    fn fits(&self, scale: &Scale, ticks: &[Tick]) -> bool {
        let spans: Vec<(f64, f64)> = ticks.iter().filter_map(|t| self.span(scale, t)).collect();
        spans
            .windows(2)
            .all(|w| (w[1].0 - w[0].0).abs() >= 0.5 * (w[0].1 + w[1].1))
    }

    /// Position and needed length of a label along the axis.
    fn span(&self, scale: &Scale, tick: &Tick) -> Option<(f64, f64)> {
        let position = scale.share(tick.value)? * self.length;
        let line = TextLine::new(&tick.label, self.font);
        let size = if self.side_by_side {
            line.width() + 0.8 * self.font
        } else {
            1.5 * self.font
        };
        Some((position, size))
    }
}

/// The richest set of ticks whose labels have room.
pub(crate) fn ticks(scale: &Scale, room: &Room) -> Ticks {
    if scale.log {
        log::ticks(scale, room)
    } else {
        linear::ticks(scale, room)
    }
}

#[cfg(test)]
#[path = "tests/mod.rs"]
mod tests;

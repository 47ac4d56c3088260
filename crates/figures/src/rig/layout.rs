//! Where everything stands along the row.

use super::{FarEnd, RigDrawing, WIDTH};
use crate::text::{LEAST_SIZE, TextLine};

/// Beads are drawn between these diameters, points.
const SMALLEST: f64 = 11.0;
const LARGEST: f64 = 24.0;
/// Width of an elision in bead diameters.
const ELISION: f64 = 1.1;
/// Beads kept at either end, and on either side of the sensor, when others are
/// left out.
const EDGE_BEADS: usize = 2;
const SENSOR_NEIGHBOURS: usize = 1;
/// Fewer beads than this leave room for one at either end.
const ROOMY: usize = 9;

/// Widths of the parts beside the row.
pub(super) const ACTUATOR: f64 = 34.0;
const STRIKER: f64 = 25.0;
const GATE: f64 = 8.0;
const SPRINGS: f64 = 13.0;
const SENSOR: f64 = 3.8;
pub(super) const STOP: f64 = 8.0;
const STRUCTURE: f64 = 17.0;
/// Between structure and bar.
pub(super) const APART: f64 = 5.0;
pub(super) const BAR: f64 = 9.0;

/// Positions along the drawing in points.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layout {
    /// Bead diameter.
    pub(super) diameter: f64,
    /// Left end of everything.
    pub(super) left: f64,
    /// The photogate.
    pub(super) gate: f64,
    /// Left edge of bead 1.
    pub(super) start: f64,
    /// Right edge of the last bead: the far end's contact.
    pub(super) end: f64,
    /// Left face of the stop.
    pub(super) face: f64,
    /// Right face of the structure.
    pub(super) back: f64,
    /// Number and centre of every bead that is drawn.
    pub(super) beads: Vec<(usize, f64)>,
    /// Middle of every place where beads are left out.
    pub(super) elisions: Vec<f64>,
}

impl Layout {
    pub(super) fn new(rig: &RigDrawing) -> Self {
        let (before, behind) = (launcher_width(rig), end_width(rig));
        let room = WIDTH - before - behind;
        let runs = runs(rig, (room / smallest(rig.beads)) as usize);
        let shown: usize = runs.iter().map(|(first, last)| last - first + 1).sum();
        let gaps = runs.len().saturating_sub(1);
        let units = shown as f64 + gaps as f64 * ELISION + half_bead(rig);
        let diameter = (room / units.max(1.0)).min(LARGEST);
        // Short rows stand in the middle.
        let left = 0.5 * (room - diameter * units).max(0.0);
        let start = left + before;
        let gate = start - sum(&[(!rig.springs.is_empty(), SPRINGS), (true, 0.5 * GATE)]);
        let mut layout = Self {
            diameter,
            left,
            gate,
            start,
            end: start,
            face: start,
            back: start,
            beads: Vec::new(),
            elisions: Vec::new(),
        };
        layout.place(&runs);
        layout.face = layout.end + half_bead(rig) * diameter + sensor(rig);
        layout.back = layout.face + support(rig);
        layout
    }

    fn place(&mut self, runs: &[(usize, usize)]) {
        let mut x = self.start;
        for (i, (first, last)) in runs.iter().enumerate() {
            if i > 0 {
                self.elisions.push(x + 0.5 * ELISION * self.diameter);
                x += ELISION * self.diameter;
            }
            for bead in *first..=*last {
                self.beads.push((bead, x + 0.5 * self.diameter));
                x += self.diameter;
            }
        }
        self.end = x;
    }

    pub(super) fn radius(&self) -> f64 {
        0.5 * self.diameter
    }

    /// Height of the lines that group dry and wet contacts.
    pub(super) fn brace(&self) -> f64 {
        self.radius() + 11.0
    }

    /// Upper end of the labels below.
    pub(super) fn floor(&self) -> f64 {
        self.brace() + 5.0
    }

    /// Centre of a bead if it is drawn.
    pub(super) fn bead(&self, number: usize) -> Option<f64> {
        self.beads
            .iter()
            .find(|(n, _)| *n == number)
            .map(|(_, x)| *x)
    }

    /// Place of a contact, or of the elision that hides it.
    pub(super) fn contact(&self, contact: usize) -> f64 {
        let after = self.bead(contact + 1).map(|x| x - self.radius());
        let before = self.bead(contact).map(|x| x + self.radius());
        let hidden = self.beads.iter().rev().find(|(n, _)| *n <= contact);
        let fallback = hidden.map_or(self.start, |(_, x)| x + self.radius() * (1.0 + ELISION));
        before.or(after).unwrap_or(fallback)
    }
}

/// Least diameter at which the longest number is legible inside a bead.
fn smallest(beads: usize) -> f64 {
    let number = TextLine::new(&beads.to_string(), LEAST_SIZE);
    (number.width() / NUMBER).clamp(SMALLEST, LARGEST)
}

/// Widest number in a bead, in diameters.
pub(super) const NUMBER: f64 = 0.86;

/// Width of the half-bead in diameters.
fn half_bead(rig: &RigDrawing) -> f64 {
    if rig.far_end == FarEnd::HalfBead {
        0.5
    } else {
        0.0
    }
}

/// Sum of the widths of what there is.
fn sum(parts: &[(bool, f64)]) -> f64 {
    let there = parts.iter().filter(|(there, _)| *there);
    there.map(|(_, width)| width).sum()
}

/// Room left of bead 1.
fn launcher_width(rig: &RigDrawing) -> f64 {
    let striker = rig.striker_ratio.is_some() || !rig.repositioner.is_empty();
    let parts = [
        (true, 2.0),
        (!rig.actuator.is_empty(), ACTUATOR),
        (striker, STRIKER),
        (!rig.photogate.is_empty(), GATE),
        (!rig.springs.is_empty(), SPRINGS),
    ];
    sum(&parts)
}

fn sensor(rig: &RigDrawing) -> f64 {
    sum(&[(rig.wall_sensor && rig.far_end != FarEnd::Open, SENSOR)])
}

/// Width of stop and structure.
fn support(rig: &RigDrawing) -> f64 {
    let closed = rig.far_end != FarEnd::Open;
    let stop = closed && !rig.stop.is_empty();
    sum(&[(stop, STOP), (closed, STRUCTURE)])
}

/// Room right of the half-bead.
fn end_width(rig: &RigDrawing) -> f64 {
    let open = rig.far_end == FarEnd::Open;
    let bar = (!rig.bar.is_empty(), APART + BAR);
    sensor(rig) + support(rig) + sum(&[bar, (open, 8.0), (true, 1.0)])
}

/// Runs of neighbouring beads to draw if there is room for `capacity` beads.
fn runs(rig: &RigDrawing, capacity: usize) -> Vec<(usize, usize)> {
    let last = rig.beads;
    if last == 0 {
        return Vec::new();
    }
    if last <= capacity {
        return vec![(1, last)];
    }
    let kept = if capacity < ROOMY { 1 } else { EDGE_BEADS };
    let mut runs = vec![(1, kept)];
    if let Some(n) = rig.sensor() {
        runs.push((
            n.saturating_sub(SENSOR_NEIGHBOURS).max(1),
            n.saturating_add(SENSOR_NEIGHBOURS).min(last),
        ));
    }
    runs.push(((last + 1).saturating_sub(kept).max(1), last));
    merged(runs)
}

/// Joins runs that touch, or that hide a single bead between them.
fn merged(runs: Vec<(usize, usize)>) -> Vec<(usize, usize)> {
    let mut out: Vec<(usize, usize)> = Vec::new();
    for (first, last) in runs {
        match out.last_mut() {
            Some(before) if first <= before.1 + 2 => before.1 = before.1.max(last),
            _ => out.push((first, last)),
        }
    }
    out
}

#[cfg(test)]
#[path = "tests/layout.rs"]
mod tests;

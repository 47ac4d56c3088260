//! Where everything stands along the row.

use super::{FarEnd, RigDrawing, WIDTH};

/// Beads are drawn between these diameters, points.
const SMALLEST: f64 = 15.0;
const LARGEST: f64 = 30.0;
/// Width of an elision in bead diameters.
const ELISION: f64 = 1.5;
/// Beads kept at either end and around the sensor when others are left out.
const KEPT: usize = 3;

/// Positions along the drawing in points.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layout {
    /// Bead diameter.
    pub(super) diameter: f64,
    /// Left end of everything.
    pub(super) left: f64,
    /// Left edge of bead 1.
    pub(super) start: f64,
    /// Right edge of the last bead: the far end's contact.
    pub(super) end: f64,
    /// Number and centre of every bead that is drawn.
    pub(super) beads: Vec<(usize, f64)>,
    /// Middle of every place where beads are left out.
    pub(super) elisions: Vec<f64>,
}

impl Layout {
    pub(super) fn new(rig: &RigDrawing) -> Self {
        let (before, after) = (launcher_width(rig), end_width(rig));
        let room = WIDTH - before - after;
        let runs = runs(rig, (room / SMALLEST) as usize);
        let shown: usize = runs.iter().map(|(first, last)| last - first + 1).sum();
        let gaps = runs.len().saturating_sub(1);
        // A half-bead takes half a diameter more.
        let far = if rig.far_end == FarEnd::HalfBead {
            0.5
        } else {
            0.0
        };
        let units = shown as f64 + gaps as f64 * ELISION + far;
        let diameter = (room / units.max(1.0)).min(LARGEST);
        // Short rows stand in the middle.
        let left = 0.5 * (room - diameter * units).max(0.0);
        let start = left + before;
        let mut layout = Self {
            diameter,
            left,
            start,
            end: start,
            beads: Vec::new(),
            elisions: Vec::new(),
        };
        layout.place(&runs);
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

/// Room left of bead 1.
fn launcher_width(rig: &RigDrawing) -> f64 {
    let mut width = 2.0;
    if rig.actuator {
        width += 62.0;
    }
    if rig.striker_radius_m.is_some() {
        width += 62.0;
    }
    if rig.photogate || rig.preload_n.is_some() {
        width += 12.0;
    }
    width
}

/// Room right of the far end.
fn end_width(rig: &RigDrawing) -> f64 {
    let disc = if rig.wall_sensor { 5.0 } else { 0.0 };
    if rig.far_end == FarEnd::Open {
        8.0
    } else {
        disc + 62.0
    }
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
    let mut runs = vec![(1, KEPT)];
    if let Some(n) = rig.sensor() {
        runs.push((n.saturating_sub(2).max(1), (n + 2).min(last)));
    }
    runs.push((last.saturating_sub(KEPT).max(1), last));
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
mod tests {
    use super::*;

    #[test]
    fn beads_never_leave_the_drawing() {
        for beads in [1, 2, 5, 10, 20, 40, 1000, 1_000_000] {
            for sensor_bead in [None, Some(1), Some(7), Some(beads / 2), Some(beads)] {
                let rig = RigDrawing {
                    beads,
                    sensor_bead,
                    actuator: true,
                    striker_radius_m: Some(1.0),
                    ..RigDrawing::default()
                };
                let layout = Layout::new(&rig);
                assert!(layout.end < WIDTH, "{beads} {sensor_bead:?}");
                assert!(layout.beads.windows(2).all(|w| w[1].0 > w[0].0));
            }
        }
    }

    #[test]
    fn long_rows_keep_both_ends_and_the_sensor() {
        let rig = RigDrawing {
            beads: 500,
            sensor_bead: Some(200),
            ..RigDrawing::default()
        };
        let layout = Layout::new(&rig);
        for bead in [1, 199, 200, 201, 500] {
            assert!(layout.bead(bead).is_some(), "{bead}");
        }
        assert_eq!(layout.elisions.len(), 2);
    }
}

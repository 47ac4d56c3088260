//! A shot as a moving picture: one HTML file that needs nothing else.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::draw::ColourMap;
use serde_json::json;

/// Largest number of values stored per quantity; beyond, frames and then beads are left out.
const MOST_VALUES: usize = 1_500_000;
const MOST_FRAMES: usize = 1200;
const FEWEST_FRAMES: usize = 300;

const PAGE: &str = include_str!("page.html");
const SCRIPT: &str = include_str!("player.js");

/// Beads in motion and the force running down their contacts.
///
/// Positions are drawn with displacements multiplied by a stated factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Animation {
    /// Heading of the page; plain text.
    pub title: String,
    /// Ascending times.
    pub times_s: Vec<f64>,
    /// Positions of each bead at these times.
    pub positions_m: Vec<Vec<f64>>,
    /// Forces of each contact at these times.
    pub forces_n: Vec<Vec<f64>>,
    /// Radius of each bead.
    pub radii_m: Vec<f64>,
    /// Names of beads, such as the striker or the sensor bead; plain text.
    pub marks: Vec<(usize, String)>,
    /// First and last contact that is drawn with oil.
    pub wet_contacts: Option<(usize, usize)>,
    /// Shown times in a second and their unit, empty in a dimensionless chain; microseconds by default.
    pub time_unit: (f64, String),
    /// Unit of forces, empty in a dimensionless chain; newtons by default.
    pub force_unit: String,
    /// Number of the contact behind the first bead; 0 by default.
    pub first_contact: usize,
}

impl Animation {
    /// `positions_m[bead][time]` and `forces_n[contact][time]` at ascending
    /// `times_s`; contact c lies between bead c and c + 1. `radii_m` has one
    /// entry per bead. What is missing counts as zero.
    pub fn new(
        times_s: &[f64],
        positions_m: &[Vec<f64>],
        forces_n: &[Vec<f64>],
        radii_m: &[f64],
    ) -> Self {
        Self {
            title: String::from("Beads in motion"),
            times_s: times_s.to_vec(),
            positions_m: positions_m.to_vec(),
            forces_n: forces_n.to_vec(),
            radii_m: radii_m.to_vec(),
            marks: Vec::new(),
            wet_contacts: None,
            time_unit: (1e6, "µs".into()),
            force_unit: "N".into(),
            first_contact: 0,
        }
    }

    /// The page.
    pub fn html(&self) -> String {
        let title = crate::files::escape(&self.title);
        let script = SCRIPT.replace("\"@DATA@\"", &self.data());
        // Parts are not searched again: a title may have any text.
        let (before, after) = PAGE.split_once("@SCRIPT@").unwrap_or((PAGE, ""));
        let [before, after] = [before, after].map(|part| part.replace("@TITLE@", &title));
        before + &script + &after
    }

    fn data(&self) -> String {
        let stride = self.stride();
        let beads: Vec<usize> = (0..self.positions_m.len()).step_by(stride).collect();
        let grid = self.frame_times(beads.len());
        let moved = self.displacements(&beads, &grid);
        let forces = self.sampled_forces(stride, &grid);
        let factor = self.fitting_factor(&moved);
        let radii: Vec<f64> = beads.iter().map(|b| self.radius(*b)).collect();
        let places: Vec<f64> = beads.iter().map(|b| self.start(*b)).collect();
        let (u, u_range) = quantised(&moved);
        let (f, f_range) = quantised(&forces);
        let single = |values: &[f64]| base64(values.iter().map(|v| (*v as f32).to_le_bytes()));
        let [u, f] = [u, f].map(|levels| base64(levels.iter().map(|level| level.to_le_bytes())));
        let data = json!({
            "beads": beads.len(), "stride": stride, "frames": grid.len(),
            "from": grid.first(), "to": grid.last(), "factor": factor,
            "x0": single(&places), "radius": single(&radii),
            "u": u, "uRange": u_range, "f": f, "fRange": f_range,
            "contacts": forces.len(), "wet": self.wet_contacts, "marks": self.marks,
            "timeScale": self.time_unit.0, "timeUnit": self.time_unit.1,
            "forceUnit": self.force_unit, "firstContact": self.first_contact, "colours": colours(),
        });
        // No text ends the script element.
        data.to_string().replace('<', "\\u003c")
    }

    /// Every how many beads one is kept.
    fn stride(&self) -> usize {
        (self.positions_m.len() * FEWEST_FRAMES).div_ceil(MOST_VALUES).max(1)
    }

    fn frame_times(&self, beads: usize) -> Vec<f64> {
        let frames = (MOST_VALUES / beads.max(1)).clamp(FEWEST_FRAMES, MOST_FRAMES);
        let finite = self.times_s.iter().copied().filter(|t| t.is_finite());
        let (from, to) =
            finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), t| (a.min(t), b.max(t)));
        if from >= to {
            return vec![0.0, 0.0];
        }
        let share = |i: usize| i as f64 / (frames - 1) as f64;
        (0..frames).map(|i| from + (to - from) * share(i)).collect()
    }

    fn displacements(&self, beads: &[usize], grid: &[f64]) -> Vec<Vec<f64>> {
        let moved = |bead: &usize| {
            let path = self.positions_m.get(*bead).map_or(&[][..], Vec::as_slice);
            let start = self.start(*bead);
            resampled(&self.times_s, path, grid).iter().map(|x| x - start).collect()
        };
        beads.iter().map(moved).collect()
    }

    /// Of the contacts that a kept bead stands for, the largest force.
    fn sampled_forces(&self, stride: usize, grid: &[f64]) -> Vec<Vec<f64>> {
        let strongest = |group: &[Vec<f64>]| {
            let mut best = vec![0.0_f64; grid.len()];
            for force in group {
                let sampled = resampled(&self.times_s, force, grid);
                best.iter_mut()
                    .zip(sampled)
                    .for_each(|(b, f)| *b = if f.abs() > b.abs() { f } else { *b });
            }
            best
        };
        self.forces_n.chunks(stride).map(strongest).collect()
    }

    /// A factor of 1, 2 or 5 times a power of ten: half of the beads behind the
    /// striker move by no more than one radius. Those thrown off do not count.
    fn fitting_factor(&self, moved: &[Vec<f64>]) -> f64 {
        let largest = |path: &Vec<f64>| path.iter().fold(0.0, |far: f64, u| far.max(u.abs()));
        let mut reach: Vec<f64> = moved.iter().skip(1).map(largest).collect();
        reach.sort_by(f64::total_cmp);
        let wanted = self.radius(1) / reach.get(reach.len() / 2).copied().unwrap_or(0.0);
        if !wanted.is_finite() || wanted <= 1.0 {
            return 1.0;
        }
        let decade = 10f64.powf(wanted.log10().floor());
        let steps = [5.0, 2.0, 1.0];
        steps.iter().map(|s| s * decade).find(|f| *f <= wanted).unwrap_or(1.0)
    }

    fn radius(&self, bead: usize) -> f64 {
        let own = self.radii_m.get(bead).or(self.radii_m.last()).copied();
        own.filter(|r| r.is_finite() && *r > 0.0).unwrap_or(1.0)
    }

    /// First finite position of a bead.
    fn start(&self, bead: usize) -> f64 {
        let path = self.positions_m.get(bead);
        path.and_then(|p| p.iter().copied().find(|x| x.is_finite())).unwrap_or(0.0)
    }
}

/// The sequential map as 256 hexadecimal colours.
fn colours() -> String {
    let hex =
        (0..256).map(|i| ColourMap::Sequential.colour(0.97 - f64::from(i) / 300.0).to_string());
    hex.collect()
}

/// Linear interpolation at ascending times; values that are not finite are passed over.
fn resampled(times: &[f64], values: &[f64], grid: &[f64]) -> Vec<f64> {
    let known: Vec<(f64, f64)> = times
        .iter()
        .copied()
        .zip(values.iter().copied())
        .filter(|(t, v)| t.is_finite() && v.is_finite())
        .collect();
    let at = |t: f64| {
        let next = known.partition_point(|(known_t, _)| *known_t < t);
        match (next.checked_sub(1).and_then(|i| known.get(i)), known.get(next)) {
            (Some((t0, v0)), Some((t1, v1))) if t1 > t0 => v0 + (v1 - v0) * (t - t0) / (t1 - t0),
            (_, Some((_, v))) | (Some((_, v)), None) => *v,
            (None, None) => 0.0,
        }
    };
    grid.iter().map(|t| at(*t)).collect()
}

/// All values as shares of their common range in sixteen bits, and that range.
fn quantised(rows: &[Vec<f64>]) -> (Vec<u16>, (f64, f64)) {
    let all = || rows.iter().flatten().copied();
    let (lo, hi) = all().fold((0.0_f64, 0.0_f64), |(lo, hi), v| (lo.min(v), hi.max(v)));
    let step = (hi - lo) / f64::from(u16::MAX);
    let level = |v: f64| {
        if step > 0.0 { ((v - lo) / step).round() as u16 } else { 0 }
    };
    (all().map(level).collect(), (lo, hi))
}

/// Little-endian numbers in base64.
fn base64<const N: usize>(numbers: impl Iterator<Item = [u8; N]>) -> String {
    STANDARD.encode(numbers.flatten().collect::<Vec<u8>>())
}

#[cfg(test)]
#[path = "tests/mod.rs"]
mod tests;

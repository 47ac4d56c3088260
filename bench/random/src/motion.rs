//! Integration by Gragg's midpoint rule with extrapolation (order up to 18), in double precision.
//!
//! Within a step every contact keeps its mode. A step ends where the first contact must change it:
//! that time is found by repeating the step with other lengths, not by interpolation. So are maxima
//! of signals.

use crate::physics::{Contact, Equations};
use std::cell::Cell;

/// What a contact does; a plastic one also remembers whether it is on its loading curve.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Open,
    Closed,
    /// Touching, with its negative force cut.
    Cut,
}

/// Time and height of a local maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Maximum {
    pub time_s: f64,
    pub height_n: f64,
}

/// Why a reference could not be computed.
#[derive(Debug)]
pub(crate) struct Stuck;

/// Substeps of the columns of the extrapolation.
const SUBSTEPS: [usize; 9] = [2, 4, 6, 8, 10, 12, 14, 16, 18];
/// Shortest step, and most forces of contacts computed, before an integration is given up: the
/// latter after some seconds.
const SHORTEST: f64 = 1e-13;
const MOST_FORCES: u64 = 300_000_000;
/// Overlaps that are none, over a typical one: so that no contact changes its mode back at once.
const TINY: f64 = 1e-14;
/// Rises and dips below this share of the largest value are none.
const SMALL: f64 = 1e-9;
/// Maxima below this share of the largest are not looked for.
const FLOOR: f64 = 1e-6;

/// Scales and accuracy of an integration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scales {
    /// Speed of the striker in m/s.
    pub speed_m_s: f64,
    /// Shortest time in s in which two bodies turn round at that speed.
    pub time_s: f64,
    /// Longest step in s: maxima of the sensors lie further apart.
    pub step_s: f64,
    /// Error of a step over these scales.
    pub tolerance: f64,
}

/// A row in motion, with the maxima of two signals so far: sensor bead and wall.
pub(crate) struct Motion {
    equations: Equations,
    scales: Scales,
    sensor: usize,
    time_s: f64,
    /// Displacements, then velocities.
    y: Vec<f64>,
    mode: Vec<Mode>,
    loading: Vec<bool>,
    /// Approaching, of sharp contacts.
    pressed: Vec<bool>,
    largest: Vec<f64>,
    step_s: f64,
    forces: Cell<u64>,
    before: Option<[[f64; 2]; 2]>,
    maxima: [Vec<Maximum>; 2],
    /// Lowest value between each maximum and the one before it.
    pub dips: [Vec<f64>; 2],
    highest: [f64; 2],
    lowest: [f64; 2],
}

impl Motion {
    /// At the striker's touch.
    pub(crate) fn new(equations: Equations, sensor: usize, scales: Scales) -> Self {
        let bodies = equations.inverse_mass.len();
        let mut y = vec![0.0; 2 * bodies];
        y[bodies] = scales.speed_m_s;
        let rest = |contact: &Contact| contact.rest_m;
        let open = |contact: &Contact| match contact.rest_m < 0.0 {
            true => Mode::Open,
            false => Mode::Closed,
        };
        let contacts = &equations.contacts;
        Self {
            mode: contacts.iter().map(open).collect(),
            loading: vec![true; contacts.len()],
            pressed: vec![true; contacts.len()],
            largest: contacts.iter().map(|contact| rest(contact).max(0.0)).collect(),
            equations,
            scales,
            sensor,
            time_s: 0.0,
            y,
            step_s: 1e-4 * scales.time_s,
            forces: Cell::new(0),
            // Before the touch there is no force.
            before: Some([[0.0; 2]; 2]),
            maxima: [Vec::new(), Vec::new()],
            dips: [Vec::new(), Vec::new()],
            highest: [0.0; 2],
            lowest: [0.0; 2],
        }
    }

    /// Goes on until a time.
    pub(crate) fn run(&mut self, until_s: f64) -> Result<(), Stuck> {
        while self.time_s < until_s {
            if self.forces.get() > MOST_FORCES {
                return Err(Stuck);
            }
            self.advance()?;
        }
        Ok(())
    }

    /// Its scales and accuracy.
    pub(crate) fn scales(&self) -> Scales {
        self.scales
    }

    fn bodies(&self) -> usize {
        self.y.len() / 2
    }

    /// Overlap and rate of a contact.
    #[inline(always)]
    fn gap(&self, y: &[f64], c: usize) -> (f64, f64) {
        let v = &y[self.bodies()..];
        (self.equations.contacts[c].rest_m - (y[c + 1] - y[c]), v[c] - v[c + 1])
    }

    /// Force of a contact in its mode.
    #[inline(always)]
    fn force(&self, y: &[f64], c: usize) -> f64 {
        let (d, r) = self.gap(y, c);
        let contact = &self.equations.contacts[c];
        match self.mode[c] {
            // Ahead of the wave.
            _ if d <= 0.0 && r == 0.0 => 0.0,
            Mode::Closed => contact.closed(d, r, self.memory(c, d)),
            Mode::Cut => 0.0,
            // A clipped force never pulls, across a gap neither.
            Mode::Open if self.equations.clipped => contact.open(r).max(0.0),
            Mode::Open => contact.open(r),
        }
    }

    /// Largest overlap so far as the law sees it.
    #[inline(always)]
    fn memory(&self, c: usize, d: f64) -> f64 {
        match self.loading[c] {
            true => d,
            false => self.largest[c].max(d * (1.0 + 1e-15)),
        }
    }

    /// dy/dt.
    fn derivative(&self, y: &[f64], out: &mut [f64]) {
        let bodies = self.bodies();
        let (x_out, v_out) = out.split_at_mut(bodies);
        x_out.copy_from_slice(&y[bodies..]);
        v_out.copy_from_slice(&self.equations.force_n);
        if let Some((force_n, stiffness)) = self.equations.spring {
            v_out[1] += (force_n - stiffness * y[1]).max(0.0);
        }
        self.forces.set(self.forces.get() + bodies as u64);
        for c in 0..bodies - 1 {
            let force = self.force(y, c);
            v_out[c] -= force;
            v_out[c + 1] += force;
        }
        for (a, inverse) in v_out.iter_mut().zip(&self.equations.inverse_mass) {
            *a *= inverse;
        }
        if self.equations.inverse_mass[bodies - 1] == 0.0 {
            v_out[bodies - 1] = 0.0;
        }
    }

    /// The state a time later; how many columns it took, `None` where they do not converge.
    fn stepped(&self, h: f64, slope: &[f64]) -> (Vec<f64>, Option<usize>) {
        // Increments, which round less than states.
        let mut table: Vec<Vec<f64>> = Vec::with_capacity(SUBSTEPS.len());
        let (mut last_error, mut columns) = (f64::INFINITY, None);
        for (k, &n) in SUBSTEPS.iter().enumerate() {
            let mut row = self.midpoint(h, n, slope);
            for j in 0..k {
                let factor = 1.0 / ((n as f64 / SUBSTEPS[k - 1 - j] as f64).powi(2) - 1.0);
                let old = &mut table[j];
                for (old, new) in old.iter_mut().zip(&mut row) {
                    (*old, *new) = (*new, *new + (*new - *old) * factor);
                }
            }
            let error = table.last().map_or(f64::INFINITY, |last| self.distance(&row, last));
            table.push(row);
            if error <= self.scales.tolerance {
                columns = Some(k);
                break;
            }
            if k >= 4 && (error.is_nan() || error > 0.3 * last_error) {
                break;
            }
            last_error = error;
        }
        let increment = table.pop().unwrap_or_default();
        let end = self.y.iter().zip(increment).map(|(y, increment)| y + increment);
        (end.collect(), columns)
    }

    /// Increment by Gragg's smoothed midpoint rule with n substeps.
    fn midpoint(&self, h: f64, n: usize, slope: &[f64]) -> Vec<f64> {
        let part = h / n as f64;
        let mut old = vec![0.0; self.y.len()];
        let mut now: Vec<f64> = slope.iter().map(|f| part * f).collect();
        let (mut f, mut there) = (old.clone(), old.clone());
        let mut derivative = |now: &[f64], f: &mut [f64]| {
            for ((there, y), now) in there.iter_mut().zip(&self.y).zip(now) {
                *there = y + now;
            }
            self.derivative(&there, f);
        };
        for _ in 1..n {
            derivative(&now, &mut f);
            for ((old, now), f) in old.iter_mut().zip(&mut now).zip(&f) {
                (*old, *now) = (*now, *old + 2.0 * part * f);
            }
        }
        derivative(&now, &mut f);
        let smooth = old.iter().zip(&now).zip(&f);
        smooth.map(|((old, now), f)| 0.5 * (old + now + part * f)).collect()
    }

    /// Largest difference of two increments in units of the motion.
    fn distance(&self, one: &[f64], two: &[f64]) -> f64 {
        let bodies = self.bodies();
        let Scales { speed_m_s, time_s, .. } = self.scales;
        (0..bodies).fold(0.0_f64, |worst, i| {
            let speed = self.y[bodies + i].abs() + 1e-3 * speed_m_s;
            let v = (one[bodies + i] - two[bodies + i]).abs() / speed;
            let x = (one[i] - two[i]).abs() / (speed * time_s);
            let worse = v.max(x);
            if worse > worst || worse.is_nan() { worse } else { worst }
        })
    }

    /// A number that is positive where a contact must change what it does.
    fn switch(&self, y: &[f64], c: usize) -> f64 {
        let (d, r) = self.gap(y, c);
        let size = self.scales.speed_m_s * self.scales.time_s;
        let contact = &self.equations.contacts[c];
        let leaves = -d / size - TINY;
        let force = || contact.closed(d, r, self.memory(c, d));
        let unit = || contact.closed(size, 0.0, 0.0);
        match self.mode[c] {
            Mode::Open => d / size - TINY,
            Mode::Cut => leaves.max(force() / unit() - TINY),
            Mode::Closed => {
                let cut = match self.equations.clipped {
                    true => -force() / unit() - TINY,
                    false => leaves,
                };
                let turn = match (contact.is_plastic, self.loading[c]) {
                    (false, _) => leaves,
                    (true, true) => -r / self.scales.speed_m_s - TINY,
                    (true, false) => (d - self.largest[c]) / size - TINY,
                };
                let rate = if self.pressed[c] { -r } else { r } / self.scales.speed_m_s;
                let sharp = if contact.is_sharp { rate - TINY } else { leaves };
                leaves.max(cut).max(turn).max(sharp)
            }
        }
    }

    fn most_switch(&self, y: &[f64]) -> f64 {
        let values = (0..self.mode.len()).map(|c| self.switch(y, c));
        values.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Where in a step a contact touches, or lets go, that is back at its end.
    fn hidden(&self, h: f64, end: &[f64], slopes: [&[f64]; 2]) -> Option<f64> {
        let bodies = self.bodies();
        let tiny = 10.0 * TINY * self.scales.speed_m_s * self.scales.time_s;
        (0..self.mode.len()).find_map(|c| {
            let sign = if self.mode[c] == Mode::Open { 1.0 } else { -1.0 };
            let ((d0, r0), (d1, r1)) = (self.gap(&self.y, c), self.gap(end, c));
            if sign * r0 <= 0.0 || sign * r1 >= 0.0 {
                return None;
            }
            let [a0, a1] = slopes.map(|f| f[bodies + c] - f[bodies + c + 1]);
            let between = |s: f64| quintic([d0, r0 * h, a0 * h * h], [d1, r1 * h, a1 * h * h], s);
            let places = (1..8).map(|i| 0.125 * f64::from(i));
            places.filter(|s| sign * between(*s) > tiny).reduce(f64::min)
        })
    }

    /// One step, to its end or to the first change of a contact.
    fn advance(&mut self) -> Result<(), Stuck> {
        let (mut slope, mut slope_after) = (vec![0.0; self.y.len()], vec![0.0; self.y.len()]);
        self.derivative(&self.y, &mut slope);
        let mut h = self.step_s.min(self.scales.step_s);
        loop {
            if h < SHORTEST * self.scales.time_s {
                return Err(Stuck);
            }
            let (end, columns) = self.stepped(h, &slope);
            let Some(columns) = columns else {
                h *= 0.3;
                self.step_s = h;
                continue;
            };
            self.derivative(&end, &mut slope_after);
            if let Some(part) = self.hidden(h, &end, [&slope, &slope_after]) {
                h *= part;
                continue;
            }
            let changes = self.most_switch(&end) > 0.0;
            let (h, end) = match changes {
                true => self.first_change(h, end, &slope),
                false => (h, end),
            };
            self.look(h, &end, &slope);
            self.time_s += h;
            self.y = end;
            self.remember();
            match changes {
                true => self.change(),
                false => self.lengthen(h, columns),
            }
            return Ok(());
        }
    }

    fn lengthen(&mut self, h: f64, columns: usize) {
        let factor = [4.0, 4.0, 4.0, 3.0, 2.0, 1.4, 1.0, 0.8, 0.6][columns];
        self.step_s = h * factor;
    }

    /// The step after which the first contact must change, by false position (Illinois).
    fn first_change(&self, h: f64, end: Vec<f64>, slope: &[f64]) -> (f64, Vec<f64>) {
        let (mut low, mut high) = (0.0, h);
        let (mut f_low, mut f_high) =
            (self.most_switch(&self.y).min(-TINY), self.most_switch(&end));
        let mut best = end;
        while f_high > TINY && high - low > 1e-15 * h {
            let guess = (low * f_high - high * f_low) / (f_high - f_low);
            let middle = match guess > low && guess < high {
                true => guess,
                false => 0.5 * (low + high),
            };
            if middle <= low || middle >= high {
                break;
            }
            let (there, _) = self.stepped(middle, slope);
            let value = self.most_switch(&there);
            if value > 0.0 {
                (high, f_high, best) = (middle, value, there);
                f_low *= 0.5;
            } else {
                (low, f_low) = (middle, value.min(-1e-3 * TINY));
                f_high *= 0.5;
                f_high = f_high.max(2.0 * TINY);
            }
        }
        (high, best)
    }

    fn remember(&mut self) {
        for c in 0..self.mode.len() {
            if self.loading[c] {
                self.largest[c] = self.largest[c].max(self.gap(&self.y, c).0);
            }
        }
    }

    /// Gives every contact that must change its new mode.
    fn change(&mut self) {
        let must: Vec<usize> =
            (0..self.mode.len()).filter(|&c| self.switch(&self.y, c) > 0.0).collect();
        for c in must {
            let (d, r) = self.gap(&self.y, c);
            let size = self.scales.speed_m_s * self.scales.time_s;
            let leaves = d / size <= -TINY;
            let plastic = self.equations.contacts[c].is_plastic;
            let turns = match self.loading[c] {
                true => r < 0.0,
                false => d >= self.largest[c],
            };
            let turned = self.equations.contacts[c].is_sharp && (r > 0.0) != self.pressed[c];
            self.pressed[c] = r > 0.0;
            match self.mode[c] {
                Mode::Closed if turned && !leaves && !(plastic && turns) => self.step_s *= 0.01,
                Mode::Open => {
                    self.mode[c] = Mode::Closed;
                    self.loading[c] = self.largest[c] <= 0.0;
                    self.step_s *= 0.01;
                }
                _ if leaves => self.mode[c] = Mode::Open,
                Mode::Closed if plastic && turns => self.loading[c] = !self.loading[c],
                Mode::Closed => self.mode[c] = Mode::Cut,
                Mode::Cut => self.mode[c] = Mode::Closed,
            }
        }
    }

    /// Value and slope of the sensor bead's signal and of the wall's.
    fn signals(&self, y: &[f64]) -> [[f64; 2]; 2] {
        let mut f = vec![0.0; y.len()];
        self.derivative(y, &mut f);
        let of = |c: usize| {
            let ((d, rate), bodies) = (self.gap(y, c), self.bodies());
            let contact = &self.equations.contacts[c];
            let [by_overlap, by_rate] = match self.mode[c] {
                Mode::Cut => [0.0; 2],
                Mode::Open if self.equations.clipped && rate < 0.0 => [0.0; 2],
                mode => contact.slopes(mode == Mode::Open, d, rate, self.memory(c, d)),
            };
            let change = f[bodies + c] - f[bodies + c + 1];
            let slope = product(by_overlap, rate) + product(by_rate, change);
            [self.force(y, c) - contact.load_n, slope]
        };
        let (left, right) = (of(self.sensor - 1), of(self.sensor));
        let wall = of(self.mode.len() - 1);
        [std::array::from_fn(|i| 0.5 * (left[i] + right[i])), wall]
    }

    /// Adds the maxima of a step and those at its start.
    fn look(&mut self, h: f64, end: &[f64], slope: &[f64]) {
        let (starts, ends) = (self.signals(&self.y), self.signals(end));
        let before = self.before.replace(ends);
        for at in 0..2 {
            let [value, rises] = starts[at];
            self.lowest[at] = self.lowest[at].min(value);
            if let Some(before) = before {
                let [old, rose] = before[at];
                let small = SMALL * self.highest[at];
                let (up, down) = (value > old + small, value < old - small);
                if (up || rose > 0.0) && (down || rises <= 0.0) {
                    self.keep(at, 0.0, old.max(value));
                }
            }
            if rises > 0.0
                && ends[at][1] <= 0.0
                && value.max(ends[at][0]) > FLOOR * self.highest[at]
            {
                let (within_s, height_n) =
                    self.highest_within(at, h, [starts[at], ends[at]], slope);
                self.keep(at, within_s, height_n);
            }
            self.highest[at] = self.highest[at].max(value).max(ends[at][0]);
            self.lowest[at] = self.lowest[at].min(ends[at][0]);
        }
    }

    fn keep(&mut self, at: usize, within_s: f64, height_n: f64) {
        if height_n <= FLOOR * self.highest[at] || height_n <= 0.0 {
            return;
        }
        let maximum = Maximum { time_s: self.time_s + within_s, height_n };
        let (dip, small) = (self.lowest[at], SMALL * self.highest[at]);
        match self.maxima[at].last_mut() {
            Some(last) if dip.min(height_n) >= last.height_n - small => {
                if height_n > last.height_n {
                    (*last, self.lowest[at]) = (maximum, height_n);
                }
            }
            _ => {
                self.maxima[at].push(maximum);
                self.dips[at].push(dip);
                self.lowest[at] = height_n;
            }
        }
    }

    /// The maxima of the sensor bead or of the wall from which the signal has fallen.
    pub(crate) fn maxima(&self, at: usize) -> &[Maximum] {
        let rises_on = |last: &Maximum| self.lowest[at] >= last.height_n - SMALL * self.highest[at];
        let all = &self.maxima[at];
        &all[..all.len() - usize::from(all.last().is_some_and(rises_on))]
    }

    /// Where a signal that rises at the start of a step and falls at its end is highest.
    fn highest_within(
        &self,
        at: usize,
        h: f64,
        [start, end]: [[f64; 2]; 2],
        slope: &[f64],
    ) -> (f64, f64) {
        let (mut low, mut high, mut f_low, mut f_high) = (0.0, h, start[1], end[1]);
        let mut best = (h, end[0]);
        for _ in 0..60 {
            if high - low <= 1e-11 * h {
                break;
            }
            let guess = (low * f_high - high * f_low) / (f_high - f_low);
            let inside = guess > low && guess < high;
            let middle = if inside { guess } else { 0.5 * (low + high) };
            let [value, slope] = self.signals(&self.stepped(middle, slope).0)[at];
            best = (middle, value);
            if slope > 0.0 {
                (low, f_low) = (middle, slope);
                f_high *= 0.5;
            } else {
                (high, f_high) = (middle, slope);
                f_low *= 0.5;
            }
        }
        best
    }
}

/// A product of which an infinite factor is harmless where the other one is 0.
fn product(one: f64, other: f64) -> f64 {
    match other == 0.0 || one == 0.0 {
        true => 0.0,
        false => (one * other).clamp(-1e300, 1e300),
    }
}

/// The polynomial of degree five through values, slopes and curvatures at 0 and 1.
fn quintic([p, v, a]: [f64; 3], [q, w, b]: [f64; 3], s: f64) -> f64 {
    let (s2, s3) = (s * s, s * s * s);
    let (s4, s5) = (s3 * s, s3 * s2);
    let rise = 10.0 * s3 - 15.0 * s4 + 6.0 * s5;
    p * (1.0 - rise)
        + v * (s - 6.0 * s3 + 8.0 * s4 - 3.0 * s5)
        + 0.5 * a * (s2 - 3.0 * s3 + 3.0 * s4 - s5)
        + q * rise
        + w * (-4.0 * s3 + 7.0 * s4 - 3.0 * s5)
        + 0.5 * b * (s3 - 2.0 * s4 + s5)
}

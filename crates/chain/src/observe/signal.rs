//! One sensor's signal as polynomials, with its maxima as roots of its rate.

use crate::sensor::Sensor;
use crate::system::System;
use crate::wave::{Flow, Observer, Piece, bracketed_root};

/// A local maximum of a signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Maximum {
    /// When, in s.
    pub time_s: f64,
    /// How much, in the signal's unit.
    pub value: f64,
}

/// How well a maximum between equal steps is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// −F̈/F: an error of the slope moves a flat maximum further.
    pub sharpness_per_s2: f64,
    /// How far interpolation through fewer samples moves it, in s.
    pub interpolation_s: f64,
}

impl Shape {
    /// Of a maximum of which nothing is known.
    pub(crate) const UNKNOWN: Self = Self { sharpness_per_s2: 0.0, interpolation_s: f64::INFINITY };
}

/// A signal over one step: its values at five equidistant times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Start in s.
    pub start_s: f64,
    /// Length in s.
    pub length_s: f64,
    /// Values at θ = 0, 1/4, 1/2, 3/4, 1.
    pub values: [f64; 5],
}

impl Stretch {
    /// The quartic through the five values.
    pub(crate) fn at(&self, time_s: f64) -> f64 {
        let s = 4.0 * (time_s - self.start_s) / self.length_s;
        let [f0, f1, f2, f3, f4] = self.values;
        // Newton's forward differences.
        let (d1, d2) = (f1 - f0, f2 - 2.0 * f1 + f0);
        let (d3, d4) = (f3 - 3.0 * f2 + 3.0 * f1 - f0, f4 - 4.0 * f3 + 6.0 * f2 - 4.0 * f1 + f0);
        let (s1, s2, s3) = (s - 1.0, (s - 2.0) / 3.0, (s - 3.0) / 4.0);
        f0 + s * (d1 + 0.5 * s1 * (d2 + s2 * (d3 + s3 * d4)))
    }

    /// This and the next stretch as one, if they are as long and it differs from no value of
    /// either by more than `most`.
    fn joined(&self, next: &Self, most: f64) -> Option<Self> {
        let ([a0, a1, a2, a3, a4], [b0, b1, b2, b3, b4]) = (self.values, next.values);
        let as_long = (self.length_s - next.length_s).abs() <= 1e-6 * self.length_s;
        let apart_s = next.start_s - self.end_s();
        let one = Self {
            start_s: self.start_s,
            length_s: next.end_s() - self.start_s,
            values: [a0, a2, 0.5 * (a4 + b0), b2, b4],
        };
        let quarter_s = 0.25 * self.length_s;
        let between = [(1.0, a1), (3.0, a3), (5.0, b1), (7.0, b3)];
        let same = between.iter().all(|(quarters, value)| {
            let differs = one.at(self.start_s + quarters * quarter_s) - value;
            differs.abs() <= most
        });
        let adjoins = as_long && apart_s.abs() <= 1e-6 * self.length_s && (a4 - b0).abs() <= most;
        (adjoins && same).then_some(one)
    }

    /// End in s.
    pub fn end_s(&self) -> f64 {
        self.start_s + self.length_s
    }

    /// Slopes at the two ends from one-sided five-point formulas, and how far each
    /// may be off: what the slope changes over the next quarter of the step, and, where
    /// no polynomial follows the signal, what a formula of one point less gives.
    fn end_slopes(&self) -> [(f64, f64); 2] {
        let [f0, f1, f2, f3, f4] = self.values;
        let start = -25.0 * f0 + 48.0 * f1 - 36.0 * f2 + 16.0 * f3 - 3.0 * f4;
        let end = 25.0 * f4 - 48.0 * f3 + 36.0 * f2 - 16.0 * f1 + 3.0 * f0;
        let rough = 3.0 * (f0 - 4.0 * f1 + 6.0 * f2 - 4.0 * f3 + f4).abs();
        let rough = if rough > ROUGH * f0.abs().max(f4.abs()) { rough } else { 0.0 };
        [
            (start, 12.0 * (f0 - 2.0 * f1 + f2).abs() + rough),
            (end, 12.0 * (f2 - 2.0 * f3 + f4).abs() + rough),
        ]
    }
}

/// Fourth difference of a step's values, over the values, from which on a quartic does
/// not follow the signal: an infinite slope at touch leaves 1.
const ROUGH: f64 = 0.01;

/// Follows one sensor through a shot.
#[derive(Clone, Debug)]
pub struct Signal {
    sensor: Sensor,
    stretches: Vec<Stretch>,
    maxima: Vec<Maximum>,
    /// Shape of each maximum, where it is known.
    shapes: Vec<Shape>,
    largest: f64,
    /// Least height times time of a pulse, in N s.
    least_n_s: f64,
    lowest: f64,
    /// The signal has not yet fallen below its last maximum by more than rounding.
    rises_on: bool,
    /// End of the previous step: time, value, slope.
    before: Option<(f64, f64, f64)>,
}

/// Steps at whose ends the signal is below this fraction of its largest value
/// so far are not kept: they lie below anything that is picked.
pub(crate) const LEAST_SHARE: f64 = 1e-4;

/// Height times time of a pulse's peak is at least this share of the momentum of the
/// lightest body at the shot's speed; below are rounding and the forerunners of the
/// wave in a loaded chain. Losses keep momentum, so they leave a pulse far above.
const FAINTEST: f64 = 1e-3;

/// Least height times time of a pulse of a chain, in N s.
pub(crate) fn least_n_s(system: &System) -> f64 {
    FAINTEST * system.scales().momentum_n_s
}

/// A force jump, or a dip, smaller than this fraction of the largest value is rounding.
const JUMP: f64 = 1e-9;

/// What a step of a given length interpolates differs from what its rates say by less than this fraction,
/// but across a jump.
const ACROSS: f64 = 0.01;

/// Where a force is cut it jumps by less than this many tolerances of a step, because a
/// step ends near the cut and not at it.
const OF_CUT: f64 = 0.03;

/// Most stretches of a signal: 59 MB.
const MOST_STRETCHES: usize = 1 << 20;

/// Most maxima of a signal: 34 MB.
const MOST_MAXIMA: usize = 1 << 21;

/// Stretches are joined where that changes no value by more than this fraction of the largest:
/// what a flank or a width is then wrong by is far below their accuracy.
const MERGED: f64 = 1e-8;

impl Signal {
    /// Of a sensor.
    pub fn new(sensor: Sensor) -> Self {
        Self {
            sensor,
            stretches: Vec::new(),
            maxima: Vec::new(),
            shapes: Vec::new(),
            largest: 0.0,
            least_n_s: 0.0,
            lowest: f64::INFINITY,
            rises_on: false,
            before: None,
        }
    }

    /// From parts that were found otherwise; a pulse has at least this height times
    /// time in N s.
    pub(crate) fn assembled(
        sensor: Sensor,
        (stretches, maxima): (Vec<Stretch>, Vec<(Maximum, Shape)>),
        least_n_s: f64,
    ) -> Self {
        let (maxima, shapes) = maxima.into_iter().unzip();
        Self { stretches, maxima, shapes, least_n_s, ..Self::new(sensor) }
    }

    /// Least height of a pulse's peak at a time in s.
    pub fn least_height(&self, time_s: f64) -> f64 {
        self.least_n_s / time_s
    }

    /// Whether a maximum is large enough for a pulse's peak.
    pub(super) fn is_pulse(&self, peak: &Maximum) -> bool {
        peak.value * peak.time_s >= self.least_n_s
    }

    /// The sensor.
    pub fn sensor(&self) -> Sensor {
        self.sensor
    }

    /// All local maxima so far, in order of time; of forces, those above
    /// 1e-4 of the largest value seen until then.
    pub fn maxima(&self) -> &[Maximum] {
        &self.maxima[..self.maxima.len() - usize::from(self.rises_on)]
    }

    /// The shape of a maximum; unknown of a signal that was followed step by step, or of what is
    /// no maximum of it.
    pub fn shape(&self, of: &Maximum) -> Shape {
        let at = self.maxima.iter().position(|maximum| maximum == of);
        let shape = at.and_then(|at| self.shapes.get(at));
        shape.copied().unwrap_or(Shape::UNKNOWN)
    }

    /// The signal so far; absent where it is 0.
    pub fn stretches(&self) -> &[Stretch] {
        &self.stretches
    }

    /// The signal at a time, 0 where nothing was kept.
    pub fn at(&self, time_s: f64) -> f64 {
        let after = self.stretches.partition_point(|stretch| stretch.start_s <= time_s);
        match after.checked_sub(1).map(|i| self.stretches[i]) {
            Some(stretch) if time_s <= stretch.end_s() => stretch.at(time_s),
            _ => 0.0,
        }
    }

    /// Whether the signal takes all the memory that it may: steps that follow are not kept.
    pub(crate) fn is_full(&self) -> bool {
        self.stretches.len() >= MOST_STRETCHES || self.maxima.len() >= MOST_MAXIMA
    }

    /// Joins neighbouring stretches where one quartic says the same: steps much shorter than a
    /// pulse, of which there may be a billion, are kept as densely as the pulse needs.
    fn merge(&mut self) {
        let (floor, mut kept) = (MERGED * self.largest, 0);
        let mut at = 0;
        while let Some(&first) = self.stretches.get(at) {
            let joined = (self.stretches.get(at + 1)).and_then(|next| first.joined(next, floor));
            at += 1 + usize::from(joined.is_some());
            self.stretches[kept] = joined.unwrap_or(first);
            kept += 1;
        }
        self.stretches.truncate(kept);
    }

    /// A slope right in sign: near a maximum, where a contact touches or parts, and where a step of a
    /// given length runs across a jump, the samples alone may not be.
    fn slope(&self, piece: &Piece<'_>, theta: f64, (slope, off): (f64, f64)) -> f64 {
        let near = slope.abs() < off || piece.is_near_touch(self.sensor, theta);
        match near || piece.has_given_length() {
            true => piece.signal_rate(self.sensor, theta),
            false => slope,
        }
    }

    /// Keeps a maximum, unless it is rounding on a signal that rests; of two without a
    /// dip between them, which the steps found twice, the higher, if that is the later.
    fn keep(&mut self, maximum: Maximum) {
        let force = !matches!(self.sensor, Sensor::Position(_) | Sensor::Velocity(_));
        if force && maximum.value <= LEAST_SHARE * self.largest {
            return;
        }
        let lowest = std::mem::replace(&mut self.lowest, f64::INFINITY);
        let floor = JUMP * self.largest;
        match self.maxima.last_mut() {
            // A falling signal may hardly rise to another maximum, which is one.
            Some(last) if lowest.min(maximum.value) >= last.value - floor => {
                if maximum.value > last.value {
                    *last = maximum;
                }
            }
            _ => self.maxima.push(maximum),
        }
    }

    /// Keeps maxima of one step, and its lowest sample or minimum since the last of them.
    fn keep_inside(&mut self, stretch: &Stretch, maxima: Vec<Maximum>, minima: &[Maximum]) {
        let quarter_s = 0.25 * stretch.length_s;
        let sample = |(i, value)| (stretch.start_s + f64::from(i) * quarter_s, value);
        let lowest = |from_s: f64, until_s: f64| {
            let samples = (0..).zip(stretch.values).map(sample);
            let low = samples.chain(minima.iter().map(|it| (it.time_s, it.value)));
            let within = low.filter(|(time_s, _)| (from_s..until_s).contains(time_s));
            within.fold(f64::INFINITY, |lowest, (_, value)| lowest.min(value))
        };
        let mut from_s = f64::NEG_INFINITY;
        for maximum in maxima {
            self.lowest = self.lowest.min(lowest(from_s, maximum.time_s));
            from_s = maximum.time_s;
            self.keep(maximum);
        }
        self.lowest = self.lowest.min(lowest(from_s, f64::INFINITY));
    }

    /// The signal falls to 0: a rise until then ends in a maximum.
    fn fall_silent(&mut self) {
        if let Some((time_s, value, slope)) = self.before.take()
            && slope > 0.0
        {
            self.keep(Maximum { time_s, value });
        }
        self.lowest = self.lowest.min(0.0);
        self.rises_on = false;
    }

    /// The slopes at a step's start and end, and its first value; where the signal begins with an
    /// infinite slope, after what it changes by at first if that is above a floor.
    fn end_slopes(
        &self,
        piece: &Piece<'_>,
        stretch: &Stretch,
        sharp_start: bool,
        floor: f64,
    ) -> (f64, [f64; 2]) {
        let slopes = stretch.end_slopes();
        let [mut start_slope, mut end_slope] = [(0.0, slopes[0]), (1.0, slopes[1])]
            .map(|(theta, slope)| self.slope(piece, theta, slope));
        let mut first_value = stretch.values[0];
        if sharp_start && let Some(change) = first_change(piece, self.sensor, floor) {
            (start_slope, first_value) = (change, first_value + change);
        }
        if end_slope <= 0.0 && piece.parts_at_end(self.sensor) {
            end_slope = last_rise(piece, self.sensor, floor).unwrap_or(end_slope);
        }
        (first_value, [start_slope, end_slope])
    }

    /// Adds the maxima of one step, and the one between it and the last.
    fn look_for_maxima(&mut self, piece: &Piece<'_>, stretch: &Stretch) {
        let [start, .., end] = stretch.values;
        let floor = JUMP.max(OF_CUT * piece.cut_tolerance()) * self.largest;
        let reversals = piece.reversals(self.sensor);
        let sharp_rises = piece.sharp_rises(self.sensor, reversals);
        let sharp_start = sharp_rises.contains(&Some(0.0));
        let (first_value, [start_slope, end_slope]) =
            self.end_slopes(piece, stretch, sharp_start, floor);
        // Before a signal is first seen, and after silence, it was 0.
        let (time_s, value, slope) = self.before.unwrap_or((stretch.start_s, 0.0, 0.0));
        let rises = slope > 0.0 || start > value + floor;
        let falls = start_slope <= 0.0 || start < value - floor;
        if rises && falls {
            self.keep(Maximum { time_s, value: value.max(start) });
        }
        // A fall behind a jump may end before the first sample.
        self.lowest = self.lowest.min(first_value);
        let mut inside = interior_maxima(piece, self.sensor, [start_slope, end_slope], stretch);
        for from in sharp_rises.into_iter().flatten().filter(|_| end_slope <= 0.0) {
            let start_s = piece.time_s(from);
            if inside.iter().all(|maximum| maximum.time_s <= start_s)
                && let Some((dip, maximum)) = sharp_maximum(piece, self.sensor, (from, 1.0), floor)
            {
                self.lowest = self.lowest.min(dip);
                inside.push(maximum);
            }
        }
        if inside.is_empty()
            && end_slope > 0.0
            && let Some((maximum, dip)) = (sharp_rises.into_iter().flatten())
                .find_map(|from| maximum_before_dip(piece, self.sensor, from, floor))
        {
            self.keep(maximum);
            self.lowest = self.lowest.min(dip);
        }
        // Where a contact begins to be released some laws' forces fall with an infinite slope in rate.
        for (at, _) in reversals.into_iter().flatten().filter(|(_, released)| *released) {
            if let Some((dip, maximum)) = sharp_maximum(piece, self.sensor, (at, 0.0), floor)
                && !inside.iter().any(|other| {
                    other.time_s <= piece.time_s(at) && other.value >= maximum.value - floor
                })
            {
                self.keep(maximum);
                self.lowest = self.lowest.min(dip);
            }
        }
        let minima = add_at_reversals(piece, self.sensor, reversals, &mut inside);
        self.keep_inside(stretch, inside, &minima);
        self.before = Some((stretch.end_s(), end, end_slope));
        let dip = JUMP * self.largest;
        self.rises_on = self.maxima.last().is_some_and(|last| self.lowest >= last.value - dip);
    }
}

impl Observer for Signal {
    fn step(&mut self, piece: &Piece<'_>) -> Flow {
        self.least_n_s = least_n_s(piece.system());
        if !piece.sees(self.sensor) {
            self.fall_silent();
            return Flow::Continue;
        }
        if self.stretches.len() >= MOST_STRETCHES {
            self.merge();
        }
        if self.is_full() {
            return Flow::Finished;
        }
        let values = std::array::from_fn(|i| piece.signal(self.sensor, 0.25 * i as f64));
        let stretch = Stretch { start_s: piece.start_s(), length_s: piece.step_s(), values };
        let size = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        if size <= LEAST_SHARE * self.largest || size <= piece.system().silence(self.sensor) {
            self.fall_silent();
            return Flow::Continue;
        }
        self.largest = self.largest.max(size);
        self.look_for_maxima(piece, &stretch);
        self.stretches.push(stretch);
        Flow::Continue
    }
}

/// Maxima inside one step: where the rate changes sign from + to −, found
/// between the sampled values and refined on the equations of motion.
fn interior_maxima(
    piece: &Piece<'_>,
    sensor: Sensor,
    [start_slope, end_slope]: [f64; 2],
    stretch: &Stretch,
) -> Vec<Maximum> {
    let values = stretch.values;
    let slope = |i: usize| match i {
        0 => start_slope,
        4 => end_slope,
        // Central five- and three-point slopes need only be right in sign.
        2 => values[0] - 8.0 * values[1] + 8.0 * values[3] - values[4],
        _ => values[i + 1] - values[i - 1],
    };
    let mut found = Vec::new();
    let mut last = 0;
    for i in 1..5 {
        if slope(last) > 0.0 && slope(i) <= 0.0 {
            let (low, high) = (0.25 * last as f64, 0.25 * i as f64);
            found.extend(refined(piece, sensor, (low, high)));
        }
        last = i;
    }
    if piece.has_given_length() {
        add_jumps(piece, sensor, [start_slope, end_slope], values, &mut found);
    }
    found
}

/// Adds maxima at jumps within a step of a given length, at which rates do not change sign: beside
/// samples that are higher than both their neighbours.
fn add_jumps(
    piece: &Piece<'_>,
    sensor: Sensor,
    [start_slope, end_slope]: [f64; 2],
    values: [f64; 5],
    maxima: &mut Vec<Maximum>,
) {
    let floor = JUMP * values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    for (i, value) in values.into_iter().enumerate() {
        let rises = if i == 0 { start_slope > 0.0 } else { value > values[i - 1] + floor };
        let falls = if i == 4 { end_slope <= 0.0 } else { value > values[i + 1] + floor };
        let [low, at, high] = [i.max(1) - 1, i, i.min(3) + 1].map(|sample| 0.25 * sample as f64);
        let between = piece.time_s(low)..=piece.time_s(high);
        if rises && falls && !maxima.iter().any(|it| between.contains(&it.time_s)) {
            let [left, right] = [low, high].map(|end| highest_towards(piece, sensor, at, end));
            maxima.push(if right.value > left.value { right } else { left });
        }
    }
    maxima.sort_by(|one, two| one.time_s.total_cmp(&two.time_s));
}

/// The highest value from a sample on, where values rise towards a jump.
fn highest_towards(piece: &Piece<'_>, sensor: Sensor, from: f64, mut end: f64) -> Maximum {
    let (mut theta, mut value) = (from, piece.signal(sensor, from));
    for _ in 0..40 {
        let middle = 0.5 * (theta + end);
        match piece.signal(sensor, middle) {
            higher if higher >= value => (theta, value) = (middle, higher),
            _ => end = middle,
        }
    }
    Maximum { time_s: piece.time_s(theta), value }
}

/// The maximum in a bracket. Slopes of samples may be wrong near the ends of the
/// bracket, so it is widened where the true rate disagrees; where the signal still
/// rises at its end, as behind an infinite slope that no polynomial follows, there is none.
fn refined(piece: &Piece<'_>, sensor: Sensor, (low, high): (f64, f64)) -> Option<Maximum> {
    let falling = |theta: f64| -piece.signal_rate(sensor, theta);
    let low = if falling(low) < 0.0 { low } else { (low - 0.25).max(0.0) };
    let high = if falling(high) >= 0.0 { high } else { (high + 0.25).min(1.0) };
    let theta = bracketed_root(falling, low, high, 1e-12);
    let maximum = Maximum { time_s: piece.time_s(theta), value: piece.signal(sensor, theta) };
    // Fixed steps run across jumps, where values decide, not rates.
    let above = |theta: f64| maximum.value > piece.signal(sensor, theta);
    let ends = [low, high].map(|theta| piece.signal(sensor, theta));
    let jumps = ends.iter().any(|end| maximum.value < end - ACROSS * end.abs());
    let falls = falling(high) >= 0.0 && !(piece.has_given_length() && jumps);
    (falls || (above(low) && above(high))).then_some(maximum)
}

/// Adds maxima near reversals of contacts' rates that lie between samples, and gives the minima there:
/// a force like a power of the rate between 1 and 2 has an infinite curvature at a reversal.
fn add_at_reversals(
    piece: &Piece<'_>,
    sensor: Sensor,
    reversals: [Option<(f64, bool)>; 3],
    maxima: &mut Vec<Maximum>,
) -> Vec<Maximum> {
    let mut minima = Vec::new();
    for (at, released) in reversals.into_iter().flatten() {
        let (more, less) = extrema_around(piece, sensor, at, if released { 1.0 } else { -1.0 });
        for one in more {
            let same = |it: &Maximum| (it.time_s - one.time_s).abs() <= 1e-9 * piece.step_s();
            if !maxima.iter().any(same) {
                maxima.push(one);
            }
        }
        minima.extend(less);
    }
    maxima.sort_by(|one, two| one.time_s.total_cmp(&two.time_s));
    minima
}

/// Maxima and minima between two samples around a reversal at which the signal's rate has the sign
/// given, if it has the other one on either side.
fn extrema_around(
    piece: &Piece<'_>,
    sensor: Sensor,
    at: f64,
    sign: f64,
) -> (Vec<Maximum>, Vec<Maximum>) {
    let rate = |theta: f64| piece.signal_rate(sensor, theta);
    let (mut maxima, mut minima) = (Vec::new(), Vec::new());
    let here = sign * rate(at);
    if here <= 0.0 || !here.is_finite() {
        return (maxima, minima);
    }
    let before = (0.25 * (4.0 * at).floor()).min(0.75);
    let ends = [before, before + 0.25];
    let nearest = |end: f64| {
        let theta = |halvings: i32| at + (end - at) * 0.5_f64.powi(halvings);
        (0..SHARPEST).rev().map(theta).find(|theta| sign * rate(*theta) < 0.0)
    };
    let near = ends.map(nearest);
    if near == [None; 2] {
        return (maxima, minima);
    }
    let nodes = [Some(ends[0]), near[0], Some(at), near[1], Some(ends[1])];
    let nodes: Vec<f64> = nodes.into_iter().flatten().collect();
    for pair in nodes.windows(2) {
        let rises = [rate(pair[0]) > 0.0, rate(pair[1]) > 0.0];
        if rises[0] == rises[1] {
            continue;
        }
        let falling = |theta: f64| if rises[0] { -rate(theta) } else { rate(theta) };
        let theta = bracketed_root(falling, pair[0], pair[1], 1e-12);
        let one = Maximum { time_s: piece.time_s(theta), value: piece.signal(sensor, theta) };
        if rises[0] { maxima.push(one) } else { minima.push(one) }
    }
    (maxima, minima)
}

/// By how much a signal first differs from its value at the start of a step, if by more than a floor.
fn first_change(piece: &Piece<'_>, sensor: Sensor, floor: f64) -> Option<f64> {
    let start = piece.signal(sensor, 0.0);
    let change = |halvings: i32| piece.signal(sensor, 0.5_f64.powi(halvings)) - start;
    (0..SHARPEST).rev().map(change).find(|change| change.abs() > floor)
}

/// By how much a signal that falls rises again at the end of a step, if by more than a floor.
fn last_rise(piece: &Piece<'_>, sensor: Sensor, floor: f64) -> Option<f64> {
    let end = piece.signal(sensor, 1.0);
    let rise = |halvings: i32| end - piece.signal(sensor, 1.0 - 0.5_f64.powi(halvings));
    let rises: Vec<f64> = (0..SHARPEST).map(rise).collect();
    let dip = rises.windows(2).find(|pair| pair[1] > pair[0].max(floor));
    dip.map(|pair| pair[1])
}

/// Halvings of a step in which a maximum behind an infinite slope is looked for.
const SHARPEST: i32 = 40;

/// The value at which a signal begins to rise, or falls until, with infinite slope, and the maximum
/// between there and an end of the step, if that is higher by a floor: it may be narrower than any
/// difference quotient.
fn sharp_maximum(
    piece: &Piece<'_>,
    sensor: Sensor,
    (from, end): (f64, f64),
    floor: f64,
) -> Option<(f64, Maximum)> {
    let at = |halvings: i32| from + (end - from) * 0.5_f64.powi(halvings);
    let values = (0..SHARPEST).map(|halvings| (piece.signal(sensor, at(halvings)), halvings));
    let (most, highest) = values.max_by(|one, two| one.0.total_cmp(&two.0))?;
    let dip = piece.signal(sensor, from);
    let (near, far) = (at(highest + 1), at(highest - 1));
    let is_one = highest > 0 && most > dip + floor;
    is_one.then(|| (dip, highest_between(piece, sensor, near.min(far), near.max(far))))
}

/// The maximum behind an infinite slope from which a signal falls by more than a floor before it rises
/// until the end of the step, and the least value that is seen behind it.
fn maximum_before_dip(
    piece: &Piece<'_>,
    sensor: Sensor,
    from: f64,
    floor: f64,
) -> Option<(Maximum, f64)> {
    let at = |halvings: usize| from + (1.0 - from) * 0.5_f64.powi(halvings as i32);
    let value = |halvings: usize| piece.signal(sensor, at(halvings));
    let values: Vec<f64> = (0..SHARPEST as usize).map(value).collect();
    let falls = (1..values.len() - 1).rev().find(|&i| values[i] > values[i - 1] + floor)?;
    let highest = (falls..values.len() - 1).find(|&i| values[i] >= values[i + 1])?;
    let dip = values[..highest].iter().copied().fold(f64::INFINITY, f64::min);
    let maximum = highest_between(piece, sensor, at(highest + 1), at(highest - 1));
    (maximum.value > piece.signal(sensor, from) + floor).then_some((maximum, dip))
}

/// A maximum by golden section: the rate of a narrow one is not known.
fn highest_between(piece: &Piece<'_>, sensor: Sensor, mut low: f64, mut high: f64) -> Maximum {
    let value = |theta: f64| piece.signal(sensor, theta);
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..30 {
        let (left, right) = (high - share * (high - low), low + share * (high - low));
        match value(left) > value(right) {
            true => high = right,
            false => low = left,
        }
    }
    let theta = 0.5 * (low + high);
    Maximum { time_s: piece.time_s(theta), value: value(theta) }
}

#[cfg(test)]
#[path = "tests/signal.rs"]
mod tests;

//! Sines under a shot, harmonics of the mains or a supply's ripple, as the record before it shows them.

use crate::signal::drift::time_error;
use crate::signal::linear::LinearSolution;
use crate::signal::statistics::{mean, median};
use std::f64::consts::{LN_2, PI};

/// Longest stretch before a shot to which sines are fitted, and means of samples in it, in s.
const LONGEST_S: f64 = 60e-3;
const MEAN_S: f64 = 20e-6;
/// Means in the shortest stretch.
const FEWEST: usize = 200;
const HIGHEST_HZ: f64 = 5e3;
const MOST: usize = 12;
/// Power of a sine over that of white noise at one frequency: by chance in 1 of 10,000 shots.
const SIGNIFICANT: f64 = 15.0;
/// Frequencies looked at, in cycles of half a stretch; those of two sines differ by at least so many.
const APART: f64 = 0.125;
const CLOSEST: f64 = 0.35;
/// Fewest cycles of half a stretch: what is slower is a slow baseline.
const SLOWEST: f64 = 0.5;
/// Share of the first pulse's height below which sines move no maximum.
const LEAST: f64 = 1e-4;
const ROUNDS: usize = 6;
/// A cubic beside the sines, and three numbers a sine.
const SLOW: usize = 4;
const UNKNOWNS: usize = SLOW + 3 * MOST;

type Unknowns = [f64; UNKNOWNS];

/// Sines fitted before a shot.
pub(super) struct Tones {
    fit: ToneFit,
    /// Middle of the stretch and half its length, in samples, and how much means weaken each sine.
    centre: f64,
    half: f64,
    gains: Vec<f64>,
}

impl Tones {
    /// The significant sines in the samples before a pulse, if any is at least the [`LEAST`] share of
    /// its height; multiples of the mains' frequency, if it is known and they leave less by fewer numbers.
    pub(super) fn new(
        before: &[f64],
        height: f64,
        interval_s: f64,
        mains_hz: Option<f64>,
    ) -> Option<Self> {
        let length = ((MEAN_S / interval_s).round() as usize).max(1);
        let count = before.len().min((LONGEST_S / interval_s) as usize) / length;
        let lead = &before[before.len() - count * length..];
        if count < FEWEST {
            return None;
        }
        let means: Vec<f64> = lead.chunks_exact(length).map(mean).collect();
        let half = 0.5 * (count * length) as f64;
        let most_hz = HIGHEST_HZ.min(0.25 / (length as f64 * interval_s));
        let cycles = |hz: f64| hz * half * interval_s;
        let free = ToneFit::new(&means, cycles(most_hz), None);
        let held = mains_hz.and_then(|hz| ToneFit::new(&means, cycles(most_hz), Some(cycles(hz))));
        let either = free.into_iter().chain(held);
        let fit = either.min_by(|a, b| a.criterion.total_cmp(&b.criterion))?;
        let gain = |tone: &Tone| {
            let angle = PI * tone.cycles / half;
            (length as f64 * angle).sin() / (length as f64 * angle.sin())
        };
        let gains = fit.tones.iter().map(gain).collect();
        let subtracted = fit.tones.iter().filter(|tone| tone.cycles >= SLOWEST);
        let largest = subtracted.map(|tone| tone.cosine.hypot(tone.sine)).fold(0.0, f64::max);
        let centre = before.len() as f64 - half - 0.5;
        (largest > LEAST * height).then_some(Self { fit, centre, half, gains })
    }

    /// A record less the sines.
    pub(super) fn subtracted(&self, samples: &[f64]) -> Vec<f64> {
        let value = |at: usize| {
            let u = (at as f64 - self.centre) / self.half;
            let tones = self.fit.tones.iter().zip(&self.gains);
            tones
                .filter(|(tone, _)| tone.cycles >= SLOWEST)
                .map(|(tone, gain)| tone.at(u)[0] / gain)
                .sum::<f64>()
        };
        samples.iter().enumerate().map(|(at, sample)| sample - value(at)).collect()
    }

    /// Standard error in samples of a maximum of this height and width, as the slope of the sines
    /// beneath it is open.
    pub(super) fn time_error(&self, at: f64, height: f64, width: f64) -> f64 {
        time_error(self.fit.slope_error((at - self.centre) / self.half) / self.half, height, width)
    }

    /// Standard error of a height there, as the sines beneath it are open.
    pub(super) fn height_error(&self, at: f64) -> f64 {
        self.fit.value_error((at - self.centre) / self.half)
    }
}

/// A sine over u from −1 to 1: cycles of a length of 1, and its parts.
#[derive(Clone, Copy)]
struct Tone {
    cycles: f64,
    cosine: f64,
    sine: f64,
}

impl Tone {
    /// Its value, and the derivative of that by its angle.
    fn at(&self, u: f64) -> [f64; 2] {
        let (sin, cos) = (2.0 * PI * self.cycles * u).sin_cos();
        [self.cosine * cos + self.sine * sin, self.sine * cos - self.cosine * sin]
    }
}

/// Sines and a cubic fitted to means. A sine that is too slow, and is held, is only fitted: it is left to
/// the slow baseline.
struct ToneFit {
    tones: Vec<Tone>,
    solution: LinearSolution<UNKNOWNS>,
    noise: f64,
    /// Schwarz's, which weighs squares against parameters.
    criterion: f64,
}

impl ToneFit {
    /// The strongest sines, one after the other, of at most so many cycles of half the stretch; held at
    /// multiples of a frequency, if one is given. `None` if there is none, if one is too slow and free, or
    /// if more is left than noise: what is no sum of sines, such as a step, takes many.
    fn new(means: &[f64], most_cycles: f64, held: Option<f64>) -> Option<Self> {
        // What a cubic leaves of a slow sine is spread over all the others.
        let slow = held.filter(|cycles| *cycles < SLOWEST);
        let tone = |cycles: f64| Tone { cycles, cosine: 0.0, sine: 0.0 };
        let mut tones: Vec<Tone> = slow.into_iter().map(tone).collect();
        let (mut found, mut left) = (None, less_sines(means, &mut tones)?);
        let step = held.unwrap_or(APART);
        while let Some(cycles) = peak(&left, most_cycles, step) {
            tones.push(tone(cycles));
            let apart = |a: &Tone, b: &Tone| (a.cycles - b.cycles).abs() >= CLOSEST;
            let (solution, residuals) =
                refined(means, &mut tones, held.is_some()).filter(|_| {
                    let mut pairs = tones.iter().enumerate();
                    held.is_some() || pairs.all(|(i, a)| tones[..i].iter().all(|b| apart(a, b)))
                })?;
            (found, left) = (Some(solution), residuals);
            if tones.len() == MOST && peak(&left, most_cycles, step).is_some() {
                return None;
            }
        }
        let count = means.len() as f64;
        let numbers = (SLOW + numbers_each(held.is_some()) * tones.len()) as f64;
        let squares = left.iter().map(|off| off * off).sum::<f64>();
        let is_slow = held.is_none() && tones.iter().any(|tone| tone.cycles < SLOWEST);
        Some(Self {
            tones,
            solution: found.filter(|_| !is_slow)?,
            noise: (squares / (count - numbers)).sqrt(),
            criterion: count * squares.max(f64::MIN_POSITIVE).ln() + numbers * count.ln(),
        })
    }

    /// Standard error of the sum of all sines at u.
    fn value_error(&self, u: f64) -> f64 {
        let (mut row, count) = (row(&self.tones, u), self.tones.len());
        // The cubic, and what is too slow, is left to the slow baseline.
        row[..SLOW].fill(0.0);
        for (i, _) in self.tones.iter().enumerate().filter(|(_, tone)| tone.cycles < SLOWEST) {
            row[SLOW + 2 * i..][..2].fill(0.0);
            row[SLOW + 2 * count + i] = 0.0;
        }
        self.noise * self.solution.variance(&row).sqrt()
    }

    /// Standard error of the slope of all sines at u.
    fn slope_error(&self, u: f64) -> f64 {
        let (mut row, count) = ([0.0; UNKNOWNS], self.tones.len());
        for (i, tone) in self.tones.iter().enumerate().filter(|(_, tone)| tone.cycles >= SLOWEST) {
            let turn = 2.0 * PI * tone.cycles;
            let (sin, cos) = (turn * u).sin_cos();
            let [value, rate] = tone.at(u);
            row[SLOW + 2 * i] = -turn * sin;
            row[SLOW + 2 * i + 1] = turn * cos;
            row[SLOW + 2 * count + i] = 2.0 * PI * (rate - u * turn * value);
        }
        self.noise * self.solution.variance(&row).sqrt()
    }
}

fn place(i: usize, count: usize) -> f64 {
    (2 * i + 1) as f64 / count as f64 - 1.0
}

/// A cubic's and the sines' parts at u, then what their cycles change.
fn row(tones: &[Tone], u: f64) -> Unknowns {
    let mut row = [0.0; UNKNOWNS];
    row[..SLOW].copy_from_slice(&[1.0, u, u * u, u * u * u]);
    for (i, tone) in tones.iter().enumerate() {
        let (sin, cos) = (2.0 * PI * tone.cycles * u).sin_cos();
        (row[SLOW + 2 * i], row[SLOW + 2 * i + 1]) = (cos, sin);
        row[SLOW + 2 * tones.len() + i] = 2.0 * PI * u * tone.at(u)[1];
    }
    row
}

fn solved(values: &[f64], tones: &[Tone], size: usize) -> Option<LinearSolution<UNKNOWNS>> {
    let rows = values.iter().enumerate();
    let equations = rows.map(|(i, value)| (row(tones, place(i, values.len())), *value));
    LinearSolution::of(size, equations)
}

/// Fits the cubic and the sines' parts at their cycles; returns what is left of the means.
fn less_sines(means: &[f64], tones: &mut [Tone]) -> Option<Vec<f64>> {
    let size = SLOW + 2 * tones.len();
    let fit = solved(means, tones, size)?;
    for (tone, parts) in tones.iter_mut().zip(fit.values[SLOW..size].chunks_exact(2)) {
        (tone.cosine, tone.sine) = (parts[0], parts[1]);
    }
    let model = |i: usize| fit.value(&row(tones, place(i, means.len())));
    Some(means.iter().enumerate().map(|(i, mean)| mean - model(i)).collect())
}

/// Both parts of a sine, and its cycles if they are free.
fn numbers_each(held: bool) -> usize {
    if held { 2 } else { 3 }
}

/// The same with the cycles by Gauss and Newton's steps unless they are held, and the solution of the last
/// of them.
fn refined(
    means: &[f64],
    tones: &mut [Tone],
    held: bool,
) -> Option<(LinearSolution<UNKNOWNS>, Vec<f64>)> {
    let (size, first) = (SLOW + numbers_each(held) * tones.len(), SLOW + 2 * tones.len());
    for _ in 0..if held { 0 } else { ROUNDS } {
        let left = less_sines(means, tones)?;
        let steps = solved(&left, tones, size)?.values;
        for (tone, step) in tones.iter_mut().zip(&steps[first..size]) {
            tone.cycles += step.clamp(-2.0 * APART, 2.0 * APART);
        }
    }
    let left = less_sines(means, tones)?;
    Some((solved(&left, tones, size)?, left))
}

/// Cycles of half a stretch of the most powerful sine at multiples of a step, if it is significant.
fn peak(left: &[f64], most_cycles: f64, step: f64) -> Option<f64> {
    let power = |cycles: f64| {
        let (mut sums, mut angle) = ([0.0; 2], [1.0, 0.0]);
        let (sin, cos) = (4.0 * PI * cycles / left.len() as f64).sin_cos();
        for off in left {
            sums = [sums[0] + off * angle[0], sums[1] + off * angle[1]];
            angle = [angle[0] * cos - angle[1] * sin, angle[0] * sin + angle[1] * cos];
        }
        sums[0] * sums[0] + sums[1] * sums[1]
    };
    let count = (most_cycles / step) as usize;
    let powers: Vec<f64> = (1..=count).map(|i| power(i as f64 * step)).collect();
    let white = median(&powers)? / LN_2;
    let (at, most) = powers.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    (*most > SIGNIFICANT * white && *most > 0.0).then(|| (at + 1) as f64 * step)
}

//! Axes: from a data range to positions, ticks and tick labels.

use crate::text::TextLine;

/// The finite values seen along one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extent {
    lo: f64,
    hi: f64,
    log: bool,
}

/// Values beyond are treated as out of any picture; differences stay finite.
const LARGEST: f64 = 1e300;
/// Values below are zero: they have no power of ten that is itself a number.
const SMALLEST: f64 = 1e-290;

impl Extent {
    pub(crate) fn new(log: bool) -> Self {
        Self { lo: f64::INFINITY, hi: f64::NEG_INFINITY, log }
    }

    /// Takes in a value unless the axis cannot show it.
    fn add(&mut self, value: f64) {
        let value = if value.abs() < SMALLEST { 0.0 } else { value };
        let shown = value.is_finite() && value.abs() <= LARGEST && (!self.log || value >= SMALLEST);
        if shown {
            self.lo = self.lo.min(value);
            self.hi = self.hi.max(value);
        }
    }

    pub(crate) fn extend(&mut self, values: impl IntoIterator<Item = f64>) {
        values.into_iter().for_each(|value| self.add(value));
    }

    /// The lowest and highest value, if any.
    pub(crate) fn ends(&self) -> Option<(f64, f64)> {
        (self.lo <= self.hi).then_some((self.lo, self.hi))
    }

    /// A scale that holds all values with `pad` of the length free at both ends.
    pub(crate) fn scale(self, pad: f64) -> Scale {
        let Self { lo, hi, log } = self;
        if lo > hi {
            let (lo, hi) = if log { (0.1, 10.0) } else { (0.0, 1.0) };
            return Scale { lo, hi, log };
        }
        if log { padded_log(lo, hi, pad) } else { padded_linear(lo, hi, pad) }
    }
}

fn padded_linear(lo: f64, hi: f64, pad: f64) -> Scale {
    let magnitude = lo.abs().max(hi.abs());
    let span = hi - lo;
    // Spans below the resolution of a label are noise around a constant.
    let (lo, hi) = if magnitude == 0.0 {
        (-1.0, 1.0)
    } else if span <= 1e-8 * magnitude {
        (lo - 0.05 * magnitude, hi + 0.05 * magnitude)
    } else {
        (lo - pad * span, hi + pad * span)
    };
    Scale { lo, hi, log: false }
}

fn padded_log(lo: f64, hi: f64, pad: f64) -> Scale {
    let span = hi.ln() - lo.ln();
    let ratio = if span < 1e-6 { 1.1 } else { (pad * span).exp() };
    Scale { lo: (lo / ratio).max(0.1 * SMALLEST), hi: (hi * ratio).min(10.0 * LARGEST), log: true }
}

/// A linear or logarithmic map of `[lo, hi]` to the unit interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    pub(crate) lo: f64,
    pub(crate) hi: f64,
    pub(crate) log: bool,
}

impl Scale {
    /// A scale with the limits asked for, if they make one.
    pub(crate) fn fixed(lo: f64, hi: f64, log: bool) -> Option<Self> {
        let finite = lo.is_finite() && hi.is_finite() && lo.abs().max(hi.abs()) <= LARGEST;
        let wide_enough = (hi - lo).abs() > SMALLEST + 1e-8 * lo.abs().max(hi.abs());
        let sound = finite && wide_enough && (!log || lo.min(hi) >= SMALLEST);
        sound.then_some(Self { lo: lo.min(hi), hi: lo.max(hi), log })
    }

    /// Position of a value, 0 at `lo` and 1 at `hi`; nothing if it has none.
    pub(crate) fn share(&self, value: f64) -> Option<f64> {
        if !value.is_finite() || (self.log && value <= 0.0) {
            return None;
        }
        let share = if self.log {
            (value.ln() - self.lo.ln()) / (self.hi.ln() - self.lo.ln())
        } else {
            (value - self.lo) / (self.hi - self.lo)
        };
        // Far outside the frame the exact place no longer matters.
        (!share.is_nan()).then(|| share.clamp(-1e6, 1e6))
    }

    /// The value at a share of the axis, the inverse of [`Scale::share`].
    pub(crate) fn value(&self, share: f64) -> f64 {
        if self.log {
            (self.lo.ln() + share * (self.hi.ln() - self.lo.ln())).exp()
        } else {
            self.lo + share * (self.hi - self.lo)
        }
    }

    pub(crate) fn decades(&self) -> f64 {
        self.hi.log10() - self.lo.log10()
    }

    pub(crate) fn holds(&self, value: f64) -> bool {
        self.share(value).is_some_and(|s| (-1e-9..=1.0 + 1e-9).contains(&s))
    }
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tick {
    pub(crate) value: f64,
    pub(crate) label: String,
}

#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Ticks {
    pub(crate) major: Vec<Tick>,
    pub(crate) minor: Vec<f64>,
    /// Labels are to be multiplied by this power of ten.
    pub(crate) exponent: Option<i32>,
}

impl Ticks {
    /// Width of the widest label at a font size.
    pub(crate) fn widest(&self, font: f64) -> f64 {
        let widths = self.major.iter().map(|tick| TextLine::new(&tick.label, font).width());
        widths.fold(0.0, f64::max)
    }

    /// `×10^n` at the end of an axis whose labels leave a power of ten out.
    pub(crate) fn factor(&self, font: f64) -> Option<TextLine> {
        let factor = |n| TextLine::new(&format!(r"$\times10^{{{n}}}$"), font);
        self.exponent.map(factor)
    }

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
    pub(crate) length: f64,
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
        spans.windows(2).all(|w| (w[1].0 - w[0].0).abs() >= 0.5 * (w[0].1 + w[1].1))
    }

    /// Position and needed length of a label along the axis.
    fn span(&self, scale: &Scale, tick: &Tick) -> Option<(f64, f64)> {
        let position = scale.share(tick.value)? * self.length;
        let line = TextLine::new(&tick.label, self.font);
        let size = if self.side_by_side { line.width() + 0.8 * self.font } else { 1.5 * self.font };
        Some((position, size))
    }
}

/// The richest set of ticks whose labels have room.
pub(crate) fn ticks(scale: &Scale, room: &Room) -> Ticks {
    if scale.log { log_ticks(scale, room) } else { linear_ticks(scale, room) }
}

/// A tick distance: number of a step in the row …, 0.5, 1, 2, 5, 10, …
#[derive(Debug, Clone, Copy)]
struct TickStep(i32);

impl TickStep {
    /// The first step that cuts the span into no more than `parts`.
    fn at_least(span: f64, parts: f64) -> Self {
        let raw = span / parts;
        let decade = 3 * raw.log10().floor() as i32;
        // One, two or three steps lead from a power of ten to the next.
        let found = (decade..decade + 4).find(|step| Self(*step).size() >= raw * (1.0 - 1e-9));
        Self(found.unwrap_or(decade + 4))
    }

    fn mantissa(self) -> f64 {
        [1.0, 2.0, 5.0][self.0.rem_euclid(3) as usize]
    }

    fn exponent(self) -> i32 {
        self.0.div_euclid(3)
    }

    fn size(self) -> f64 {
        self.multiple(1.0)
    }

    fn multiple(self, n: f64) -> f64 {
        times_power(n * self.mantissa(), self.exponent())
    }
}

/// More changes of step than any sound range needs.
const TRIES: usize = 12;

fn linear_ticks(scale: &Scale, room: &Room) -> Ticks {
    let exponent = shared_exponent(scale);
    let mut step = TickStep::at_least(scale.hi - scale.lo, room.most() as f64);
    let mut major = labelled(scale, step, exponent);
    for _ in 0..TRIES {
        if major.len() <= 3 || room.fits(scale, &major) {
            break;
        }
        step = TickStep(step.0 + 1);
        major = labelled(scale, step, exponent);
    }
    for _ in 0..TRIES {
        if major.len() >= 2 {
            break;
        }
        step = TickStep(step.0 - 1);
        major = labelled(scale, step, exponent);
    }
    Ticks { minor: minor(scale, step), major, exponent }
}

/// Power of ten to take out of the labels of very large or small numbers.
fn shared_exponent(scale: &Scale) -> Option<i32> {
    let largest = scale.lo.abs().max(scale.hi.abs());
    let exponent = largest.log10().floor() as i32;
    (!(-2..5).contains(&exponent)).then_some(exponent)
}

fn labelled(scale: &Scale, step: TickStep, exponent: Option<i32>) -> Vec<Tick> {
    let shift = exponent.unwrap_or(0);
    let decimals = usize::try_from(shift - step.exponent()).unwrap_or(0);
    multiples(scale, step.size())
        .map(|n| {
            let value = step.multiple(n);
            let label = fixed(scaled_down(value, shift), decimals);
            Tick { value, label }
        })
        .collect()
}

/// `value / 10^exponent` where 10^exponent alone may not be a number.
fn scaled_down(value: f64, exponent: i32) -> f64 {
    let half = exponent / 2;
    value / 10f64.powi(half) / 10f64.powi(exponent - half)
}

/// Whole numbers `n` with `n * step` on the axis.
fn multiples(scale: &Scale, step: f64) -> impl Iterator<Item = f64> {
    let slack = 1e-9 * (scale.hi - scale.lo) / step;
    let first = (scale.lo / step - slack).ceil();
    let last = (scale.hi / step + slack).floor();
    let count = (last - first).clamp(-1.0, 1000.0) as i32;
    (0..=count).map(move |i| first + f64::from(i))
}

fn minor(scale: &Scale, step: TickStep) -> Vec<f64> {
    let parts = if step.mantissa() == 2.0 { 4.0 } else { 5.0 };
    multiples(scale, step.size() / parts)
        .filter(|n| n.rem_euclid(parts) != 0.0)
        .map(|n| step.multiple(n / parts))
        .collect()
}

/// Multiples of powers of ten that carry labels, richest choice first.
const CHOICES: [(&[u32], i32); 8] = [
    (&[1, 2, 3, 4, 5, 6, 7, 8, 9], 1),
    (&[1, 2, 5], 1),
    (&[1, 3], 1),
    (&[1], 1),
    (&[1], 2),
    (&[1], 3),
    (&[1], 5),
    (&[1], 10),
];

/// Beyond this many decades, multiples of a power of ten say nothing.
const MANY_DECADES: f64 = 3.0;

fn log_ticks(scale: &Scale, room: &Room) -> Ticks {
    let found = CHOICES
        .iter()
        .filter(|(mantissas, _)| mantissas.len() == 1 || scale.decades() <= MANY_DECADES)
        .map(|(mantissas, every)| powers(scale, mantissas, *every))
        .find(|major| major.len() <= room.most() && room.fits(scale, major))
        // About five labels.
        .unwrap_or_else(|| powers(scale, &[1], ((scale.decades() / 5.0).ceil() as i32).max(1)));
    if found.len() < 2 || found.len() < 3 && scale.decades() < 1.0 {
        return even_steps(scale, room);
    }
    Ticks { minor: unlabelled(scale, &found), major: found, exponent: None }
}

/// Within a small part of a decade a logarithmic axis is nearly linear.
fn even_steps(scale: &Scale, room: &Room) -> Ticks {
    let mut found = linear_ticks(scale, room);
    if !room.fits(scale, &found.major) && found.major.len() > 3 {
        let mut n = 0;
        found.major.retain(|_| {
            n += 1;
            n % 2 == 1
        });
    }
    found
}

fn powers(scale: &Scale, mantissas: &[u32], every: i32) -> Vec<Tick> {
    let written_out = scale.lo >= 9.9e-4 && scale.hi <= 1.01e5;
    let write = if written_out { plain } else { power };
    ((scale.lo.log10().floor() as i32)..=(scale.hi.log10().ceil() as i32))
        .filter(|e| e.rem_euclid(every) == 0)
        .flat_map(|e| mantissas.iter().map(move |m| (*m, e)))
        .filter(|(m, e)| scale.holds(value(*m, *e)))
        .map(|(m, e)| Tick { value: value(m, e), label: write(m, e) })
        .collect()
}

/// Ticks between the labels. Where powers of ten go without a label only they
/// are marked, so that a short tick always means the same.
fn unlabelled(scale: &Scale, major: &[Tick]) -> Vec<f64> {
    let labels_missing = |p: &Tick| major.iter().all(|t| t.value != p.value);
    let crowded = powers(scale, &[1], 1).iter().any(labels_missing);
    let mantissas: &[u32] = if crowded { &[1] } else { CHOICES[0].0 };
    let mut found: Vec<f64> = powers(scale, mantissas, 1).iter().map(|t| t.value).collect();
    found.retain(|v| major.iter().all(|t| t.value != *v));
    found
}

/// `mantissa * 10^exponent`, exact for the decimals a label shows.
fn value(mantissa: u32, exponent: i32) -> f64 {
    times_power(f64::from(mantissa), exponent)
}

/// `factor * 10^exponent`; dividing by an exact power of ten keeps 0.3 from becoming
/// 0.30000000000000004.
fn times_power(factor: f64, exponent: i32) -> f64 {
    match exponent < 0 {
        true => factor / 10f64.powi(-exponent),
        false => factor * 10f64.powi(exponent),
    }
}

/// A number with a fixed count of decimals and a true minus sign; no "-0".
fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let digits = text.trim_start_matches('-');
    let zero = digits.chars().all(|c| matches!(c, '0' | '.'));
    if zero || !text.starts_with('-') { digits.to_owned() } else { format!("−{digits}") }
}

/// `mantissa * 10^exponent` in plain decimals.
fn plain(mantissa: u32, exponent: i32) -> String {
    let decimals = usize::try_from(-exponent).unwrap_or(0);
    fixed(f64::from(mantissa) * 10f64.powi(exponent), decimals)
}

/// `mantissa * 10^exponent` as a power of ten.
fn power(mantissa: u32, exponent: i32) -> String {
    match mantissa {
        1 => format!("$10^{{{exponent}}}$"),
        m => format!(r"${m}\times10^{{{exponent}}}$"),
    }
}

#[cfg(test)]
#[path = "tests/mod.rs"]
mod tests;

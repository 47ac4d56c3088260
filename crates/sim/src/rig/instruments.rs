//! Parts of the rig: actuator, photogate, charge amplifier, analogue-to-digital converter, and
//! the random streams that they draw from.

use crate::rig::RigError;
use hertzchain_experiment::{Actuator, Amplifier as Settings, LowPassFactor, Photogate, Recorder};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Exp1, StandardNormal};
use std::f64::consts::TAU;

/// A random stream of one purpose; its numbers depend on seed, series and purpose alone.
#[derive(Clone, Debug)]
pub struct RandomStream(ChaCha8Rng);

/// What a stream is for: another number of taps leaves the noise as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Assembly of the chain before a series.
    Assembly,
    /// Resampling of series for the claims' error bars.
    Resampling,
    /// Taps and striker of a shot, by its number from 0.
    Shot(u32),
    /// Noise of a shot's record.
    Noise(u32),
}

/// Shots of one series that have streams of their own.
pub(super) const MOST_SHOTS: usize = 1 << 30;

impl RandomStream {
    /// Returns the stream of a purpose in a series of a campaign.
    pub fn new(seed: u64, series: u32, purpose: Purpose) -> Self {
        // Two streams of the series' own, then two a shot.
        let stream = match purpose {
            Purpose::Assembly => 0,
            Purpose::Resampling => 1,
            Purpose::Shot(shot) => 2 * u64::from(shot) + 2,
            Purpose::Noise(shot) => 2 * u64::from(shot) + 3,
        };
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream((u64::from(series) << 32) | stream);
        Self(generator)
    }

    /// Draws from the standard normal distribution.
    pub(crate) fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// Draws from the exponential distribution with mean 1.
    pub(crate) fn exponential(&mut self) -> f64 {
        Exp1.sample(&mut self.0)
    }

    /// Draws uniformly from 0 (included) to 1 (excluded).
    pub fn uniform(&mut self) -> f64 {
        self.0.random()
    }

    /// Draws 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }
}

/// Shots as slow as this share of the slowest happen by chance; slower ones would not roll to
/// the chain.
const SLOWEST_SHARE: f64 = 0.1;

/// Returns the programmable speed nearest to one asked for, in m/s.
///
/// # Errors
/// [`RigError::Speed`] for a speed outside the actuator's range.
pub(crate) fn programmed(actuator: &Actuator, asked_m_s: f64) -> Result<f64, RigError> {
    let (least_m_s, most_m_s) = (actuator.least_speed_m_s, actuator.most_speed_m_s);
    if !(least_m_s..=most_m_s).contains(&asked_m_s) {
        return Err(RigError::Speed(format!(
            "the actuator cannot shoot at {asked_m_s} m/s: expected a speed from {least_m_s} to {most_m_s} m/s"
        )));
    }
    Ok((asked_m_s / actuator.resolution_m_s).round() * actuator.resolution_m_s)
}

/// Draws the true speed of one shot in m/s: programmed + spread · normal.
pub(crate) fn true_speed_m_s(
    actuator: &Actuator,
    programmed_m_s: f64,
    random: &mut RandomStream,
) -> f64 {
    let speed = programmed_m_s + actuator.spread_m_s * random.normal();
    let slowest_m_s = SLOWEST_SHARE * actuator.least_speed_m_s;
    // Not `max`, which would turn NaN into a speed.
    match speed < slowest_m_s {
        true => slowest_m_s,
        false => speed,
    }
}

/// What the photogate measures of one shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GateReading {
    /// Measured speed in m/s.
    pub speed_m_s: f64,
    /// When the striker passed, in s before the first touch: negative.
    pub time_s: f64,
}

impl GateReading {
    /// Reads a striker of this true speed whose way to bead 1 is longer by `misplaced_m`.
    pub(crate) fn new(
        gate: &Photogate,
        speed_m_s: f64,
        misplaced_m: f64,
        random: &mut RandomStream,
    ) -> Self {
        // A striker is never put beyond bead 1.
        let way_m = (gate.way_m + misplaced_m).max(0.0);
        Self { speed_m_s: speed_m_s + gate.error_m_s * random.normal(), time_s: -way_m / speed_m_s }
    }
}

/// A converter of up to 16 bits. Its readings stand at the upper end of 16 bits, as DAQ cards
/// deliver them, whatever its own number of bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Converter {
    volts_per_reading: f64,
    /// Counts of a 16-bit reading that one reading of this converter is.
    stride: i32,
    least: f64,
    most: f64,
    offset_v: f64,
}

impl Converter {
    /// Returns the converter of a recorder.
    pub(crate) fn new(recorder: &Recorder) -> Self {
        let bits = recorder.bits.clamp(2, 16);
        let half = f64::from(1u32 << (bits - 1));
        Self {
            volts_per_reading: recorder.range_v / half,
            stride: 1 << (16 - bits),
            least: -half,
            most: half - 1.0,
            offset_v: recorder.offset_v,
        }
    }

    /// Returns the reading of a signal in V: with the offset, rounded to the nearest, cut at
    /// both ends of the range.
    #[inline]
    pub(crate) fn reading(&self, signal_v: f64) -> i16 {
        let found = (signal_v + self.offset_v) / self.volts_per_reading;
        let cut = found.round_ties_even().clamp(self.least, self.most);
        // Within 16 bits by the limits; NaN becomes 0.
        (cut as i32 * self.stride) as i16
    }

    /// Returns the volts of one count of the 16-bit reading.
    pub(crate) fn volts_per_count(&self) -> f64 {
        self.volts_per_reading / f64::from(self.stride)
    }
}

/// States of the high-pass and of the longest low-pass.
const STATES: usize = 5;

/// Charge amplifier of two piezo discs on a sampling grid.
///
/// v = G (S₇ F₇ + S_w F_w), then a high-pass of first order, H(s) = s/(s + ω_h), then a
/// low-pass, a product of [factors](LowPassFactor) of first and second order.
#[derive(Clone, Copy, Debug)]
pub struct Amplifier {
    filter: FirstOrderHold,
    /// What the high-pass has followed, then each factor's output and, of one of second order,
    /// its rate over ω.
    state: [f64; STATES],
    /// Number of the last factor's output.
    output: usize,
    sensor_v_n: f64,
    wall_v_n: f64,
    input_v: f64,
}

impl Amplifier {
    /// Returns the amplifier at rest, for samples every `interval_s`.
    pub fn new(settings: &Settings, interval_s: f64) -> Self {
        let (a, b, output) = system(settings);
        Self {
            filter: FirstOrderHold::new(&a, &b, interval_s),
            state: [0.0; STATES],
            output,
            sensor_v_n: settings.gain_v_c * settings.sensitivity_c_n,
            wall_v_n: settings.gain_v_c * settings.wall_sensitivity_c_n,
            input_v: 0.0,
        }
    }

    /// Returns the voltage at the next sample, at which the forces in N are these.
    #[inline]
    pub fn next(&mut self, sensor_n: f64, wall_n: f64) -> f64 {
        let input_v = self.sensor_v_n * sensor_n + self.wall_v_n * wall_n;
        let before_v = std::mem::replace(&mut self.input_v, input_v);
        self.state = self.filter.step(&self.state, before_v, input_v);
        self.state[self.output]
    }

    /// Returns voltages at equal times for forces in N that are smooth between samples.
    pub fn follow(&mut self, count: usize, forces_n: impl Fn(usize) -> [f64; 2]) -> Vec<f64> {
        let last = count.saturating_sub(1);
        // Straight lines between samples are h²/12 of the second derivative above the force on
        // average: taken off the samples, that leaves an error of order h⁴.
        let one = |at: usize| {
            let [before, now, after] =
                [at.saturating_sub(1), at, (at + 1).min(last)].map(&forces_n);
            let lowered = |of: usize| now[of] - (before[of] - 2.0 * now[of] + after[of]) / 12.0;
            self.next(lowered(0), lowered(1))
        };
        (0..count).map(one).collect()
    }
}

/// A and B of both filters in 1/s, and which state is the output. The input less the first
/// state passes the high-pass; of each factor the output is the next one's input.
fn system(settings: &Settings) -> ([[f64; STATES]; STATES], [f64; STATES], usize) {
    let (mut a, mut b) = ([[0.0; STATES]; STATES], [0.0; STATES]);
    let high = TAU * settings.high_pass_hz;
    (a[0][0], b[0]) = (-high, high);
    let (mut output, mut next) = (0, 1);
    for factor in settings.factors() {
        let (rate, driven, damping) = match *factor {
            LowPassFactor::One { frequency } => (frequency, next, None),
            LowPassFactor::Two { frequency, damping } => (frequency, next + 1, Some(damping)),
        };
        let rate = TAU * settings.low_pass_hz * rate;
        // Of the state that the input drives.
        match output {
            0 => (a[driven][0], b[driven]) = (-rate, rate),
            before => a[driven][before] = rate,
        }
        a[driven][next] = -rate;
        if let Some(damping) = damping {
            a[next][driven] = rate;
            a[driven][driven] = -damping * rate;
        }
        (output, next) = (next, driven + 1);
    }
    (a, b, output)
}

/// First-order-hold discretisation of ẋ = A x + B u, exact for inputs that are straight lines
/// between samples: x(h) = Φ x(0) + γ u(0) + δ (u(h) − u(0)).
#[derive(Clone, Copy, Debug)]
struct FirstOrderHold {
    transition: [[f64; STATES]; STATES],
    input: [f64; STATES],
    change: [f64; STATES],
}

impl FirstOrderHold {
    fn new(a: &[[f64; STATES]; STATES], b: &[f64; STATES], step_s: f64) -> Self {
        // exp of the system with u and its change as states of their own:
        // u̇ = change/step, so that over a step of length 1 it is the change.
        let mut square = vec![vec![0.0; STATES + 2]; STATES + 2];
        for row in 0..STATES {
            for column in 0..STATES {
                square[row][column] = a[row][column] * step_s;
            }
            square[row][STATES] = b[row] * step_s;
        }
        square[STATES][STATES + 1] = 1.0;
        let whole = exponential(&square);
        Self {
            transition: std::array::from_fn(|x| std::array::from_fn(|y| whole[x][y])),
            input: std::array::from_fn(|x| whole[x][STATES]),
            change: std::array::from_fn(|x| whole[x][STATES + 1]),
        }
    }

    /// The state a step later; the input goes from `from` to `to`.
    #[inline]
    fn step(&self, state: &[f64; STATES], from: f64, to: f64) -> [f64; STATES] {
        let change = to - from;
        std::array::from_fn(|row| {
            let rows = self.transition[row].iter().zip(state);
            let own: f64 = rows.map(|(factor, x)| factor * x).sum();
            own + self.input[row] * from + self.change[row] * change
        })
    }
}

type Square = Vec<Vec<f64>>;

/// Terms of the series for a matrix of norm up to 1/2: (1/2)^18/18! < 1e-21.
const TERMS: u32 = 18;

/// exp of a matrix: a Taylor series of a part, squared again and again.
fn exponential(matrix: &Square) -> Square {
    let rows = matrix.iter().map(|row| row.iter().map(|x| x.abs()).sum::<f64>());
    let norm = rows.fold(0.0, f64::max);
    let halvings = (norm.max(0.5).log2() + 1.0).ceil().clamp(0.0, 1000.0) as i32;
    let part = scaled(matrix, 0.5f64.powi(halvings));
    let mut sum = scaled(matrix, 0.0);
    add_identity(&mut sum);
    for term in (1..=TERMS).rev() {
        sum = product(&scaled(&part, f64::from(term).recip()), &sum);
        add_identity(&mut sum);
    }
    (0..halvings).fold(sum, |root, _| product(&root, &root))
}

fn add_identity(matrix: &mut Square) {
    for (at, row) in matrix.iter_mut().enumerate() {
        row[at] += 1.0;
    }
}

fn scaled(matrix: &Square, factor: f64) -> Square {
    let row = |row: &Vec<f64>| row.iter().map(|x| factor * x).collect();
    matrix.iter().map(row).collect()
}

fn product(left: &Square, right: &Square) -> Square {
    let columns = 0..right.len();
    let entry = |row: &[f64], column: usize| -> f64 {
        row.iter().zip(right).map(|(factor, other)| factor * other[column]).sum()
    };
    let row = |row: &Vec<f64>| columns.clone().map(|column| entry(row, column)).collect();
    left.iter().map(row).collect()
}

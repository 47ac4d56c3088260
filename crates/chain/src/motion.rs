//! Prescribed motion of a driven end.

use std::f64::consts::{PI, TAU};

/// Position of a driven end against time, starting from rest at 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// x = a sin 2πft; its velocity jumps to 2πaf at t = 0.
    Sine {
        /// Amplitude a in m.
        amplitude_m: f64,
        /// Frequency f in Hz.
        frequency_hz: f64,
    },
    /// One push and back: x = a sin²(πt/T) for t < T, then 0.
    Pulse {
        /// Largest displacement a in m.
        amplitude_m: f64,
        /// Duration T in s.
        duration_s: f64,
    },
    /// Measured points, counted from the first position and joined by a cubic with continuous velocity
    /// (three-point slopes); at rest before the first and after the last.
    Table {
        /// Times in s, strictly increasing.
        times_s: Vec<f64>,
        /// Positions in m, one a time.
        positions_m: Vec<f64>,
    },
}

impl Motion {
    /// Position in m and velocity in m/s at a time in s.
    pub(crate) fn at(&self, time_s: f64) -> (f64, f64) {
        match self {
            Self::Sine { amplitude_m, frequency_hz } => {
                let omega = TAU * frequency_hz;
                let (sin, cos) = (omega * time_s).sin_cos();
                (amplitude_m * sin, amplitude_m * omega * cos)
            }
            Self::Pulse { amplitude_m, duration_s } if time_s < *duration_s => {
                push_and_back(*amplitude_m, *duration_s, time_s)
            }
            Self::Pulse { .. } => (0.0, 0.0),
            Self::Table { times_s, positions_m } => interpolate(times_s, positions_m, time_s),
        }
    }

    /// Acceleration in m/s² at a time in s of a smooth stretch that holds another time.
    pub(crate) fn acceleration_m_s2(&self, time_s: f64, inside_s: f64) -> f64 {
        match self {
            Self::Sine { frequency_hz, .. } => -(TAU * frequency_hz).powi(2) * self.at(time_s).0,
            Self::Pulse { amplitude_m, duration_s } if inside_s < *duration_s => {
                let omega = TAU / duration_s;
                0.5 * amplitude_m * omega * omega * (omega * time_s).cos()
            }
            Self::Pulse { .. } => 0.0,
            Self::Table { times_s, positions_m } => {
                let right = times_s.partition_point(|&t| t <= inside_s);
                if right == 0 || right >= times_s.len() {
                    return 0.0;
                }
                let cubic = Cubic::new(times_s, positions_m, right - 1);
                let s = (time_s - times_s[right - 1]) / cubic.length;
                (2.0 * cubic.c2 + 6.0 * cubic.c3 * s) / (cubic.length * cubic.length)
            }
        }
    }

    /// The first time after `time_s` at which the motion is not smooth; a
    /// step must end there.
    pub(crate) fn next_break(&self, time_s: f64) -> f64 {
        match self {
            Self::Sine { .. } => f64::INFINITY,
            Self::Pulse { duration_s, .. } if time_s < *duration_s => *duration_s,
            Self::Pulse { .. } => f64::INFINITY,
            Self::Table { times_s, .. } => {
                let next = times_s.partition_point(|&t| t <= time_s);
                times_s.get(next).copied().unwrap_or(f64::INFINITY)
            }
        }
    }

    /// What is wrong with it, if anything.
    ///
    /// # Errors
    /// Numbers that are not finite, a frequency or duration that is not
    /// positive, a table whose times do not increase or lack positions.
    pub fn check(&self) -> Result<(), String> {
        let positive = |what: &str, value: f64| match value > 0.0 && value.is_finite() {
            true => Ok(()),
            false => Err(format!("{what} = {value} must be positive and finite")),
        };
        match self {
            Self::Sine { amplitude_m, frequency_hz } => {
                positive("amplitude in m", amplitude_m.abs())?;
                positive("frequency in Hz", *frequency_hz)
            }
            Self::Pulse { amplitude_m, duration_s } => {
                positive("amplitude in m", amplitude_m.abs())?;
                positive("duration in s", *duration_s)
            }
            Self::Table { times_s, positions_m } => check_table(times_s, positions_m),
        }
    }

    /// The longest step in s that cannot step over a swing of the motion.
    pub fn longest_step_s(&self) -> f64 {
        match self {
            Self::Sine { frequency_hz, .. } => 0.05 / frequency_hz.abs(),
            Self::Pulse { duration_s, .. } => 0.05 * duration_s,
            Self::Table { .. } => f64::INFINITY,
        }
    }

    /// A speed in m/s that the motion reaches, for scales.
    pub fn largest_speed_m_s(&self) -> f64 {
        match self {
            Self::Sine { amplitude_m, frequency_hz } => TAU * (amplitude_m * frequency_hz).abs(),
            Self::Pulse { amplitude_m, duration_s } => PI * (amplitude_m / duration_s).abs(),
            Self::Table { times_s, positions_m } => times_s
                .windows(2)
                .zip(positions_m.windows(2))
                .map(|(t, x)| ((x[1] - x[0]) / (t[1] - t[0])).abs())
                .fold(0.0, f64::max),
        }
    }
}

fn check_table(times_s: &[f64], positions_m: &[f64]) -> Result<(), String> {
    if times_s.len() != positions_m.len() || times_s.len() < 2 {
        let (times, positions) = (times_s.len(), positions_m.len());
        return Err(format!(
            "{times} times and {positions} positions; two or more of each are needed"
        ));
    }
    if times_s.iter().chain(positions_m).any(|value| !value.is_finite()) {
        return Err("a time or position is not finite".into());
    }
    match times_s.windows(2).find(|pair| pair[1] <= pair[0]) {
        Some(pair) => Err(format!("times must increase, but {} s follows {} s", pair[1], pair[0])),
        None => Ok(()),
    }
}

fn push_and_back(amplitude_m: f64, duration_s: f64, time_s: f64) -> (f64, f64) {
    let omega = TAU / duration_s;
    let (sin, cos) = (omega * time_s).sin_cos();
    (0.5 * amplitude_m * (1.0 - cos), 0.5 * amplitude_m * omega * sin)
}

/// Cubic Hermite interpolation with three-point slopes, flat outside.
fn interpolate(times: &[f64], positions: &[f64], time: f64) -> (f64, f64) {
    let right = times.partition_point(|&t| t <= time);
    let (Some(&first), Some(&last)) = (positions.first(), positions.last()) else {
        return (0.0, 0.0);
    };
    if right == 0 {
        return (0.0, 0.0);
    }
    if right >= times.len() {
        return (last - first, 0.0);
    }
    let left = right - 1;
    let Cubic { length, d0, c2, c3 } = Cubic::new(times, positions, left);
    let s = (time - times[left]) / length;
    let position = positions[left] - first + s * (d0 + s * (c2 + s * c3));
    (position, (d0 + s * (2.0 * c2 + 3.0 * s * c3)) / length)
}

/// One stretch: x − x₀ = d₀ s + c₂ s² + c₃ s³ over its length in s.
struct Cubic {
    length: f64,
    d0: f64,
    c2: f64,
    c3: f64,
}

impl Cubic {
    /// From this point to the next.
    fn new(times: &[f64], positions: &[f64], left: usize) -> Self {
        let length = times[left + 1] - times[left];
        let first = positions[0];
        let (x0, x1) = (positions[left] - first, positions[left + 1] - first);
        let [d0, d1] = [left, left + 1].map(|at| length * slope(times, positions, at));
        let (c2, c3) = (3.0 * (x1 - x0) - 2.0 * d0 - d1, d0 + d1 - 2.0 * (x1 - x0));
        Self { length, d0, c2, c3 }
    }
}

/// Slope of the parabola through a point and its neighbours; 0 at the ends,
/// where the driven end is at rest.
fn slope(times: &[f64], positions: &[f64], at: usize) -> f64 {
    if at == 0 || at + 1 >= times.len() {
        return 0.0;
    }
    let (left, right) = (times[at] - times[at - 1], times[at + 1] - times[at]);
    let before = (positions[at] - positions[at - 1]) / left;
    let after = (positions[at + 1] - positions[at]) / right;
    (before * right + after * left) / (left + right)
}

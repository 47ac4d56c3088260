//! The parts of a rig in numbers.

use crate::finding::Problem;
use crate::value::short;
use crate::view::View;
use std::f64::consts::SQRT_2;

/// How a chain is laid before a series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laying {
    /// Mean of the random gaps in m, exponentially distributed.
    pub gap_scatter_m: f64,
    /// Standard deviation of bead radii over their mean.
    pub radius_spread: f64,
}

/// What launches the striker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuator {
    /// Step of the speeds that can be programmed, in m/s.
    pub resolution_m_s: f64,
    /// Standard deviation of the speed from shot to shot, in m/s.
    pub spread_m_s: f64,
    /// Slowest shot in m/s.
    pub least_speed_m_s: f64,
    /// Fastest shot in m/s.
    pub most_speed_m_s: f64,
    /// Standard deviation of the place to which the striker is brought back,
    /// in m.
    pub placing_m: f64,
}

/// What measures the striker's speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Photogate {
    /// Standard deviation of a measured speed in m/s.
    pub error_m_s: f64,
    /// Way of the striker from the gate to bead 1 in m.
    pub way_m: f64,
}

/// What turns forces into voltages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amplifier {
    /// Charge of the sensor bead's disc in C/N.
    pub sensitivity_c_n: f64,
    /// Charge of the wall's disc in C/N.
    pub wall_sensitivity_c_n: f64,
    /// Voltage for a charge in V/C.
    pub gain_v_c: f64,
    /// Corner of the low-pass in Hz.
    pub low_pass_hz: f64,
    /// Order of the low-pass.
    pub order: LowPass,
    /// Kind of the low-pass; of first order all are one.
    pub kind: LowPassKind,
    /// Corner of the high-pass in Hz.
    pub high_pass_hz: f64,
    /// Standard deviation of each sample's noise in V.
    pub noise_v: f64,
}

/// Order of an amplifier's low-pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LowPass {
    /// One pole.
    First,
    /// Two poles.
    Second,
    /// Three.
    Third,
    /// Four.
    Fourth,
}

/// Names of orders in a file.
pub const ORDERS: &[&str] = &["first", "second", "third", "fourth"];

/// Kind of an amplifier's low-pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LowPassKind {
    /// Flattest amplitude.
    Butterworth,
    /// Flattest delay.
    Bessel,
}

/// Names of kinds in a file.
pub const KINDS: &[&str] = &["butterworth", "bessel"];

/// One factor of a low-pass, its frequency over that of the corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Factor {
    /// ω/(s + ω).
    One {
        /// ω over the corner's.
        frequency: f64,
    },
    /// ω²/(s² + d ω s + ω²).
    Two {
        /// ω over the corner's.
        frequency: f64,
        /// d, twice the damping ratio.
        damping: f64,
    },
}

const fn one(frequency: f64) -> Factor {
    Factor::One { frequency }
}

const fn two(frequency: f64, damping: f64) -> Factor {
    Factor::Two { frequency, damping }
}

impl Amplifier {
    /// Factors of the low-pass, whose product falls to 1/√2 at the corner.
    pub const fn factors(&self) -> &'static [Factor] {
        match (self.order, self.kind) {
            (LowPass::First, _) => const { &[one(1.0)] },
            // Damping 2 cos(π/8) and 2 cos(3π/8).
            (LowPass::Second, LowPassKind::Butterworth) => const { &[two(1.0, SQRT_2)] },
            (LowPass::Third, LowPassKind::Butterworth) => const { &[one(1.0), two(1.0, 1.0)] },
            (LowPass::Fourth, LowPassKind::Butterworth) => {
                const {
                    &[
                        two(1.0, 1.847_759_065_022_573_5),
                        two(1.0, 0.765_366_864_730_179_7),
                    ]
                }
            }
            // Roots of the reverse Bessel polynomials, over the frequency of half power.
            (LowPass::Second, LowPassKind::Bessel) => {
                const { &[two(1.272_019_649_514_068_8, 1.732_050_807_568_877_4)] }
            }
            (LowPass::Third, LowPassKind::Bessel) => {
                const {
                    &[
                        one(1.322_675_799_910_444_4),
                        two(1.447_617_133_146_987_4, 1.447_080_359_890_413_2),
                    ]
                }
            }
            (LowPass::Fourth, LowPassKind::Bessel) => {
                const {
                    &[
                        two(1.430_171_559_993_991, 1.915_948_923_718_216),
                        two(1.603_357_516_216_973, 1.241_405_930_098_995_7),
                    ]
                }
            }
        }
    }

    /// What the amplifier's filters are, in words.
    pub fn filters(&self) -> String {
        let kind = match (self.order, self.kind) {
            (LowPass::First, _) => "",
            (_, LowPassKind::Butterworth) => "Butterworth ",
            (_, LowPassKind::Bessel) => "Bessel ",
        };
        format!(
            "{kind}low-pass of {} order at {} kHz, high-pass of first order at {} Hz",
            ORDERS[self.order as usize],
            rounded(1e-3 * self.low_pass_hz),
            rounded(self.high_pass_hz)
        )
    }
}

/// A number of four digits.
fn rounded(value: f64) -> String {
    short(format!("{value:.3e}").parse().unwrap_or(value))
}

/// What turns voltages into records.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recorder {
    /// Bits of a sample, at most 16.
    pub bits: u32,
    /// Samples a second in Hz.
    pub sampling_hz: f64,
    /// Largest voltage either way, in V.
    pub range_v: f64,
    /// Voltage of no signal.
    pub offset_v: f64,
    /// Length of a record in s.
    pub record_s: f64,
    /// Part of it before the trigger in s.
    pub before_s: f64,
    /// What starts a record.
    pub trigger: Trigger,
    /// In which channels both sensors are.
    pub channels: Channels,
}

/// In which channels of a recorder both sensors are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// Added up in one, as in the paper.
    Summed,
    /// One each.
    Separate,
}

impl Channels {
    /// How many there are.
    pub const fn count(self) -> usize {
        match self {
            Self::Summed => 1,
            Self::Separate => 2,
        }
    }
}

/// Names of channels in a file.
pub const CHANNELS: &[&str] = &["summed", "separate"];

/// What starts a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trigger {
    /// The striker in the photogate.
    Photogate,
    /// The channel, or the sensor bead's, when it passes a level in V upward.
    Level(f64),
}

/// Names of triggers in a file.
pub const TRIGGERS: &[&str] = &["photogate", "level"];

/// A quantity of a table, or its default.
fn quantity(table: Option<&View<'_>>, key: &str, default: f64) -> Result<f64, Problem> {
    let given = table.map_or(Ok(None), |table| table.quantity(key))?;
    Ok(given.unwrap_or(default))
}

impl Laying {
    pub(super) fn read(table: Option<&View<'_>>) -> Result<Self, Problem> {
        Ok(Self {
            gap_scatter_m: quantity(table, "gap_scatter", 5e-6)?,
            radius_spread: quantity(table, "radius_spread", 0.0)?,
        })
    }
}

impl Actuator {
    pub(super) fn read(table: Option<&View<'_>>) -> Result<Self, Problem> {
        let actuator = Self {
            resolution_m_s: quantity(table, "resolution", 1.5e-4)?,
            spread_m_s: quantity(table, "spread", 0.003)?,
            least_speed_m_s: quantity(table, "least_speed", 0.05)?,
            most_speed_m_s: quantity(table, "most_speed", 2.5)?,
            placing_m: quantity(table, "placing", 20e-6)?,
        };
        match table {
            Some(table) if actuator.least_speed_m_s >= actuator.most_speed_m_s => {
                let message = "the slowest shot is not slower than the fastest";
                let label = "expected `least_speed` below `most_speed`";
                Err(Problem::new(&table.span(), message, label))
            }
            _ => Ok(actuator),
        }
    }
}

impl Photogate {
    pub(super) fn read(table: Option<&View<'_>>) -> Result<Self, Problem> {
        Ok(Self {
            error_m_s: quantity(table, "error", 5e-4)?,
            way_m: quantity(table, "way", 1e-3)?,
        })
    }
}

impl Amplifier {
    pub(super) fn read(table: Option<&View<'_>>) -> Result<Self, Problem> {
        let sensitivity_c_n = quantity(table, "sensitivity", 10e-12)?;
        Ok(Self {
            sensitivity_c_n,
            wall_sensitivity_c_n: quantity(table, "wall_sensitivity", sensitivity_c_n)?,
            gain_v_c: quantity(table, "gain", 1e9)?,
            low_pass_hz: quantity(table, "low_pass", 180e3)?,
            order: match table.and_then(|table| table.text("order")) {
                Some("first") => LowPass::First,
                Some("third") => LowPass::Third,
                Some("fourth") => LowPass::Fourth,
                _ => LowPass::Second,
            },
            kind: match table.and_then(|table| table.text("kind")) {
                Some("bessel") => LowPassKind::Bessel,
                _ => LowPassKind::Butterworth,
            },
            high_pass_hz: quantity(table, "high_pass", 0.5)?,
            noise_v: quantity(table, "noise", 1.5e-3)?,
        })
    }
}

/// Most samples of a record: a quarter of a minute at 1 MHz.
const MOST_SAMPLES: f64 = 1.6e7;

impl Recorder {
    pub(super) fn read(table: Option<&View<'_>>) -> Result<Self, Problem> {
        let bits = table.map_or(Ok(None), |table| table.count("bits"))?;
        let level = table.and_then(|table| table.text("trigger")) == Some("level");
        let recorder = Self {
            bits: bits.and_then(|bits| u32::try_from(bits).ok()).unwrap_or(16),
            sampling_hz: quantity(table, "sampling", 1e6)?,
            range_v: quantity(table, "range", 10.0)?,
            offset_v: quantity(table, "offset", 0.0)?,
            record_s: quantity(table, "record", 0.1)?,
            before_s: quantity(table, "before", 2e-3)?,
            trigger: match level {
                true => Trigger::Level(quantity(table, "level", 0.02)?),
                false => Trigger::Photogate,
            },
            channels: match table.and_then(|table| table.text("channels")) {
                Some("separate") => Channels::Separate,
                _ => Channels::Summed,
            },
        };
        match table {
            Some(table) => recorder.checked(table),
            None => Ok(recorder),
        }
    }

    /// Samples of a record.
    pub fn samples(&self) -> usize {
        // Rounded: 0.1 s at 1 MHz are 100,000 samples.
        (self.record_s * self.sampling_hz).round() as usize
    }

    fn checked(self, table: &View<'_>) -> Result<Self, Problem> {
        let samples = self.record_s * self.sampling_hz;
        let problem = |key, message, label| Problem::new(&table.span_of(key), message, label);
        if !(2.0..=MOST_SAMPLES).contains(&samples.round()) {
            let message = format!("a record of {samples:.0} samples cannot be taken");
            let label = "expected from 2 to 16 million samples";
            return Err(problem("record", message, label));
        }
        if self.before_s >= self.record_s {
            let message = "nothing of the record is after the trigger".to_owned();
            return Err(problem("before", message, "expected less than `record`"));
        }
        let range_v = self.range_v;
        let label = "expected less than `range` either way";
        if self.offset_v.abs() >= range_v {
            let message = format!(
                "no signal at all, {} V, is outside the converter's range of ± {range_v} V: every \
                 sample would be clipped",
                self.offset_v
            );
            return Err(problem("offset", message, label));
        }
        match self.trigger {
            Trigger::Level(level_v) if level_v.abs() >= range_v => {
                let message = format!(
                    "a level of {level_v} V is outside the converter's range of ± {range_v} V and is \
                     never passed"
                );
                return Err(problem("level", message, label));
            }
            _ => {}
        }
        Ok(self)
    }
}

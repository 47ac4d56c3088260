//! The apparatus: the campaign that it runs, the numbers of its instruments, and its parts by
//! name. No law and no single shot uses them.

use crate::bodies::{BeadGroup, Materials};
use crate::contacts::{self, SectionSpec};
use crate::keys::{
    Choice, Count, Fields, SPREAD, Table, Text, VOLTAGE, choice, from, not_negative, positive,
    table,
};
use crate::report::{FileProblem, to_digits};
use crate::settings::Liquid;
use crate::values::{FromKey, TableView, record};
use std::f64::consts::SQRT_2;

/// Everything that a rig does: series at several speeds, each for every case.
#[derive(Clone, Debug, PartialEq)]
pub struct Campaign {
    /// Seed of all that is random.
    pub seed: u64,
    /// Programmed speeds in m/s, in the file's order.
    pub speeds_m_s: Vec<f64>,
    /// Shots of a series.
    pub shots: usize,
    /// Taps before a shot; 0 switches them off.
    pub taps: usize,
    /// Speed of the striker in a tap, in m/s.
    pub tap_speed_m_s: f64,
    /// Gaps and radii of a chain as it is laid before a series.
    pub laying: Laying,
    /// Launches the striker.
    pub actuator: Actuator,
    /// Measures its speed.
    pub photogate: Photogate,
    /// Turns forces into voltages.
    pub amplifier: Amplifier,
    /// Turns voltages into records.
    pub recorder: Recorder,
}

/// One of several chains that a campaign measures.
#[derive(Clone, Debug)]
pub(crate) struct CaseSpec {
    pub(crate) name: String,
    /// Sections in place of the file's own.
    pub(crate) sections: Option<Vec<SectionSpec>>,
    /// Liquid in place of the file's own.
    pub(crate) liquid: Option<Liquid>,
}

record! {
    /// How a chain is laid before a series.
    #[derive(Copy)]
    Laying "[campaign.laying]"
    gap_scatter_m: f64 = gap_scatter 5e-6, not_negative("m"), "mean of the random gaps of a chain as it is laid, exponentially distributed; default 5 um";
    radius_spread: f64 = radius_spread 0.0, SPREAD, "standard deviation of bead radii over their mean; default 0";
}

record! {
    /// Launches the striker.
    #[derive(Copy)]
    Actuator "[campaign.actuator]"
    resolution_m_s: f64 = resolution 1.5e-4, positive("m/s"), "step of the speeds that can be programmed; default 0.15 mm/s";
    spread_m_s: f64 = spread 0.003, not_negative("m/s"), "standard deviation of the speed from shot to shot; default 3 mm/s";
    least_speed_m_s: f64 = least_speed 0.05, positive("m/s"), "slowest speed that can be programmed; default 0.05 m/s";
    most_speed_m_s: f64 = most_speed 2.5, positive("m/s"), "fastest speed that can be programmed; default 2.5 m/s";
    placing_m: f64 = placing 20e-6, not_negative("m"), "standard deviation of the place to which the striker is brought back; default 20 um";
}

record! {
    /// Measures the striker's speed.
    #[derive(Copy)]
    Photogate "[campaign.photogate]"
    error_m_s: f64 = error 5e-4, not_negative("m/s"), "standard deviation of a measured speed; default 0.5 mm/s";
    way_m: f64 = way 1e-3, positive("m"), "way of the striker from the gate to bead 1; default 1 mm";
}

record! {
    /// Turns forces into voltages.
    #[derive(Copy)]
    Amplifier "[campaign.amplifier]"
    sensitivity_c_n: f64 = sensitivity 10e-12, positive("C/N"), "charge of the sensor bead's disc; default 10 pC/N";
    wall_sensitivity_c_n: f64 = wall_sensitivity sensitivity_c_n, positive("C/N"), "charge of the wall's disc; default: as sensitivity";
    gain_v_c: f64 = gain 1e9, positive("V/C"), "voltage for a charge; default 1 mV/pC";
    low_pass_hz: f64 = low_pass 180e3, positive("Hz"), "corner frequency of the low-pass; default 180 kHz";
    order: LowPass = order LowPass::Second, Choice(LowPass::NAMES), "order of the low-pass; default second";
    kind: LowPassKind = kind LowPassKind::Butterworth, Choice(LowPassKind::NAMES), "kind of the low-pass, the same for all of first order; default butterworth";
    high_pass_hz: f64 = high_pass 0.5, positive("Hz"), "corner frequency of the high-pass; default 0.5 Hz";
    noise_v: f64 = noise 1.5e-3, not_negative("V"), "standard deviation of each sample's noise; default 1.5 mV";
}

record! {
    /// Turns voltages into records.
    #[derive(Copy)]
    Recorder "[campaign.recorder]"
    bits: u32 = bits 16, Count { least: 2, most: 16 }, "bits of a sample; default 16";
    sampling_hz: f64 = sampling 1e6, positive("Hz"), "samples a second; default 1 MHz";
    range_v: f64 = range 10.0, positive("V"), "largest voltage either way; default 10 V";
    offset_v: f64 = offset 0.0, VOLTAGE, "voltage of no signal; default 0";
    record_s: f64 = record 0.1, positive("s"), "length of a record; default 0.1 s";
    before_s: f64 = before 2e-3, not_negative("s"), "part of a record before the trigger; default 2 ms";
    trigger: Trigger = trigger Trigger::Photogate, Choice(&["photogate", "level"]), "what starts a record; default photogate";
    channels: Channels = channels Channels::Summed, Choice(Channels::NAMES), "both sensors summed in one channel or each in a separate one; default summed";
    + level VOLTAGE, "voltage that triggers, with trigger = \"level\"; default 20 mV";
}

choice! {
    /// Order of an amplifier's low-pass.
    LowPass {
        "first" => First: "One pole.",
        "second" => Second: "Two poles.",
        "third" => Third: "Three poles.",
        "fourth" => Fourth: "Four poles.",
    }
}

choice! {
    /// Kind of an amplifier's low-pass.
    LowPassKind {
        "butterworth" => Butterworth: "Flattest amplitude.",
        "bessel" => Bessel: "Flattest delay.",
    }
}

choice! {
    /// In which channels of a recorder both sensors are.
    Channels {
        "summed" => Summed: "Added up in one, as in the paper.",
        "separate" => Separate: "One each.",
    }
}

/// The event that starts a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trigger {
    /// The striker in the photogate.
    Photogate,
    /// The channel, or the sensor bead's, when it passes a level in V upward.
    Level(f64),
}

impl FromKey for Trigger {
    fn from_key(table: &TableView<'_>, key: &str) -> Result<Option<Self>, FileProblem> {
        const LEVEL_V: f64 = 0.02;
        let level_v = table.quantity("level")?.unwrap_or(LEVEL_V);
        let level = table.text(key) == Some("level");
        Ok(level.then_some(Self::Level(level_v)))
    }
}

macro_rules! choice_keys {
    ($($Type:ident)+) => {
        $(impl FromKey for $Type {
            fn from_key(table: &TableView<'_>, key: &str) -> Result<Option<Self>, FileProblem> {
                Ok(table.text(key).and_then(Self::from_name))
            }
        })+
    };
}
choice_keys! { LowPass LowPassKind Channels }

impl FromKey for u32 {
    fn from_key(table: &TableView<'_>, key: &str) -> Result<Option<Self>, FileProblem> {
        Ok(table.count(key)?.and_then(|bits| Self::try_from(bits).ok()))
    }
}

/// One factor of a low-pass, its frequency over that of the corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LowPassFactor {
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

const fn one(frequency: f64) -> LowPassFactor {
    LowPassFactor::One { frequency }
}

const fn two(frequency: f64, damping: f64) -> LowPassFactor {
    LowPassFactor::Two { frequency, damping }
}

impl Amplifier {
    /// Factors of the low-pass, whose product falls to 1/√2 at the corner.
    pub const fn factors(&self) -> &'static [LowPassFactor] {
        // Damping 2 cos(π/8) and 2 cos(3π/8).
        const BUTTERWORTH_4: &[LowPassFactor] =
            &[two(1.0, 1.847_759_065_022_573_5), two(1.0, 0.765_366_864_730_179_7)];
        // Roots of the reverse Bessel polynomials, over the frequency of half power.
        const BESSEL_2: &[LowPassFactor] = &[two(1.272_019_649_514_068_8, 1.732_050_807_568_877_4)];
        const BESSEL_3: &[LowPassFactor] =
            &[one(1.322_675_799_910_444_4), two(1.447_617_133_146_987_4, 1.447_080_359_890_413_2)];
        const BESSEL_4: &[LowPassFactor] = &[
            two(1.430_171_559_993_991, 1.915_948_923_718_216),
            two(1.603_357_516_216_973, 1.241_405_930_098_995_7),
        ];
        match (self.order, self.kind) {
            (LowPass::First, _) => const { &[one(1.0)] },
            (LowPass::Second, LowPassKind::Butterworth) => const { &[two(1.0, SQRT_2)] },
            (LowPass::Third, LowPassKind::Butterworth) => const { &[one(1.0), two(1.0, 1.0)] },
            (LowPass::Fourth, LowPassKind::Butterworth) => BUTTERWORTH_4,
            (LowPass::Second, LowPassKind::Bessel) => BESSEL_2,
            (LowPass::Third, LowPassKind::Bessel) => BESSEL_3,
            (LowPass::Fourth, LowPassKind::Bessel) => BESSEL_4,
        }
    }

    /// The amplifier's filters, in words.
    pub fn filters(&self) -> String {
        let kind = match (self.order, self.kind) {
            (LowPass::First, _) => "",
            (_, LowPassKind::Butterworth) => "Butterworth ",
            (_, LowPassKind::Bessel) => "Bessel ",
        };
        let (order, low_khz) = (self.order.name(), to_digits(1e-3 * self.low_pass_hz, 4));
        let high_hz = to_digits(self.high_pass_hz, 4);
        format!(
            "{kind}low-pass of {order} order at {low_khz} kHz, high-pass of first order at {high_hz} Hz"
        )
    }
}

impl Channels {
    /// Number of channels.
    pub const fn count(self) -> usize {
        self as usize + 1
    }
}

impl Recorder {
    /// Samples of a record.
    pub fn samples(&self) -> usize {
        // Rounded: 0.1 s at 1 MHz are 100,000 samples.
        (self.record_s * self.sampling_hz).round() as usize
    }

    fn check(&self, table: &TableView<'_>) -> Result<(), FileProblem> {
        /// A quarter of a minute at 1 MHz.
        const MOST_SAMPLES: f64 = 1.6e7;
        let samples = (self.record_s * self.sampling_hz).round();
        let range_v = self.range_v;
        let level_v = match self.trigger {
            Trigger::Level(level_v) => level_v,
            Trigger::Photogate => 0.0,
        };
        let within = "expected less than `range` either way";
        Err(if !(2.0..=MOST_SAMPLES).contains(&samples) {
            let message = format!("a record of {samples:.0} samples cannot be taken");
            table.problem("record", message, "expected from 2 to 16 million samples")
        } else if self.before_s >= self.record_s {
            let message = "nothing of the record is after the trigger";
            table.problem("before", message, "expected less than `record`")
        } else if self.offset_v.abs() >= range_v {
            let message = format!(
                "no signal at all, {} V, is outside the converter's range of ± {range_v} V: every sample \
                 would be clipped",
                self.offset_v
            );
            table.problem("offset", message, within)
        } else if level_v.abs() >= range_v {
            let message = format!(
                "a level of {level_v} V is outside the converter's range of ± {range_v} V and is never passed"
            );
            table.problem("level", message, within)
        } else {
            return Ok(());
        })
    }
}

impl Campaign {
    /// The campaign of a file; without the table the paper's numbers and the
    /// striker's own speed.
    pub(crate) fn read(
        root: &TableView<'_>,
        striker_m_s: Option<f64>,
    ) -> Result<Self, FileProblem> {
        let table = root.table("campaign");
        let count = |key| table.map_or(Ok(None), |t| t.count(key));
        let part = |key| table.and_then(|t| t.table(key));
        let tap_speed = table.map_or(Ok(None), |t| t.quantity("tap_speed"))?;
        let listed = table.map_or(Ok(Vec::new()), |t| speeds(&t))?;
        let campaign = Self {
            seed: count("seed")?.map_or(1, |seed| seed as u64),
            speeds_m_s: match listed.is_empty() {
                true => striker_m_s.into_iter().collect(),
                false => listed,
            },
            shots: count("shots")?.unwrap_or(20),
            taps: count("taps")?.unwrap_or(40),
            tap_speed_m_s: tap_speed.unwrap_or(0.18),
            laying: Laying::read(part("laying").as_ref())?,
            actuator: Actuator::read(part("actuator").as_ref())?,
            photogate: Photogate::read(part("photogate").as_ref())?,
            amplifier: Amplifier::read(part("amplifier").as_ref())?,
            recorder: Recorder::read(part("recorder").as_ref())?,
        };
        if let Some(table) = part("recorder") {
            campaign.recorder.check(&table)?;
        }
        let actuator = &campaign.actuator;
        match part("actuator") {
            Some(table) if actuator.least_speed_m_s >= actuator.most_speed_m_s => {
                let message = "the slowest shot is not slower than the fastest";
                let label = "expected `least_speed` below `most_speed`";
                Err(FileProblem::new(&table.span(), message, label))
            }
            _ => Ok(campaign),
        }
    }
}

/// The speeds as a list, or in equal ratios from the slowest to the fastest; none without both.
fn speeds(table: &TableView<'_>) -> Result<Vec<f64>, FileProblem> {
    let listed = table.quantities("speeds")?;
    let ends = (table.quantity("slowest")?, table.quantity("fastest")?);
    let count = table.count("speed_count")?;
    let named = ["slowest", "fastest", "speed_count"];
    match (named.iter().find(|key| table.has(key)), ends, count) {
        (Some(key), _, _) if !listed.is_empty() => {
            let problem = table.problem(key, "the speeds are given twice", "expected nothing here");
            Err(problem.also(&table.span_of("speeds"), "they are listed here"))
        }
        (None, _, _) if listed.iter().any(|speed| *speed <= 0.0) => {
            let message = "a speed of `speeds` is not positive";
            Err(table.problem("speeds", message, "expected speeds such as \"0.5 m/s\""))
        }
        (None, _, _) => Ok(listed),
        (Some(_), (Some(slowest), Some(fastest)), Some(count)) if slowest < fastest => {
            let last = count.saturating_sub(1).max(1) as f64;
            let speed = |at: usize| slowest * (fastest / slowest).powf(at as f64 / last);
            Ok((0..count).map(speed).collect())
        }
        (Some(key), _, _) => {
            let label = "expected `slowest` below `fastest`, and `speed_count`";
            Err(table.problem(key, "these speeds are not complete", label))
        }
    }
}

/// The cases of a campaign, in the file's order.
pub(crate) fn cases(
    root: &TableView<'_>,
    materials: &Materials,
    groups: &[BeadGroup],
    liquid: Option<&Liquid>,
) -> Result<Vec<CaseSpec>, FileProblem> {
    let mut cases: Vec<CaseSpec> = Vec::new();
    let tables = root.table("campaign").map(|table| table.tables("cases"));
    for table in tables.into_iter().flatten() {
        let name = table.text("name").unwrap_or_default();
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        if name.is_empty() || !name.chars().all(plain) {
            let message = format!("`{name}` cannot be part of a file's name");
            return Err(table.problem("name", message, "expected letters, digits, `-` and `_`"));
        }
        if cases.iter().any(|other| other.name == name) {
            let message = format!("there are two cases with the name `{name}`");
            return Err(table.problem("name", message, "expected another name"));
        }
        let own = Liquid::read_from(&table)?;
        // Another liquid changes the file's own contacts too.
        let holder = if table.has("contacts") { Some(&table) } else { own.as_ref().map(|_| root) };
        let wet_by = own.as_ref().or(liquid);
        let sections = holder.map(|holder| contacts::read(holder, materials, groups, wet_by));
        cases.push(CaseSpec {
            name: name.to_owned(),
            sections: sections.transpose()?,
            liquid: own,
        });
    }
    Ok(cases)
}

/// The apparatus around a chain, as a file describes it: for drawings and
/// reports, without any effect on what is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Rig {
    /// Material of the beads, in words.
    pub beads: Option<String>,
    /// The parts that the file names, in the order of [`RigPartKind::ALL`].
    pub parts: Vec<RigPart>,
}

/// One part of the apparatus.
#[derive(Clone, Debug, PartialEq)]
pub struct RigPart {
    /// Its purpose.
    pub kind: RigPartKind,
    /// Its name in the file; else that of its kind.
    pub name: String,
    /// Mass in kg.
    pub mass_kg: Option<f64>,
    /// Length in m.
    pub length_m: Option<f64>,
    /// Force on bead 1 in N; of springs.
    pub force_n: Option<f64>,
    /// Bits of a sample; of a recorder.
    pub bits: Option<usize>,
    /// Samples a second in Hz; of a recorder.
    pub rate_hz: Option<f64>,
}

/// Declares the parts of `[rig]`, from the launcher to the far end, with their keys.
macro_rules! parts {
    ($($KeyKind:ident $key:ident $about:literal { $($name:ident: $own:expr, $own_about:literal;)* })+) => {
        /// The purpose of a part.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum RigPartKind {
            $(#[doc = concat!("Part: ", $about, ".")] $KeyKind,)+
        }

        impl RigPartKind {
            /// Every kind, from the launcher to the far end.
            pub const ALL: [Self; [$($about),+].len()] = [$(Self::$KeyKind),+];

            /// Its key in `[rig]`.
            pub const fn key(self) -> &'static str {
                match self {
                    $(Self::$KeyKind => stringify!($key),)+
                }
            }
        }

        /// The parts around the chain, for drawings and reports: nothing is computed from them.
        pub(crate) static RIG: Fields = table! { "[rig]";
            beads: Text, "what the beads are made of, in words";
            $($key: Table(&table! { concat!("[rig.", stringify!($key), "]");
                name: Text, "what drawings and reports call it";
                $($name: $own, $own_about;)*
            }), $about;)+
        };
    };
}

parts! {
    Actuator actuator "what launches the striker" { mass: positive("kg"), "its mass"; length: positive("m"), "its length"; }
    Repositioner repositioner "what brings the striker back to its place" { mass: positive("kg"), "its mass"; length: positive("m"), "its length"; }
    Photogate photogate "what measures the striker's speed" { mass: positive("kg"), "its mass"; length: positive("m"), "its length"; }
    Springs springs "springs that hold bead 1" { force: positive("N"), "force on bead 1 at rest"; length: positive("m"), "its length"; }
    Sensor sensor "force sensors in the sensor bead and at the wall" { mass: positive("kg"), "its mass"; length: positive("m"), "its length"; }
    Recorder recorder "what both sensors are wired to" { bits: from(1), "bits of a sample"; rate: positive("Hz"), "samples a second"; }
    Stop stop "what the far end is fixed to" { mass: positive("kg"), "its mass"; length: positive("m"), "its length"; }
    EndStructure end_structure "the structure that carries the stop" { mass: positive("kg"), "its mass"; length: positive("m"), "its length"; }
    Bar bar "a separate mass against noise" { mass: positive("kg"), "its mass"; length: positive("m"), "its length"; }
}

impl Rig {
    /// A part, if the file names it.
    pub fn part(&self, kind: RigPartKind) -> Option<&RigPart> {
        self.parts.iter().find(|part| part.kind == kind)
    }

    pub(crate) fn read(root: &TableView<'_>) -> Result<Option<Self>, FileProblem> {
        let Some(table) = root.table("rig") else {
            return Ok(None);
        };
        let part = |kind: RigPartKind| {
            let own = table.table(kind.key())?;
            let read = || {
                Ok(RigPart {
                    kind,
                    name: own.text("name").map_or(kind.key().replace('_', " "), str::to_owned),
                    mass_kg: own.quantity("mass")?,
                    length_m: own.quantity("length")?,
                    force_n: own.quantity("force")?,
                    bits: own.count("bits")?,
                    rate_hz: own.quantity("rate")?,
                })
            };
            Some(read())
        };
        let parts = RigPartKind::ALL.into_iter().filter_map(part);
        Ok(Some(Self {
            beads: table.text("beads").map(str::to_owned),
            parts: parts.collect::<Result<_, _>>()?,
        }))
    }
}

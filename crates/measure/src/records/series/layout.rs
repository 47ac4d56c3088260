//! Names in a series' file, for writer and reader alike.

/// Attribute that tells our files, and its value.
pub(super) const FORMAT: (&str, &str) = ("format", "hertzchain series");
/// Version of this layout.
pub(super) const VERSION: (&str, i64) = ("format_version", 1);

/// Readings of the converter, shots × samples: of both sensors in one channel, or
/// of one each.
pub(super) const SUMMED: &[&str] = &["samples"];
pub(crate) const SEPARATE: &[&str] = &["sensor", "wall"];
/// Numbers of the shots; the scale of the first axis.
pub(super) const SHOT: &str = "shot";
/// The second axis, which has no numbers of its own.
pub(super) const SAMPLE: &str = "sample";
/// Speeds that the striker was told, in m/s.
pub(super) const PROGRAMMED: &str = "programmed_speed";
/// Speeds that the photogate measured, in m/s.
pub(super) const MEASURED: &str = "measured_speed";
/// Whether the trigger fired: 1, or 0 where the recorder gave up waiting for it.
pub(super) const TRIGGERED: &str = "triggered";
/// Group of what only a simulation knows. The reader never opens it.
pub(super) const TRUTH: &str = "truth";

/// In it, the numbers of contacts: the second axis of what is told of each.
pub(super) const CONTACT: &str = "contact";

/// Attributes of the samples: the library reads numbers of datasets only.
pub(super) const INTERVAL: &str = "sampling_interval_s";
pub(super) const VOLTS_PER_COUNT: &str = "volts_per_count";
pub(super) const OFFSET: &str = "offset_v";
pub(super) const PRETRIGGER: &str = "pretrigger_samples";

/// Attributes of the file.
pub(super) const SERIES: &str = "series";
pub(super) const CASE: &str = "case";
pub(super) const SEED: &str = "seed";
pub(super) const EXPERIMENT: &str = "experiment";
/// Standard error of the measured speed in m/s; written if the rig tells one.
pub(super) const SPEED_ERROR: &str = "measured_speed_error_m_s";
/// Corner of the amplifier's high-pass in Hz; written if the rig tells one.
pub(super) const HIGH_PASS: &str = "high_pass_hz";
/// Corner of its low-pass in Hz, its order in words and its kind; written if the rig states them.
pub(super) const LOW_PASS: [&str; 3] = ["low_pass_hz", "low_pass_order", "low_pass_kind"];

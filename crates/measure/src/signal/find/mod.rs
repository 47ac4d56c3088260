//! Where a shot's pulses are, from the samples alone.

mod channel;
mod flags;
mod found;
mod select;

pub use self::found::{CompetingMaximum, Found, Normalisation, Pulse, PulseKind, QualityFlag};

use crate::error::{MeasureError, Result};
use channel::{ChannelSignal, FIRST, FIRST_HIGH, FIRST_LOW, Smoothed};
use select::PulseSelection;

/// Samples of a shot: how sensor bead and wall were recorded.
#[derive(Clone, Copy, Debug)]
pub enum Channels<'a> {
    /// Both in one channel, of the same polarity: incident, wall, reflected.
    Summed(&'a [f64]),
    /// One channel each, sampled together.
    Separate {
        /// The sensor bead's.
        sensor: &'a [f64],
        /// The wall's.
        wall: &'a [f64],
    },
}

impl<'a> Channels<'a> {
    /// Samples that hold the sensor's pulses, and those that hold the wall's.
    pub(crate) fn both(&self) -> [&'a [f64]; 2] {
        match self {
            Self::Summed(samples) => [samples; 2],
            Self::Separate { sensor, wall } => [sensor, wall],
        }
    }

    pub(crate) fn of(&self, kind: PulseKind) -> &'a [f64] {
        self.both()[usize::from(kind == PulseKind::Wall)]
    }

    pub(crate) fn is_summed(&self) -> bool {
        matches!(self, Self::Summed(_))
    }
}

/// Direction of pulses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Polarity {
    /// That of the larger swing from the baseline.
    #[default]
    Auto,
    /// Up.
    Positive,
    /// Down.
    Negative,
}

/// The two ends of a digitiser's range, in the samples' unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DigitiserRange {
    /// Least number that can be recorded.
    pub low: f64,
    /// Largest number that can be recorded.
    pub high: f64,
}

impl DigitiserRange {
    /// Whether a sample is at an end of the range or beyond, to 10⁻⁹ of the range: converting
    /// digits to volts rounds.
    pub(crate) fn clips(&self, sample: f64) -> bool {
        let range = self.high - self.low;
        let rounding = if range.is_finite() { 1e-9 * range } else { 0.0 };
        sample <= self.low + rounding || sample >= self.high - rounding
    }

    /// Whether at least `shortest` samples in a row are at an end of the range.
    ///
    /// Of an unknown digitiser give the record's own extremes and a `shortest` that no round top
    /// reaches: a bell of width w (full width at half maximum, in samples) and H steps high has
    /// some 0.9 w/√H equal samples.
    pub(crate) fn clips_run(&self, samples: &[f64], shortest: usize) -> bool {
        let mut runs = samples.chunk_by(|a, b| self.clips(*a) == self.clips(*b));
        runs.any(|run| run.len() >= shortest && self.clips(run[0]))
    }
}

/// Widths and heights of pulses that distinguish them. Defaults hold for compact rows of
/// equal Hertz beads, dry and wet, between 0.06 and 2.4 m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulseLimits {
    /// Beads a wave passes while a sensor bead sees half its maximum or more: 2.07, as computed
    /// waves pass 33 beads in 16 such times.
    pub width_beads: f64,
    /// Least height of the wall's pulse over the incident one's: 0.42, where computed rows have 0.48
    /// (weak shots in gear oil) to 1.9 (dry).
    pub wall_over_incident_min: f64,
    /// Largest height of the reflected pulse over the incident one's: 0.7, where computed rows have
    /// up to 0.67.
    pub reflected_over_incident_max: f64,
    /// Least height of the reflected pulse over the wall's: 0.15, where computed rows have 0.20 to
    /// 0.35.
    pub reflected_over_wall_min: f64,
}

impl Default for PulseLimits {
    fn default() -> Self {
        Self {
            width_beads: 2.07,
            wall_over_incident_min: 0.42,
            reflected_over_incident_max: 0.7,
            reflected_over_wall_min: 0.15,
        }
    }
}

/// What is known of a record before its pulses are searched for; nothing need be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FindOptions {
    /// Polarity of the sensor's, or of the summed channel.
    pub polarity: Polarity,
    /// Polarity of the wall's channel, if it has one.
    pub wall_polarity: Polarity,
    /// Number N of beads and the sensor bead's number n, 1 ≤ n < N: they bound
    /// when the wall's and the reflected pulse can come.
    pub beads: Option<(usize, usize)>,
    /// Widths and heights of the row's pulses.
    pub limits: PulseLimits,
    /// The digitiser's range in the sensor's, or in the summed channel; without it, long runs at
    /// a record's extremes count as saturated.
    pub range: Option<DigitiserRange>,
    /// The same in the wall's channel, if it has one.
    pub wall_range: Option<DigitiserRange>,
}

impl FindOptions {
    /// Ranges of the channels that hold the sensor's and the wall's pulses.
    pub(crate) fn ranges(&self, channels: Channels<'_>) -> [Option<DigitiserRange>; 2] {
        match channels {
            Channels::Summed(_) => [self.range; 2],
            Channels::Separate { .. } => [self.range, self.wall_range],
        }
    }

    fn check(&self) -> Result<()> {
        MeasureError::positive("width of a pulse in beads", self.limits.width_beads)?;
        let Some((beads, sensor)) = self.beads else {
            return Ok(());
        };
        MeasureError::require(
            (1..beads).contains(&sensor),
            "number of the sensor bead",
            sensor as f64,
            "1 or more, and less than the number of beads",
        )
    }
}

/// Finds the incident, the wall's and the reflected pulse of one shot.
///
/// The rules are those of a computed shot: the wall's pulse is the largest maximum at the wall, the
/// incident pulse the largest before it at the sensor, the reflected one the largest at the sensor
/// from 0.6 to three incident times after it: before that comes crosstalk of the wall's pulse. In a
/// summed channel the wall's pulse is the largest after the first pulse; the reflected one is
/// searched for until the wall could be reached again. One shot a record: cut longer ones first.
///
/// Signals are smoothed for this only as far as their noise requires, over at most a quarter of a
/// pulse; the reflected one, the weakest, by its own signal-to-noise ratio. A pulse must rise and
/// fall by five deviations of the remaining noise. Where another maximum of a pulse is nearly as
/// high, fits to both decide: see [`CompetingMaximum`].
///
/// # Errors
/// Too few, not finite or constant samples; no pulse at all; channels of different lengths; options
/// out of range. A missing wall or reflected pulse is no error but a [`QualityFlag`].
pub fn pulses(channels: Channels<'_>, options: &FindOptions) -> Result<Found> {
    conditioned_pulses(channels, channels, options)
}

/// As [`pulses`], of samples that were filtered after they were recorded.
pub(crate) fn conditioned_pulses(
    channels: Channels<'_>,
    recorded: Channels<'_>,
    options: &FindOptions,
) -> Result<Found> {
    options.check()?;
    let (mut found, others) = match channels {
        Channels::Summed(samples) => summed(samples, options),
        Channels::Separate { sensor, wall } => separate(sensor, wall, options),
    }?;
    flags::flag_digitiser(&mut found, recorded, options);
    flags::compare_maxima(&mut found, &others, channels);
    if channels.is_summed() {
        // Where a clipped pulse has its maximum is chance.
        let clipped = |pulse: &Pulse| found.flags.contains(&QualityFlag::Saturation(pulse.kind));
        let asymmetric = found.pulses().filter(|p| !clipped(p) && p.is_asymmetric());
        let asymmetric: Vec<_> = asymmetric.map(|p| QualityFlag::Asymmetric(p.kind)).collect();
        found.flag(asymmetric);
    }
    Ok(found)
}

/// Polarity, offset and noise of one channel, without finding all its pulses.
///
/// # Errors
/// As [`pulses`].
pub fn normalisation(samples: &[f64], polarity: Polarity) -> Result<Normalisation> {
    ChannelSignal::new(samples, polarity, FIRST).map(|channel| channel.normalisation)
}

/// What was found, and other maxima that could be the largest of their pulses.
type Gathered = (Found, Vec<Pulse>);

fn summed(samples: &[f64], options: &FindOptions) -> Result<Gathered> {
    let doubtful = [QualityFlag::Order, QualityFlag::Unidentified];
    let is_complete = |(found, _): &Gathered| {
        found.pulses().count() == 3 && !doubtful.iter().any(|flag| found.flags.contains(flag))
    };
    let usual = summed_above(samples, options, FIRST)?;
    if is_complete(&usual) {
        return Ok(usual);
    }
    let (found, _) = &usual;
    let share = if is_hum(found.incident, found.wall) { FIRST_HIGH } else { FIRST_LOW };
    let other = summed_above(samples, options, share);
    Ok(other.ok().filter(is_complete).unwrap_or(usual))
}

/// Width of what was taken for the incident pulse over that of the wall's from which on it is no pulse
/// of the same wave, if it stands above the baseline from the first sample on. Those of 4,000 shots of
/// chains at random have up to 1.3, hum of the mains 8 and more; trains of heavy strikers have 7, but
/// begin within the record.
const WIDEST: f64 = 3.0;

fn is_hum(incident: Option<Pulse>, wall: Option<Pulse>) -> bool {
    let cut = incident.filter(|incident| incident.extent.0 == 0);
    let pair = cut.zip(wall);
    pair.is_some_and(|(incident, wall)| incident.width_samples > WIDEST * wall.width_samples)
}

/// The pulses of a channel whose first one exceeds a share of the largest swing.
fn summed_above(samples: &[f64], options: &FindOptions, share: f64) -> Result<Gathered> {
    let channel = ChannelSignal::new(samples, options.polarity, share)?;
    let end = select::end_of_interest(&channel, options);
    let mut smoothed = Smoothed::of_all(&channel, end);
    let mut selection = select::summed(&smoothed, options);
    if smoothed.retain_significant(selection.windows[2]) {
        selection = select::summed(&smoothed, options);
    }
    let reflected = smooth_reflected(&channel, &mut selection, end);
    if selection.maxima[2].is_some() && reflected.is_none() {
        let (from, to) = selection.windows[2];
        let outside = |at: f64| at <= from || at >= to;
        smoothed.maxima.retain(|m| outside(m.at as f64));
        selection = select::summed(&smoothed, options);
    }
    let back = reflected.as_ref().unwrap_or(&smoothed);
    Ok(gather(&selection, [&smoothed, &smoothed, back]))
}

fn separate(sensor: &[f64], wall: &[f64], options: &FindOptions) -> Result<Gathered> {
    if sensor.len() != wall.len() {
        return Err(MeasureError::Lengths(format!(
            "the sensor's channel has {} samples and the wall's {}: they must be recorded together",
            sensor.len(),
            wall.len()
        )));
    }
    let channel = ChannelSignal::new(sensor, options.polarity, FIRST)?;
    let wall = ChannelSignal::new(wall, options.wall_polarity, FIRST)?;
    let reached = wall.first + wall.width as usize;
    let time = reached.saturating_sub(channel.first);
    let end = reached + 4 * time + 3 * channel.width as usize;
    let mut sensor = Smoothed::of_all(&channel, end);
    let wall = Smoothed::of_all(&wall, end);
    let mut selection = select::separate(&sensor, &wall, options);
    if sensor.retain_significant(selection.windows[2]) {
        selection = select::separate(&sensor, &wall, options);
    }
    let reflected = smooth_reflected(&channel, &mut selection, end);
    if reflected.is_none() {
        selection.maxima[2] = None;
    }
    let back = reflected.as_ref().unwrap_or(&sensor);
    Ok(gather(&selection, [&sensor, &wall, back]))
}

/// Smooths the reflected pulse, which has a tenth of the highest pulse's height, by its own
/// signal-to-noise ratio: with less, single samples would choose among its fragments.
fn smooth_reflected<'a>(
    channel: &'a ChannelSignal<'a>,
    selection: &mut PulseSelection,
    end: usize,
) -> Option<Smoothed<'a>> {
    let (from, to) = selection.windows[2];
    let back = selection.maxima[2].filter(|_| to > from)?;
    let start = (from - channel.width).max(0.0) as usize;
    let mut smoothed = Smoothed::new(channel, start..end, back.height);
    smoothed.retain_significant((from, to));
    selection.maxima[2] = Some(select::largest(&smoothed.maxima, from, to)?);
    Some(smoothed)
}

/// Pulses with their quality flags, each from the stretch smoothed for it.
fn gather(selection: &PulseSelection, views: [&Smoothed<'_>; 3]) -> Gathered {
    let pulse = |i: usize| {
        let maximum = selection.maxima[i].as_ref();
        maximum.map(|maximum| views[i].pulse(PulseKind::ALL[i], maximum))
    };
    let pulses: [Option<Pulse>; 3] = std::array::from_fn(pulse);
    let others = (0..3).flat_map(|i| {
        let own = selection.maxima[i].iter();
        let maxima = own.flat_map(move |own| {
            flags::other_maxima(views[i], selection.windows[i], own, PulseKind::ALL[i])
        });
        maxima.map(move |other| views[i].pulse(PulseKind::ALL[i], &other))
    });
    let [sensor, wall, _] = views.map(|view| view.channel);
    let missing = |kind: &PulseKind| pulses[*kind as usize].is_none();
    let missing = PulseKind::ALL.into_iter().filter(missing);
    let mut flags: Vec<QualityFlag> = match selection.unidentified {
        true => vec![QualityFlag::Unidentified],
        false => missing.map(QualityFlag::Missing).collect(),
    };
    flags.extend(pulse_flags(&pulses, views));
    if let [Some(first), Some(second), None] = pulses
        && select::ends_early(first.at, second.at, sensor.samples.len())
    {
        flags.push(QualityFlag::RecordTooShort);
    }
    let order_doubtful = selection.order_doubtful || is_hum(pulses[0], pulses[1]);
    flags.extend(order_doubtful.then_some(QualityFlag::Order));
    let rough = |channel: &ChannelSignal<'_>| channel.normalisation.baseline.quiet_samples == 0;
    let rough = rough(sensor) || rough(wall);
    flags.extend(rough.then_some(QualityFlag::FewQuietSamples));
    let others = others.collect();
    let [incident, at_wall, reflected] = pulses;
    let mut found = Found {
        incident,
        wall: at_wall,
        reflected,
        competing: Vec::new(),
        flags: Vec::new(),
        sensor: sensor.normalisation,
        wall_channel: wall.normalisation,
    };
    found.flag(flags);
    (found, others)
}

/// Height over noise below which a pulse is low: 20 dB.
const LOW: f64 = 10.0;
/// Samples across the half maximum below which means of four hide a pulse.
const FEW: f64 = 5.0;

fn pulse_flags(pulses: &[Option<Pulse>; 3], views: [&Smoothed<'_>; 3]) -> Vec<QualityFlag> {
    let seen: Vec<(&Pulse, &Smoothed<'_>)> = pulses
        .iter()
        .zip(views)
        .filter_map(|(pulse, view)| Some((pulse.as_ref()?, view)))
        .collect();
    let summed = std::ptr::eq(views[0].channel, views[1].channel);
    let mut flags = Vec::new();
    for (i, (pulse, view)) in seen.iter().enumerate() {
        let kind = pulse.kind;
        let middle = |other: &Pulse| usize::midpoint(other.at, pulse.at);
        let before = i.checked_sub(1).and_then(|i| seen.get(i));
        let after = seen.get(i + 1);
        let from = before.map_or(0, |(other, _)| middle(other));
        let to = after.map_or(usize::MAX, |(other, _)| middle(other));
        let cut = pulse.extent.0 == 0 || pulse.extent.1 + 1 >= view.channel.samples.len();
        let low = pulse.height < LOW * view.channel.normalisation.baseline.noise;
        let overlap = after.filter(|(next, _)| summed && view.overlaps(pulse, next));
        let checks = [
            (view.is_split(pulse, (from, to)), QualityFlag::Split(kind)),
            (low, QualityFlag::LowSignal(kind)),
            (cut, QualityFlag::RecordTooShort),
            (pulse.width_samples < FEW, QualityFlag::FewSamples(kind)),
        ];
        flags.extend(checks.into_iter().filter_map(|(is_so, flag)| is_so.then_some(flag)));
        flags.extend(overlap.map(|(next, _)| QualityFlag::Overlap(kind, next.kind)));
    }
    flags
}

#[cfg(test)]
#[path = "../tests/saturation.rs"]
mod tests;

//! Where a shot's pulses are, from the samples alone.

mod choose;
mod digitiser;
mod doubts;
mod found;
mod options;
mod rivals;
mod significance;
mod smooth;
mod track;

pub use found::{Doubt, Found, Place, Pulse, Rival, Upright};
pub use options::{Channels, Finding, Polarity};

use crate::signal::error::SignalError;
use choose::Chosen;
use doubts::Seen;
use smooth::{Maximum, Smooth};
use std::array::from_fn;
use std::ops::Range;
use track::Track;

/// Finds the passing, the wall's and the returning pulse of one shot.
///
/// The rules are those of a computed shot: the wall's pulse is the largest
/// maximum at the wall, the passing pulse the largest before it at the sensor,
/// the returning one the largest at the sensor from 0.6 to three incident times
/// after it: before that comes what the wall's pulse leaves in the sensor's channel by crosstalk. In a summed channel the wall's pulse is the largest after the
/// first pulse; the return is looked for from 0.6 incident times after it until
/// the wall could be reached again. One shot a record: cut longer ones first.
///
/// Signals are smoothed for this only as far as their noise asks for, over at
/// most a quarter of a pulse; the return, which is the weakest, as far as its own height
/// asks for. A pulse must rise and fall by five deviations of the noise left. Where another
/// maximum of a pulse is nearly as high, fits to both tell which is the largest: see [`Rival`].
///
/// # Errors
/// Too few, not finite or constant samples; no pulse at all; channels of
/// different lengths; options out of range. A missing wall or return is no
/// error but a [`Doubt`].
pub fn pulses(channels: Channels<'_>, finding: &Finding) -> Result<Found, SignalError> {
    conditioned_pulses(channels, channels, finding)
}

/// As [`pulses`], of samples that were filtered after they were recorded.
pub(crate) fn conditioned_pulses(
    channels: Channels<'_>,
    recorded: Channels<'_>,
    finding: &Finding,
) -> Result<Found, SignalError> {
    finding.check()?;
    let (mut found, others) = match channels {
        Channels::Summed(samples) => summed(samples, finding),
        Channels::Separate { sensor, wall } => separate(sensor, wall, finding),
    }?;
    digitiser::judge(&mut found, recorded, finding);
    rivals::tell(&mut found, &others, channels);
    if let Channels::Summed(_) = channels {
        found.doubt(doubts::trailing(&found));
    }
    Ok(found)
}

/// Offset, noise and direction of one channel, without looking for all its pulses.
///
/// # Errors
/// As [`pulses`].
pub fn upright(samples: &[f64], polarity: Polarity) -> Result<Upright, SignalError> {
    Track::new(samples, polarity).map(|track| track.upright)
}

/// What was found, and other maxima that could be the largest of their pulses.
type Looked = (Found, Vec<Pulse>);

fn summed(samples: &[f64], finding: &Finding) -> Result<Looked, SignalError> {
    let track = Track::new(samples, finding.polarity)?;
    let end = choose::end_of_interest(&track, finding);
    let (smooth, mut maxima) = look(&track, end);
    let mut chosen = choose::summed(&maxima, &track, finding);
    if significance::retain(&mut maxima, &track, &smooth, chosen.windows[2]) {
        chosen = choose::summed(&maxima, &track, finding);
    }
    let mut closer = closer(&View::new(&track, &smooth, &maxima), &mut chosen, end);
    if chosen.returning.is_some() && closer.is_none() {
        let (from, to) = chosen.windows[2];
        maxima.retain(|m| (m.at as f64) <= from || (m.at as f64) >= to);
        chosen = choose::summed(&maxima, &track, finding);
        closer = None;
    }
    let one = View::new(&track, &smooth, &maxima);
    let back = closer
        .as_ref()
        .map_or(one, |(s, m)| View::new(&track, s, m));
    Ok(gather(&chosen, [one, one, back]))
}

fn separate(sensor: &[f64], wall: &[f64], finding: &Finding) -> Result<Looked, SignalError> {
    if sensor.len() != wall.len() {
        return Err(SignalError::Lengths {
            sensor: sensor.len(),
            wall: wall.len(),
        });
    }
    let track = Track::new(sensor, finding.polarity)?;
    let wall = Track::new(wall, finding.wall_polarity)?;
    let began = track.first;
    let reached = wall.first + wall.width as usize;
    let end = reached + 4 * reached.saturating_sub(began) + 3 * track.width as usize;
    let (sensor_smooth, mut sensor_maxima) = look(&track, end);
    let (wall_smooth, wall_maxima) = look(&wall, end);
    let mut chosen = choose::separate(&sensor_maxima, &wall_maxima, &track, finding);
    if significance::retain(
        &mut sensor_maxima,
        &track,
        &sensor_smooth,
        chosen.windows[2],
    ) {
        chosen = choose::separate(&sensor_maxima, &wall_maxima, &track, finding);
    }
    let sensor = View::new(&track, &sensor_smooth, &sensor_maxima);
    let wall = View::new(&wall, &wall_smooth, &wall_maxima);
    let closer = closer(&sensor, &mut chosen, end);
    if closer.is_none() {
        chosen.returning = None;
    }
    let back = closer.as_ref();
    let back = back.map_or(sensor, |(s, m)| View::new(&track, s, m));
    Ok(gather(&chosen, [sensor, wall, back]))
}

/// Smoothes a track from before its first pulse on, and finds its maxima.
fn look(track: &Track<'_>, end: usize) -> (Smooth, Vec<Maximum>) {
    let start = track.first.saturating_sub((3.0 * track.width) as usize);
    let range = (start as f64, end as f64);
    let highest = choose::largest_block(track, range.0, range.1)
        .map_or(0.0, |at| track.block_height(at / track::BLOCK));
    look_at(track, start..end, highest)
}

/// Smoothes a stretch as far as a pulse so high asks for, and finds its maxima.
fn look_at(track: &Track<'_>, stretch: Range<usize>, height: f64) -> (Smooth, Vec<Maximum>) {
    let smooth = Smooth::of(track, stretch, height);
    let least = (5.0 * smooth.noise).max(0.005 * height);
    let mut maxima = smooth.maxima(least);
    maxima.retain(|m| m.height > least);
    (smooth, maxima)
}

/// A channel as it is looked at for one pulse.
#[derive(Clone, Copy)]
struct View<'a, 'b> {
    track: &'a Track<'b>,
    smooth: &'a Smooth,
    maxima: &'a [Maximum],
}

impl<'a, 'b> View<'a, 'b> {
    fn new(track: &'a Track<'b>, smooth: &'a Smooth, maxima: &'a [Maximum]) -> Self {
        Self {
            track,
            smooth,
            maxima,
        }
    }
}

/// Looks again for the return, which has a tenth of the highest pulse's height: left as rough as
/// that one bears, single samples would choose among its fragments and end its width.
fn closer(
    sensor: &View<'_, '_>,
    chosen: &mut Chosen,
    end: usize,
) -> Option<(Smooth, Vec<Maximum>)> {
    let (from, to) = chosen.windows[2];
    let back = chosen.returning.filter(|_| to > from)?;
    let start = (from - sensor.track.width).max(0.0) as usize;
    let (smooth, mut maxima) = look_at(sensor.track, start..end, back.height);
    significance::retain(&mut maxima, sensor.track, &smooth, (from, to));
    let largest = choose::largest(&maxima, from, to)?;
    chosen.returning = Some(largest);
    Some((smooth, maxima))
}

fn gather(chosen: &Chosen, views: [View<'_, '_>; 3]) -> Looked {
    let places = [Place::Passing, Place::Wall, Place::Returning];
    let maxima = [chosen.passing, chosen.wall, chosen.returning];
    let seen: [Option<Seen<'_, '_>>; 3] =
        from_fn(|i| maxima[i].map(|maximum| seen(&views[i], places[i], &maximum)));
    let others = (0..3).flat_map(|i| {
        let own = maxima[i].iter();
        let others = own.flat_map(move |own| {
            rivals::others(views[i].maxima, chosen.windows[i], own, views[i].smooth)
        });
        others.map(move |other| seen_pulse(&views[i], places[i], &other))
    });
    let [passing, at_wall, returning] = seen.each_ref().map(|s| s.as_ref().map(|s| s.pulse));
    let [sensor, wall, _] = views.map(|view| view.track);
    let mut doubts: Vec<Doubt> = match chosen.lost {
        true => vec![Doubt::Lost],
        false => doubts::missing(&[passing, at_wall, returning]).collect(),
    };
    doubts.extend(each(&seen, std::ptr::eq(sensor, wall)));
    if let (Some(first), Some(second), None) = (passing, at_wall, returning)
        && choose::ends_early(first.at, second.at, sensor.samples.len())
    {
        doubts.push(Doubt::RecordTooShort);
    }
    doubts.extend(chosen.order_doubtful.then_some(Doubt::Order));
    let rough = [sensor, wall]
        .iter()
        .any(|t| t.upright.level.quiet_samples == 0);
    doubts.extend(rough.then_some(Doubt::FewQuietSamples));
    let mut found = Found {
        passing,
        wall: at_wall,
        returning,
        rivals: Vec::new(),
        doubts: Vec::new(),
        sensor: sensor.upright,
        wall_channel: wall.upright,
    };
    found.doubt(doubts);
    (found, others.collect())
}

/// Doubts about each pulse and about neighbours.
fn each(seen: &[Option<Seen<'_, '_>>; 3], one_channel: bool) -> Vec<Doubt> {
    let seen: Vec<&Seen<'_, '_>> = seen.iter().flatten().collect();
    let mut doubts = Vec::new();
    for (i, here) in seen.iter().enumerate() {
        let middle = |other: &Seen<'_, '_>| usize::midpoint(other.pulse.at, here.pulse.at);
        let before = i.checked_sub(1).and_then(|i| seen.get(i));
        let after = seen.get(i + 1);
        let from = before.map_or(0, |other| middle(other));
        let to = after.map_or(usize::MAX, |other| middle(other));
        doubts.extend(here.doubts((from, to)));
        if let Some(next) = after
            && one_channel
            && doubts::overlap(here, next)
        {
            doubts.push(Doubt::Overlap(here.pulse.place, next.pulse.place));
        }
    }
    doubts
}

fn seen<'a, 'b>(view: &View<'a, 'b>, place: Place, maximum: &Maximum) -> Seen<'a, 'b> {
    Seen {
        pulse: seen_pulse(view, place, maximum),
        track: view.track,
        smooth: view.smooth,
    }
}

fn seen_pulse(view: &View<'_, '_>, place: Place, maximum: &Maximum) -> Pulse {
    let smooth = view.smooth;
    let (from, to) = smooth.reach(maximum, 0.1 * maximum.height);
    let sides_samples = smooth.sides(maximum);
    let last = view.track.samples.len().saturating_sub(1);
    Pulse {
        place,
        at: maximum.at,
        height: maximum.height,
        width_samples: sides_samples.0 + sides_samples.1,
        sides_samples,
        extent: (from as usize, (to.ceil() as usize).min(last)),
        clipped: None,
    }
}

//! What is doubtful about the pulses found.

use super::smooth::Smooth;
use super::track::Track;
use super::{Doubt, Found, Place, Pulse};

/// One pulse with the channel and the smoothed stretch it was found in.
pub(super) struct Seen<'a, 'b> {
    pub(super) pulse: Pulse,
    pub(super) track: &'a Track<'b>,
    pub(super) smooth: &'a Smooth,
}

/// Height over noise below which a pulse is low: 20 dB.
const LOW: f64 = 10.0;

/// Samples across the half maximum below which means of four hide a pulse.
const FEW: f64 = 5.0;

impl Seen<'_, '_> {
    /// Doubts about this pulse alone, given the samples between which it has no neighbour.
    pub(super) fn doubts(&self, alone: (usize, usize)) -> Vec<Doubt> {
        let place = self.pulse.place;
        let noise = self.track.upright.level.noise;
        let checks = [
            (self.split(alone), Doubt::Split(place)),
            (self.pulse.height < LOW * noise, Doubt::LowSignal(place)),
            (self.cut_off(), Doubt::RecordTooShort),
            (self.pulse.width_samples < FEW, Doubt::FewSamples(place)),
        ];
        let raised = checks.into_iter().filter(|(raised, _)| *raised);
        raised.map(|(_, doubt)| doubt).collect()
    }

    /// Another maximum within five widths, a quarter as high or more.
    fn split(&self, (from, to): (usize, usize)) -> bool {
        let reach = (5.0 * self.pulse.width_samples) as usize;
        let from = from.max(self.pulse.at.saturating_sub(reach));
        let to = to.min(self.pulse.at + reach);
        let drop = (5.0 * self.smooth.noise).max(0.1 * self.pulse.height);
        let maxima = self.smooth.maxima(drop);
        let near = maxima.iter().filter(|m| (from..=to).contains(&m.at));
        near.filter(|m| m.height >= 0.25 * self.pulse.height)
            .count()
            > 1
    }

    fn cut_off(&self) -> bool {
        let (from, to) = self.pulse.extent;
        from == 0 || to + 1 >= self.track.samples.len()
    }
}

/// Whether the signal between two pulses of one channel stays above a tenth of the lower.
pub(super) fn overlap(one: &Seen<'_, '_>, other: &Seen<'_, '_>) -> bool {
    let between = one.pulse.at..=other.pulse.at;
    let lowest = between.map(|i| one.smooth.height(i));
    let valley = lowest.fold(f64::INFINITY, f64::min);
    let lower = one.pulse.height.min(other.pulse.height);
    valley > (0.1 * lower).max(5.0 * one.smooth.noise)
}

/// Missing pulses.
pub(super) fn missing(found: &[Option<Pulse>; 3]) -> impl Iterator<Item = Doubt> {
    let places = [Place::Passing, Place::Wall, Place::Returning];
    let pairs = places.into_iter().zip(found);
    pairs.filter_map(|(place, pulse)| pulse.is_none().then_some(Doubt::Missing(place)))
}

/// Pulses that trail in a summed channel; where a clipped one has its maximum is chance.
pub(super) fn trailing(found: &Found) -> Vec<Doubt> {
    let clipped = |pulse: &&Pulse| found.doubts.contains(&Doubt::Saturation(pulse.place));
    let whole = found.pulses().filter(|pulse| !clipped(pulse));
    let trail = whole.filter(|pulse| pulse.trails());
    trail.map(|pulse| Doubt::Trailing(pulse.place)).collect()
}

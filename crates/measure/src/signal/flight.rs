//! From a shot's samples to its times of flight.

use std::borrow::Cow;

use crate::error::{MeasureError, Result};
use crate::signal::drift::{self, Detrended, MARGIN};
use crate::signal::find::conditioned_pulses;
use crate::signal::pick::{PulseSamples, pick};
use crate::signal::tones::Tones;
use crate::signal::{
    Bandwidth, Channels, CompetingPick, Estimate, FindOptions, Found, LowPass, Method, Picked,
    Picks, Polarity, Pulse, PulseKind, QualityFlag, Systematic, invert_high_pass, normalisation,
    without_spikes,
};

/// Railways have 16.7 Hz, aircraft 400 Hz.
const LEAST_MAINS_HZ: f64 = 10.0;
const MOST_MAINS_HZ: f64 = 1000.0;

/// Conditioning of a shot's samples, and how its pulses are found and picked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SignalOptions {
    /// What is known of the record and its pulses.
    pub find: FindOptions,
    /// How pulses' times are defined.
    pub method: Method,
    /// Time constant in s of the amplifier's high-pass, if AC coupling is to be corrected.
    pub high_pass_s: Option<f64>,
    /// A zero-phase low-pass to be applied.
    pub low_pass: Option<LowPass>,
    /// The amplifier's low-pass, if its effects on maxima are to be corrected.
    pub bandwidth: Option<Bandwidth>,
    /// Frequency of the mains in Hz, at multiples of which sines before a shot are held.
    pub mains_hz: Option<f64>,
    /// What is known of the sensors.
    pub calibration: SensorCalibration,
}

/// Calibration of the sensor bead's and the wall's sensor. Errors of it are those of a fit's systematic
/// parameters, not of a shot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensorCalibration {
    /// Sensitivities of both in V/N, if heights are to be forces.
    pub sensitivities_v_n: Option<[f64; 2]>,
    /// By how much the wall's channel is late, in s; 0 of a summed channel.
    pub skew_s: f64,
}

impl SensorCalibration {
    /// The sensitivity in V/N of the sensor that sees a pulse.
    pub(crate) fn sensitivity_v_n(&self, kind: PulseKind) -> Option<f64> {
        self.sensitivities_v_n.map(|both| both[usize::from(kind == PulseKind::Wall)])
    }

    fn check(&self, channels: Channels<'_>) -> Result<()> {
        let sensitivities = self.sensitivities_v_n.into_iter().flatten();
        for sensitivity in sensitivities {
            MeasureError::positive("sensitivity in V/N", sensitivity)?;
        }
        let accepted = self.skew_s == 0.0 || (self.skew_s.is_finite() && !channels.is_summed());
        let expected = "0 where one channel sums both sensors; name the two channels";
        MeasureError::require(accepted, "skew in s", self.skew_s, expected)
    }
}

/// A measured shot.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Its pulses and quality flags.
    pub found: Found,
    /// Times of flight, or why there are none.
    pub flight: Result<Flight>,
    /// Samples about its pulses, from which shots of one speed have one shape.
    pub samples: [Option<Box<PulseSamples>>; 3],
}

/// Finds and picks the pulses of one shot.
///
/// # Errors
/// As [`pulses`](crate::signal::pulses); a time constant that is not positive, or a low-pass of an
/// order or corner that filters can't have. A shot whose pulses are found in part is no error: its
/// `flight` is.
pub fn measure(
    channels: Channels<'_>,
    interval_s: f64,
    options: &SignalOptions,
) -> Result<Measured> {
    MeasureError::positive("sampling interval in s", interval_s)?;
    options.calibration.check(channels)?;
    if let Some(hz) = options.mains_hz {
        let accepted = (LEAST_MAINS_HZ..=MOST_MAINS_HZ).contains(&hz);
        MeasureError::require(accepted, "mains frequency in Hz", hz, "a number from 10 to 1000")?;
    }
    let find = &options.find;
    let sign = if find.wall_polarity == Polarity::Negative { -1.0 } else { 1.0 };
    let accepted = find.wall_polarity == Polarity::Auto || !channels.is_summed();
    let expected = "none where one channel sums both sensors; name the two channels";
    MeasureError::require(accepted, "polarity of the wall's channel", sign, expected)?;
    let polarities = [find.polarity, find.wall_polarity];
    let raw = channels.both();
    let count = if channels.is_summed() { 1 } else { 2 };
    let repaired: Vec<_> = raw[..count].iter().map(|raw| without_spikes(raw)).collect();
    let spikes: usize = repaired.iter().map(|(_, spikes)| spikes.len()).sum();
    let mut conditioned: Vec<Cow<'_, [f64]>> = repaired
        .iter()
        .zip(polarities)
        .map(|((samples, _), polarity)| options.condition(samples, interval_s, polarity))
        .collect::<Result<_, _>>()?;
    let recorded: Vec<&[f64]> = repaired.iter().map(|(samples, _)| &samples[..]).collect();
    let recorded = channels_of(&recorded);
    let (found, calm) = without_hum(&conditioned, interval_s, (recorded, find))?;
    let tones = subtract_tones(&found, &mut conditioned, interval_s, options.mains_hz);
    let (mut found, calm) = match tones.iter().any(Option::is_some) {
        true => without_hum(&conditioned, interval_s, (recorded, find))?,
        false => (found, calm),
    };
    let drifts: Vec<Option<Detrended>> =
        (0..count).map(|of| drift(&found, &conditioned, calm[of].as_deref(), of)).collect();
    let has_drift = drifts.iter().any(Option::is_some) || calm.iter().any(Option::is_some);
    if has_drift {
        for ((samples, drift), calm) in conditioned.iter_mut().zip(&drifts).zip(&calm) {
            if let Some(without) = drift.as_ref().map(|drift| &drift.samples).or(calm.as_ref()) {
                *samples = Cow::Borrowed(without);
            }
        }
        found = conditioned_pulses(channels_of(&conditioned), recorded, find)?;
    }
    let channels = channels_of(&conditioned);
    options.spread_clipping(&mut found, interval_s);
    let changed = options.high_pass_s.is_some() || options.low_pass.is_some();
    let ranges = if changed { [None; 2] } else { find.ranges(channels) };
    let picks = pick(channels, interval_s, &found, &options.method, (ranges, options.bandwidth));
    let (flight, samples) = timed(picks, (&drifts, &tones), interval_s, options.calibration);
    let none_reflected = flight.as_ref().is_ok_and(|f| f.reflected_s.is_none());
    let not_picked = none_reflected && found.reflected.is_some();
    found.flag(not_picked.then_some(QualityFlag::NotPicked(PulseKind::Reflected)));
    found.flag((spikes > 0).then_some(QualityFlag::Spikes(spikes)));
    let is_subtracted = has_drift || tones.iter().any(Option::is_some);
    found.flag(is_subtracted.then_some(QualityFlag::Drift));
    Ok(Measured { found, flight, samples })
}

fn channels_of<T: AsRef<[f64]>>(samples: &[T]) -> Channels<'_> {
    match samples {
        [sensor, wall] => Channels::Separate { sensor: sensor.as_ref(), wall: wall.as_ref() },
        one => Channels::Summed(one.first().map_or(&[], AsRef::as_ref)),
    }
}

/// Pulses of a shot, and its channels less their hum, if that is high and wide enough to be taken for one.
fn without_hum(
    channels: &[Cow<'_, [f64]>],
    interval_s: f64,
    (recorded, find): (Channels<'_>, &FindOptions),
) -> Result<(Found, Vec<Option<Vec<f64>>>)> {
    let mut calm: Vec<_> = channels.iter().map(|one| drift::without_hum(one, interval_s)).collect();
    if calm.iter().any(Option::is_some) {
        let either: Vec<&[f64]> =
            calm.iter().zip(channels).map(|(calm, own)| calm.as_deref().unwrap_or(own)).collect();
        if let Ok(found) = conditioned_pulses(channels_of(&either), recorded, find) {
            for (calm, own) in calm.iter_mut().zip(channels) {
                *calm = calm.take().filter(|calm| drift::is_hum(&found, own, calm, interval_s));
            }
            if calm.iter().any(Option::is_some) {
                return Ok((found, calm));
            }
        }
    }
    let found = conditioned_pulses(channels_of(channels), recorded, find)?;
    Ok((found, vec![None; channels.len()]))
}

/// Subtracts from each channel the sines that it has before the first pulse, and returns them.
fn subtract_tones(
    found: &Found,
    channels: &mut [Cow<'_, [f64]>],
    interval_s: f64,
    mains_hz: Option<f64>,
) -> Vec<Option<Tones>> {
    let tones = |samples: &mut Cow<'_, [f64]>| {
        let first = found.incident.filter(|_| found.wall.is_some())?;
        let end = first.at.checked_sub((MARGIN * first.width_samples) as usize)?;
        let tones = Tones::new(&samples[..end], first.height, interval_s, mains_hz)?;
        *samples = tones.subtracted(samples).into();
        Some(tones)
    };
    channels.iter_mut().map(tones).collect()
}

/// The slow baseline of a channel of a shot whose pulses were found, if it has one.
fn drift(
    found: &Found,
    channels: &[Cow<'_, [f64]>],
    calm: Option<&[f64]>,
    which: usize,
) -> Option<Detrended> {
    let (incident, wall) = (found.incident?, found.wall?);
    let is_here =
        |pulse: &&Pulse| channels.len() == 1 || which == usize::from(pulse.kind == PulseKind::Wall);
    let pulses: Vec<Pulse> = found.pulses().filter(is_here).copied().collect();
    let time = wall.at.checked_sub(incident.at)?;
    Detrended::new(&channels[which], calm, &pulses, time as f64)
}

type AboutPulses = [Option<Box<PulseSamples>>; 3];

/// Times of flight from picked pulses, whose errors hold what the slow baseline leaves open.
fn timed(
    picks: Result<(Picks, AboutPulses)>,
    slow: (&[Option<Detrended>], &[Option<Tones>]),
    interval_s: f64,
    calibration: SensorCalibration,
) -> (Result<Flight>, AboutPulses) {
    let (picks, mut samples) = match picks {
        Ok((picks, samples)) => (Ok(picks), samples),
        Err(error) => (Err(error), [const { None }; 3]),
    };
    let calibrated =
        |picks| with_drift(picks, &mut samples, slow, interval_s).calibrated(calibration);
    let flight = picks.map(calibrated).and_then(Picks::in_order).map(Picks::flight);
    (flight, samples)
}

fn with_drift(
    mut picks: Picks,
    samples: &mut [Option<Box<PulseSamples>>; 3],
    (drifts, tones): (&[Option<Detrended>], &[Option<Tones>]),
    interval_s: f64,
) -> Picks {
    let last = drifts.len() - 1;
    for kind in PulseKind::ALL {
        let Some(mut pick) = picks.pulse(kind) else { continue };
        let which = usize::from(kind == PulseKind::Wall);
        let (drift, tones) = (&drifts[which.min(last)], &tones[which.min(last)]);
        if drift.is_some() || tones.is_some() {
            let [at, width] = [pick.time_s, pick.width_s].map(|s| s / interval_s);
            let of_drift = drift.as_ref().map_or(0.0, |it| it.time_error(at, pick.height, width));
            let of_tones = tones.as_ref().map_or(0.0, |it| it.time_error(at, pick.height, width));
            let error_s = of_drift.hypot(of_tones) * interval_s;
            pick.sigma_s = pick.sigma_s.hypot(error_s);
            let of_drift = drift.as_ref().map_or(0.0, |it| it.height_error(at));
            let error_v = of_drift.hypot(tones.as_ref().map_or(0.0, |it| it.height_error(at)));
            pick.height_sigma = pick.height_sigma.hypot(error_v);
            if let Some(samples) = &mut samples[kind as usize] {
                (samples.of_drift_s, samples.of_drift_v) = (error_s, error_v);
            }
            picks.set(kind, pick);
        }
    }
    picks
}

impl SignalOptions {
    /// Widens clipped tops by how far a low-pass spreads their corners.
    fn spread_clipping(&self, found: &mut Found, interval_s: f64) {
        if let Some(low_pass) = self.low_pass {
            let reach = (0.5 / (low_pass.cutoff_hz * interval_s)).ceil() as usize;
            for pulse in found.pulses_mut() {
                *pulse = pulse.with_clipped_spread(reach);
            }
        }
    }

    fn condition<'a>(
        &self,
        samples: &'a [f64],
        interval_s: f64,
        polarity: Polarity,
    ) -> Result<Cow<'a, [f64]>> {
        let mut samples = Cow::Borrowed(samples);
        if let Some(time_constant_s) = self.high_pass_s {
            let offset = normalisation(&samples, polarity)?.baseline.offset;
            let samples = samples.to_mut();
            samples.iter_mut().for_each(|x| *x -= offset);
            invert_high_pass(samples, interval_s, time_constant_s)?;
        }
        if let Some(low_pass) = self.low_pass {
            samples = Cow::Owned(low_pass.apply(&samples, interval_s)?);
        }
        Ok(samples)
    }
}

/// Times of flight and height ratios of one shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// From the sensor bead to the wall, in s.
    pub incident_s: Estimate,
    /// From the wall back to the sensor bead, in s.
    pub reflected_s: Option<Estimate>,
    /// Covariance of both in s²: minus the variance of the wall's time, which
    /// ends one and begins the other. 0 without a reflected pulse.
    pub covariance_s2: f64,
    /// Height of the wall's pulse over that of the incident one; of forces, if sensors are calibrated.
    pub wall_over_incident: Estimate,
    /// Height of the reflected pulse over that of the incident one.
    pub reflected_over_incident: Option<Estimate>,
    /// Relative standard error of the sampling interval, which is in both times' errors.
    pub interval_error: f64,
    /// The pulses.
    pub picks: Picks,
}

impl Flight {
    /// Correlation of the errors of both times of flight; `None` without a reflected pulse, or where
    /// an error is 0.
    pub fn correlation(&self) -> Option<f64> {
        let product = self.incident_s.sigma * self.reflected_s?.sigma;
        (product > 0.0).then(|| self.covariance_s2 / product)
    }

    pub(crate) fn times_s(&self) -> [Option<Estimate>; 2] {
        [Some(self.incident_s), self.reflected_s]
    }

    /// Height of a pulse over that of the incident one, unless it is that.
    pub(crate) fn over_incident(&self, kind: PulseKind) -> Option<Estimate> {
        match kind {
            PulseKind::Incident => None,
            PulseKind::Wall => Some(self.wall_over_incident),
            PulseKind::Reflected => self.reflected_over_incident,
        }
    }

    /// The part of that one's error which equal shots share.
    pub(crate) fn shared_height(&self, kind: PulseKind) -> Option<f64> {
        let share = |pulse: Picked| pulse.systematic.height / pulse.height;
        let shares = share(self.picks.pulse(kind)?).hypot(share(self.picks.incident));
        Some(self.over_incident(kind)?.value * shares)
    }

    pub(crate) fn without_return(&self) -> Self {
        let mut picks = self.picks;
        picks.reflected = None;
        Self {
            reflected_s: None,
            covariance_s2: 0.0,
            reflected_over_incident: None,
            picks,
            ..*self
        }
    }

    /// The part of the covariance in s² that repeated shots do not share: without systematic errors
    /// of the wall's pulse and of the sampling interval.
    pub(crate) fn random_covariance_s2(&self) -> f64 {
        let Some(reflected_s) = self.reflected_s else {
            return 0.0;
        };
        let of_interval = self.interval_error.powi(2) * self.incident_s.value * reflected_s.value;
        let wall = self.picks.wall.systematic;
        self.covariance_s2 - of_interval + wall.superposition_s.powi(2) + wall.shape_s.powi(2)
    }

    /// The same with the relative standard error of the sampling interval added to both times: all
    /// of one recording share it.
    pub(crate) fn with_interval_error(mut self, relative: f64) -> Self {
        self.interval_error = relative;
        self.incident_s.widen(relative);
        if let Some(reflected_s) = &mut self.reflected_s {
            reflected_s.widen(relative);
            self.covariance_s2 += self.incident_s.value * reflected_s.value * relative * relative;
        }
        self
    }

    /// Systematic errors of the two pulses of the incident and of the reflected time. The
    /// interval's error counts with the pulse that no other time has.
    pub fn systematic(&self) -> [[Systematic; 2]; 2] {
        let wall = self.picks.wall.systematic;
        let back = self.picks.reflected.map(|back| back.systematic);
        let widen = |mut of: Systematic, time: Option<Estimate>| {
            let more = time.map_or(0.0, |time| self.interval_error * time.value);
            of.shape_s = of.shape_s.hypot(more);
            of
        };
        let incident = widen(self.picks.incident.systematic, Some(self.incident_s));
        let back = widen(back.unwrap_or_default(), self.reflected_s);
        [[incident, wall], [wall, back]]
    }

    /// The same where more than this shot determines how much lower a pulse's competing maximum is:
    /// below 0 that one is the pulse.
    pub(crate) fn with_height_difference(&self, kind: PulseKind, lower: Estimate) -> Self {
        let mut picks = self.picks;
        let (Some(pulse), Some(other)) = (picks.pulse(kind), picks.competing[kind as usize]) else {
            return *self;
        };
        let (most, picked) = match lower.value >= 0.0 {
            true => (pulse, other.picked),
            false => (other.picked, pulse),
        };
        picks.set(kind, most);
        let value = lower.value.abs();
        let lower = Estimate { value, ..lower };
        picks.competing[kind as usize] = Some(CompetingPick { picked, lower, ..other });
        picks.flight().with_interval_error(self.interval_error)
    }
}

impl Picks {
    pub(crate) fn pulse(&self, kind: PulseKind) -> Option<Picked> {
        [Some(self.incident), Some(self.wall), self.reflected][kind as usize]
    }

    pub(crate) fn set(&mut self, kind: PulseKind, picked: Picked) {
        match kind {
            PulseKind::Incident => self.incident = picked,
            PulseKind::Wall => self.wall = picked,
            PulseKind::Reflected => self.reflected = Some(picked),
        }
    }

    /// Times of the wall's channel moved to the sensor bead's clock, and ratios of heights those of forces.
    pub(crate) fn calibrated(mut self, calibration: SensorCalibration) -> Self {
        self.calibration = calibration;
        self.wall.time_s -= calibration.skew_s;
        let other = &mut self.competing[PulseKind::Wall as usize];
        other.iter_mut().for_each(|other| other.picked.time_s -= calibration.skew_s);
        self
    }

    fn in_order(self) -> Result<Self> {
        let times = PulseKind::ALL.map(|kind| self.pulse(kind).map(|pulse| (kind, pulse.time_s)));
        let times: Vec<(PulseKind, f64)> = times.into_iter().flatten().collect();
        let wrong = times.windows(2).find(|pair| pair[1].1 <= pair[0].1);
        wrong.map_or(Ok(self), |pair| {
            let [(before, from_s), (after, to_s)] = [pair[0], pair[1]];
            Err(MeasureError::OutOfOrder(after, before, from_s - to_s))
        })
    }

    /// A pulse's height in N, if its sensor is calibrated.
    pub fn force_n(&self, kind: PulseKind) -> Option<f64> {
        Some(self.pulse(kind)?.height / self.calibration.sensitivity_v_n(kind)?)
    }

    /// Times of flight and height ratios from the three pulses.
    pub fn flight(self) -> Flight {
        let height = |picked: Picked| Estimate { value: picked.height, sigma: picked.height_sigma };
        let [sensor, wall] = self.calibration.sensitivities_v_n.unwrap_or([1.0; 2]);
        let force = |of: Estimate| Estimate {
            value: of.value * (sensor / wall),
            sigma: of.sigma * (sensor / wall),
        };
        // The error of having taken another maximum for the largest: as far as that lies off, with
        // the root of its probability.
        let time = |picked: Picked, kind: PulseKind| {
            let of_other = self.competing[kind as usize].map_or(0.0, |other| {
                other.p_value().sqrt() * (other.picked.time_s - picked.time_s)
            });
            Estimate { value: picked.time_s, sigma: picked.sigma_s.hypot(of_other) }
        };
        let between = |from: Estimate, to: Estimate| Estimate {
            value: to.value - from.value,
            sigma: from.sigma.hypot(to.sigma),
        };
        let incident = height(self.incident);
        let from = time(self.incident, PulseKind::Incident);
        let wall = time(self.wall, PulseKind::Wall);
        let back = self.reflected.map(|back| time(back, PulseKind::Reflected));
        Flight {
            incident_s: between(from, wall),
            reflected_s: back.map(|back| between(wall, back)),
            covariance_s2: back.map_or(0.0, |_| -wall.sigma.powi(2)),
            interval_error: 0.0,
            wall_over_incident: force(height(self.wall)).over(incident),
            reflected_over_incident: self.reflected.map(|back| height(back).over(incident)),
            picks: self,
        }
    }
}

/// Systematic error of the mean of times between two pulses, from those of the pulses, a pair a
/// shot: noise among what lies under them, which has signs, averages out, what stands there in
/// every shot and what is open of the shapes does not. 0 without shots.
pub(crate) fn mean_systematic(pairs: &[[Systematic; 2]]) -> f64 {
    let count = pairs.len().max(1) as f64;
    let mean = |of: &dyn Fn(&[Systematic; 2]) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let superposition = |pulse: usize| mean(&|both| both[pulse].superposition_s);
    let shape = |pulse: usize| mean(&|both| both[pulse].shape_s);
    let parts = [superposition(0), superposition(1), shape(0), shape(1)];
    parts.into_iter().fold(0.0, f64::hypot)
}

/// A shot's error without the systematic errors of its two pulses.
pub fn without_systematic(sigma: f64, pair: [Systematic; 2]) -> f64 {
    let of = |one: Systematic| one.superposition_s.powi(2) + one.shape_s.powi(2);
    let squared = sigma.powi(2) - of(pair[0]) - of(pair[1]);
    squared.max(0.0).sqrt()
}

//! From a shot's samples to its times of flight.

use std::borrow::Cow;

use crate::signal::error::SignalError;
use crate::signal::find::conditioned_pulses;
use crate::signal::picks::pick_before;
use crate::signal::{
    Bandwidth, Channels, Doubt, Finding, Flight, Found, LowPass, Method, Place, Polarity, undroop,
    upright, without_spikes,
};

/// What is done to a shot's samples, and how pulses are picked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measuring {
    /// What is known before.
    pub finding: Finding,
    /// How pulses' times are told.
    pub method: Method,
    /// Time constant in s of the amplifier's high-pass, if its droop is to be taken out.
    pub high_pass_s: Option<f64>,
    /// A low-pass without delay, if one is wanted.
    pub low_pass: Option<LowPass>,
    /// The amplifier's low-pass, if its delay and what it does to maxima are to be taken out.
    pub bandwidth: Option<Bandwidth>,
}

/// A measured shot.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Where its pulses are, and what is doubtful.
    pub found: Found,
    /// Times of flight; an error says what is missing.
    pub flight: Result<Flight, SignalError>,
}

/// Finds and picks the pulses of one shot.
///
/// # Errors
/// As [`pulses`], [`undroop`] and [`LowPass::apply`]. A shot whose pulses are
/// found in part is no error: its `flight` is.
pub fn measure(
    channels: Channels<'_>,
    interval_s: f64,
    measuring: &Measuring,
) -> Result<Measured, SignalError> {
    SignalError::positive("sampling interval in s", interval_s)?;
    let finding = &measuring.finding;
    let (one, other);
    let (channels, spikes) = match channels {
        Channels::Summed(samples) => {
            one = without_spikes(samples);
            (Channels::Summed(&one.0), one.1.len())
        }
        Channels::Separate { sensor, wall } => {
            (one, other) = (without_spikes(sensor), without_spikes(wall));
            let (sensor, wall) = (&one.0, &other.0);
            (
                Channels::Separate { sensor, wall },
                one.1.len() + other.1.len(),
            )
        }
    };
    let recorded = channels;
    let conditioned = |samples, polarity| measuring.conditioned(samples, interval_s, polarity);
    let (sensor, wall);
    let channels = match channels {
        Channels::Summed(samples) => {
            sensor = conditioned(samples, finding.polarity)?;
            Channels::Summed(&sensor)
        }
        Channels::Separate {
            sensor: one,
            wall: other,
        } => {
            sensor = conditioned(one, finding.polarity)?;
            wall = conditioned(other, finding.wall_polarity)?;
            Channels::Separate {
                sensor: &sensor,
                wall: &wall,
            }
        }
    };
    let mut found = conditioned_pulses(channels, recorded, finding)?;
    if let Some(low_pass) = measuring.low_pass {
        // How far a clipped top's corners reach.
        let reach = 0.5 / (low_pass.cutoff_hz * interval_s);
        found.spread_clipped(reach.ceil() as usize);
    }
    let rails = match measuring.conditions() {
        true => [None; 2],
        false => finding.rails_of(channels),
    };
    let how = (rails, measuring.bandwidth);
    let picks = pick_before(channels, interval_s, &found, &measuring.method, how);
    let flight = picks.map(crate::signal::Picks::flight);
    let lost = flight.as_ref().is_ok_and(|f| f.reflected_s.is_none());
    if lost && found.returning.is_some() {
        found.doubt(vec![Doubt::NotPicked(Place::Returning)]);
    }
    if spikes > 0 {
        found.doubt(vec![Doubt::Spikes(spikes)]);
    }
    Ok(Measured { found, flight })
}

impl Measuring {
    /// Whether samples are changed before pulses are looked for.
    fn conditions(&self) -> bool {
        self.high_pass_s.is_some() || self.low_pass.is_some()
    }

    fn conditioned<'a>(
        &self,
        samples: &'a [f64],
        interval_s: f64,
        polarity: Polarity,
    ) -> Result<Cow<'a, [f64]>, SignalError> {
        let mut samples = Cow::Borrowed(samples);
        if let Some(time_constant_s) = self.high_pass_s {
            let offset = upright(&samples, polarity)?.level.offset;
            let samples = samples.to_mut();
            samples.iter_mut().for_each(|x| *x -= offset);
            undroop(samples, interval_s, time_constant_s)?;
        }
        if let Some(low_pass) = self.low_pass {
            samples = Cow::Owned(low_pass.apply(&samples, interval_s)?);
        }
        Ok(samples)
    }
}

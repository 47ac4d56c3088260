//! One measured shot.

use hertzchain_records::{Channel, Record, Samples};
use hertzchain_signal::{
    Channels, Doubt, Estimate, Finding, Flight, Measured, Measuring, Rails, SignalError,
};
use std::path::PathBuf;

/// What was measured on one record.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// Which file and which shot in it, as it is told to people.
    pub source: String,
    /// Which file.
    pub file: PathBuf,
    /// Number of the shot, if the file holds several or says.
    pub shot: Option<u64>,
    /// Which section of the chain was wet and with what; empty if nobody says.
    pub case: String,
    /// Speed that the striker was told, in m/s.
    pub programmed_speed_m_s: Option<f64>,
    /// Speed of the striker in m/s, sigma 0 if nobody says.
    pub speed_m_s: Option<Estimate>,
    /// Time between samples in s.
    pub interval_s: f64,
    /// Times of flight, heights, widths; or why there are none.
    pub flight: Result<Flight, SignalError>,
    /// What is doubtful.
    pub doubts: Vec<Doubt>,
}

impl Shot {
    /// Measures one record.
    pub(crate) fn of(record: &Record, measuring: &Measuring) -> (Self, Vec<Vec<f64>>) {
        let volts: Vec<Vec<f64>> = record
            .channels
            .iter()
            .map(|channel| channel.samples.volts())
            .collect();
        let channels = match volts.as_slice() {
            [sensor, wall, ..] => Channels::Separate { sensor, wall },
            one => Channels::Summed(one.first().map_or(&[], Vec::as_slice)),
        };
        let measuring = Measuring {
            finding: Finding {
                rails: measuring.finding.rails.or_else(|| rails(&record.channels)),
                ..measuring.finding
            },
            ..measuring.clone()
        };
        let measured = hertzchain_signal::measure(channels, record.interval_s, &measuring);
        let (flight, doubts) = match measured {
            Ok(Measured { found, flight }) => (flight, found.doubts),
            Err(error) => (Err(error), Vec::new()),
        };
        let shot = Self {
            source: record.source.clone(),
            file: record.file.clone(),
            shot: record.shot,
            case: record.case.clone().unwrap_or_default(),
            programmed_speed_m_s: record.programmed_speed_m_s,
            speed_m_s: record.speed_m_s.map(|value| Estimate {
                value,
                sigma: record.speed_error_m_s.unwrap_or(0.0),
            }),
            interval_s: record.interval_s,
            flight,
            doubts,
        };
        (shot, volts)
    }

    /// Whether its times may be of something else than the wave: a clipped
    /// pulse, or pulses that may have been taken for one another.
    #[must_use]
    pub fn is_dubious(&self) -> bool {
        let grave = |doubt: &Doubt| matches!(doubt, Doubt::Saturation(_) | Doubt::Order);
        self.doubts.iter().any(grave)
    }

    /// Doubts as one text.
    #[must_use]
    pub fn flags(&self) -> String {
        let error = self.flight.as_ref().err().map(ToString::to_string);
        let doubts = self.doubts.iter().map(ToString::to_string);
        doubts.chain(error).collect::<Vec<_>>().join("; ")
    }
}

/// The converter's range, where the first channel tells.
fn rails(channels: &[Channel]) -> Option<Rails> {
    let (low, high) = channels
        .first()
        .map(|c| &c.samples)
        .and_then(Samples::range_v)?;
    Some(Rails { low, high })
}

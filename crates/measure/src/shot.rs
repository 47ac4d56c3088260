//! One measured shot.

use crate::Options;
use crate::error::Result;
use crate::records::Record;
use crate::run::{bandwidth, stated_high_pass_hz};
use crate::signal::{
    Channels, DigitiserRange, Estimate, FindOptions, Flight, Measured, Picked, Picks, PulseKind,
    PulseSamples, QualityFlag, SensorCalibration, SignalOptions,
};
use std::f64::consts::TAU;
use std::ops::Range;
use std::path::PathBuf;

/// What was measured on one record.
#[derive(Clone, Debug, PartialEq)]
pub struct Shot {
    /// File and shot, for messages.
    pub source: String,
    /// Path of the file.
    pub file: PathBuf,
    /// Number of the shot, if the file holds several or says.
    pub shot: Option<u64>,
    /// Which section of the chain was wet and with what; empty if unknown.
    pub case: String,
    /// Programmed speed of the striker in m/s.
    pub programmed_speed_m_s: Option<f64>,
    /// Speed of the striker in m/s, sigma 0 if unknown.
    pub speed_m_s: Option<Estimate>,
    /// Time between samples in s.
    pub interval_s: f64,
    /// How long its samples last in s.
    pub duration_s: f64,
    /// Times of flight, heights, widths; or why there are none.
    pub flight: Result<Flight>,
    /// What is doubtful.
    pub doubts: Vec<QualityFlag>,
    /// Whether its recorder waited for a trigger in vain.
    pub untriggered: bool,
    /// How many of its samples are no numbers and were filled, and the first, from 0.
    pub gaps: Option<(usize, usize)>,
    /// Whether one of these lies in a pulse.
    pub gap_in_pulse: bool,
    /// Whether its record seems to hold more shots than this one.
    pub holds_several: bool,
    /// Whether it was cut out of a longer recording by what is in it.
    pub is_cut: bool,
    /// Whether the list of shots says that it does not count.
    pub excluded: bool,
    /// Whether all shots of its speed leave open which maximum is that of its incident or wall pulse,
    /// as [`Measurement::curves`](crate::Measurement::curves) finds.
    pub undecided: bool,
    /// Samples about its pulses, as [`Measured::samples`].
    pub samples: [Option<Box<PulseSamples>>; 3],
}

impl Shot {
    pub(crate) fn measure(record: &Record, options: &Options) -> Self {
        let asked = &options.measuring;
        let stated_s = stated_high_pass_hz(record, options).map(|hz| (TAU * hz).recip());
        let channels = match record.channels.as_slice() {
            [sensor, wall, ..] => Channels::Separate { sensor: &sensor.volts, wall: &wall.volts },
            one => Channels::Summed(one.first().map_or(&[], |one| &one.volts)),
        };
        let range = |channel: usize| {
            let (low, high) = record.channels.get(channel)?.range_v?;
            Some(DigitiserRange { low, high })
        };
        let measuring = SignalOptions {
            find: FindOptions {
                range: asked.find.range.or_else(|| range(0)),
                wall_range: asked.find.wall_range.or_else(|| range(1)),
                ..asked.find
            },
            high_pass_s: asked.high_pass_s.or(stated_s),
            bandwidth: bandwidth(record, options),
            ..asked.clone()
        };
        let measured = crate::signal::measure(channels, record.interval_s, &measuring);
        let (flight, doubts, samples) = match measured {
            Ok(Measured { found, flight, samples }) => {
                let relative = record.interval_error_s / record.interval_s;
                let widened = flight.map(|flight| flight.with_interval_error(relative));
                (widened, found.flags, samples)
            }
            Err(error) => (Err(error), Vec::new(), [const { None }; 3]),
        };
        let in_pulse = |flight: &Flight| record.gaps.iter().any(|gap| lies_in(gap, flight, record));
        let filled = record.gaps.iter().map(Range::len).sum();
        Self {
            gaps: record.gaps.first().map(|first| (filled, first.start)),
            gap_in_pulse: flight.as_ref().is_ok_and(in_pulse),
            source: record.source.clone(),
            file: record.file.clone(),
            shot: record.shot,
            case: record.case.clone().unwrap_or_default(),
            programmed_speed_m_s: record.programmed_speed_m_s,
            speed_m_s: record.speed_m_s.map(|value| Estimate { value, sigma: 0.0 }),
            interval_s: record.interval_s,
            duration_s: record.len() as f64 * record.interval_s,
            flight,
            doubts,
            untriggered: record.triggered == Some(false),
            holds_several: false,
            is_cut: false,
            excluded: false,
            undecided: false,
            samples,
        }
    }

    pub(crate) fn identify(&mut self, error_m_s: Option<f64>, options: &Options) {
        let list = options.list.as_ref();
        let entry = list.and_then(|list| list.find(&self.file, self.shot));
        let listed = entry.map(|entry| (entry.speed_m_s, entry.speed_error_m_s));
        let (speed_m_s, listed_error_m_s) = listed.unwrap_or_default();
        let error_m_s = listed_error_m_s.or(error_m_s).or(options.speed_error_m_s);
        let speed_m_s = speed_m_s.or(self.speed_m_s.map(|speed| speed.value));
        let sigma = error_m_s.unwrap_or(0.0);
        self.speed_m_s = speed_m_s.map(|value| Estimate { value, sigma });
        self.excluded = entry.is_some_and(|entry| entry.counts == Some(false));
        if let Some(case) = entry.and_then(|entry| entry.case.clone()) {
            self.case = case;
        }
        if let Some(entry) = entry.filter(|entry| entry.picks_s.iter().any(Option::is_some)) {
            let sigma_s = entry.pick_error_s.unwrap_or(self.interval_s);
            let error = entry.pick_outside(&self.source, self.duration_s).or_else(|| {
                self.pick_by_hand(entry.picks_s, sigma_s, options.measuring.calibration);
                entry.out_of_order(&self.source, &self.flight.as_ref().ok()?.picks)
            });
            if let Some(error) = error {
                self.flight = Err(error);
            }
        }
    }

    /// Takes over times that the user picked, and drops what was doubtful about these pulses.
    fn pick_by_hand(
        &mut self,
        mut times_s: [Option<f64>; 3],
        sigma_s: f64,
        calibration: SensorCalibration,
    ) {
        let wall_s = &mut times_s[PulseKind::Wall as usize];
        wall_s.iter_mut().for_each(|time_s| *time_s -= calibration.skew_s);
        let found = self.flight.as_ref().ok();
        let interval_error = found.map_or(0.0, |flight| flight.interval_error);
        let unknown = Picks {
            incident: Picked::UNKNOWN,
            wall: Picked::UNKNOWN,
            reflected: None,
            competing: [None; 3],
            calibration,
        };
        let mut picks = found.map_or(unknown, |flight| flight.picks);
        for (kind, time_s) in PulseKind::ALL.into_iter().zip(times_s) {
            let Some(time_s) = time_s else { continue };
            let own = picks.pulse(kind).unwrap_or(Picked::UNKNOWN);
            picks.set(kind, own.by_fit(time_s, sigma_s, None));
            picks.competing[kind as usize] = None;
            self.samples[kind as usize] = None;
            self.doubts.retain(|flag| flag.pulse() != Some(kind));
            self.doubts.push(QualityFlag::ByHand(kind));
        }
        if times_s[0].and(times_s[1]).is_some() {
            let of_order = [QualityFlag::Order, QualityFlag::Unidentified];
            self.doubts.retain(|flag| !of_order.contains(flag));
        }
        if picks.incident.time_s.is_finite() && picks.wall.time_s.is_finite() {
            self.flight = Ok(picks.flight().with_interval_error(interval_error));
        }
    }

    /// Whether its times may be of something else than the wave: a clipped pulse or one with a gap,
    /// pulses taken for one another or of several shots, or a missing one.
    pub fn is_dubious(&self) -> bool {
        self.holds_several || self.gap_in_pulse || self.doubts.iter().any(QualityFlag::is_grave)
    }

    /// Codes of the reasons why it counts in no mean, the reference's; none if it counts.
    pub fn reasons(&self, keep_dubious: bool) -> Vec<&'static str> {
        let mut codes = self.own_reasons(keep_dubious);
        codes.extend((self.undecided && !keep_dubious).then_some("ambiguous"));
        codes
    }

    /// Those that do not depend on the other shots of its speed.
    pub(crate) fn own_reasons(&self, keep_dubious: bool) -> Vec<&'static str> {
        let grave = self.doubts.iter().filter(|flag| flag.is_grave() && !keep_dubious);
        let own = [
            (self.excluded, "excluded"),
            (self.flight.is_err(), "no-time"),
            (self.true_speed().is_none(), "no-speed"),
            (self.holds_several && !keep_dubious, "several-shots"),
            (self.gap_in_pulse && !keep_dubious, "gap-in-pulse"),
        ];
        let own = own.into_iter().filter_map(|(is_so, code)| is_so.then_some(code));
        let mut codes: Vec<&str> = own.chain(grave.map(QualityFlag::code)).collect();
        codes.dedup();
        codes
    }

    /// Its speed, if it is above 0, below which a photogate with a large error may come.
    pub(crate) fn true_speed(&self) -> Option<Estimate> {
        self.speed_m_s.filter(|speed| speed.value > 0.0)
    }

    /// What is doubtful, in words.
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        if let (Some(Estimate { value, .. }), None) = (self.speed_m_s, self.true_speed()) {
            let remark = format!("a measured speed of {value:.4} m/s is none: left out of curves");
            remarks.push(remark);
        }
        if self.excluded {
            remarks.push("excluded by the list of shots".to_owned());
        }
        if self.holds_several {
            let remark =
                "several shots: cut the recording with --level, shorter with --shot-samples";
            remarks.push(remark.to_owned());
        }
        if self.untriggered {
            let remark =
                "no trigger: its level was never passed, and the record may not hold the shot";
            remarks.push(remark.to_owned());
        }
        if let Some((count, first)) = self.gaps {
            let (are, were) = if count == 1 { (" is", "was") } else { ("s are", "were") };
            let inside = if self.gap_in_pulse { " in a pulse" } else { "" };
            remarks.push(format!(
                "{count} sample{are} missing{inside}, from sample {} on, and {were} filled",
                first + 1
            ));
        }
        remarks.extend(self.doubts.iter().map(ToString::to_string));
        remarks
    }

    /// What is doubtful and what is missing, as one text.
    pub fn flags(&self) -> String {
        let error = self.flight.as_ref().err().map(ToString::to_string);
        let all = self.remarks().into_iter().chain(error);
        all.collect::<Vec<_>>().join("; ")
    }
}

/// A shot with its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Example {
    /// What was measured.
    pub shot: Shot,
    /// Names of the channels.
    pub names: Vec<String>,
    /// Samples in V, a channel each.
    pub volts: Vec<Vec<f64>>,
}

impl Example {
    /// A shot of a record, of which it may be a part.
    pub(crate) fn new(shot: &Shot, record: &Record, range: Option<(usize, usize)>) -> Self {
        let (from, to) = range.unwrap_or((0, record.len()));
        let channels = record.part(from, to - from).channels;
        Self {
            shot: shot.clone(),
            names: channels.iter().map(|c| c.name.clone()).collect(),
            volts: channels.into_iter().map(|c| c.volts).collect(),
        }
    }
}

fn lies_in(gap: &Range<usize>, flight: &Flight, record: &Record) -> bool {
    let pulses = PulseKind::ALL.map(|kind| flight.picks.pulse(kind));
    pulses.into_iter().flatten().any(|pulse| {
        let (at, reach) = (pulse.time_s, 1.5 * pulse.width_s);
        let [from, to] = [gap.start, gap.end].map(|sample| sample as f64 * record.interval_s);
        to > at - reach && from < at + reach
    })
}

//! A pulse past the sensor bead, at the wall and back: times of flight.

use super::signal::{Maximum, Signal};
use crate::sensor::Sensor;
use crate::wave::{Flow, Observer, Piece, bracketed_root};

/// Follows the sensor bead and the wall until the reflected pulse has passed.
#[derive(Clone, Debug)]
pub struct Passages {
    sensor: Signal,
    wall: Signal,
    ends_shot: bool,
    until_s: f64,
    /// Which maxima of the sensor bead and of the wall have been looked at.
    seen: (Seen, Seen),
    /// Largest maximum of the sensor bead among those.
    incoming: Option<Maximum>,
    best: Option<(Option<Maximum>, Maximum)>,
    /// The search is over: what comes later changes no peak.
    over: bool,
}

/// How many maxima have been looked at, and the last of them.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    count: usize,
    last: Option<Maximum>,
}

impl Seen {
    fn add(&mut self, maximum: Maximum) {
        self.count += 1;
        self.last = Some(maximum);
    }

    /// A signal may put a higher maximum in the place of its last: that one is new.
    fn check(&mut self, maxima: &[Maximum]) {
        let last = self.count.checked_sub(1).and_then(|at| maxima.get(at));
        if last != self.last.as_ref() {
            self.count = self.count.saturating_sub(1);
        }
    }
}

/// The pulse was not seen.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PassageError {
    /// No maximum at the wall.
    #[error("no pulse reached the wall within {duration_s:e} s")]
    NoWallPulse {
        /// Duration of the shot in s.
        duration_s: f64,
    },
    /// No maximum at the sensor bead before the wall's.
    #[error("the sensor bead has no maximum before the wall's peak at {:e} s", wall.time_s)]
    NoIncidentPulse {
        /// The wall's peak.
        wall: Maximum,
    },
}

/// Which of the three pulses of a shot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pulse {
    /// Past the sensor bead on its way to the wall.
    Incident,
    /// At the wall.
    Wall,
    /// Past the sensor bead on its way back.
    Reflected,
}

impl Pulse {
    /// Its name: `incident`, `wall` or `reflected`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Incident => "incident",
            Self::Wall => "wall",
            Self::Reflected => "reflected",
        }
    }
}

/// A maximum that could be taken for the peak of a pulse instead of the one that is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Competing {
    /// The pulse.
    pub pulse: Pulse,
    /// The other maximum.
    pub maximum: Maximum,
    /// Its height over that of the pulse's peak.
    pub share: f64,
}

/// Peaks and times of flight of one shot.
#[derive(Clone, Debug, PartialEq)]
pub struct Passage {
    /// Largest maximum of the sensor bead before the wall's peak.
    pub incident: Maximum,
    /// The first maximum of the wall that none exceeds until the end of the search.
    pub wall: Maximum,
    /// Largest maximum of the sensor bead in (tw, tw + 3 (tw − t7)].
    pub reflected: Option<Maximum>,
    /// End of the search for the wall's peak and the reflected pulse, in s:
    /// max(3 tw, tw + 3 (tw − t7)).
    pub search_ends_s: f64,
    /// Maxima that could be taken for one of the peaks instead, by pulse and time.
    pub competing: Vec<Competing>,
    /// All maxima of the sensor bead in the same time, small ones too: 1e-4 of
    /// its largest.
    pub returning_maxima: Vec<Maximum>,
    /// All maxima of the sensor bead above 5 % of its largest.
    pub sensor_maxima: Vec<Maximum>,
    /// All maxima of the wall until the end of the search, above 5 % of its peak.
    pub wall_maxima: Vec<Maximum>,
    /// Full width at half maximum of the incident pulse in s.
    pub incident_width_s: Option<f64>,
    /// Full width at half maximum of the wall pulse in s.
    pub wall_width_s: Option<f64>,
    /// Full width at half maximum of the reflected pulse in s.
    pub reflected_width_s: Option<f64>,
}

/// Maxima below this fraction of the largest are not reported.
const REPORTED: f64 = 0.05;

/// The reflected pulse is looked for until tw + this · (tw − t7).
pub const RETURN_WITHIN: f64 = 3.0;

/// The wall's peak is looked for until this many times its time at least: about when
/// the pulse, back from the striker, is at the wall again.
pub const WALL_WITHIN: f64 = 3.0;

/// A maximum of at least this share of a peak's height could be taken for it.
const COMPETES: f64 = 0.5;

/// An earlier one at the sensor bead or the wall from this share on.
const FORERUNS: f64 = 0.1;

/// A maximum of the wall later than this many times its peak's time, and no larger, is an echo.
const ECHO: f64 = 2.0;

impl Passage {
    /// Drops the reflected pulse, of a shot that did not wait for it.
    pub fn drop_return(&mut self) {
        self.reflected = None;
        self.reflected_width_s = None;
        self.competing.retain(|other| other.pulse != Pulse::Reflected);
    }

    /// Incident time of flight in s.
    pub fn tof_incident_s(&self) -> f64 {
        self.wall.time_s - self.incident.time_s
    }

    /// The highest maximum, over its pulse's peak, that could be the peak of one of
    /// these pulses instead.
    pub fn highest_competing(&self, pulses: &[Pulse]) -> Option<&Competing> {
        let competing = (self.competing.iter()).filter(|other| pulses.contains(&other.pulse));
        competing.max_by(|a, b| a.share.total_cmp(&b.share))
    }

    /// Reflected time of flight in s.
    pub fn tof_reflected_s(&self) -> Option<f64> {
        self.reflected.map(|peak| peak.time_s - self.wall.time_s)
    }
}

impl Passages {
    /// Of a bead sensor and the wall contact; `ends_shot` when the shot has
    /// no other end than the reflected pulse.
    pub fn new(sensor_bead: usize, wall_contact: usize, ends_shot: bool) -> Self {
        Self {
            sensor: Signal::new(Sensor::Bead(sensor_bead)),
            wall: Signal::new(Sensor::Contact(wall_contact)),
            ends_shot,
            until_s: 0.0,
            seen: (Seen::default(), Seen::default()),
            incoming: None,
            best: None,
            over: false,
        }
    }

    /// From the signals of a sensor bead and of the wall, followed until a time in s.
    pub fn from_signals(sensor: Signal, wall: Signal, until_s: f64) -> Self {
        let mut passages = Self { sensor, wall, until_s, ..Self::new(0, 0, true) };
        passages.update();
        passages
    }

    /// The sensor bead's signal.
    pub fn sensor(&self) -> &Signal {
        &self.sensor
    }

    /// Whether a signal takes all the memory that it may; that ends the shot.
    pub fn is_full(&self) -> bool {
        self.sensor.is_full() || self.wall.is_full()
    }

    /// The wall's signal.
    pub fn wall(&self) -> &Signal {
        &self.wall
    }

    /// Incident and wall peak as far as seen: the first maximum of the wall, large
    /// enough for a pulse, that none exceeds until the end of its search, and the
    /// largest of the sensor bead before it.
    fn update(&mut self) {
        self.seen.1.check(self.wall.maxima());
        while let Some(&peak) = self.wall.maxima().get(self.seen.1.count) {
            if self.ends_s().is_some_and(|ends_s| peak.time_s > ends_s) {
                break;
            }
            self.seen.1.add(peak);
            let highest = self.best.map_or(0.0, |(_, wall)| wall.value);
            if peak.value > highest && self.wall.is_pulse(&peak) {
                self.look_until(peak.time_s);
                self.best = Some((self.incoming, peak));
            }
        }
        self.over = self.ends_s().is_some_and(|ends_s| self.until_s > ends_s);
    }

    /// Looks at the sensor bead's maxima before a time.
    fn look_until(&mut self, time_s: f64) {
        self.seen.0.check(self.sensor.maxima());
        let later = (self.sensor.maxima()).get(self.seen.0.count..).unwrap_or_default();
        for peak in later.iter().take_while(|peak| peak.time_s < time_s) {
            self.seen.0.add(*peak);
            let highest = self.incoming.map_or(0.0, |incoming| incoming.value);
            if peak.value > highest && self.sensor.is_pulse(peak) {
                self.incoming = Some(*peak);
            }
        }
    }

    /// When the search ends, as far as is known.
    fn ends_s(&self) -> Option<f64> {
        self.best.map(|(incident, wall)| search_ends_s(incident, wall))
    }

    fn incident_and_wall(&self) -> Result<(Maximum, Maximum), PassageError> {
        let duration_s = self.until_s;
        let (incident, wall) = self.best.ok_or(PassageError::NoWallPulse { duration_s })?;
        let incident = incident.ok_or(PassageError::NoIncidentPulse { wall })?;
        Ok((incident, wall))
    }

    /// Time of the wall's peak in s as far as seen.
    pub fn wall_peak_s(&self) -> Option<f64> {
        self.best.map(|(_, wall)| wall.time_s)
    }

    /// The incident, the wall's and the reflected maximum alone: what times of
    /// flight need, without widths.
    ///
    /// # Errors
    /// When the pulse did not pass the sensor bead or reach the wall.
    pub fn peaks(&self) -> Result<(Maximum, Maximum, Option<Maximum>), PassageError> {
        let (incident, wall) = self.incident_and_wall()?;
        let returning = |peak: &Maximum| returns(peak, incident, wall);
        Ok((incident, wall, largest(self.sensor.maxima(), returning)))
    }

    /// What was seen.
    ///
    /// # Errors
    /// When the pulse did not pass the sensor bead or reach the wall.
    pub fn passage(&self) -> Result<Passage, PassageError> {
        let (incident, wall, reflected) = self.peaks()?;
        let width = |signal: &Signal, peak: Maximum| {
            let half = 0.5 * peak.value;
            Some(
                crossing(signal, peak, half, Side::After)?
                    - crossing(signal, peak, half, Side::Before)?,
            )
        };
        let returning = |peak: &&Maximum| returns(peak, incident, wall);
        let maxima = self.sensor.maxima().iter();
        let returning_maxima: Vec<Maximum> = maxima.filter(returning).copied().collect();
        let sensor_maxima = self.sensor.maxima();
        let incoming = sensor_maxima.partition_point(|peak| peak.time_s < wall.time_s);
        let search_ends_s = search_ends_s(Some(incident), wall);
        let searched = self.wall.maxima();
        let searched = &searched[..searched.partition_point(|peak| peak.time_s <= search_ends_s)];
        let incoming = &sensor_maxima[..incoming];
        let mut competing = self.sensor.competing(Pulse::Incident, incoming, incident);
        competing.extend((self.wall).competing(Pulse::Wall, self.wall.maxima(), wall));
        competing.extend(
            (reflected.iter()).flat_map(|&peak| {
                (self.sensor).competing(Pulse::Reflected, &returning_maxima, peak)
            }),
        );
        Ok(Passage {
            incident,
            wall,
            reflected,
            search_ends_s,
            competing,
            returning_maxima,
            sensor_maxima: reported(sensor_maxima),
            wall_maxima: reported(searched),
            incident_width_s: width(&self.sensor, incident),
            wall_width_s: width(&self.wall, wall),
            reflected_width_s: reflected.and_then(|peak| width(&self.sensor, peak)),
        })
    }

    /// When the rising flank of the incident, wall and reflected pulse passes
    /// a fraction of its peak, in s.
    pub fn flanks(&self, passage: &Passage, at: f64) -> [Option<f64>; 3] {
        let rise =
            |signal: &Signal, peak: Maximum| crossing(signal, peak, at * peak.value, Side::Before);
        [
            rise(&self.sensor, passage.incident),
            rise(&self.wall, passage.wall),
            passage.reflected.and_then(|peak| rise(&self.sensor, peak)),
        ]
    }
}

impl Observer for Passages {
    fn step(&mut self, piece: &Piece<'_>) -> Flow {
        self.until_s = piece.time_s(1.0);
        self.sensor.step(piece);
        self.wall.step(piece);
        if self.is_full() {
            return Flow::Finished;
        }
        self.update();
        match self.ends_shot && self.over {
            true => Flow::Finished,
            false => Flow::Continue,
        }
    }
}

/// When the search for the wall's peak and the reflected pulse ends, in s.
fn search_ends_s(incident: Option<Maximum>, wall: Maximum) -> f64 {
    let way_s = incident.map_or(0.0, |incident| wall.time_s - incident.time_s);
    (WALL_WITHIN * wall.time_s).max(wall.time_s + RETURN_WITHIN * way_s)
}

impl Signal {
    /// Maxima that could be taken for a pulse's peak.
    fn competing(&self, pulse: Pulse, maxima: &[Maximum], peak: Maximum) -> Vec<Competing> {
        let one =
            |&maximum: &Maximum| Competing { pulse, maximum, share: maximum.value / peak.value };
        let competes = |other: &Competing| {
            let earlier = other.maximum.time_s < peak.time_s;
            let forerunner = earlier && pulse != Pulse::Reflected;
            // Later than that it has been to the striker, unless it is a larger one: of another
            // impact, or of beads that follow more slowly.
            let late = other.maximum.time_s > ECHO * peak.time_s;
            let echo = pulse == Pulse::Wall && late && other.share <= 1.0;
            let least = if forerunner { FORERUNS } else { COMPETES };
            let other_pulse = self.is_pulse(&other.maximum) && other.maximum != peak;
            other.share >= least && !echo && other_pulse
        };
        maxima.iter().map(one).filter(competes).collect()
    }
}

/// Whether a maximum of the sensor bead lies in (tw, tw + 3 (tw − t7)].
fn returns(peak: &Maximum, incident: Maximum, wall: Maximum) -> bool {
    let since_s = peak.time_s - wall.time_s;
    since_s > 0.0 && peak.time_s <= wall.time_s + RETURN_WITHIN * (wall.time_s - incident.time_s)
}

fn largest(maxima: &[Maximum], wanted: impl Fn(&Maximum) -> bool) -> Option<Maximum> {
    let wanted = maxima.iter().filter(|peak| peak.value > 0.0 && wanted(peak));
    wanted.copied().reduce(|best, peak| if peak.value > best.value { peak } else { best })
}

fn reported(maxima: &[Maximum]) -> Vec<Maximum> {
    let most = largest(maxima, |_| true).map_or(0.0, |peak| peak.value);
    maxima.iter().copied().filter(|peak| peak.value >= REPORTED * most && most > 0.0).collect()
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Before,
    After,
}

/// The time nearest to a peak, on one side, at which its signal passes a level.
fn crossing(signal: &Signal, peak: Maximum, level: f64, side: Side) -> Option<f64> {
    let stretches = signal.stretches();
    let home =
        stretches.partition_point(|stretch| stretch.start_s <= peak.time_s).checked_sub(1)?;
    let above = |time: f64, stretch: usize| stretches[stretch].at(time) - level;
    let mut inner = peak.time_s;
    let mut index = home;
    loop {
        let stretch = stretches[index];
        for quarter in 0..=4 {
            let part = 0.25 * f64::from(quarter) * stretch.length_s;
            let outer = match side {
                Side::Before => stretch.end_s() - part,
                Side::After => stretch.start_s + part,
            };
            let outside = match side {
                Side::Before => outer <= inner,
                Side::After => outer >= inner,
            };
            if outside && above(outer, index) < 0.0 {
                // A jump between stretches leaves no bracket: the jump it is.
                if above(inner, index) < 0.0 {
                    return Some(inner);
                }
                return Some(root_between(outer, inner, |time| above(time, index)));
            }
            inner = if outside { outer } else { inner };
        }
        index = match side {
            Side::Before => index.checked_sub(1)?,
            Side::After => index + 1,
        };
        if index >= stretches.len() {
            return None;
        }
    }
}

/// Root between an outer time (negative) and an inner one (not negative).
fn root_between(outer: f64, inner: f64, f: impl Fn(f64) -> f64) -> f64 {
    let span = inner - outer;
    outer + span * bracketed_root(|s| f(outer + s * span), 0.0, 1.0, 1e-12)
}

#[cfg(test)]
#[path = "tests/passage.rs"]
mod tests;

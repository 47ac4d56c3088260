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
    whole: bool,
    until_s: f64,
    seen: (usize, usize),
    best: Option<(Maximum, Maximum)>,
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
    #[error("no pulse passed the sensor bead before the wall's peak at {wall_s:e} s")]
    NoIncidentPulse {
        /// Time of the wall's peak in s.
        wall_s: f64,
    },
}

/// Peaks and times of flight of one shot.
#[derive(Clone, Debug, PartialEq)]
pub struct Passage {
    /// Largest maximum of the sensor bead before the wall's peak.
    pub incident: Maximum,
    /// Largest maximum of the wall.
    pub wall: Maximum,
    /// Largest maximum of the sensor bead in (tw, tw + 3 (tw − t7)].
    pub reflected: Option<Maximum>,
    /// All maxima of the sensor bead in the same time, small ones too: 1e-4 of
    /// its largest.
    pub returning_maxima: Vec<Maximum>,
    /// All maxima of the sensor bead above 5 % of its largest.
    pub sensor_maxima: Vec<Maximum>,
    /// All maxima of the wall above 5 % of its largest.
    pub wall_maxima: Vec<Maximum>,
    /// Full width at half maximum of the incident pulse in s.
    pub incident_width_s: Option<f64>,
    /// Full width at half maximum of the wall pulse in s.
    pub wall_width_s: Option<f64>,
    /// Full width at half maximum of the reflected pulse in s.
    pub reflected_width_s: Option<f64>,
}

/// A threshold on the rising flank of a pulse, as a fraction of its peak.
pub type Flank = f64;

/// Maxima below this fraction of the largest are not reported.
const REPORTED: f64 = 0.05;

/// The reflected pulse is looked for until tw + this · (tw − t7).
pub const RETURN_WITHIN: f64 = 3.0;

impl Passage {
    /// Incident time of flight in s.
    #[must_use]
    pub fn tof_incident_s(&self) -> f64 {
        self.wall.time_s - self.incident.time_s
    }

    /// Reflected time of flight in s.
    #[must_use]
    pub fn tof_reflected_s(&self) -> Option<f64> {
        self.reflected.map(|peak| peak.time_s - self.wall.time_s)
    }
}

impl Passages {
    /// Of a bead sensor and the wall contact; `ends_shot` when the shot has
    /// no other end than the reflected pulse.
    #[must_use]
    pub fn new(sensor_bead: usize, wall_contact: usize, ends_shot: bool) -> Self {
        Self {
            sensor: Signal::new(Sensor::Bead(sensor_bead)),
            wall: Signal::new(Sensor::Contact(wall_contact)),
            ends_shot,
            whole: !ends_shot,
            until_s: 0.0,
            seen: (0, 0),
            best: None,
        }
    }

    /// These, with maxima after the end of the search counted too: for a shot
    /// whose duration was asked for.
    #[must_use]
    pub fn of_whole_shot(self) -> Self {
        Self {
            whole: true,
            ..self
        }
    }

    /// From the signals of a sensor bead and of the wall, followed until a time
    /// in s; `ends_shot` as for [`Passages::new`].
    #[must_use]
    pub fn from_signals(sensor: Signal, wall: Signal, until_s: f64, ends_shot: bool) -> Self {
        let mut passages = Self {
            sensor,
            wall,
            ends_shot,
            whole: !ends_shot,
            until_s,
            seen: (0, 0),
            best: None,
        };
        passages.update();
        passages
    }

    /// The sensor bead's signal.
    #[must_use]
    pub fn sensor(&self) -> &Signal {
        &self.sensor
    }

    /// The wall's signal.
    #[must_use]
    pub fn wall(&self) -> &Signal {
        &self.wall
    }

    /// Incident and wall peak as far as seen.
    fn update(&mut self) {
        let seen = (self.sensor.maxima().len(), self.wall.maxima().len());
        if seen != self.seen {
            self.seen = seen;
            self.best = self.incident_and_wall().ok();
        }
    }

    /// The wall's largest maximum and the sensor's before it. Where the search
    /// ends the shot, what the wall sees after its end is another pulse, whatever
    /// else the shot is followed for.
    fn incident_and_wall(&self) -> Result<(Maximum, Maximum), PassageError> {
        let mut wall: Option<Maximum> = None;
        let mut incident = None;
        for &peak in self.wall.maxima() {
            let over = |(incident, wall)| peak.time_s > search_ends_s(incident, wall);
            if !self.whole && incident.zip(wall).is_some_and(over) {
                break;
            }
            if peak.value > wall.map_or(0.0, |wall| wall.value) {
                wall = Some(peak);
                incident = largest(self.sensor.maxima(), |other| other.time_s < peak.time_s);
            }
        }
        let duration_s = self.until_s;
        let wall = wall.ok_or(PassageError::NoWallPulse { duration_s })?;
        let wall_s = wall.time_s;
        let incident = incident.ok_or(PassageError::NoIncidentPulse { wall_s })?;
        Ok((incident, wall))
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
        Ok(Passage {
            incident,
            wall,
            reflected,
            returning_maxima: maxima.filter(returning).copied().collect(),
            sensor_maxima: reported(self.sensor.maxima()),
            wall_maxima: reported(self.wall.maxima()),
            incident_width_s: width(&self.sensor, incident),
            wall_width_s: width(&self.wall, wall),
            reflected_width_s: reflected.and_then(|peak| width(&self.sensor, peak)),
        })
    }

    /// When the rising flank of the incident, wall and reflected pulse passes
    /// a fraction of its peak, in s.
    #[must_use]
    pub fn flanks(&self, passage: &Passage, at: Flank) -> [Option<f64>; 3] {
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
        self.update();
        match self.best {
            Some((incident, wall)) if self.ends_shot => {
                if piece.time_s(1.0) > search_ends_s(incident, wall) {
                    Flow::Finished
                } else {
                    Flow::Continue
                }
            }
            _ => Flow::Continue,
        }
    }
}

/// Until when the reflected pulse is looked for, in s.
fn search_ends_s(incident: Maximum, wall: Maximum) -> f64 {
    wall.time_s + RETURN_WITHIN * (wall.time_s - incident.time_s)
}

/// Whether a maximum of the sensor bead lies in (tw, tw + 3 (tw − t7)].
fn returns(peak: &Maximum, incident: Maximum, wall: Maximum) -> bool {
    peak.time_s > wall.time_s && peak.time_s <= search_ends_s(incident, wall)
}

fn largest(maxima: &[Maximum], wanted: impl Fn(&Maximum) -> bool) -> Option<Maximum> {
    let wanted = maxima
        .iter()
        .filter(|peak| peak.value > 0.0 && wanted(peak));
    wanted
        .copied()
        .reduce(|best, peak| if peak.value > best.value { peak } else { best })
}

fn reported(maxima: &[Maximum]) -> Vec<Maximum> {
    let most = largest(maxima, |_| true).map_or(0.0, |peak| peak.value);
    maxima
        .iter()
        .copied()
        .filter(|peak| peak.value >= REPORTED * most && most > 0.0)
        .collect()
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Before,
    After,
}

/// The time nearest to a peak, on one side, at which its signal passes a level.
fn crossing(signal: &Signal, peak: Maximum, level: f64, side: Side) -> Option<f64> {
    let stretches = signal.stretches();
    let home = stretches
        .partition_point(|stretch| stretch.start_s <= peak.time_s)
        .checked_sub(1)?;
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

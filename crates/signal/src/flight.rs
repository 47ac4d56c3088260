//! Times of flight of one shot.

use crate::{Moved, Picked, Picks};

/// A number with its standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its standard deviation, in the same unit.
    pub sigma: f64,
}

/// What one shot tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// From the sensor bead to the wall, in s.
    pub incident_s: Estimate,
    /// From the wall back to the sensor bead, in s.
    pub reflected_s: Option<Estimate>,
    /// Covariance of both in s²: minus the variance of the wall's time, which
    /// ends one and begins the other. 0 without a return.
    pub covariance_s2: f64,
    /// Height of the wall's pulse over that of the passing one.
    pub wall_over_passing: Estimate,
    /// Height of the returning pulse over that of the passing one.
    pub returning_over_passing: Option<Estimate>,
    /// The pulses.
    pub picks: Picks,
}

impl Flight {
    /// The same with a sampling interval whose relative standard error is this: times of
    /// flight are wrong by as much, all of one recording alike.
    #[must_use]
    pub fn with_interval_error(mut self, relative: f64) -> Self {
        let picks = &mut self.picks;
        self.incident_s.widen(relative, &mut picks.passing);
        if let (Some(reflected_s), Some(back)) = (&mut self.reflected_s, &mut picks.returning) {
            reflected_s.widen(relative, back);
            self.covariance_s2 += self.incident_s.value * reflected_s.value * relative * relative;
        }
        self
    }
}

impl Estimate {
    /// Adds a relative error that all alike shots share; the pulse that no other time has
    /// tells of it.
    fn widen(&mut self, relative: f64, shared_by: &mut Picked) {
        let more = relative * self.value;
        self.sigma = self.sigma.hypot(more);
        shared_by.moved.shape_s = shared_by.moved.shape_s.hypot(more);
    }

    /// Quotient of two independent numbers, errors to first order.
    #[must_use]
    pub fn over(self, other: Self) -> Self {
        let value = self.value / other.value;
        let own = self.sigma / other.value;
        let of_other = value * other.sigma / other.value;
        Self {
            value,
            sigma: own.hypot(of_other),
        }
    }
}

impl Picks {
    /// What may have moved the two pulses of the incident and of the reflected time.
    #[must_use]
    pub fn moved(&self) -> [[Moved; 2]; 2] {
        let wall = self.wall.moved;
        let back = self.returning.map(|back| back.moved).unwrap_or_default();
        [[self.passing.moved, wall], [wall, back]]
    }

    /// Times of flight and attenuation from the three pulses.
    #[must_use]
    pub fn flight(self) -> Flight {
        let height = |picked: &Picked| Estimate {
            value: picked.height,
            sigma: picked.height_sigma,
        };
        let passing = height(&self.passing);
        let back = self.returning.as_ref();
        Flight {
            incident_s: between(&self.passing, &self.wall),
            reflected_s: back.map(|back| between(&self.wall, back)),
            covariance_s2: back.map_or(0.0, |_| -self.wall.sigma_s.powi(2)),
            wall_over_passing: height(&self.wall).over(passing),
            returning_over_passing: back.map(|back| height(back).over(passing)),
            picks: self,
        }
    }
}

fn between(from: &Picked, to: &Picked) -> Estimate {
    Estimate {
        value: to.time_s - from.time_s,
        sigma: from.sigma_s.hypot(to.sigma_s),
    }
}

//! Times of flight of one shot.

use crate::signal::{Moved, Picked, PickedRival, Picks, Place};

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
    /// Relative standard error of the sampling interval, which is in both times' errors.
    pub interval_error: f64,
    /// The pulses.
    pub picks: Picks,
}

impl Flight {
    /// Correlation of the errors of both times of flight; `None` without a return, or where an
    /// error is 0.
    #[must_use]
    pub fn correlation(&self) -> Option<f64> {
        let product = self.incident_s.sigma * self.reflected_s?.sigma;
        (product > 0.0).then(|| self.covariance_s2 / product)
    }

    /// The part of the covariance in s² that repeated shots do not share: without what moved the
    /// wall's pulse and the sampling interval in all of them.
    #[must_use]
    pub fn covariance_alone_s2(&self) -> f64 {
        let Some(reflected_s) = self.reflected_s else {
            return 0.0;
        };
        let of_interval = self.interval_error.powi(2) * self.incident_s.value * reflected_s.value;
        let Moved { under_s, shape_s } = self.picks.wall.moved;
        self.covariance_s2 - of_interval + under_s.powi(2) + shape_s.powi(2)
    }

    /// The same with a sampling interval whose relative standard error is this: times of
    /// flight are wrong by as much, all of one recording alike.
    #[must_use]
    pub fn with_interval_error(mut self, relative: f64) -> Self {
        self.interval_error = relative;
        self.incident_s.widen(relative);
        if let Some(reflected_s) = &mut self.reflected_s {
            reflected_s.widen(relative);
            self.covariance_s2 += self.incident_s.value * reflected_s.value * relative * relative;
        }
        self
    }

    /// What may have moved the two pulses of the incident and of the reflected time in all alike
    /// shots. The interval's error counts with the pulse that no other time has.
    #[must_use]
    pub fn moved(&self) -> [[Moved; 2]; 2] {
        let [mut incident, mut reflected] = self.picks.moved();
        let more = |of: Estimate| self.interval_error * of.value;
        let widen = |moved: &mut Moved, more: f64| moved.shape_s = moved.shape_s.hypot(more);
        widen(&mut incident[0], more(self.incident_s));
        widen(&mut reflected[1], self.reflected_s.map_or(0.0, more));
        [incident, reflected]
    }

    /// The same where more than this shot tells how much lower a pulse's rival is: below 0 the
    /// rival is the pulse.
    #[must_use]
    pub fn with_rival_lower(&self, place: Place, lower: Estimate) -> Self {
        let mut picks = self.picks;
        let (Some(pulse), Some(rival)) = (picks.pulse(place), picks.rival(place)) else {
            return *self;
        };
        let (most, next) = match lower.value >= 0.0 {
            true => (pulse, rival.picked),
            false => (rival.picked, pulse),
        };
        match place {
            Place::Passing => picks.passing = most,
            Place::Wall => picks.wall = most,
            Place::Returning => picks.returning = Some(most),
        }
        let value = lower.value.abs();
        picks.rivals[place as usize] = Some(PickedRival {
            picked: next,
            lower: Estimate { value, ..lower },
        });
        picks.flight().with_interval_error(self.interval_error)
    }
}

impl Estimate {
    /// Adds a relative error.
    fn widen(&mut self, relative: f64) {
        self.sigma = self.sigma.hypot(relative * self.value);
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
    /// A pulse by its place.
    #[must_use]
    pub fn pulse(&self, place: Place) -> Option<Picked> {
        match place {
            Place::Passing => Some(self.passing),
            Place::Wall => Some(self.wall),
            Place::Returning => self.returning,
        }
    }

    /// The rival of a pulse.
    #[must_use]
    pub fn rival(&self, place: Place) -> Option<PickedRival> {
        self.rivals[place as usize]
    }

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
        let passing_s = time(&self.passing, self.rivals[0].as_ref());
        let wall_s = time(&self.wall, self.rivals[1].as_ref());
        let back_s = back.map(|back| time(back, self.rivals[2].as_ref()));
        Flight {
            incident_s: between(passing_s, wall_s),
            reflected_s: back_s.map(|back_s| between(wall_s, back_s)),
            covariance_s2: back.map_or(0.0, |_| -wall_s.sigma.powi(2)),
            interval_error: 0.0,
            wall_over_passing: height(&self.wall).over(passing),
            returning_over_passing: back.map(|back| height(back).over(passing)),
            picks: self,
        }
    }
}

/// A pulse's time, with the error of having taken another maximum for the largest: as far as
/// that lies off, with the root of its chance.
fn time(picked: &Picked, rival: Option<&PickedRival>) -> Estimate {
    let of_rival = rival.map_or(0.0, |rival| {
        rival.chance().sqrt() * (rival.picked.time_s - picked.time_s)
    });
    Estimate {
        value: picked.time_s,
        sigma: picked.sigma_s.hypot(of_rival),
    }
}

fn between(from: Estimate, to: Estimate) -> Estimate {
    Estimate {
        value: to.value - from.value,
        sigma: from.sigma.hypot(to.sigma),
    }
}

//! One parameter, one side, from the optimum outward.

use super::{End, Profiling};
use crate::covariance::Covariance;
use crate::{Fit, Problem};

/// A walk that asks for values of its parameter and takes what χ² rises to.
pub(super) struct Walk {
    pub parameter: usize,
    /// What was met, by distance from the optimum, which is the first.
    pub met: Vec<Met>,
    side: f64,
    levels: Vec<f64>,
    /// Lower and upper bounds of all parameters.
    bounds: Vec<(f64, f64)>,
    /// First step, positive.
    first: f64,
    /// Farthest distance followed.
    farthest: f64,
    /// Displacement of all parameters for a unit of this one, from the covariance.
    tangent: Vec<f64>,
    most: usize,
    /// Where the model failed, nearest so far.
    failing: Option<f64>,
    asked: f64,
    stop: Option<Stop>,
}

/// A value that was met.
#[derive(Clone, Debug)]
pub(super) struct Met {
    pub point: Vec<f64>,
    pub rise: f64,
}

/// Why a walk goes no farther out.
#[derive(Clone, Copy)]
enum Stop {
    Risen,
    Bound,
    Far,
    Fails,
}

/// Increase of √rise aimed at by each step.
const STRIDE: f64 = 0.5;
/// Longest step, in units of the distance walked so far.
const GROWTH: f64 = 1.5;
/// How far beyond the largest level's √rise the curve is followed.
const BEYOND: f64 = 1.1;
/// Accuracy of √rise at an end.
const ACCURACY: f64 = 1e-3;
/// Farthest distance, in units of the parameter's scale.
const FARTHEST: f64 = 1e3;
/// Nearness to a failing value, in units of the distance walked, at which it is a limit.
const NEAR: f64 = 0.02;

impl Walk {
    pub(super) fn new(
        problem: &dyn Problem,
        (fit, covariance): (&Fit, &Covariance),
        parameter: usize,
        side: f64,
        how: &Profiling,
    ) -> Self {
        let parameters = problem.parameters();
        let (sd, scale) = (covariance.sd[parameter], parameters[parameter].scale);
        let known = sd > 0.0 && sd.is_finite();
        let row = &covariance.matrix[parameter];
        let tangent = row.iter().map(|c| if known { c / (sd * sd) } else { 0.0 });
        Self {
            parameter,
            met: vec![Met {
                point: fit.point.clone(),
                rise: 0.0,
            }],
            side,
            levels: how.levels.clone(),
            bounds: parameters.iter().map(|p| (p.lower, p.upper)).collect(),
            first: if known { STRIDE * sd } else { 0.01 * scale },
            farthest: FARTHEST * scale.max(if known { sd } else { 0.0 }),
            tangent: tangent.collect(),
            most: how.most_values.max(4),
            failing: None,
            asked: 0.0,
            stop: None,
        }
    }

    fn optimum(&self) -> f64 {
        self.met[0].point[self.parameter]
    }

    /// Distance from the optimum and √rise of what was met, outward.
    fn heights(&self) -> impl DoubleEndedIterator<Item = (f64, f64)> + '_ {
        let distance = |met: &Met| (met.point[self.parameter] - self.optimum()).abs();
        (self.met.iter()).map(move |met| (distance(met), met.rise.max(0.0).sqrt()))
    }

    fn last(&self) -> (f64, f64) {
        self.heights().next_back().unwrap_or((0.0, 0.0))
    }

    /// Where to compute next, the others where the last optima point; `None` at the end.
    pub(super) fn next(&mut self) -> Option<Vec<f64>> {
        let distance = match self.stop {
            None => self.outward(),
            Some(_) => None,
        };
        let distance = distance.or_else(|| self.inward())?;
        self.asked = distance;
        Some(self.start(distance))
    }

    /// Distance of the next value farther out, or none and the reason.
    fn outward(&mut self) -> Option<f64> {
        let (distance, height) = self.last();
        let goal = BEYOND * self.levels.last().copied().unwrap_or(1.0).sqrt();
        let (lower, upper) = self.bounds[self.parameter];
        let room = if self.side > 0.0 {
            upper - self.optimum()
        } else {
            self.optimum() - lower
        };
        self.stop = match () {
            () if height >= goal => Some(Stop::Risen),
            () if distance >= room => Some(Stop::Bound),
            () if self.nears_failure(distance) => Some(Stop::Fails),
            () if distance >= self.farthest || self.met.len() > self.most => Some(Stop::Far),
            () => None,
        };
        if self.stop.is_some() {
            return None;
        }
        let limit = self
            .failing
            .map_or(f64::INFINITY, |fails| 0.5 * (distance + fails));
        Some((distance + self.step()).min(room).min(limit))
    }

    fn nears_failure(&self, distance: f64) -> bool {
        let near = |fails: f64| fails - distance <= NEAR * fails;
        self.failing.is_some_and(near)
    }

    /// From the slope of √rise over the last step, within what is sensible.
    fn step(&self) -> f64 {
        let mut outermost = self.heights().rev();
        let (Some((far, high)), Some((near, low))) = (outermost.next(), outermost.next()) else {
            return self.first;
        };
        let aimed = STRIDE * (far - near) / (high - low).max(f64::MIN_POSITIVE);
        aimed.clamp(0.1 * (far - near), (GROWTH * far).max(self.first))
    }

    /// Distance at which a level is looked for between two values, if any is still wanted.
    fn inward(&self) -> Option<f64> {
        (0..self.levels.len()).find_map(|i| {
            let goal = self.levels[i].sqrt();
            let (near, far) = self.bracket(i)?;
            let close = |height: f64| (height - goal).abs() <= ACCURACY;
            let narrow = far.0 - near.0 <= 1e-9 * far.0;
            if close(near.1) || close(far.1) || narrow || self.met.len() > 2 * self.most {
                return None;
            }
            // Straight in √rise, kept off the ends so that the bracket shrinks.
            let share = (goal - near.1) / (far.1 - near.1);
            Some(near.0 + share.clamp(0.02, 0.98) * (far.0 - near.0))
        })
    }

    /// Values met below and above a level.
    fn bracket(&self, level: usize) -> Option<((f64, f64), (f64, f64))> {
        let goal = self.levels[level].sqrt();
        let pairs = self.heights().zip(self.heights().skip(1));
        pairs
            .into_iter()
            .find(|(near, far)| near.1 < goal && far.1 >= goal)
    }

    /// All parameters where a descent for this distance starts.
    fn start(&self, distance: f64) -> Vec<f64> {
        let value = self.optimum() + self.side * distance;
        let place = self.heights().take_while(|met| met.0 < distance).count();
        let near = &self.met[place.saturating_sub(1)].point;
        let other = match (place, self.met.get(place)) {
            (_, Some(beyond)) => Some(&beyond.point),
            (2.., None) => Some(&self.met[place - 2].point),
            _ => None,
        };
        let along = |point: &Vec<f64>| point[self.parameter];
        let slope = |k: usize| match other {
            Some(other) => (other[k] - near[k]) / (along(other) - along(near)),
            None => self.tangent[k],
        };
        let moved = |k: usize| {
            let (lower, upper) = self.bounds[k];
            (near[k] + slope(k) * (value - along(near))).clamp(lower, upper)
        };
        let mut start: Vec<f64> = (0..near.len()).map(moved).collect();
        let (lower, upper) = self.bounds[self.parameter];
        start[self.parameter] = value.clamp(lower, upper);
        start
    }

    /// Takes the optimum of the others and the rise of χ², or that there is none.
    pub(super) fn take(&mut self, found: Option<(Vec<f64>, f64)>) {
        match found {
            Some((point, rise)) => {
                let place = self.heights().take_while(|met| met.0 < self.asked).count();
                self.met.insert(place, Met { point, rise });
            }
            None if self.stop.is_some() => self.most = 0,
            None => self.failing = Some(self.asked),
        }
    }

    /// The end of a level's interval.
    pub(super) fn end(&self, level: usize) -> End {
        let at = |distance: f64| self.optimum() + self.side * distance;
        if let Some((near, far)) = self.bracket(level) {
            let share = (self.levels[level].sqrt() - near.1) / (far.1 - near.1);
            return End::At(at(near.0 + share * (far.0 - near.0)));
        }
        let last = at(self.last().0);
        match self.stop {
            Some(Stop::Bound) => End::Bound(last),
            Some(Stop::Fails) => End::ModelFails(last),
            _ => End::Open(last),
        }
    }
}

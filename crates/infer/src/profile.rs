//! Profile likelihood: uncertainty by re-optimising everything else.

use crate::least_squares::{Descent, Merit, run};
use crate::{Covariance, Fit, Fitting, InferError, Problem};

/// How to profile.
#[derive(Clone, Debug, PartialEq)]
pub struct Profiling {
    /// Rises of χ² whose intervals are wanted, ascending: 1 and 3.841459 for 68.3 and 95 %.
    pub levels: Vec<f64>,
    /// Most values of a parameter on either side of the optimum.
    pub most_values: usize,
}

/// Rise of χ² that bounds a 95 % interval of one parameter.
pub const RISE_OF_95_PERCENT: f64 = 3.841_458_820_694_124;

impl Default for Profiling {
    fn default() -> Self {
        Self { levels: vec![1.0, RISE_OF_95_PERCENT], most_values: 60 }
    }
}

/// The least χ² as a function of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Which parameter.
    pub parameter: usize,
    /// Its values, ascending, the optimum among them.
    pub values: Vec<f64>,
    /// χ² above the optimum at each value, all other parameters re-optimised;
    /// priors and ln σ are counted in, a robust loss replaces the squares.
    pub rise: Vec<f64>,
    /// All parameters at each value.
    pub points: Vec<Vec<f64>>,
    /// One interval a level.
    pub intervals: Vec<Interval>,
}

/// An interval of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Rise of χ² at its ends.
    pub level: f64,
    /// Lower end.
    pub lower: End,
    /// Upper end.
    pub upper: End,
}

/// An end of an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// χ² has risen to the level here.
    At(f64),
    /// χ² does not rise to the level up to this bound of the parameter.
    Bound(f64),
    /// χ² did not rise to the level as far as it was followed: the data set no limit.
    Open(f64),
    /// Beyond this value the others cannot be re-optimised, though χ² has not
    /// risen to the level: the model fails there, or is computed too coarsely.
    ModelFails(f64),
}

impl End {
    /// The value if the data determine it.
    pub fn closed(self) -> Option<f64> {
        match self {
            Self::At(value) => Some(value),
            _ => None,
        }
    }
}

/// Fall of χ² below the optimum's that is more than noise of the model.
const BETTER: f64 = 0.01;

/// Profiles of those of some parameters that there are, all walks and descents side by side.
///
/// From the optimum outward, each value is held and the others re-optimised from
/// where the last two values' optima point; the ends are found on √(χ² rise),
/// which is straight where the problem is linear, to 10⁻³ standard errors.
///
/// # Errors
/// An unconverged fit, a better fit met on the way, unusable levels.
pub fn profile(
    problem: &dyn Problem,
    fit: &Fit,
    covariance: &Covariance,
    which: &[usize],
    how: &Profiling,
) -> Result<Vec<Profile>, InferError> {
    let sound = how.levels.iter().all(|level| *level > 0.0 && level.is_finite());
    if !sound || how.levels.is_empty() || !how.levels.is_sorted() {
        let levels = &how.levels;
        return InferError::input(format!("levels {levels:?} must be positive and ascending"));
    }
    if !fit.ending.converged() {
        let text = "the fit has not converged: a profile needs a minimum to start from";
        return Err(InferError::NotConverged(text.to_owned()));
    }
    let known = which.iter().filter(|k| **k < fit.point.len());
    let mut walks: Vec<Walk> = known
        .flat_map(|k| [-1.0, 1.0].map(|side| Walk::new(problem, (fit, covariance), *k, side, how)))
        .collect();
    while walk_on(problem, fit, &mut walks)? {}
    Ok(walks.chunks(2).map(|pair| joined(pair, how)).collect())
}

/// One round: a value for each walk that is not at its end; whether there was any.
fn walk_on(problem: &dyn Problem, fit: &Fit, walks: &mut [Walk]) -> Result<bool, InferError> {
    let merit = Merit::new(problem, fit.loss);
    let mut going: Vec<(&mut Walk, Vec<f64>)> =
        (walks.iter_mut()).filter_map(|walk| walk.next().map(|point| (walk, point))).collect();
    let limits = Fitting::default().limits();
    let mut descents: Vec<Descent<'_>> = (going.iter())
        .map(|(walk, point)| {
            let others = (0..point.len()).filter(|k| *k != walk.parameter).collect();
            Descent::new(merit.clone(), point.clone(), others, limits)
                .with_steps(&fit.jacobian.steps)
        })
        .collect();
    run(problem, &mut descents);
    for ((walk, _), reached) in going.iter_mut().zip(descents) {
        let rise = 2.0 * (reached.cost() - fit.cost);
        if rise < -BETTER {
            let point = reached.point;
            return Err(InferError::BetterFit { point, by: -rise });
        }
        let found = reached.ending().converged().then_some((reached.point, rise));
        walk.take(found);
    }
    Ok(!going.is_empty())
}

fn joined(pair: &[Walk], how: &Profiling) -> Profile {
    let (down, up) = (&pair[0], &pair[pair.len() - 1]);
    let below = down.met.iter().skip(1).rev();
    let all: Vec<_> = below.chain(&up.met).collect();
    let levels = how.levels.iter().enumerate();
    Profile {
        parameter: up.parameter,
        values: all.iter().map(|met| met.point[up.parameter]).collect(),
        rise: all.iter().map(|met| met.rise).collect(),
        points: all.iter().map(|met| met.point.clone()).collect(),
        intervals: levels
            .map(|(i, level)| Interval { level: *level, lower: down.end(i), upper: up.end(i) })
            .collect(),
    }
}

/// A walk that asks for values of its parameter and takes what χ² rises to.
struct Walk {
    parameter: usize,
    /// What was met, by distance from the optimum, which is the first.
    met: Vec<Met>,
    side: f64,
    levels: Vec<f64>,
    /// Lower and upper bounds of all parameters.
    bounds: Vec<(f64, f64)>,
    /// First step, positive.
    first: f64,
    limit_distance: f64,
    /// Displacement of all parameters for a unit of this one, from the covariance.
    tangent: Vec<f64>,
    most: usize,
    /// Where the model failed, nearest so far.
    failing: Option<f64>,
    asked: f64,
    stop: Option<ProfileStop>,
}

#[derive(Clone, Debug)]
struct Met {
    point: Vec<f64>,
    rise: f64,
}

/// Why a walk goes no farther out.
#[derive(Clone, Copy)]
enum ProfileStop {
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
/// Largest distance followed, in units of the parameter's scale.
const LARGEST_DISTANCE: f64 = 1e3;
/// Nearness to a failing value, in units of the distance walked, at which it is a limit.
const NEAR: f64 = 0.02;

impl Walk {
    fn new(
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
            met: vec![Met { point: fit.point.clone(), rise: 0.0 }],
            side,
            levels: how.levels.clone(),
            bounds: parameters.iter().map(|p| (p.lower, p.upper)).collect(),
            first: if known { STRIDE * sd } else { 0.01 * scale },
            limit_distance: LARGEST_DISTANCE * scale.max(if known { sd } else { 0.0 }),
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
    fn next(&mut self) -> Option<Vec<f64>> {
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
        let room = if self.side > 0.0 { upper - self.optimum() } else { self.optimum() - lower };
        self.stop = match () {
            () if height >= goal => Some(ProfileStop::Risen),
            () if distance >= room => Some(ProfileStop::Bound),
            () if self.failing.is_some_and(|fails| fails - distance <= NEAR * fails) => {
                Some(ProfileStop::Fails)
            }
            () if distance >= self.limit_distance || self.met.len() > self.most => {
                Some(ProfileStop::Far)
            }
            () => None,
        };
        if self.stop.is_some() {
            return None;
        }
        let limit = self.failing.map_or(f64::INFINITY, |fails| 0.5 * (distance + fails));
        Some((distance + self.step()).min(room).min(limit))
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
        pairs.into_iter().find(|(near, far)| near.1 < goal && far.1 >= goal)
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
    fn take(&mut self, found: Option<(Vec<f64>, f64)>) {
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
    fn end(&self, level: usize) -> End {
        let at = |distance: f64| self.optimum() + self.side * distance;
        if let Some((near, far)) = self.bracket(level) {
            let share = (self.levels[level].sqrt() - near.1) / (far.1 - near.1);
            return End::At(at(near.0 + share * (far.0 - near.0)));
        }
        let last = at(self.last().0);
        match self.stop {
            Some(ProfileStop::Bound) => End::Bound(last),
            Some(ProfileStop::Fails) => End::ModelFails(last),
            _ => End::Open(last),
        }
    }
}

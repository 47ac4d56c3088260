//! Levenberg–Marquardt descents that ask for residuals, so that many share one call of the model.

use super::merit::{Linear, Merit, Neighbours, Slopes, Valued, slopes};
use crate::linear::{Svd, combine, dot, norm, svd};
use crate::{ModelError, Parameter, Problem, Residuals};
use std::fmt;

/// A point and the residuals around it.
type Around = (Vec<f64>, Vec<Result<Residuals, ModelError>>);

/// A Levenberg–Marquardt descent [More1978].
///
/// Columns are scaled to unit length; a step solves (JᵀJ + λ) s = −g by singular values, once for
/// all λ tried. Parameters at a bound that the gradient pushes outward are held; steps beyond a
/// bound end at it.
pub(crate) struct Descent<'a> {
    merit: Merit<'a>,
    free: Vec<usize>,
    limits: DescentLimits,
    pub point: Vec<f64>,
    /// Residuals there; `None` if the model failed at the first point.
    pub at: Option<Valued>,
    /// Steps of differences, one for each parameter of the problem.
    pub steps: Vec<f64>,
    damping: f64,
    stage: Stage,
    pub iterations: usize,
    /// Iterations in a row that hardly gained anything.
    idle: usize,
    start: Vec<f64>,
    /// Whether every parameter must change some residual at the start.
    checks_start: bool,
    /// Whether the last step went as the linear model predicts: then fewer are tried.
    is_linear: bool,
    /// Residuals at the neighbours of the point, two for each free parameter, and their steps.
    pub around: Option<Around>,
}

/// When a descent ends: expected fall of the cost at which the minimum counts as reached, as it is or
/// as a share of the cost, and most iterations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DescentLimits {
    pub tolerance: f64,
    pub share: f64,
    pub iterations: usize,
}

/// Why a descent ended.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Ending {
    /// The cost would fall by less than the tolerance.
    Minimum,
    /// No step lowers the cost any more, though a small fall was expected: the model is no
    /// smoother than that.
    Floor {
        /// Expected fall of χ²/2.
        expected_fall: f64,
    },
    /// No step lowers the cost, though it should fall by a good deal.
    Stuck {
        /// Expected fall of χ²/2.
        expected_fall: f64,
    },
    /// The minimum in all identifiable directions; along the others there is no one minimum.
    Open {
        /// Expected fall of χ²/2 along the identifiable directions.
        expected_fall: f64,
    },
    /// The iterations allowed ran out.
    Iterations {
        /// Expected fall of χ²/2.
        expected_fall: f64,
    },
    /// The model has no residuals here or at the neighbours.
    ModelFails(ModelError),
    /// A parameter, by its place, that changes no residual at the start, or diverges.
    ChangesNothing(usize),
}

impl Ending {
    /// Whether the point reached is a minimum, as far as the model is smooth.
    pub fn converged(&self) -> bool {
        matches!(self, Self::Minimum | Self::Floor { .. } | Self::Open { .. })
    }
}

impl fmt::Display for Ending {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Minimum => write!(f, "converged"),
            Self::Floor { expected_fall } => write!(
                f,
                "converged as far as the model is smooth (chi-square could fall by {:.1e})",
                2.0 * expected_fall
            ),
            Self::Open { .. } => write!(
                f,
                "converged in the identifiable directions; along the unidentifiable ones there is no one minimum"
            ),
            Self::Stuck { expected_fall } => write!(
                f,
                "stuck: chi-square should fall by {:.1e} but no step lowers it; the model may be discontinuous, or computed too coarsely",
                2.0 * expected_fall
            ),
            Self::Iterations { expected_fall } => write!(
                f,
                "not converged: chi-square was still to fall by {:.1e} when the iterations allowed were used up",
                2.0 * expected_fall
            ),
            Self::ModelFails(error) => write!(f, "not converged: the model fails: {error}"),
            Self::ChangesNothing(at) => {
                write!(f, "not converged: parameter {} changes nothing", at + 1)
            }
        }
    }
}

/// What a descent asks residuals for.
enum Stage {
    /// The first point and its neighbours.
    Start(Vec<Neighbours>),
    Slopes(Vec<Neighbours>),
    /// The ends of steps with several λ.
    Trials(Box<Trials>),
    Done(Ending),
}

struct Trials {
    linear: Linear,
    svd: Svd,
    /// Free parameters that are not held at a bound, as places among the free.
    loose: Vec<usize>,
    scales: Vec<f64>,
    expected_fall: f64,
    dampings: Vec<f64>,
    points: Vec<Vec<f64>>,
}

/// First step of differences, in units of a parameter's scale.
const FIRST_STEP: f64 = 1e-3;
/// Later steps aim at this change of the residuals' length: large against the model's own noise,
/// small against the curvature over one standard error.
const AIM: f64 = 0.3;
/// Where steps stay, in units of a parameter's scale.
const STEPS: [f64; 2] = [1e-6, 1e-2];
/// Singular values below this share of the largest are not resolved by differences.
const RESOLVED: f64 = 1e-5;
const LARGEST_DAMPING: f64 = 1e10;
const LEAST_DAMPING: f64 = 1e-12;
/// A fall of χ²/2 that no conclusion depends on.
pub(super) const SMALL_FALL: f64 = 1e-3;
/// Change of all residuals, in σ, by a parameter's whole size, that counts for nothing.
pub(super) const NOTICED: f64 = 0.01;
/// Distance from the start, in units of the scale, from which a parameter diverges.
const DIVERGED: f64 = 1e3;
/// An expected fall that is hardly more than a model's noise: where a step does not gain at least a
/// tenth of it, none will. It is 0.0014 standard errors.
const QUIET_FALL: f64 = 1e-6;
/// Iterations that gain less than a thousandth of what was expected, before the descent ends.
const IDLE: usize = 3;

impl<'a> Descent<'a> {
    /// A descent from `point` over the parameters `free`.
    pub(crate) fn new(
        merit: Merit<'a>,
        point: Vec<f64>,
        free: Vec<usize>,
        limits: DescentLimits,
    ) -> Self {
        let parameters = merit.problem.parameters();
        let steps: Vec<f64> = parameters.iter().map(|p| FIRST_STEP * p.scale).collect();
        Self {
            merit,
            free,
            limits,
            start: point.clone(),
            point,
            at: None,
            steps: Vec::new(),
            damping: 1e-3,
            stage: Stage::Done(Ending::Minimum),
            iterations: 0,
            idle: 0,
            checks_start: false,
            is_linear: false,
            around: None,
        }
        .with_steps(&steps)
    }

    /// The same with steps of differences that are known to suit.
    pub(crate) fn with_steps(mut self, steps: &[f64]) -> Self {
        self.steps = steps.to_vec();
        self.stage = Stage::Start(self.neighbours());
        self
    }

    /// The same, ended at once if a parameter changes nothing where it starts.
    pub(crate) fn checking_start(mut self) -> Self {
        self.checks_start = true;
        self
    }

    fn parameters(&self) -> &'a [Parameter] {
        self.merit.problem.parameters()
    }

    fn neighbours(&self) -> Vec<Neighbours> {
        let pair =
            |k: &usize| Neighbours::new(*k, &self.parameters()[*k], self.point[*k], self.steps[*k]);
        self.free.iter().map(pair).collect()
    }

    /// Points whose residuals are wanted next; none when the descent has ended.
    fn wanted(&self) -> Vec<Vec<f64>> {
        let around = |pairs: &[Neighbours]| -> Vec<Vec<f64>> {
            pairs.iter().flat_map(|pair| pair.points(&self.point)).collect()
        };
        match &self.stage {
            Stage::Start(pairs) => [vec![self.point.clone()], around(pairs)].concat(),
            Stage::Slopes(pairs) => around(pairs),
            Stage::Trials(trials) => trials.points.clone(),
            Stage::Done(_) => Vec::new(),
        }
    }

    /// Takes the residuals at the points asked for.
    fn take(&mut self, found: &[Result<Residuals, ModelError>]) {
        let stage = std::mem::replace(&mut self.stage, Stage::Done(Ending::Minimum));
        let next = match stage {
            Stage::Start(pairs) => match found.split_first() {
                Some((first, rest)) => self.merit.value(&self.point, first).and_then(|at| {
                    self.at = Some(at);
                    self.prepare(&pairs, rest)
                }),
                None => Err(ModelError::default()),
            },
            Stage::Slopes(pairs) => self.prepare(&pairs, found),
            Stage::Trials(trials) => Ok(self.accept(trials, found)),
            done => Ok(done),
        };
        self.stage = next.unwrap_or_else(|error| Stage::Done(Ending::ModelFails(error)));
    }

    /// From slopes to the next trials, or to the end.
    fn prepare(
        &mut self,
        pairs: &[Neighbours],
        found: &[Result<Residuals, ModelError>],
    ) -> Result<Stage, ModelError> {
        let at = self.at.as_ref().ok_or_else(ModelError::default)?;
        let slopes = slopes(&self.merit, (&self.point, at), pairs, found)?;
        if let Some(parameter) = self.without_effect(&slopes) {
            return Ok(Stage::Done(Ending::ChangesNothing(parameter)));
        }
        let linear = self.merit.linear(at, &slopes);
        // The first steps are not yet suited to the residuals.
        self.around = (self.iterations > 0).then(|| (self.steps.clone(), found.to_vec()));
        for (k, column) in self.free.iter().zip(&linear.columns) {
            let scale = self.merit.problem.parameters()[*k].scale;
            self.steps[*k] = (AIM / norm(column)).clamp(STEPS[0] * scale, STEPS[1] * scale);
        }
        let trials = self.trials(linear);
        let expected_fall = trials.expected_fall;
        if expected_fall < self.limits.tolerance.max(self.limits.share * self.cost()) {
            return Ok(Stage::Done(Ending::Minimum));
        }
        if self.iterations >= self.limits.iterations {
            return Ok(Stage::Done(Ending::Iterations { expected_fall }));
        }
        if self.idle >= IDLE {
            return Ok(self.at_rest(expected_fall));
        }
        self.iterations += 1;
        Ok(Stage::Trials(Box::new(trials)))
    }

    /// A parameter by whose whole size no residual changes, at the start or far from it.
    fn without_effect(&self, slopes: &Slopes) -> Option<usize> {
        let data = self.merit.problem.residual_count();
        let without = |(k, column): (&usize, &Vec<f64>)| {
            let (value, scale) = (self.point[*k], self.parameters()[*k].scale);
            let diverged = (value - self.start[*k]).abs() > DIVERGED * scale;
            let is_checked = diverged || self.checks_start && self.iterations == 0;
            let effect = norm(&column[..data]) * value.abs().max(scale);
            (is_checked && effect < NOTICED).then_some(*k)
        };
        self.free.iter().zip(&slopes.columns).find_map(without)
    }

    fn trials(&self, linear: Linear) -> Trials {
        let is_held = |place: &usize| {
            let (k, slope) = (self.free[*place], linear.gradient[*place]);
            let parameter = &self.parameters()[k];
            (self.point[k] <= parameter.lower && slope > 0.0)
                || (self.point[k] >= parameter.upper && slope < 0.0)
        };
        let loose: Vec<usize> = (0..self.free.len()).filter(|place| !is_held(place)).collect();
        let lengths = loose.iter().map(|place| norm(&linear.columns[*place]));
        let scales: Vec<f64> =
            lengths.map(|length| if length > 0.0 { length } else { 1.0 }).collect();
        let scaled = loose.iter().zip(&scales);
        let scaled = scaled.map(|(p, d)| linear.columns[*p].iter().map(|x| x / d).collect());
        let mut trials = Trials {
            svd: svd(&scaled.collect::<Vec<_>>()),
            linear,
            loose,
            scales,
            expected_fall: 0.0,
            dampings: Vec::new(),
            points: Vec::new(),
        };
        trials.expected_fall = trials.fall();
        self.spread(&mut trials, self.damping);
        trials
    }

    /// Ends of steps for dampings around a middle one.
    fn spread(&self, trials: &mut Trials, damping: f64) {
        let factors: &[f64] = match self.is_linear {
            true => &[0.1, 100.0],
            false => &[0.1, 1.0, 10.0, 100.0],
        };
        trials.dampings = factors.iter().map(|factor| factor * damping).collect();
        let end = |damping: &f64| {
            let mut point = self.point.clone();
            for (place, step) in trials.loose.iter().zip(trials.step(*damping)) {
                let k = self.free[*place];
                let parameter = &self.parameters()[k];
                point[k] = (point[k] + step).clamp(parameter.lower, parameter.upper);
            }
            point
        };
        trials.points = trials.dampings.iter().map(end).collect();
    }

    /// Moves to the best trial, or tries shorter steps, or ends.
    fn accept(
        &mut self,
        mut trials: Box<Trials>,
        found: &[Result<Residuals, ModelError>],
    ) -> Stage {
        let valued = trials.points.iter().zip(found).enumerate();
        let best = valued
            .filter_map(|(i, (point, found))| Some((i, self.merit.value(point, found).ok()?)))
            .min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
        let (before, fall) = (self.cost(), trials.expected_fall);
        let most = trials.dampings.last().copied().unwrap_or(LARGEST_DAMPING);
        match best {
            Some((i, valued)) if valued.cost < before => {
                let gained = before - valued.cost;
                self.idle = if gained < 1e-3 * fall.min(1.0) { self.idle + 1 } else { 0 };
                if fall < QUIET_FALL && gained < 0.1 * fall {
                    self.idle = IDLE;
                }
                self.is_linear = gained > 0.5 * fall;
                self.damping = (0.3 * trials.dampings[i]).max(LEAST_DAMPING);
                self.point.clone_from(&trials.points[i]);
                self.around = None;
                self.at = Some(valued);
                Stage::Slopes(self.neighbours())
            }
            _ if fall >= QUIET_FALL && most < LARGEST_DAMPING => {
                self.damping = 1e3 * most;
                self.is_linear = false;
                self.spread(&mut trials, self.damping);
                Stage::Trials(trials)
            }
            _ => self.at_rest(fall),
        }
    }

    /// A rest where the cost should fall by so much: far from the data, chi-square is large and
    /// changes by its own share where no conclusion does.
    fn at_rest(&self, expected_fall: f64) -> Stage {
        let rows = self.at.as_ref().map_or(&[][..], |at| &at.rows);
        let freedom = rows.len().saturating_sub(self.free.len()).max(1);
        let reduced_chi_square = dot(rows, rows) / freedom as f64;
        Stage::Done(match expected_fall < SMALL_FALL * reduced_chi_square.max(1.0) {
            true => Ending::Floor { expected_fall },
            false => Ending::Stuck { expected_fall },
        })
    }

    pub(crate) fn cost(&self) -> f64 {
        self.at.as_ref().map_or(f64::INFINITY, |at| at.cost)
    }

    pub(crate) fn ending(&self) -> Ending {
        match &self.stage {
            Stage::Done(ending) => ending.clone(),
            _ => Ending::ModelFails(ModelError("the descent was left early".into())),
        }
    }
}

impl Trials {
    /// Components of the scaled gradient along the right singular vectors.
    fn along(&self) -> Vec<f64> {
        let pairs = self.loose.iter().zip(&self.scales);
        let gradient: Vec<f64> =
            pairs.map(|(place, scale)| self.linear.gradient[*place] / scale).collect();
        self.svd.right.iter().map(|v| dot(v, &gradient)).collect()
    }

    /// ½ gᵀ (JᵀJ)⁻¹ g over the directions that differences resolve.
    fn fall(&self) -> f64 {
        let least = RESOLVED * self.svd.values.first().copied().unwrap_or(0.0);
        let parts = self.along().into_iter().zip(&self.svd.values);
        let resolved = parts.filter(|(_, value)| **value > least);
        resolved.map(|(along, value)| 0.5 * (along / value).powi(2)).sum()
    }

    /// −(JᵀJ + λ)⁻¹ g, in the parameters' units.
    fn step(&self, damping: f64) -> Vec<f64> {
        let pairs = self.along().into_iter().zip(&self.svd.values);
        let weights: Vec<f64> =
            pairs.map(|(along, value)| -along / (value * value + damping)).collect();
        let scaled = combine(&self.svd.right, &weights);
        scaled.iter().zip(&self.scales).map(|(s, d)| s / d).collect()
    }
}

/// Runs descents to their ends, one call of the model a round; returns how often it was computed.
pub(crate) fn run(problem: &dyn Problem, descents: &mut [Descent<'_>]) -> usize {
    let mut evaluations = 0;
    loop {
        let wanted: Vec<Vec<Vec<f64>>> = descents.iter().map(Descent::wanted).collect();
        let counts: Vec<usize> = wanted.iter().map(Vec::len).collect();
        let points: Vec<Vec<f64>> = wanted.into_iter().flatten().collect();
        if points.is_empty() {
            return evaluations;
        }
        evaluations += points.len();
        let mut found = problem.residuals(&points);
        let missing = || Err(ModelError("the model returned no result here".into()));
        found.resize_with(points.len(), missing);
        let mut rest = found.as_slice();
        for (descent, count) in descents.iter_mut().zip(counts) {
            let (own, others) = rest.split_at(count);
            rest = others;
            if count > 0 {
                descent.take(own);
            }
        }
    }
}

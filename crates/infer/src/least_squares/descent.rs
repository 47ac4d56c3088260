//! One way down to a minimum, as questions and answers.

use super::merit::{Linear, Merit, Valued};
use super::slopes::{Slopes, Stencil, slopes};
use crate::linear::{Svd, dot, norm, svd};
use crate::{ModelError, Parameter, Residuals};

/// A Levenberg–Marquardt descent [More1978] that asks for residuals instead of
/// computing them, so that many descents share one call of the model.
///
/// Columns are scaled to unit length; a step solves (JᵀJ + λ) s = −g by singular
/// values, once for all λ tried. Parameters at a bound that the gradient pushes
/// outward are held; steps beyond a bound end at it.
pub(crate) struct Descent<'a> {
    merit: Merit<'a>,
    free: Vec<usize>,
    limits: Limits,
    point: Vec<f64>,
    at: Option<Valued>,
    /// Steps of differences, one for each parameter of the problem.
    steps: Vec<f64>,
    damping: f64,
    stage: Stage,
    iterations: usize,
    /// Iterations in a row that hardly gained anything.
    idle: usize,
    /// Where it started, and whether it must see there that every parameter counts.
    start: Vec<f64>,
    wary: bool,
    /// Whether the last step went as the linear model said: then fewer are tried.
    sure: bool,
    /// Neighbours of the point, and the steps to them.
    beside: Option<Beside>,
}

/// When a descent ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    /// Expected fall of the cost at which the minimum counts as reached.
    pub tolerance: f64,
    /// Most iterations.
    pub iterations: usize,
}

/// Why a descent ended.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Ending {
    /// The cost would fall by less than the tolerance.
    Minimum,
    /// No step lowers the cost any more, though `expected_fall`, small against
    /// one, was left: the model is no smoother than that.
    Floor {
        /// Expected fall of χ²/2.
        expected_fall: f64,
    },
    /// No step lowers the cost, though it should fall by a good deal.
    Stuck {
        /// Expected fall of χ²/2.
        expected_fall: f64,
    },
    /// The minimum of all that the data determine; along combinations that they leave
    /// open there is no one minimum.
    Open {
        /// Expected fall of χ²/2 along those that they determine.
        expected_fall: f64,
    },
    /// The iterations allowed ran out.
    Iterations {
        /// Expected fall of χ²/2.
        expected_fall: f64,
    },
    /// The model has no residuals here or beside here.
    ModelFails(ModelError),
    /// A parameter, by its place, that changes no residual at the start, or is on
    /// its way to nowhere.
    ChangesNothing(usize),
}

impl Ending {
    /// Whether the point reached is a minimum, as far as the model is smooth.
    #[must_use]
    pub fn converged(&self) -> bool {
        matches!(self, Self::Minimum | Self::Floor { .. } | Self::Open { .. })
    }
}

impl std::fmt::Display for Ending {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Minimum => write!(f, "converged"),
            Self::Floor { expected_fall } => write!(
                f,
                "converged as far as the model is smooth (chi-square could fall by {:.1e})",
                2.0 * expected_fall
            ),
            Self::Open { .. } => write!(
                f,
                "converged in what the data determine; along the combinations that they leave open there is no one minimum"
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

enum Stage {
    /// Residuals at the first point and its neighbours.
    Start(Vec<Stencil>),
    /// Residuals at the neighbours of a point.
    Slopes(Vec<Stencil>),
    /// Residuals at the ends of steps with several λ.
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
/// Later steps aim at this change of the residuals' length: large against the
/// model's own noise, small against the curvature over one standard error.
const AIM: f64 = 0.3;
/// Where steps stay, in units of a parameter's scale.
const STEPS: [f64; 2] = [1e-6, 1e-2];
/// Singular values below this share of the largest have no part in the
/// expected fall: differences do not resolve them.
const RESOLVED: f64 = 1e-5;
const LARGEST_DAMPING: f64 = 1e10;
const LEAST_DAMPING: f64 = 1e-12;
/// A fall of χ²/2 that no conclusion depends on.
pub(super) const SMALL_FALL: f64 = 1e-3;
/// Change of all residuals together, in σ, by a parameter's whole size, below which
/// it counts for nothing.
pub(super) const NOTICED: f64 = 0.01;
/// Distance from the start, in units of the scale, from which it is nowhere.
const NOWHERE: f64 = 1e3;
/// An expected fall that is hardly more than a model's noise: where a step does not
/// gain at least a tenth of it, none will. It is 0.0014 standard errors.
const QUIET_FALL: f64 = 1e-6;
/// Iterations that gain less than a thousandth of what was expected, after
/// which the model's noise is taken to be reached.
const IDLE: usize = 3;

impl<'a> Descent<'a> {
    /// A descent from `point` over the parameters `free`.
    pub(crate) fn new(merit: Merit<'a>, point: Vec<f64>, free: Vec<usize>, limits: Limits) -> Self {
        let parameters = merit.problem.parameters();
        let steps: Vec<f64> = parameters.iter().map(|p| FIRST_STEP * p.scale).collect();
        let mut descent = Self {
            merit,
            free,
            limits,
            start: point.clone(),
            point,
            at: None,
            steps,
            damping: 1e-3,
            stage: Stage::Done(Ending::Minimum),
            iterations: 0,
            idle: 0,
            wary: false,
            sure: false,
            beside: None,
        };
        descent.stage = Stage::Start(descent.stencils());
        descent
    }

    /// The same with steps of differences that are known to suit.
    pub(crate) fn with_steps(mut self, steps: &[f64]) -> Self {
        self.steps = steps.to_vec();
        self.stage = Stage::Start(self.stencils());
        self
    }

    /// The same, ended at once if a parameter changes nothing where it starts.
    pub(crate) fn wary(mut self) -> Self {
        self.wary = true;
        self
    }

    fn parameters(&self) -> &'a [Parameter] {
        self.merit.problem.parameters()
    }

    fn stencils(&self) -> Vec<Stencil> {
        let stencil = |k: &usize| {
            let k = *k;
            Stencil::new(k, &self.parameters()[k], self.point[k], self.steps[k])
        };
        self.free.iter().map(stencil).collect()
    }

    /// Points whose residuals are wanted next; none when the descent has ended.
    pub(crate) fn ask(&self) -> Vec<Vec<f64>> {
        let neighbours = |stencils: &[Stencil]| {
            let points = stencils.iter().flat_map(|s| s.points(&self.point));
            points.collect::<Vec<_>>()
        };
        match &self.stage {
            Stage::Start(stencils) => {
                let mut points = vec![self.point.clone()];
                points.extend(neighbours(stencils));
                points
            }
            Stage::Slopes(stencils) => neighbours(stencils),
            Stage::Trials(trials) => trials.points.clone(),
            Stage::Done(_) => Vec::new(),
        }
    }

    /// Takes the residuals at the points asked for.
    pub(crate) fn tell(&mut self, found: &[Result<Residuals, ModelError>]) {
        let stage = std::mem::replace(&mut self.stage, Stage::Done(Ending::Minimum));
        self.stage = match stage {
            Stage::Start(stencils) => self.started(&stencils, found),
            Stage::Slopes(stencils) => self.aim(&stencils, found),
            Stage::Trials(trials) => self.tried(trials, found),
            Stage::Done(ending) => Stage::Done(ending),
        };
    }

    fn started(&mut self, stencils: &[Stencil], found: &[Result<Residuals, ModelError>]) -> Stage {
        let Some((first, rest)) = found.split_first() else {
            return Stage::Done(Ending::ModelFails(ModelError::default()));
        };
        match self.merit.value(&self.point, first) {
            Ok(at) => self.at = Some(at),
            Err(error) => return Stage::Done(Ending::ModelFails(error)),
        }
        self.aim(stencils, rest)
    }

    /// From slopes to the next trials, or to the end.
    fn aim(&mut self, stencils: &[Stencil], found: &[Result<Residuals, ModelError>]) -> Stage {
        let Some(at) = &self.at else {
            return Stage::Done(Ending::ModelFails(ModelError::default()));
        };
        let slopes = match slopes(&self.merit, (&self.point, at), stencils, found) {
            Ok(slopes) => slopes,
            Err(error) => return Stage::Done(Ending::ModelFails(error)),
        };
        if let Some(parameter) = self.without_effect(&slopes) {
            return Stage::Done(Ending::ChangesNothing(parameter));
        }
        let linear = self.merit.linear(at, &slopes);
        // The first steps are not yet suited to the residuals.
        let suited = self.iterations > 0;
        self.beside = suited.then(|| Beside {
            steps: self.steps.clone(),
            found: found.to_vec(),
        });
        self.choose_steps(&linear);
        let trials = self.trials(linear);
        if trials.expected_fall < self.limits.tolerance {
            return Stage::Done(Ending::Minimum);
        }
        let expected_fall = trials.expected_fall;
        if self.iterations >= self.limits.iterations {
            return Stage::Done(Ending::Iterations { expected_fall });
        }
        if self.idle >= IDLE {
            return Stage::Done(resting(expected_fall, self.misfit()));
        }
        self.iterations += 1;
        Stage::Trials(Box::new(trials))
    }

    /// A parameter by whose whole size no residual changes, at the start or far from it.
    fn without_effect(&self, slopes: &Slopes) -> Option<usize> {
        let data = self.merit.problem.residual_count();
        let without = |(k, column): (&usize, &Vec<f64>)| {
            let (value, scale) = (self.point[*k], self.parameters()[*k].scale);
            let nowhere = (value - self.start[*k]).abs() > NOWHERE * scale;
            let looked_at = nowhere || self.wary && self.iterations == 0;
            let effect = norm(&column[..data]) * value.abs().max(scale);
            (looked_at && effect < NOTICED).then_some(*k)
        };
        self.free.iter().zip(&slopes.columns).find_map(without)
    }

    fn choose_steps(&mut self, linear: &Linear) {
        let parameters = self.parameters();
        for (k, column) in self.free.iter().zip(&linear.columns) {
            let scale = parameters[*k].scale;
            let aimed = AIM / norm(column);
            self.steps[*k] = aimed.clamp(STEPS[0] * scale, STEPS[1] * scale);
        }
    }

    fn trials(&self, linear: Linear) -> Trials {
        let held = |place: usize| {
            let (k, slope) = (self.free[place], linear.gradient[place]);
            let parameter = &self.parameters()[k];
            (self.point[k] <= parameter.lower && slope > 0.0)
                || (self.point[k] >= parameter.upper && slope < 0.0)
        };
        let loose: Vec<usize> = (0..self.free.len()).filter(|p| !held(*p)).collect();
        let length = |place: &usize| norm(&linear.columns[*place]);
        let unit = |length: f64| if length > 0.0 { length } else { 1.0 };
        let scales: Vec<f64> = loose.iter().map(|p| unit(length(p))).collect();
        let scaled: Vec<Vec<f64>> = (loose.iter().zip(&scales))
            .map(|(place, scale)| linear.columns[*place].iter().map(|x| x / scale).collect())
            .collect();
        let mut trials = Trials {
            linear,
            svd: svd(&scaled),
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
        let factors: &[f64] = match self.sure {
            true => &[0.1, 100.0],
            false => &[0.1, 1.0, 10.0, 100.0],
        };
        trials.dampings = factors.iter().map(|factor| factor * damping).collect();
        trials.points = (trials.dampings.iter())
            .map(|damping| self.clipped(trials, &trials.step(*damping)))
            .collect();
    }

    fn clipped(&self, trials: &Trials, step: &[f64]) -> Vec<f64> {
        let mut point = self.point.clone();
        for (place, step) in trials.loose.iter().zip(step) {
            let k = self.free[*place];
            let parameter = &self.parameters()[k];
            point[k] = (point[k] + step).clamp(parameter.lower, parameter.upper);
        }
        point
    }

    fn tried(&mut self, mut trials: Box<Trials>, found: &[Result<Residuals, ModelError>]) -> Stage {
        let valued = trials.points.iter().zip(found).enumerate();
        let best = valued
            .filter_map(|(i, (point, found))| Some((i, self.merit.value(point, found).ok()?)))
            .min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
        let before = self.at.as_ref().map_or(f64::INFINITY, |at| at.cost);
        match best {
            Some((i, valued)) if valued.cost < before => {
                let gained = before - valued.cost;
                let idle = gained < 1e-3 * trials.expected_fall.min(1.0);
                self.idle = if idle { self.idle + 1 } else { 0 };
                if trials.expected_fall < QUIET_FALL && gained < 0.1 * trials.expected_fall {
                    self.idle = IDLE;
                }
                self.sure = gained > 0.5 * trials.expected_fall;
                self.damping = (0.3 * trials.dampings[i]).max(LEAST_DAMPING);
                self.point.clone_from(&trials.points[i]);
                self.beside = None;
                self.at = Some(valued);
                Stage::Slopes(self.stencils())
            }
            _ if trials.expected_fall < QUIET_FALL => {
                Stage::Done(resting(trials.expected_fall, self.misfit()))
            }
            _ if trials.most() < LARGEST_DAMPING => {
                self.damping = 1e3 * trials.most();
                self.sure = false;
                self.spread(&mut trials, self.damping);
                Stage::Trials(trials)
            }
            _ => Stage::Done(resting(trials.expected_fall, self.misfit())),
        }
    }

    /// Chi-square over degrees of freedom.
    fn misfit(&self) -> f64 {
        let rows = self.at.as_ref().map_or(&[][..], |at| &at.rows);
        let freedom = rows.len().saturating_sub(self.free.len()).max(1);
        dot(rows, rows) / freedom as f64
    }

    /// Where the descent stands, and why it ended.
    pub(crate) fn finish(self) -> Reached {
        let ending = match self.stage {
            Stage::Done(ending) => ending,
            _ => Ending::ModelFails(ModelError("the descent was left early".into())),
        };
        Reached {
            point: self.point,
            at: self.at,
            steps: self.steps,
            beside: self.beside,
            iterations: self.iterations,
            ending,
        }
    }
}

/// A rest where the cost should fall by so much: far from the data, chi-square is large and
/// changes by its own share where no conclusion does.
fn resting(expected_fall: f64, misfit: f64) -> Ending {
    if expected_fall < SMALL_FALL * misfit.max(1.0) {
        Ending::Floor { expected_fall }
    } else {
        Ending::Stuck { expected_fall }
    }
}

/// Where a descent came to.
#[derive(Clone, Debug)]
pub(crate) struct Reached {
    pub point: Vec<f64>,
    /// Residuals there; `None` if the model failed at the first point.
    pub at: Option<Valued>,
    pub steps: Vec<f64>,
    /// What is known of its neighbours.
    pub beside: Option<Beside>,
    pub iterations: usize,
    pub ending: Ending,
}

/// Residuals at the neighbours of a point, two for each free parameter.
#[derive(Clone, Debug)]
pub(crate) struct Beside {
    pub steps: Vec<f64>,
    pub found: Vec<Result<Residuals, ModelError>>,
}

impl Reached {
    pub(crate) fn cost(&self) -> f64 {
        self.at.as_ref().map_or(f64::INFINITY, |at| at.cost)
    }
}

impl Trials {
    /// The largest damping.
    fn most(&self) -> f64 {
        self.dampings.last().copied().unwrap_or(LARGEST_DAMPING)
    }

    /// Components of the scaled gradient along the right singular vectors.
    fn along(&self) -> Vec<f64> {
        let gradient: Vec<f64> = (self.loose.iter().zip(&self.scales))
            .map(|(place, scale)| self.linear.gradient[*place] / scale)
            .collect();
        self.svd.right.iter().map(|v| dot(v, &gradient)).collect()
    }

    /// ½ gᵀ (JᵀJ)⁻¹ g over the directions that differences resolve.
    fn fall(&self) -> f64 {
        let least = RESOLVED * self.svd.values.first().copied().unwrap_or(0.0);
        let parts = self.along().into_iter().zip(&self.svd.values);
        parts
            .filter(|(_, value)| **value > least)
            .map(|(along, value)| 0.5 * (along / value).powi(2))
            .sum()
    }

    /// −(JᵀJ + λ)⁻¹ g, in the parameters' units.
    fn step(&self, damping: f64) -> Vec<f64> {
        let weights: Vec<f64> = (self.along().iter().zip(&self.svd.values))
            .map(|(along, value)| -along / (value * value + damping))
            .collect();
        let scaled = crate::linear::combine(&self.svd.right, &weights);
        scaled
            .iter()
            .zip(&self.scales)
            .map(|(s, d)| s / d)
            .collect()
    }
}

//! Points of the model in batches, for several machines.

use crate::Parameter;
use crate::problem::{ModelError, Problem, Residuals};
use hertzchain_sim::{Fingerprint, Inputs, count_done};
use std::sync::OnceLock;

/// What became of the points of a batch, in their order.
pub type Outcomes = Vec<Result<Residuals, ModelError>>;

/// Points whose residuals are computed together, on whichever machine has the
/// problem: their bits depend on nothing but the problem and the points.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// A hash of the problem and the bits of the points.
    pub name: Fingerprint,
    /// The points, in the parameters' own units.
    pub points: Vec<Vec<f64>>,
}

impl Batch {
    /// Points in batches of so many at most, in order. Small ones occupy more
    /// machines, large ones fill the lanes of an ensemble: a point's curve has a lane
    /// for each speed already.
    #[must_use]
    pub fn cut(problem: &Fingerprint, points: &[Vec<f64>], size: usize) -> Vec<Self> {
        let batch = |points: &[Vec<f64>]| {
            let inputs = Inputs::of("batch").work("problem", problem);
            let add = |inputs: Inputs, point: &Vec<f64>| inputs.numbers("point", point);
            Self {
                name: points.iter().fold(inputs, add).fingerprint(),
                points: points.to_vec(),
            }
        };
        points.chunks(size.max(1)).map(batch).collect()
    }

    /// Computes the batch here.
    #[must_use]
    pub fn outcomes(&self, problem: &dyn Problem) -> Outcomes {
        problem.residuals(&self.points)
    }
}

/// Who computes batches elsewhere: outcomes of all of them, in order, or why there
/// are none.
pub type Compute<'a> = dyn Fn(&[Batch]) -> Result<Vec<Outcomes>, String> + Sync + 'a;

/// A problem whose residuals are computed elsewhere: a fit, a profile or a sampler
/// that is given it in the problem's place comes to the same bits.
///
/// Once batches are lost for good, all points from then on have an error; what
/// was made of them is worth nothing. Ask [`lost`](Self::lost) before a chain is saved
/// or believed.
pub struct Spread<'a> {
    problem: &'a dyn Problem,
    fingerprint: Fingerprint,
    size: usize,
    workers: usize,
    compute: &'a Compute<'a>,
    lost: OnceLock<String>,
}

impl<'a> Spread<'a> {
    /// Of a problem by its fingerprint, in batches of so many points at most.
    #[must_use]
    pub fn new(
        problem: &'a dyn Problem,
        fingerprint: Fingerprint,
        size: usize,
        compute: &'a Compute<'a>,
    ) -> Self {
        Self {
            problem,
            fingerprint,
            size,
            workers: 1,
            compute,
            lost: OnceLock::new(),
        }
    }

    /// The same in smaller batches where so many workers would otherwise not all
    /// have one.
    #[must_use]
    pub fn among(self, workers: usize) -> Self {
        Self { workers, ..self }
    }

    /// Why batches were lost, if any were.
    pub fn lost(&self) -> Option<&str> {
        self.lost.get().map(String::as_str)
    }

    fn outcomes(&self, points: &[Vec<f64>]) -> Result<Outcomes, String> {
        if let Some(why) = self.lost() {
            return Err(why.to_owned());
        }
        let share = points.len().div_ceil(self.workers.max(1));
        let batches = Batch::cut(&self.fingerprint, points, self.size.min(share));
        let found = (self.compute)(&batches)?;
        let sizes = batches.iter().map(|batch| batch.points.len());
        match found.iter().map(Vec::len).eq(sizes) {
            true => {
                count_done(points.len());
                Ok(found.into_iter().flatten().collect())
            }
            false => Err("batches came back with other numbers of points".to_owned()),
        }
    }
}

impl Problem for Spread<'_> {
    fn parameters(&self) -> &[Parameter] {
        self.problem.parameters()
    }

    fn residual_count(&self) -> usize {
        self.problem.residual_count()
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Outcomes {
        self.outcomes(points).unwrap_or_else(|why| {
            let why = self.lost.get_or_init(|| why);
            points
                .iter()
                .map(|_| Err(ModelError(why.clone())))
                .collect()
        })
    }

    fn residual_label(&self, index: usize) -> String {
        self.problem.residual_label(index)
    }
}

//! Evidence under the rounding of the printed constants, which are drawn anew within half a unit
//! of their last digit.

use crate::claims::{Evaluator, Evidence};
use crate::reproduce::{Cases, Effort, Gathering, OILS, ReproduceError, SPEEDS_M_S, gather};
use hertzchain_experiment::{Experiment, NamedNumber, PathError, Reading};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Ends of the paths of the constants that all cases share, in the order in which they are drawn.
static SHARED: [&str; 6] = [
    "aisi316.young_modulus",
    STEEL_POISSON,
    "aisi316.shear_viscosity",
    "damping_cubic.coefficient",
    "beads[0].mass",
    "beads[0].radius",
];
const STEEL_POISSON: &str = "aisi316.poisson_ratio";

/// The same of an oil's own.
static OF_OIL: [&str; 7] = [
    "-oil.young_modulus",
    "-oil.poisson_ratio.prefactor",
    "-oil.poisson_ratio.exponent",
    "-oil.shear_viscosity.prefactor",
    "-oil.shear_viscosity.exponent",
    "liquid.kinematic_viscosity",
    "liquid.density",
];

/// How far the Poisson ratio 0.3 of the dry balls may be off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum DryPoisson {
    /// The handbooks' 0.30, within 0.005.
    TwoDigits,
    /// 0.3 to the letter, within 0.05.
    #[default]
    OneDigit,
}

/// One draw of all printed constants.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Draw {
    /// Offsets from -1 to 1 in half units of the last digit: [`SHARED`], then each oil's own.
    offsets: Vec<f64>,
    dry_poisson: DryPoisson,
}

impl Draw {
    /// Draw `index` of a seed; each has a stream of its own.
    pub(crate) fn new(seed: u64, index: u64, dry_poisson: DryPoisson) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(index);
        let count = SHARED.len() + OILS.len() * OF_OIL.len();
        let offsets = (0..count).map(|_| 2.0 * rng.random::<f64>() - 1.0).collect();
        Self { offsets, dry_poisson }
    }

    /// The experiment of a case with the constants drawn.
    pub(crate) fn of(&self, case: &str, experiment: &Experiment) -> Result<Experiment, PathError> {
        let numbers = experiment.numbers();
        let drawn = numbers.iter().filter_map(|named| {
            Some((named.path.as_str(), named.value? + self.offset(case, named)?))
        });
        experiment.set(&drawn.collect::<Vec<_>>())
    }

    /// The change of a number in SI; `None` of what the paper does not print.
    fn offset(&self, case: &str, named: &NamedNumber) -> Option<f64> {
        let ends = |end: &&str| named.path.ends_with(end);
        let own = || {
            let oil = OILS.iter().position(|oil| *oil == case)?;
            Some(SHARED.len() + oil * OF_OIL.len() + OF_OIL.iter().position(&ends)?)
        };
        let at = SHARED.iter().position(&ends).or_else(own)?;
        let half = match self.dry_poisson {
            DryPoisson::TwoDigits if ends(&STEEL_POISSON) => 0.005,
            _ => named.half_digit,
        };
        Some(half * self.offsets[at])
    }
}

/// Accuracies of a draw's shots: the next one where the last leaves it open on
/// which side of a threshold a number lies.
const ACCURACIES: [f64; 2] = [1e-6, 1e-7];

/// Draws the printed constants anew and shoots, in a reading, all cases at all speeds of the tables
/// for each draw, as accurately as the claims take to be decided on it.
pub(crate) fn rounded_evidence(
    evaluators: &[Evaluator],
    reading: &Reading,
    (seed, draws): (u64, usize),
    dry_poisson: DryPoisson,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Evidence>, ReproduceError> {
    let cases = Cases::new(reading)?;
    let one = |index: usize| {
        let draw = Draw::new(seed, index as u64, dry_poisson);
        let drawn = cases.changed(|case, experiment| draw.of(case, experiment))?;
        let evidence = sharpened(evaluators, &ACCURACIES, &|accuracy| {
            let effort = Effort::Lean(evaluators);
            let how = Gathering { cases: &drawn, speeds_m_s: &SPEEDS_M_S, accuracy, effort };
            gather(&how, None, &|| {})
        });
        done();
        evidence
    };
    (0..draws).map(one).collect()
}

/// Evidence at the first accuracy that leaves no claim open, or at the last.
pub(super) fn sharpened(
    evaluators: &[Evaluator],
    accuracies: &[f64],
    gather: &dyn Fn(f64) -> Result<Evidence, ReproduceError>,
) -> Result<Evidence, ReproduceError> {
    let mut evidence = Evidence::default();
    for accuracy in accuracies {
        evidence = gather(*accuracy)?;
        let mut findings = evaluators.iter().map(|evaluator| evaluator.decide(&evidence));
        if !findings.any(|finding| finding.is_open()) {
            break;
        }
    }
    Ok(evidence)
}

#[cfg(test)]
#[path = "tests/sharpened.rs"]
mod tests;

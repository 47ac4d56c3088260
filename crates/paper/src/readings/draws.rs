//! Evidence under the rounding of the printed constants.

use super::rounding::{Draw, DryPoisson, Prefactors};
use super::sharpened::sharpened;
use crate::claims::{Evaluator, Evidence};
use crate::reproduce::{Cases, Effort, Gathering, OILS, ReproduceError, SPEEDS_M_S, gather};
use hertzchain_chain::Chain;
use hertzchain_experiment::Reading;

/// Accuracies of a draw's shots: the next one where the last leaves it open on
/// which side of a threshold a number lies.
const ACCURACIES: [f64; 2] = [1e-6, 1e-7];

/// Draws the printed constants anew and shoots, in a reading, all cases at all speeds of the tables
/// for each draw, as accurately as the claims take to be decided on it.
///
/// # Errors
/// The first shot that can't be computed.
pub fn rounded_evidence(
    evaluators: &[Evaluator],
    reading: &Reading,
    (seed, draws): (u64, usize),
    dry_poisson: DryPoisson,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Evidence>, ReproduceError> {
    let cases = Cases::new(reading)?;
    let mut prefactors = Vec::new();
    for case in OILS {
        if let Some(experiment) = cases.get(case) {
            prefactors.push((case, Prefactors::of(&experiment.chain(Some(1.0))?.0)));
        }
    }
    let one = |index: usize| {
        let draw = Draw::new(seed, index as u64, dry_poisson);
        let change = |case: &str, speed: f64, chain: &mut Chain| {
            let known = prefactors.iter().find(|(name, _)| *name == case);
            draw.change(case, speed, known.and_then(|(_, p)| *p), chain);
        };
        let evidence = sharpened(evaluators, &ACCURACIES, &|accuracy| {
            let how = Gathering {
                reading: *reading,
                speeds_m_s: &SPEEDS_M_S,
                accuracy,
                effort: Effort::Lean(evaluators),
            };
            let mut evidence = gather(&how, &change, &|| {})?;
            draw.change_oils(&mut evidence.oils);
            Ok(evidence)
        });
        done();
        evidence
    };
    (0..draws).map(one).collect()
}

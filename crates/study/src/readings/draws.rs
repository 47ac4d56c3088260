//! Evidence under the rounding of the printed constants.

use super::rounding::{Draw, DryPoisson, Prefactors};
use crate::claims::Evidence;
use crate::reproduce::{Cases, Gathering, OILS, ReproduceError, gather};
use hertzchain_chain::Chain;

/// Draws the printed constants anew and shoots all cases for each draw.
///
/// # Errors
/// The first shot that can't be computed.
pub fn rounded_evidence(
    how: &Gathering<'_>,
    seed: u64,
    draws: usize,
    dry_poisson: DryPoisson,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Evidence>, ReproduceError> {
    let cases = Cases::new(&how.reading)?;
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
        let mut evidence = gather(how, &change, done)?;
        draw.change_oils(&mut evidence.oils);
        Ok(evidence)
    };
    (0..draws).map(one).collect()
}

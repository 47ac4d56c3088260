//! A chain as it is laid on the track at the beginning of a series.

use crate::rig::chance::Chance;
use hertzchain_chain::Chain;
use hertzchain_experiment::Laying;

/// No bead is smaller or larger than its fellows by more than this share.
const MOST_UNLIKE: f64 = 0.5;

/// Radii of all beads over what the file says: 1 + spread · normal.
#[must_use]
pub(super) fn sizes(laying: &Laying, beads: usize, chance: &mut Chance) -> Vec<f64> {
    let size = |_| {
        let unlike = laying.radius_spread * chance.normal();
        1.0 + unlike.clamp(-MOST_UNLIKE, MOST_UNLIKE)
    };
    (0..beads).map(size).collect()
}

/// Gives beads their own sizes; masses go with the third power.
pub(super) fn resize(chain: &mut Chain, sizes: &[f64]) {
    for (bead, size) in chain.beads.iter_mut().zip(sizes) {
        bead.radius_m *= size;
        bead.mass_kg *= size * size * size;
    }
}

/// Gaps in m of contacts 0..=N, exponentially distributed; none before bead 1,
/// where the striker comes.
#[must_use]
pub(super) fn gaps_m(laying: &Laying, beads: usize, chance: &mut Chance) -> Vec<f64> {
    let gap = |_| laying.gap_scatter_m * chance.exponential();
    std::iter::once(0.0).chain((0..beads).map(gap)).collect()
}

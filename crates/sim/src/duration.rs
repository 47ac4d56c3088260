//! When a shot is over.
//!
//! One rule for every study. A shot with a wall ends once the wall's peak and the
//! reflected pulse have been looked for, until 3 tw and tw + 3 (tw − tn); one that
//! follows its striker goes on until the striker is away for good, or for [`RETURNS`] times the
//! pulse's way to the wall, whichever comes first. A long chain ends earlier,
//! once energy alone shows that neither can change any more. Without a wall a
//! shot ends when all bodies fly apart.

use crate::plan::Plan;
use hertzchain_chain::{FarEnd, Start, System};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct End {
    /// Longest duration in s.
    pub longest_s: f64,
    /// Most steps.
    pub most_steps: f64,
    /// Once the reflected pulse has passed the sensor bead, and the striker
    /// is away for good if it is followed.
    pub at_reflection: bool,
    /// Once all bodies fly apart.
    pub when_apart: bool,
    /// Interval in s of looks whether the shot is decided: a fraction of the chain's own
    /// time, so that the moment does not depend on steps, and long enough to cost nothing.
    pub look_every_s: f64,
    /// The striker is followed until it is away for good.
    pub striker: bool,
    /// Once energy shows that nothing can change any more.
    pub when_decided: bool,
}

/// Longest shot in times that the wave takes along the chain. It is at the wall after
/// about one and the shot ends four later; losses and chains of unlike beads stretch
/// this by a factor below ten. The rest is for what drifts, which costs few steps: work
/// ends what goes on for nothing.
const LONGEST: f64 = 1000.0;

/// Most steps of a shot that ends by itself, and a bead: a thousand times what pulses
/// need at an accuracy of 1e-6.
const MOST_STEPS: (f64, f64) = (1e6, 1e4);

/// Longest shot with equal steps, in contact times a bead, and in steps if that is
/// longer; what takes longer is computed with adaptive steps.
const EQUAL_LONGEST: (f64, f64) = (40.0, 262_144.0);

/// Longest shot without a wall in contact times a bead.
const WITHOUT_WALL: f64 = 40.0;

/// Beads' worth of time that even the shortest chain gets.
const SHORT_CHAIN: f64 = 10.0;

/// A striker is followed for at most this many times the time that the pulse
/// took to the wall. It is back at 2 and has hit the striker; behind strong
/// losses slow beads follow until 4; in all of the paper's chains the striker is
/// away for good before 6. Chains under load ring for ever and end here.
pub(crate) const RETURNS: f64 = 6.0;

/// Chains of this length and longer end when energy decides; shorter ones are
/// followed to the end of the search, which costs them nothing.
pub(crate) const LONG_CHAIN: usize = 512;

/// Looks in the time of a contact time a bead.
const LOOKS: f64 = 32.0;

/// A ring is followed for about two turns of a pulse.
const TWO_TURNS: f64 = 3.0;

/// The end of a shot of a system.
pub(crate) fn end(plan: &Plan, system: &System) -> End {
    let scales = system.scales();
    let beads = system.beads() as f64 + SHORT_CHAIN;
    let gaps: f64 = plan.chain.gaps.iter().map(|gap| gap.gap_m.abs()).sum();
    let bead_times = |count: f64| count * (beads * scales.time_s + gaps / scales.speed_m_s);
    let crossing_s = scales.crossing_s.max(bead_times(1.0));
    let wall = has_wall(&plan.chain.far);
    let longest_s = match (plan.duration_s, &plan.chain.far) {
        (Some(duration_s), _) => duration_s,
        (None, FarEnd::Periodic { .. }) => bead_times(TWO_TURNS),
        (None, _) => swing_s(plan).unwrap_or(match wall {
            true => LONGEST * crossing_s,
            false => bead_times(WITHOUT_WALL),
        }),
    };
    let open = plan.duration_s.is_none();
    let struck = matches!(plan.chain.start, Start::Striker { .. });
    let followed = plan.rebound && struck && plan.chain.suspension_m.is_none();
    End {
        longest_s,
        most_steps: match open && wall {
            true => MOST_STEPS.0 + MOST_STEPS.1 * system.beads() as f64,
            false => f64::INFINITY,
        },
        at_reflection: open && wall,
        when_apart: open && !wall && plan.chain.suspension_m.is_none(),
        look_every_s: bead_times(1.0 / LOOKS),
        striker: followed,
        when_decided: open && wall && system.beads() >= LONG_CHAIN,
    }
}

/// The longest duration in s of a shot with equal steps of some contact times.
pub(crate) fn with_equal_steps_s(plan: &Plan, system: &System, step: f64) -> f64 {
    let contact_times = EQUAL_LONGEST.0 * (system.beads() as f64 + SHORT_CHAIN);
    let most_s = contact_times.max(EQUAL_LONGEST.1 * step) * system.scales().time_s;
    end(plan, system).longest_s.min(most_s)
}

/// Whether there is a wall for a pulse to reach.
pub(crate) fn has_wall(far: &FarEnd) -> bool {
    !matches!(far, FarEnd::Free | FarEnd::Periodic { .. })
}

/// A cradle is followed for one swing of its threads, in s.
fn swing_s(plan: &Plan) -> Option<f64> {
    let length_m = plan.chain.suspension_m?;
    let period_s = std::f64::consts::TAU * (length_m / plan.chain.gravity_m_s2).sqrt();
    period_s.is_finite().then_some(period_s)
}

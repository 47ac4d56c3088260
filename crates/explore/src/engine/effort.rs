//! How much a page may ask for: what takes longer than a look is the program's work.

use super::Refusal;
use hertzchain_sim::{Expected, Plan};

/// Longest expected time of all shots of one request, in s of one core.
const LONGEST_S: f64 = 60.0;

/// Most beads of a row.
const MOST_BEADS: usize = 20_000;

/// Refuses a row that is too long for the page.
pub(super) fn check_beads(beads: usize) -> Result<(), Refusal> {
    match beads > MOST_BEADS {
        true => Err(Refusal::Error(format!(
            "the row has {beads} beads: the explorer takes at most {MOST_BEADS}; `hertzchain shot` takes more"
        ))),
        false => Ok(()),
    }
}

/// Refuses shots that together take too long for the page.
pub(super) fn check_time(plan: &Plan, shots: usize) -> Result<(), Refusal> {
    let expected = Expected::of(plan).map_err(Refusal::words)?;
    match shots as f64 * expected.time_s > LONGEST_S {
        true => Err(Refusal::Error(format!(
            "{shots} × {expected}: the explorer takes on what ends within {LONGEST_S:.0} s. Fewer beads, a shorter \
             duration or less accuracy make it quicker; `hertzchain {}` has no limit",
            if shots > 1 { "sweep" } else { "shot" }
        ))),
        false => Ok(()),
    }
}

//! What the paper says, held against what the model shows.
//!
//! Claims are rows of a data file; each names a predicate, which is code on
//! plain numbers. No verdict is written down anywhere: change the numbers and
//! the verdicts follow.

mod claim;
mod evidence;
mod finding;
mod predicates;
mod report;
mod rounded;

pub use claim::{Claim, ClaimError, Evaluator, Needs, Predicate, claims, read};
pub use evidence::{
    Branch, Curve, Digitised, Evidence, Measured, Oil, Point, Ratio, SHOTS_PER_POINT,
    SPEED_SCATTER_M_S,
};
pub use finding::{Distance, Finding, IN_PART, Tally, Verdict, Worst};
pub use predicates::find as predicate;
pub use report::{MEANING, claims_json, claims_markdown, computed_text};
pub(crate) use report::{rounded_text, verdicts_text, with_unit};
pub use rounded::{EvaluatedClaim, Rounded, evaluate_all, evaluate_all_rounded};

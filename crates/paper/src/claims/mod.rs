//! The paper's statements, compared with the model's numbers.
//!
//! Claims are rows of a data file; each names a predicate, which is code on
//! plain numbers. No verdict is written down anywhere: change the numbers and
//! the verdicts follow.

mod claim;
mod evidence;
mod finding;
mod predicates;
mod report;

pub use self::{
    claim::{
        Claim, ClaimError, EvaluatedClaim, Evaluator, Needs, Rounded, claims, evaluate_all,
        evaluate_all_rounded, read,
    },
    evidence::{Curve, Digitised, Evidence, MeasuredKind, PrintedOil, ShotPoint, TofBranch},
    predicates::find as predicate,
    report::{MEANING, claims_markdown, computed_text},
};
pub(crate) use claim::Predicate;
pub(crate) use evidence::{SHOTS_PER_POINT, SPEED_SCATTER_M_S};
pub use finding::{ClaimFinding, ClaimVerdict, Distance};
pub(crate) use finding::{Comparisons, IN_PART};
pub(crate) use report::{claims_json, rounded_text, verdicts_text, with_unit};

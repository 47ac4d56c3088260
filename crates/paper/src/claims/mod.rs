//! The paper's statements, compared with the model's numbers.
//!
//! Claims are rows of a data file; each names a predicate, which is code on plain numbers. No
//! verdict is written down anywhere: change the numbers and the verdicts follow.

mod claim;
pub(crate) mod evidence;
pub(crate) mod finding;
pub(crate) mod predicates;
mod report;

pub use self::{
    claim::EvaluatedClaim,
    finding::ClaimVerdict,
    report::{MEANING, computed_text},
};
pub(crate) use self::{
    claim::{Claim, ClaimError, Evaluator, Needs, Predicate, Rounded, claims, evaluate_all, read},
    evidence::{
        Curve, Evidence, MeasuredKind, PrintedOil, SHOTS_PER_POINT, SPEED_SCATTER_M_S, ShotPoint,
        TofBranch,
    },
    finding::{ClaimFinding, Comparisons, IN_PART},
    report::{
        claims_json, claims_markdown, rounded_text, table_head, table_row, verdicts_text, with_unit,
    },
};

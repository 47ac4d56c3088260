//! The paper's claims, rows of a data file, and their evaluation, also under the rounding of the
//! printed constants.

use super::predicates;
use super::{ClaimFinding, ClaimVerdict, Evidence};
use serde::{Deserialize, Serialize};

/// On which side of the threshold the deciding number must lie.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Needs {
    /// The number exceeds the threshold.
    Above,
    /// The number is less than the threshold.
    Below,
    /// The number differs from the expected one by less than the threshold.
    Within,
}

/// One statement of the paper that a model can be held to.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Claim {
    /// Short name, unique.
    pub id: String,
    /// What the paper says, in our words.
    pub statement: String,
    /// Where in the paper.
    pub paper: String,
    /// Name of the predicate that decides.
    pub predicate: String,
    /// Cases it is about; their order may matter.
    #[serde(default)]
    pub cases: Vec<String>,
    /// Branches of the ToF it is about: `incident`, `reflected` or both.
    #[serde(default)]
    pub branches: Vec<String>,
    /// Values that the paper prints.
    #[serde(default)]
    pub expected: Vec<f64>,
    /// The side of the threshold that the claim needs.
    pub(crate) needs: Needs,
    /// What the deciding number is compared with, or its largest deviation from the expected one.
    pub threshold: f64,
    /// A weaker threshold, at which the claim holds in part.
    pub partly: Option<f64>,
    /// What the deciding number must not exceed.
    pub at_most: Option<f64>,
    /// Unit of the deciding number, the expected ones and all thresholds; empty for plain numbers.
    #[serde(default)]
    pub unit: String,
    /// Only speeds from here in m/s.
    #[serde(default, skip_serializing)]
    pub from_m_s: f64,
    /// Only speeds up to here in m/s.
    #[serde(default = "no_limit", skip_serializing)]
    pub to_m_s: f64,
    /// The deciding number, in words.
    #[serde(rename(serialize = "value_is"))]
    pub value: String,
    /// Why this threshold.
    pub reason: String,
}

fn no_limit() -> f64 {
    f64::INFINITY
}

/// A claim file that can't be used.
#[derive(Debug, thiserror::Error)]
pub enum ClaimError {
    /// The text is not a list of claims.
    #[error("the claims can't be read: {0}")]
    Text(#[from] toml::de::Error),
    /// A row names no predicate that exists.
    #[error("claim `{claim}` names the predicate `{predicate}`, which does not exist")]
    Predicate { claim: String, predicate: String },
    /// Two rows share a name.
    #[error("there are two claims `{0}`")]
    Twice(String),
}

pub(crate) type Predicate<E> = fn(&Claim, &E) -> ClaimFinding;

/// A claim and the code that decides it on numbers of a kind.
#[derive(Clone, Debug)]
pub(crate) struct Evaluator<E = Evidence> {
    pub claim: Claim,
    predicate: Predicate<E>,
}

impl<E> Evaluator<E> {
    pub(crate) fn decide(&self, evidence: &E) -> ClaimFinding {
        (self.predicate)(&self.claim, evidence)
    }
}

impl Evaluator {
    /// Whether the claim is about the striker or the gaps after a shot of a case.
    pub(crate) fn needs_end(&self, case: &str, speed_m_s: f64) -> bool {
        predicates::OF_THE_END.contains(&self.claim.predicate.as_str())
            && self.covers(case, speed_m_s)
    }

    /// Whether the claim is about a shot of a case whose gaps close at the wall.
    pub(crate) fn needs_closing(&self, case: &str, speed_m_s: f64) -> bool {
        self.claim.predicate == predicates::CLOSING && self.covers(case, speed_m_s)
    }

    fn covers(&self, case: &str, speed_m_s: f64) -> bool {
        self.claim.cases.iter().any(|name| name == case)
            && (self.claim.from_m_s..=self.claim.to_m_s).contains(&speed_m_s)
    }
}

#[derive(Deserialize)]
struct File {
    claim: Vec<Claim>,
}

/// The paper's claims as they come with the program.
static PAPER: &str = include_str!("../../data/claims.toml");

/// The paper's claims, in the order of the data file.
pub(crate) fn claims() -> Result<Vec<Evaluator>, ClaimError> {
    read(PAPER, predicates::find)
}

/// Claims from the text of a data file, with predicates found by their names.
pub(crate) fn read<E>(
    text: &str,
    find: impl Fn(&str) -> Option<Predicate<E>>,
) -> Result<Vec<Evaluator<E>>, ClaimError> {
    let file: File = toml::from_str(text)?;
    let mut evaluators: Vec<Evaluator<E>> = Vec::with_capacity(file.claim.len());
    for claim in file.claim {
        if evaluators.iter().any(|other| other.claim.id == claim.id) {
            return Err(ClaimError::Twice(claim.id));
        }
        let predicate = find(&claim.predicate).ok_or_else(|| ClaimError::Predicate {
            claim: claim.id.clone(),
            predicate: claim.predicate.clone(),
        })?;
        evaluators.push(Evaluator { claim, predicate });
    }
    Ok(evaluators)
}

/// Findings of a claim on draws of the printed constants within half a unit of their last digit.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rounded {
    pub draws: usize,
    /// Draws with each verdict, in the order of [`ClaimVerdict::ALL`], by the side on
    /// which their numbers lie: how accurately a draw was computed decides nothing.
    pub verdicts: [usize; 4],
    /// Draws whose numbers lie on their side by less than their accuracy.
    pub open: usize,
    /// Draws that had a deciding number: a passage of 1 may be missing.
    pub with_value: usize,
    /// Smallest and largest deciding number of these.
    pub range: Option<(f64, f64)>,
}

impl Rounded {
    fn of(findings: &[ClaimFinding]) -> Self {
        let count = |verdict| findings.iter().filter(|f| f.leaning == verdict).count();
        let values = findings.iter().map(|f| f.value).filter(|v| v.is_finite());
        let range = values.clone().fold(None, |range: Option<(f64, f64)>, v| {
            let (low, high) = range.unwrap_or((v, v));
            Some((low.min(v), high.max(v)))
        });
        Self {
            draws: findings.len(),
            verdicts: ClaimVerdict::ALL.map(count),
            open: findings.iter().filter(|f| f.is_open()).count(),
            with_value: values.count(),
            range,
        }
    }

    /// Whether some draw lies on another side than a verdict.
    pub(crate) fn flips(&self, verdict: ClaimVerdict) -> bool {
        let same = ClaimVerdict::ALL.iter().position(|v| *v == verdict);
        same.is_some_and(|i| self.verdicts.get(i) != Some(&self.draws))
    }
}

/// A claim with all that was found about it.
#[derive(Clone, Debug, PartialEq)]
pub struct EvaluatedClaim {
    /// The claim.
    pub claim: Claim,
    /// The verdict, rounding considered.
    pub verdict: ClaimVerdict,
    /// What the constants as printed give.
    pub(crate) finding: ClaimFinding,
    pub(crate) rounded: Option<Rounded>,
}

impl EvaluatedClaim {
    /// Whether rounding of the printed constants alone flips the verdict.
    pub(crate) fn flips_by_rounding(&self) -> bool {
        let rounded = self.rounded.as_ref();
        rounded.is_some_and(|rounded| rounded.flips(self.finding.leaning))
    }
}

/// Decides all claims on the constants as printed. A claim of which one of the draws within their
/// rounding lies on another side is not decidable.
pub(crate) fn evaluate_all<E>(
    evaluators: &[Evaluator<E>],
    printed: &E,
    draws: &[E],
) -> Vec<EvaluatedClaim> {
    let decide = |evaluator: &Evaluator<E>| {
        let finding = evaluator.decide(printed);
        let drawn: Vec<ClaimFinding> = draws.iter().map(|draw| evaluator.decide(draw)).collect();
        let rounded = (!drawn.is_empty()).then(|| Rounded::of(&drawn));
        let (claim, verdict) = (evaluator.claim.clone(), finding.verdict);
        let evaluated = EvaluatedClaim { claim, verdict, finding, rounded };
        match evaluated.flips_by_rounding() {
            true => EvaluatedClaim { verdict: ClaimVerdict::NotDecidable, ..evaluated },
            false => evaluated,
        }
    };
    evaluators.iter().map(decide).collect()
}

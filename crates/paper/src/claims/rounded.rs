//! Verdicts under the rounding of the printed constants.

use super::{Claim, Evaluator, Finding, Verdict};

/// What became of a claim when the printed constants were drawn anew within
/// half a unit of their last digit.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounded {
    /// Number of draws.
    pub draws: usize,
    /// Draws with each verdict, in the order of [`Verdict::ALL`], by the side on
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
    /// From the draws' findings.
    fn of(findings: &[Finding]) -> Self {
        let count = |verdict| findings.iter().filter(|f| f.leaning == verdict).count();
        let values = findings.iter().map(|f| f.value).filter(|v| v.is_finite());
        let range = values.clone().fold(None, |range: Option<(f64, f64)>, v| {
            let (low, high) = range.unwrap_or((v, v));
            Some((low.min(v), high.max(v)))
        });
        Self {
            draws: findings.len(),
            verdicts: Verdict::ALL.map(count),
            open: findings.iter().filter(|f| f.is_open()).count(),
            with_value: values.count(),
            range,
        }
    }

    /// Whether some draw lies on another side than a verdict.
    #[must_use]
    pub fn flips(&self, verdict: Verdict) -> bool {
        let same = Verdict::ALL.iter().position(|v| *v == verdict);
        same.is_some_and(|i| self.verdicts.get(i) != Some(&self.draws))
    }
}

/// A claim with all that was found about it.
#[derive(Clone, Debug, PartialEq)]
pub struct EvaluatedClaim {
    /// The claim.
    pub claim: Claim,
    /// The verdict, rounding considered.
    pub verdict: Verdict,
    /// What the constants as printed give.
    pub finding: Finding,
    /// What rounding does, if it was looked at.
    pub rounded: Option<Rounded>,
}

impl EvaluatedClaim {
    /// Whether rounding of the printed constants alone flips the verdict that
    /// they give.
    #[must_use]
    pub fn flips_by_rounding(&self) -> bool {
        let rounded = self.rounded.as_ref();
        rounded.is_some_and(|rounded| rounded.flips(self.finding.leaning))
    }
}

/// Decides all claims on the constants as printed.
#[must_use]
pub fn evaluate_all<E>(evaluators: &[Evaluator<E>], printed: &E) -> Vec<EvaluatedClaim> {
    evaluate_all_rounded(evaluators, printed, &[])
}

/// Decides all claims on the constants as printed, and looks what draws within
/// their rounding do: a claim of which one draw lies on another side than the
/// printed constants is not decidable.
#[must_use]
pub fn evaluate_all_rounded<E>(
    evaluators: &[Evaluator<E>],
    printed: &E,
    draws: &[E],
) -> Vec<EvaluatedClaim> {
    let all = evaluators
        .iter()
        .map(|evaluator| decide(evaluator, printed, draws));
    all.collect()
}

fn decide<E>(evaluator: &Evaluator<E>, printed: &E, draws: &[E]) -> EvaluatedClaim {
    let finding = evaluator.decide(printed);
    let drawn: Vec<Finding> = draws.iter().map(|draw| evaluator.decide(draw)).collect();
    let rounded = (!drawn.is_empty()).then(|| Rounded::of(&drawn));
    let mut evaluated = EvaluatedClaim {
        claim: evaluator.claim.clone(),
        verdict: finding.verdict,
        finding,
        rounded,
    };
    if evaluated.flips_by_rounding() {
        evaluated.verdict = Verdict::NotDecidable;
    }
    evaluated
}

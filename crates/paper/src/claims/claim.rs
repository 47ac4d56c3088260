//! The paper's claims: rows of a data file.

use super::predicates;
use super::{Evidence, Finding};
use serde::Deserialize;

/// On which side of the threshold the deciding number must lie.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Needs {
    /// The number exceeds the threshold.
    Above,
    /// The number is less than the threshold.
    Below,
    /// The number differs from the expected one by less than the threshold.
    Within,
}

/// One statement of the paper that a model can be held to.
#[derive(Clone, Debug, Deserialize, PartialEq)]
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
    pub needs: Needs,
    /// What the deciding number is compared with, or its largest deviation from
    /// the expected one.
    pub threshold: f64,
    /// A weaker threshold, at which the claim holds in part.
    pub partly: Option<f64>,
    /// What the deciding number must not exceed.
    pub at_most: Option<f64>,
    /// Unit of the deciding number, the expected ones and all thresholds; empty
    /// for plain numbers.
    #[serde(default)]
    pub unit: String,
    /// Only speeds from here in m/s.
    #[serde(default)]
    pub from_m_s: f64,
    /// Only speeds up to here in m/s.
    #[serde(default = "no_limit")]
    pub to_m_s: f64,
    /// The deciding number, in words.
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
    Predicate {
        /// The row.
        claim: String,
        /// The name.
        predicate: String,
    },
    /// Two rows share a name.
    #[error("there are two claims `{0}`")]
    Twice(String),
}

/// Decides a claim on numbers.
pub type Predicate<E> = fn(&Claim, &E) -> Finding;

/// A claim and the code that decides it on numbers of a kind: those of single
/// shots, if nothing else is said.
#[derive(Clone, Debug)]
pub struct Evaluator<E = Evidence> {
    /// The row.
    pub claim: Claim,
    predicate: Predicate<E>,
}

impl<E> Evaluator<E> {
    /// Decides the claim on numbers.
    #[must_use]
    pub fn decide(&self, evidence: &E) -> Finding {
        (self.predicate)(&self.claim, evidence)
    }
}

impl Evaluator {
    /// Whether the claim is about what a shot of a case leaves behind when the
    /// pulses have passed: the striker or the gaps.
    #[must_use]
    pub fn needs_end(&self, case: &str, speed_m_s: f64) -> bool {
        predicates::OF_THE_END.contains(&self.claim.predicate.as_str())
            && self.covers(case, speed_m_s)
    }

    /// Whether the claim is about a shot of a case whose gaps close when the pulse
    /// meets the wall.
    #[must_use]
    pub fn needs_closing(&self, case: &str, speed_m_s: f64) -> bool {
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
///
/// # Errors
/// When the data file is damaged, which a test rules out.
pub fn claims() -> Result<Vec<Evaluator>, ClaimError> {
    read(PAPER, predicates::find)
}

/// Claims from the text of a data file, with predicates found by their names.
///
/// # Errors
/// A text that is no list of claims, an unknown predicate, a name used twice.
pub fn read<E>(
    text: &str,
    find: impl Fn(&str) -> Option<Predicate<E>>,
) -> Result<Vec<Evaluator<E>>, ClaimError> {
    let file: File = toml::from_str(text)?;
    let mut evaluators: Vec<Evaluator<E>> = Vec::with_capacity(file.claim.len());
    for claim in file.claim {
        if evaluators
            .iter()
            .any(|evaluator| evaluator.claim.id == claim.id)
        {
            return Err(ClaimError::Twice(claim.id));
        }
        match find(&claim.predicate) {
            Some(predicate) => evaluators.push(Evaluator { claim, predicate }),
            None => {
                return Err(ClaimError::Predicate {
                    claim: claim.id,
                    predicate: claim.predicate,
                });
            }
        }
    }
    Ok(evaluators)
}

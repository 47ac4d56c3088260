//! The answer to a claim: a verdict and the number behind it.

pub use hertzchain_figures::ClaimVerdict;

/// Share of its comparisons that a claim must meet to hold in part.
pub(crate) const IN_PART: f64 = 0.5;

/// A predicate's answer: a number with its accuracy, and what follows from it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ClaimFinding {
    pub verdict: ClaimVerdict,
    /// What would follow if the numbers were exact: on which side they lie, be it
    /// by less than their accuracy.
    pub leaning: ClaimVerdict,
    /// The number that decides; not a number when there is none.
    pub value: f64,
    /// Absolute accuracy of the number.
    pub accuracy: f64,
    /// What the paper has for this number, if it prints one.
    pub expected: Option<f64>,
    /// Where and how much, in words.
    pub detail: String,
    /// Of what is counted: how far the nearest reading is from changing it.
    pub nearest_change: Option<Distance>,
}

/// How far a reading is from where what is counted changes.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub(crate) struct Distance {
    pub margin: f64,
    /// Absolute accuracy of the reading: a count whose margins are all larger is exact.
    pub accuracy: f64,
}

impl ClaimFinding {
    /// By how much the number differs from what the paper has.
    pub(crate) fn deviation(&self) -> Option<f64> {
        self.expected.map(|expected| self.value - expected)
    }

    pub(crate) fn without_numbers(why: &str) -> Self {
        Self {
            verdict: ClaimVerdict::NotDecidable,
            leaning: ClaimVerdict::NotDecidable,
            value: f64::NAN,
            accuracy: f64::NAN,
            expected: None,
            detail: why.to_owned(),
            nearest_change: None,
        }
    }

    pub(crate) fn of_one(margin: f64, value: f64, accuracy: f64, detail: String) -> Self {
        let mut comparisons = Comparisons::default();
        comparisons.add(margin, value, accuracy, String::new);
        Self { value, accuracy, detail, ..comparisons.finding() }
    }

    /// The finding at the threshold, or in part where only the weaker one is met.
    pub(crate) fn or_in_part(self, weaker: Option<&Self>) -> Self {
        let or_in_part = |verdict, weaker: Option<ClaimVerdict>| match (verdict, weaker) {
            (ClaimVerdict::Fails, Some(ClaimVerdict::Holds)) => ClaimVerdict::InPart,
            (ClaimVerdict::Fails, Some(ClaimVerdict::NotDecidable)) => ClaimVerdict::NotDecidable,
            (verdict, _) => verdict,
        };
        Self {
            verdict: or_in_part(self.verdict, weaker.map(|weaker| weaker.verdict)),
            leaning: or_in_part(self.leaning, weaker.map(|weaker| weaker.leaning)),
            ..self
        }
    }

    /// Whether more accurate numbers could say more.
    pub(crate) fn is_open(&self) -> bool {
        self.verdict != self.leaning
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Counts {
    yes: usize,
    no: usize,
    open: usize,
}

impl Counts {
    /// Counts a comparison: met when the margin exceeds its accuracy, not met
    /// when it is below minus that, open in between or when not a number.
    fn margin(&mut self, margin: f64, accuracy: f64) {
        if margin > accuracy {
            self.yes += 1;
        } else if margin < -accuracy {
            self.no += 1;
        } else {
            self.open += 1;
        }
    }

    const fn all(self) -> usize {
        self.yes + self.no + self.open
    }

    /// The verdict that stands whichever way the open comparisons go: holds when all are met, in
    /// part when at least [`IN_PART`] of them are, else fails.
    fn verdict(self) -> ClaimVerdict {
        let all = self.all();
        let when_met = |met: usize| match met {
            _ if all == 0 => ClaimVerdict::NotDecidable,
            met if met == all => ClaimVerdict::Holds,
            met if met as f64 >= IN_PART * all as f64 => ClaimVerdict::InPart,
            _ => ClaimVerdict::Fails,
        };
        // More comparisons met never make a verdict worse: the extremes decide.
        let (least, most) = (when_met(self.yes), when_met(self.yes + self.open));
        if least == most { least } else { ClaimVerdict::NotDecidable }
    }
}

/// The comparisons of a claim: how many are met, and the one with the smallest margin.
#[derive(Clone, Debug, Default)]
pub(crate) struct Comparisons {
    seen: Counts,
    /// By the signs of the margins alone.
    leaning: Counts,
    /// Margin, value, its accuracy and place of the nearest or worst.
    nearest: Option<(f64, f64, f64, String)>,
}

impl Comparisons {
    pub(crate) const fn is_empty(&self) -> bool {
        self.seen.all() == 0
    }

    /// Adds the comparison of a value that has the accuracy of its margin.
    pub(crate) fn add(
        &mut self,
        margin: f64,
        value: f64,
        accuracy: f64,
        place: impl FnOnce() -> String,
    ) {
        self.compare(margin, accuracy, value, accuracy, place);
    }

    /// Adds the comparison of a value whose margin has an accuracy of its own.
    pub(crate) fn compare(
        &mut self,
        margin: f64,
        margin_accuracy: f64,
        value: f64,
        accuracy: f64,
        place: impl FnOnce() -> String,
    ) {
        self.seen.margin(margin, margin_accuracy);
        self.leaning.margin(margin, 0.0);
        let least = self.nearest.as_ref().map_or(f64::INFINITY, |nearest| nearest.0);
        if margin < least || margin.is_nan() {
            self.nearest = Some((margin, value, accuracy, place()));
        }
    }

    /// The finding with the number whose margin is smallest.
    pub(crate) fn finding(self) -> ClaimFinding {
        let (met, all) = (self.seen.yes, self.seen.all());
        let (_, value, accuracy, place) =
            self.nearest.unwrap_or((f64::NAN, f64::NAN, f64::NAN, String::new()));
        let mut detail = format!("{met} of {all} comparisons met");
        if !place.is_empty() {
            detail += &format!("; nearest or worst: {place}");
        }
        ClaimFinding {
            verdict: self.seen.verdict(),
            leaning: self.leaning.verdict(),
            value,
            accuracy,
            expected: None,
            detail,
            nearest_change: None,
        }
    }
}

#[cfg(test)]
#[path = "tests/finding.rs"]
mod tests;

//! What was found about a claim.

/// The answer to "does the model show what the paper says?".
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Verdict {
    /// It does.
    Holds,
    /// It does in at least [`IN_PART`] of the comparisons that the claim covers, or
    /// meets the claim's weaker threshold.
    InPart,
    /// It does not, or in fewer.
    Fails,
    /// The numbers do not decide.
    NotDecidable,
}

impl Verdict {
    /// All verdicts.
    pub const ALL: [Self; 4] = [Self::Holds, Self::InPart, Self::Fails, Self::NotDecidable];

    /// As written in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::InPart => "holds in part",
            Self::Fails => "fails",
            Self::NotDecidable => "not decidable",
        }
    }

    /// How much of the claim is met, for ranking readings: 1, 1/2 or 0.
    #[must_use]
    pub const fn score(self) -> f64 {
        match self {
            Self::Holds => 1.0,
            Self::InPart => 0.5,
            Self::Fails | Self::NotDecidable => 0.0,
        }
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// Share of its comparisons that a claim must meet to hold in part: what more
/// often fails than holds is not partly true.
pub const IN_PART: f64 = 0.5;

/// A predicate's answer: a number with its accuracy, and what follows from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What follows.
    pub verdict: Verdict,
    /// What would follow if the numbers were exact: on which side they lie, be it
    /// by less than their accuracy.
    pub leaning: Verdict,
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// The reading's distance from there.
    pub margin: f64,
    /// Absolute accuracy of the reading: a count whose margins are all larger
    /// is exact.
    pub accuracy: f64,
}

impl Finding {
    /// By how much the number differs from what the paper has.
    #[must_use]
    pub fn deviation(&self) -> Option<f64> {
        self.expected.map(|expected| self.value - expected)
    }

    /// Of a claim for which numbers are missing.
    #[must_use]
    pub fn without_numbers(why: &str) -> Self {
        Self {
            verdict: Verdict::NotDecidable,
            leaning: Verdict::NotDecidable,
            value: f64::NAN,
            accuracy: f64::NAN,
            expected: None,
            detail: why.to_owned(),
            nearest_change: None,
        }
    }

    /// Whether more accurate numbers could say more.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.verdict != self.leaning
    }
}

/// Counts single comparisons and makes a verdict of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    seen: Counts,
    leaning: Counts,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Counts {
    yes: usize,
    no: usize,
    open: usize,
}

impl Counts {
    fn margin(&mut self, margin: f64, accuracy: f64) {
        if margin > accuracy {
            self.yes += 1;
        } else if margin < -accuracy {
            self.no += 1;
        } else {
            self.open += 1;
        }
    }

    /// The verdict that stands whichever way the open comparisons go.
    fn verdict(self) -> Verdict {
        let all = self.yes + self.no + self.open;
        // More comparisons met never make a verdict worse: the extremes decide.
        let (least, most) = (sure(self.yes, all), sure(self.yes + self.open, all));
        if least == most {
            least
        } else {
            Verdict::NotDecidable
        }
    }
}

/// The verdict when so many of all comparisons are met.
fn sure(met: usize, all: usize) -> Verdict {
    if all == 0 {
        Verdict::NotDecidable
    } else if met == all {
        Verdict::Holds
    } else if met as f64 >= IN_PART * all as f64 {
        Verdict::InPart
    } else {
        Verdict::Fails
    }
}

impl Tally {
    /// Counts a comparison: met when the margin exceeds its accuracy, not met
    /// when it is below minus that, open in between or when not a number.
    pub fn margin(&mut self, margin: f64, accuracy: f64) {
        self.seen.margin(margin, accuracy);
        self.leaning.margin(margin, 0.0);
    }

    /// Counts a plain yes or no.
    pub fn answer(&mut self, yes: bool) {
        self.margin(if yes { 1.0 } else { -1.0 }, 0.0);
    }

    /// Holds when all are met, in part when at least [`IN_PART`] of them are, else
    /// fails; not decidable when open ones could change that.
    #[must_use]
    pub fn verdict(self) -> Verdict {
        self.seen.verdict()
    }

    /// The same by the signs of the margins alone.
    #[must_use]
    pub fn leaning(self) -> Verdict {
        self.leaning.verdict()
    }

    /// How many were met, and of how many.
    #[must_use]
    pub fn counts(self) -> (usize, usize) {
        let Counts { yes, no, open } = self.seen;
        (yes, yes + no + open)
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (met, all) = self.counts();
        write!(f, "{met} of {all}")
    }
}

/// The number whose margin is smallest, kept with its accuracy and place.
#[derive(Debug)]
pub struct Worst {
    margin: f64,
    value: f64,
    accuracy: f64,
    place: String,
}

impl Worst {
    /// None seen yet.
    #[must_use]
    pub fn none() -> Self {
        Self {
            margin: f64::INFINITY,
            value: f64::NAN,
            accuracy: f64::NAN,
            place: String::new(),
        }
    }

    /// Keeps this one if its margin is the smallest so far.
    pub fn see(&mut self, margin: f64, value: f64, accuracy: f64, place: impl FnOnce() -> String) {
        if margin < self.margin || margin.is_nan() {
            *self = Self {
                margin,
                value,
                accuracy,
                place: place(),
            };
        }
    }

    /// The finding with the tally's verdict.
    #[must_use]
    pub fn finding(self, tally: Tally) -> Finding {
        let detail = match self.place.is_empty() {
            true => format!("{tally} comparisons met"),
            false => format!("{tally} comparisons met; nearest or worst: {}", self.place),
        };
        Finding {
            verdict: tally.verdict(),
            leaning: tally.leaning(),
            value: self.value,
            accuracy: self.accuracy,
            expected: None,
            detail,
            nearest_change: None,
        }
    }
}

#[cfg(test)]
#[path = "tests/finding.rs"]
mod tests;

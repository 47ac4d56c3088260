//! Claims with their verdicts, as JSON and Markdown.

use super::{Claim, ClaimFinding, ClaimVerdict, EvaluatedClaim, IN_PART, Needs, Rounded};
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// What a claim that fails means, above the table of claims.
pub const MEANING: &str = "A claim that fails is a statement that the paper's model, with the printed constants and in \
    this reading, does not give; this does not make the statement wrong, because the paper prints no measured value to \
    compare with, and its authors may have computed with more digits or read their equations otherwise.";

/// All that was found about every claim; numbers that do not exist are `null`.
pub(crate) fn claims_json(evaluated: &[EvaluatedClaim]) -> Value {
    evaluated.iter().map(row).collect()
}

fn row(evaluated: &EvaluatedClaim) -> Value {
    let finding = &evaluated.finding;
    let found = json!({
        "value": finding.value,
        "value_accuracy": finding.accuracy,
        "value_expected": finding.expected,
        "deviation": finding.deviation(),
        "detail": finding.detail,
        "nearest_change": finding.nearest_change,
        "verdict_as_printed": finding.verdict.name(),
        "verdict": evaluated.verdict.name(),
    });
    let claim = serde_json::to_value(&evaluated.claim).unwrap_or_default();
    let both = [claim, found].into_iter().filter_map(|part| part.as_object().cloned());
    let mut row: Map<String, Value> = both.flatten().collect();
    if let Some(rounded) = &evaluated.rounded {
        let counts = ClaimVerdict::ALL.iter().zip(rounded.verdicts);
        let counts: Map<String, Value> =
            counts.map(|(verdict, count)| (verdict.name().to_owned(), json!(count))).collect();
        let rounding = json!({
            "draws": rounded.draws,
            "verdicts": counts,
            "within_accuracy": rounded.open,
            "draws_with_value": rounded.with_value,
            "value_range": rounded.range.map(|(low, high)| [low, high]),
        });
        row.insert("rounding".to_owned(), rounding);
    }
    Value::Object(row)
}

/// The same as a page for people, below a head of its own.
pub(crate) fn claims_markdown(evaluated: &[EvaluatedClaim], head: &str) -> String {
    let mut page = format!("{head}\n\n{}\n\n", verdicts_text());
    let drawn = evaluated.iter().any(|evaluated| evaluated.rounded.is_some());
    let mut header = vec!["claim", "verdict", "computed", "needed"];
    if drawn {
        page.push_str(ROUNDING);
        header.push("rounding allows");
    }
    let _ = writeln!(page, "{}\n", totals(evaluated));
    page += &table_head(header);
    for evaluated in evaluated {
        let rounding = drawn.then(|| rounded_text(evaluated).unwrap_or_default());
        let row = [
            evaluated.claim.statement.clone(),
            evaluated.verdict.name().to_owned(),
            computed_text(evaluated),
            needed(evaluated),
        ];
        page += &table_row(row.into_iter().chain(rounding));
    }
    page.push_str("\n## One by one\n");
    for evaluated in evaluated {
        section(&mut page, evaluated);
    }
    page
}

/// A row of a Markdown table.
pub(crate) fn table_row(cells: impl IntoIterator<Item = impl AsRef<str>>) -> String {
    let cells = cells.into_iter().map(|cell| format!("| {} ", cell.as_ref()));
    cells.collect::<String>() + "|\n"
}

/// The head of a Markdown table.
pub(crate) fn table_head<'a>(titles: impl IntoIterator<Item = &'a str>) -> String {
    let titles: Vec<&str> = titles.into_iter().collect();
    format!("{}|{}\n", table_row(&titles), "---|".repeat(titles.len()))
}

/// What makes which verdict, for the pages.
pub(crate) fn verdicts_text() -> String {
    format!(
        "Verdicts: a claim of many comparisons (speeds, liquids, passages) holds when all of them are met, \
         and in part when not all but at least {:.0} % are; with fewer it fails, for what more often fails than \
         holds is not partly true. Where a claim names a weaker threshold, it also holds in part when that one is \
         met. It is not decidable when numbers within their accuracy could change the verdict.",
        100.0 * IN_PART
    )
}

const ROUNDING: &str = "Rounding: every printed constant is drawn within half a unit of its last \
    digit, steel's Poisson ratio 0.3 from 0.25 to 0.35, and all speeds are computed anew; a claim of which \
    one draw lies on another side than the printed constants is not decidable. A draw that lies closer to \
    a threshold than its accuracy is computed again more accurately.\n\n";

fn totals(evaluated: &[EvaluatedClaim]) -> String {
    let count = |verdict| evaluated.iter().filter(|j| j.verdict == verdict).count();
    let parts = ClaimVerdict::ALL.map(|verdict| format!("{} {}", count(verdict), verdict.name()));
    format!("Of {} claims: {}.", evaluated.len(), parts.join(", "))
}

fn section(page: &mut String, evaluated: &EvaluatedClaim) {
    let (claim, finding) = (&evaluated.claim, &evaluated.finding);
    let _ = writeln!(page, "\n### `{}`: {}\n", claim.id, evaluated.verdict);
    let _ = writeln!(page, "{} ({})\n", claim.statement, claim.paper);
    let _ = writeln!(page, "- Computed: {} ({}).", computed_text(evaluated), claim.value);
    if let (Some(expected), Some(deviation)) = (finding.expected, finding.deviation()) {
        let expected = with_unit(expected, claim);
        let sign = if deviation > 0.0 { "+" } else { "" };
        let deviation = value_text(deviation, accuracy_shown(finding));
        let _ = writeln!(
            page,
            "- The paper: {expected}. Deviation: {sign}{}.",
            of_unit(deviation, claim)
        );
    }
    let _ = writeln!(page, "- Needed: {}. {}", needed(evaluated), claim.reason);
    let _ = writeln!(page, "- Detail: {}.", finding.detail);
    if let Some(rounded) = &evaluated.rounded {
        rounding(page, evaluated, rounded);
    }
}

/// What rounding of the printed constants does to a claim.
fn rounding(page: &mut String, evaluated: &EvaluatedClaim, rounded: &Rounded) {
    let counts = ClaimVerdict::ALL.iter().zip(rounded.verdicts);
    let counts = counts.filter(|(_, count)| *count > 0);
    let counts: Vec<String> =
        counts.map(|(verdict, count)| format!("{verdict} in {count}")).collect();
    let open = match rounded.open {
        0 => String::new(),
        open => format!(" ({open} of them by less than their accuracy)"),
    };
    let in_some = match rounded.with_value < rounded.draws {
        true => format!(" in the {} that have it", rounded.with_value),
        false => String::new(),
    };
    let range = rounded_text(evaluated);
    let range = range.map_or(String::new(), |range| format!("; computed: {range}{in_some}"));
    let _ = writeln!(
        page,
        "- Rounding of the printed constants, {} draws: {}{open}{range}. The constants as printed give: {}.",
        rounded.draws,
        counts.join(", "),
        evaluated.finding.verdict,
    );
}

/// What was computed, with its accuracy and unit.
pub fn computed_text(evaluated: &EvaluatedClaim) -> String {
    let value = value_text(evaluated.finding.value, accuracy_shown(&evaluated.finding));
    of_unit(value, &evaluated.claim)
}

/// What the claim needs, in the unit of what was computed.
fn needed(evaluated: &EvaluatedClaim) -> String {
    let claim = &evaluated.claim;
    let threshold = with_unit(claim.threshold, claim);
    let mut text = match (claim.needs, evaluated.finding.expected) {
        (Needs::Above, _) => format!("above {threshold}"),
        (Needs::Below, _) => format!("below {threshold}"),
        (Needs::Within, None) => format!("within {threshold}"),
        (Needs::Within, Some(expected)) => format!("{} ± {threshold}", digits(expected)),
    };
    if let Some(most) = claim.at_most {
        let _ = write!(text, ", at most {}", with_unit(most, claim));
    }
    if let Some(partly) = claim.partly {
        let _ = write!(text, ", in part above {}", with_unit(partly, claim));
    }
    text
}

/// What rounding allows, if anything was drawn.
pub(crate) fn rounded_text(evaluated: &EvaluatedClaim) -> Option<String> {
    let (low, high) = evaluated.rounded.as_ref()?.range?;
    let high = with_unit(high, &evaluated.claim);
    Some(format!("{} to {high}", digits(low)))
}

pub(crate) fn with_unit(value: f64, claim: &Claim) -> String {
    of_unit(digits(value), claim)
}

fn of_unit(number: String, claim: &Claim) -> String {
    match claim.unit.is_empty() || number == "none" {
        true => number,
        false => format!("{number} {}", claim.unit),
    }
}

/// Accuracies below this fraction of their value are rounding of the arithmetic.
const ROUNDED: f64 = 1e-13;

/// The accuracy of a finding, `None` where it is rounding of the arithmetic.
fn accuracy_shown(finding: &ClaimFinding) -> Option<f64> {
    let accuracy = finding.accuracy;
    (accuracy.is_finite() && accuracy > ROUNDED * finding.value.abs()).then_some(accuracy)
}

/// A value to the place of its accuracy's first digit, at most eight digits.
fn value_text(value: f64, accuracy: Option<f64>) -> String {
    match accuracy {
        _ if !value.is_finite() => "none".to_owned(),
        None => digits(value),
        Some(accuracy) => {
            let place = |number: f64| number.abs().log10().floor();
            let shown = (place(value) - place(accuracy) + 1.0).clamp(1.0, 8.0) as usize;
            let (value, accuracy) = (significant(value, shown), significant(accuracy, 1));
            format!("{value} ± {accuracy}")
        }
    }
}

fn digits(value: f64) -> String {
    significant(value, 6)
}

/// A number with so many significant digits, with an exponent if it is large or small.
fn significant(value: f64, count: usize) -> String {
    let magnitude = value.abs().log10().floor();
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    if !(-4.0..6.0).contains(&magnitude) {
        let text = format!("{value:.*e}", count.saturating_sub(1));
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{exponent}", trimmed(mantissa));
    }
    let decimals = (count as f64 - 1.0 - magnitude).max(0.0) as usize;
    trimmed(&format!("{value:.decimals$}")).to_owned()
}

/// Without zeros at the end of decimals.
fn trimmed(text: &str) -> &str {
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => text,
    }
}

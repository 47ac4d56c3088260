//! Claims with their verdicts, as JSON and Markdown.

use super::{Judged, Verdict};
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// All that was found about every claim, as JSON. Numbers that do not exist
/// are `null`.
#[must_use]
pub fn claims_json(judged: &[Judged], reading: &str) -> Value {
    let rows: Vec<Value> = judged.iter().map(row).collect();
    json!({ "reading": reading, "claims": rows })
}

fn row(judged: &Judged) -> Value {
    let claim = &judged.claim;
    let mut row = json!({
        "id": claim.id,
        "statement": claim.statement,
        "paper": claim.paper,
        "predicate": claim.predicate,
        "cases": claim.cases,
        "branches": claim.branches,
        "expected": claim.expected,
        "threshold": claim.threshold,
        "partly": claim.partly,
        "reason": claim.reason,
        "value_is": claim.value,
        "value": number(judged.finding.value),
        "value_accuracy": number(judged.finding.accuracy),
        "detail": judged.finding.detail,
        "verdict_as_printed": judged.finding.verdict.name(),
        "verdict": judged.verdict.name(),
    });
    if let (Some(rounded), Some(row)) = (&judged.rounded, row.as_object_mut()) {
        let counts = Verdict::ALL.iter().zip(rounded.verdicts);
        let counts: Map<String, Value> = counts
            .map(|(verdict, count)| (verdict.name().to_owned(), json!(count)))
            .collect();
        let rounding = json!({
            "draws": rounded.draws,
            "verdicts": counts,
            "value_range": rounded.range.map(|(low, high)| [low, high]),
        });
        row.insert("rounding".to_owned(), rounding);
    }
    row
}

fn number(value: f64) -> Value {
    // JSON has no NaN.
    match value.is_finite() {
        true => json!(value),
        false => Value::Null,
    }
}

/// The same as a page for people.
#[must_use]
pub fn claims_markdown(judged: &[Judged], reading: &str) -> String {
    let mut page = String::from("# What the paper says, and what its model shows\n\n");
    let _ = writeln!(page, "Read as: {reading}.\n");
    if judged.iter().any(|judged| judged.rounded.is_some()) {
        page.push_str(ROUNDING);
    }
    let _ = writeln!(page, "{}\n", totals(judged));
    page.push_str("| claim | verdict | value | rounding allows |\n|---|---|---|---|\n");
    for judged in judged {
        let finding = &judged.finding;
        let range = judged.rounded.as_ref().and_then(|rounded| rounded.range);
        let range = range.map_or(String::new(), |(low, high)| {
            format!("{} to {}", digits(low), digits(high))
        });
        let value = value_text(finding.value, finding.accuracy);
        let row = [
            &judged.claim.statement,
            judged.verdict.name(),
            &value,
            &range,
        ];
        let _ = writeln!(page, "| {} |", row.join(" | "));
    }
    page.push_str("\n## One by one\n");
    for judged in judged {
        section(&mut page, judged);
    }
    page
}

/// What was drawn, for the page.
const ROUNDING: &str = "Rounding: every printed constant is drawn within half a unit of its last \
    digit, steel's Poisson ratio 0.3 from 0.25 to 0.35; a claim that a draw decides otherwise \
    is not decidable.\n\n";

/// How many claims have which verdict, in a sentence.
fn totals(judged: &[Judged]) -> String {
    let count = |verdict| judged.iter().filter(|j| j.verdict == verdict).count();
    let parts = Verdict::ALL.map(|verdict| format!("{} {}", count(verdict), verdict.name()));
    format!("Of {} claims: {}.", judged.len(), parts.join(", "))
}

fn section(page: &mut String, judged: &Judged) {
    let (claim, finding) = (&judged.claim, &judged.finding);
    let _ = writeln!(page, "\n### `{}`: {}\n", claim.id, judged.verdict);
    let _ = writeln!(page, "{} ({})\n", claim.statement, claim.paper);
    let value = value_text(finding.value, finding.accuracy);
    let _ = writeln!(page, "- Value: {value} ({}).", claim.value);
    if !claim.expected.is_empty() {
        let printed: Vec<String> = claim.expected.iter().map(|value| digits(*value)).collect();
        let _ = writeln!(page, "- The paper has: {}.", printed.join(", "));
    }
    let threshold = digits(claim.threshold);
    let _ = writeln!(page, "- Threshold: {threshold}. {}", claim.reason);
    let _ = writeln!(page, "- Detail: {}.", finding.detail);
    if let Some(rounded) = &judged.rounded {
        let counts = Verdict::ALL
            .iter()
            .zip(rounded.verdicts)
            .filter(|(_, count)| *count > 0);
        let counts: Vec<String> = counts
            .map(|(verdict, count)| format!("{verdict} in {count}"))
            .collect();
        let printed = finding.verdict;
        let range = rounded.range.map_or(String::new(), |(low, high)| {
            format!(
                "; the value lies between {} and {}",
                digits(low),
                digits(high)
            )
        });
        let _ = writeln!(
            page,
            "- Rounding of the printed constants, {} draws: {}{range}. The constants as printed give: {printed}.",
            rounded.draws,
            counts.join(", "),
        );
    }
}

/// A value with as many digits as its accuracy allows, at most eight.
#[must_use]
pub fn value_text(value: f64, accuracy: f64) -> String {
    match (value.is_finite(), accuracy.is_finite() && accuracy > 0.0) {
        (false, _) => "none".to_owned(),
        (true, false) => digits(value),
        (true, true) => {
            let shown = (value.abs() / accuracy).log10().ceil().clamp(1.0, 7.0) as usize;
            format!("{} ± {accuracy:.0e}", significant(value, shown))
        }
    }
}

/// Six significant digits.
fn digits(value: f64) -> String {
    significant(value, 6)
}

/// A number with this many significant digits, without an exponent where it
/// is neither large nor small.
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

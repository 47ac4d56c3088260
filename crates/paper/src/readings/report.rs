//! A scan over readings as a table and a page.

use super::scan::{ReadingRow, ReadingScan, SwitchOptions};
use crate::claims::{Claim, ClaimVerdict, EvaluatedClaim, rounded_text, verdicts_text, with_unit};
use hertzchain_experiment::Reading;
use std::collections::HashSet;
use std::fmt::Write as _;

/// Marks a claim whose verdict in the default reading rounding alone flips.
pub(crate) const FLIPPED: &str = "†";

/// The same in the closest reading.
const FLIPPED_IN_CLOSEST: &str = "‡";

/// One row a reading: its switches, its score, the verdict of each claim.
pub(crate) fn scan_csv(scan: &ReadingScan) -> String {
    let switches = Reading::switches().iter().map(|switch| switch.name);
    let claims = scan.claims.iter().map(|claim| claim.id.as_str());
    let header: Vec<&str> = switches.chain(["score"]).chain(claims).collect();
    let mut csv = header.join(",") + "\n";
    let mut seen = HashSet::new();
    for row in scan.rows().filter(|row| seen.insert(row.reading)) {
        let options = Reading::switches().iter();
        let options = options.map(|s| row.reading.get(s.name).unwrap_or_default().to_owned());
        let verdicts = row.verdicts.iter().map(|verdict| verdict.name().to_owned());
        let fields: Vec<String> =
            options.chain([row.score().to_string()]).chain(verdicts).collect();
        let _ = writeln!(csv, "{}", fields.join(","));
    }
    csv
}

pub(crate) fn scan_markdown(scan: &ReadingScan) -> String {
    let mut page = String::from("# Which claims hold in which reading\n\n");
    page.push_str(
        "The paper leaves open what these switches decide. The score counts a claim that holds as \
         1 and one that holds in part as 1/2. Every reading takes the printed constants to the letter.\n\n",
    );
    rounding(&mut page, scan);
    let _ = writeln!(page, "{}\n", verdicts_text());
    page.push_str(
        "## One switch at a time\n\n| reading | score | gained | lost |\n|---|---|---|---|\n",
    );
    let _ = writeln!(page, "| default | {} | | |", scan.default.score());
    for row in &scan.single {
        table_row(&mut page, scan, row);
    }
    product(&mut page, scan);
    closest(&mut page, scan);
    side_by_side(&mut page, scan);
    prices(&mut page, scan);
    page
}

/// What the mark means, and how many claims have it.
fn rounding(page: &mut String, scan: &ReadingScan) {
    let count = scan.flipped_by_rounding.len();
    if count > 0 {
        let _ = writeln!(
            page,
            "{FLIPPED} marks {count} claims that rounding of the printed constants alone flips in the default \
             reading: claims.md calls them not decidable, whatever the constants as printed give here.\n"
        );
    }
}

fn table_row(page: &mut String, scan: &ReadingScan, row: &ReadingRow) {
    let (gained, lost) = row.against(&scan.default);
    let (gained, lost) = (names(scan, &gained), names(scan, &lost));
    let _ = writeln!(page, "| {} | {} | {gained} | {lost} |", row.reading, row.score());
}

fn names(scan: &ReadingScan, claims: &[usize]) -> String {
    let names = claims.iter().filter_map(|claim| name(scan, *claim));
    names.collect::<Vec<_>>().join(", ")
}

/// A claim's name, marked if rounding flips it.
fn name(scan: &ReadingScan, claim: usize) -> Option<String> {
    let id = &scan.claims.get(claim)?.id;
    Some(match scan.flipped_by_rounding.contains(&claim) {
        true => format!("{id}{FLIPPED}"),
        false => id.clone(),
    })
}

fn product(page: &mut String, scan: &ReadingScan) {
    let (tried, all) = (scan.product.len(), scan.full_product_size());
    page.push_str(match tried < all {
        true => "\n## Part of the full product\n\n",
        false => "\n## Full product\n\n",
    });
    let _ = writeln!(
        page,
        "{tried} readings, of the switches that move a verdict, with their options: {}.",
        factors(&scan.product_of)
    );
    if tried < all {
        let _ = writeln!(
            page,
            "The full product has {all}; the other {} are more than were asked for: all that change, besides others, {}. These \
             switches were tried one at a time from the default reading and again from the best of the part, \
             not in every combination.",
            all - tried,
            factors(&scan.left_out)
        );
    }
    page.push_str("\nThe ten best:\n\n| reading | score | gained | lost |\n|---|---|---|---|\n");
    let mut rows: Vec<&ReadingRow> = scan.product.iter().collect();
    rows.sort_by(|a, b| {
        let changes = |row: &ReadingRow| row.reading.changes().len();
        b.score().total_cmp(&a.score()).then(changes(a).cmp(&changes(b)))
    });
    for row in rows.into_iter().take(10) {
        table_row(page, scan, row);
    }
}

fn factors(factors: &[SwitchOptions]) -> String {
    let texts = factors.iter().map(|(name, options)| format!("{name} ({})", options.len()));
    texts.collect::<Vec<_>>().join(", ")
}

fn closest(page: &mut String, scan: &ReadingScan) {
    let row = scan.closest();
    let (gained, lost) = row.against(&scan.default);
    page.push_str("\n## Closest to the paper\n\n");
    let _ = writeln!(
        page,
        "{}: score {} against {} of the default reading, of {} claims.\n",
        row.reading,
        row.score(),
        scan.default.score(),
        scan.claims.len()
    );
    let _ = writeln!(
        page,
        "Without what rounding of the printed constants leaves open there ({FLIPPED_IN_CLOSEST} below, {} claims; \
         {FLIPPED} in the default reading): {} against {}.\n",
        scan.flipped_in_closest.len(),
        row.score_without(&scan.flipped_in_closest),
        scan.default.score_without(&scan.flipped_by_rounding),
    );
    let equals: Vec<String> = scan.as_close().iter().map(|row| row.reading.to_string()).collect();
    if !equals.is_empty() {
        let _ = writeln!(
            page,
            "The same score, with as many changes or more: {}.\n",
            equals.join("; ")
        );
    }
    let or_none = |list: String| {
        if list.is_empty() { "nothing".to_owned() } else { list }
    };
    let _ = writeln!(page, "- Gained: {}.", or_none(names(scan, &gained)));
    let _ = writeln!(page, "- Missing: {}.", or_none(names(scan, &lost)));
    let unmet = row.verdicts.iter().enumerate();
    let unmet: Vec<usize> =
        unmet.filter(|(_, v)| **v == ClaimVerdict::Fails).map(|(i, _)| i).collect();
    let _ = writeln!(page, "- Still failing: {}.", or_none(names(scan, &unmet)));
}

/// Verdict and value of every claim in the default and the closest reading.
fn side_by_side(page: &mut String, scan: &ReadingScan) {
    page.push_str("\n| claim | default | value | closest | value |\n|---|---|---|---|---|\n");
    let closest = scan.closest();
    let cells = |row: &ReadingRow, i: usize, claim: &Claim| {
        let verdict = row.verdicts.get(i).map_or("", |v| v.name());
        let value = row.values.get(i).filter(|value| value.is_finite());
        let value = value.map_or("none".to_owned(), |value| with_unit(*value, claim));
        format!("{verdict} | {value}")
    };
    for (i, claim) in scan.claims.iter().enumerate() {
        let (one, mut other) = (cells(&scan.default, i, claim), cells(closest, i, claim));
        if scan.flipped_in_closest.contains(&i) {
            other = format!("{FLIPPED_IN_CLOSEST} {other}");
        }
        let name = name(scan, i).unwrap_or_default();
        let _ = writeln!(page, "| {name} | {one} | {other} |");
    }
}

fn prices(page: &mut String, scan: &ReadingScan) {
    page.push_str("\n## What the open claims cost\n\n");
    page.push_str(
        "For each claim that does not fully hold in the default reading: the reading that meets it \
         best, of these the one with the highest score, and what is lost there.\n\n\
         | claim | default | best | reading | score | lost |\n|---|---|---|---|---|---|\n",
    );
    for (claim, row) in scan.prices() {
        let name = names(scan, &[claim]);
        let verdict = |row: &ReadingRow| row.verdicts.get(claim).map_or("", |v| v.name());
        let default = verdict(&scan.default);
        match row {
            None => {
                let _ = writeln!(page, "| {name} | {default} | {default} | no reading tried | | |");
            }
            Some(row) => {
                let lost = names(scan, &row.against(&scan.default).1);
                let (best, score) = (verdict(row), row.score());
                let _ = writeln!(
                    page,
                    "| {name} | {default} | {best} | {} | {score} | {lost} |",
                    row.reading
                );
            }
        }
    }
}

/// What rounding does when the dry balls' Poisson ratio is 0.3 to one digit
/// instead of two: the claims whose verdict then differs.
pub(crate) fn two_digits_markdown(
    one_digit: &[EvaluatedClaim],
    two_digits: &[EvaluatedClaim],
) -> String {
    let mut page = String::from(
        "\n## If steel's 0.3 means the handbooks' 0.30\n\nThe verdicts of claims.md let the printed Poisson \
         ratio of steel, 0.3, lie between 0.25 and 0.35, as its one digit says. Taken for the handbooks' \
         0.30 it lies within 0.005, and rounding leaves fewer claims open:\n\n\
         | claim | 0.30 | 0.3 | range of the value at 0.3 |\n|---|---|---|---|\n",
    );
    let pairs = two_digits.iter().zip(one_digit);
    for (two, one) in pairs.filter(|(two, one)| two.verdict != one.verdict) {
        let range = rounded_text(one).unwrap_or_default();
        let id = &one.claim.id;
        let _ = writeln!(page, "| {id} | {} | {} | {range} |", two.verdict, one.verdict);
    }
    page
}

#[cfg(test)]
#[path = "tests/report.rs"]
mod tests;

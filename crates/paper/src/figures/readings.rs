//! Which claims hold in which reading.

use crate::claims::Verdict as Found;
use crate::readings::{FLIPPED, Row, Scan};
use hertzchain_figures::{Figure, Verdict, VerdictMatrix};

/// Claims against readings: the default, one switch at a time, the closest.
///
/// What never moves needs no cells: claims with one verdict in all readings
/// are listed by it, and so are switches that move no verdict. Claims that
/// rounding flips are marked: a verdict is that of the constants as printed.
pub(super) fn figure(scan: &Scan) -> Figure {
    let columns = columns(scan);
    let moved: Vec<&Column> = columns.iter().filter(|c| c.is_shown(scan)).collect();
    let names: Vec<&str> = moved.iter().map(|column| column.name.as_str()).collect();
    let mut matrix = VerdictMatrix::new(&names);
    let mut fixed: [Vec<String>; 4] = Default::default();
    for (i, claim) in scan.claims.iter().enumerate() {
        let name = name(scan, i, &claim.id);
        let verdicts: Vec<Verdict> = moved.iter().filter_map(|c| c.verdict(i)).collect();
        match verdicts.split_first() {
            Some((first, others)) if others.iter().all(|other| other == first) => {
                if let Some(list) = fixed.get_mut(place(*first)) {
                    list.push(name);
                }
            }
            _ => matrix = matrix.row(&name, &verdicts),
        }
    }
    for (verdict, claims) in LISTED.into_iter().zip(&fixed) {
        if !claims.is_empty() {
            matrix = matrix.throughout(verdict, &format!("in all: {}", claims.join(", ")));
        }
    }
    let unmoved = columns.iter().filter(|column| !column.is_shown(scan));
    let unmoved: Vec<&str> = unmoved.map(|column| column.name.as_str()).collect();
    if !unmoved.is_empty() {
        matrix = matrix.note(&format!("As the default: {}.", unmoved.join("; ")));
    }
    if !scan.flipped_by_rounding.is_empty() {
        matrix = matrix.note(&format!("{FLIPPED} {ROUNDING}"));
    }
    matrix
        .figure()
        .title("Claims of the paper in different readings of it")
        .caption(&caption(scan))
}

/// What the mark means.
const ROUNDING: &str = "Not decidable in the default reading: there rounding of the printed constants \
    alone flips the verdict that they give as printed, which is shown.";

fn caption(scan: &Scan) -> String {
    let mut caption = String::from(
        "Which claims of the paper hold in which reading of its model: the default, one switch \
         changed at a time, and the reading that comes closest to the paper. Claims with the same \
         verdict in all of them, and switches that move no verdict, are listed below the table.",
    );
    if !scan.flipped_by_rounding.is_empty() {
        caption += &format!(" {FLIPPED} {ROUNDING}");
    }
    caption
}

/// A claim's name in words, marked if rounding flips it.
fn name(scan: &Scan, claim: usize, id: &str) -> String {
    match scan.flipped_by_rounding.contains(&claim) {
        true => words(id) + FLIPPED,
        false => words(id),
    }
}

/// Verdicts in the order of the lists below the table.
const LISTED: [Verdict; 4] = [
    Verdict::Holds,
    Verdict::InPart,
    Verdict::Fails,
    Verdict::NotDecidable,
];

fn place(verdict: Verdict) -> usize {
    LISTED
        .iter()
        .take_while(|listed| **listed != verdict)
        .count()
}

/// One reading, or options of one switch with the same verdicts.
struct Column<'a> {
    name: String,
    /// The switch that is changed; empty for the default and the closest.
    switch: &'static str,
    row: &'a Row,
}

impl Column<'_> {
    /// The default and the closest are always shown.
    fn is_shown(&self, scan: &Scan) -> bool {
        self.switch.is_empty() || self.row.verdicts != scan.default.verdicts
    }

    fn verdict(&self, claim: usize) -> Option<Verdict> {
        self.row.verdicts.get(claim).copied().map(symbol)
    }
}

fn columns(scan: &Scan) -> Vec<Column<'_>> {
    let always = |name: &str, row| Column {
        name: name.to_owned(),
        switch: "",
        row,
    };
    let mut columns = vec![always("default", &scan.default)];
    for row in &scan.single {
        let Some((switch, option)) = row.reading.changes().first().copied() else {
            continue;
        };
        match columns.last_mut() {
            Some(last) if last.switch == switch && last.row.verdicts == row.verdicts => {
                last.name += &format!(", {option}");
            }
            _ => columns.push(Column {
                name: format!("{switch} = {option}"),
                switch,
                row,
            }),
        }
    }
    columns.push(always("closest to the paper", scan.closest()));
    columns
}

/// A claim's name in words.
fn words(id: &str) -> String {
    let word = |word: &str| match word {
        "tof" => "ToF".to_owned(),
        "hertz" => "Hertz".to_owned(),
        word => word.to_owned(),
    };
    id.split('-').map(word).collect::<Vec<_>>().join(" ")
}

fn symbol(verdict: Found) -> Verdict {
    match verdict {
        Found::Holds => Verdict::Holds,
        Found::InPart => Verdict::InPart,
        Found::Fails => Verdict::Fails,
        Found::NotDecidable => Verdict::NotDecidable,
    }
}

//! Which claims hold in which reading.

use crate::{Figure, Verdict, VerdictMatrix};
use hertzchain_study::claims::Verdict as Judged;
use hertzchain_study::readings::{Row, Scan};

/// Claims against readings: the default, one switch at a time, the closest.
pub(super) fn figure(scan: &Scan) -> Figure {
    let singles = scan.single.iter().map(|row| (row.reading.to_string(), row));
    let first = [("default".to_owned(), &scan.default)];
    let last = [("closest to the paper".to_owned(), scan.closest())];
    let columns: Vec<(String, &Row)> = first.into_iter().chain(singles).chain(last).collect();
    let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
    let claims = scan.claims.iter().enumerate();
    let matrix = claims.fold(VerdictMatrix::new(&names), |matrix, (i, claim)| {
        let verdicts = columns.iter().filter_map(|(_, row)| row.verdicts.get(i));
        let verdicts: Vec<Verdict> = verdicts.copied().map(symbol).collect();
        matrix.row(&claim.id.replace('-', " "), &verdicts)
    });
    matrix
        .figure()
        .title("Claims of the paper in different readings of it")
        .caption(
            "Which claims of the paper hold in which reading of its model: the default, one \
             switch changed at a time, and the reading that comes closest to the paper.",
        )
}

fn symbol(verdict: Judged) -> Verdict {
    match verdict {
        Judged::Holds => Verdict::Holds,
        Judged::InPart => Verdict::InPart,
        Judged::Fails => Verdict::Fails,
        Judged::NotDecidable => Verdict::NotDecidable,
    }
}

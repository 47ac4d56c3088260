//! Figures of verdicts: which claims hold in which reading and on which rig, and what the rigs show.

use crate::claims::{ClaimVerdict, EvaluatedClaim, TofBranch};
use crate::readings::{FLIPPED, ReadingRow, ReadingScan};
use crate::rig_claims::{
    FACTORS, Observed, RigClaims, RigEvidence, SpeedSeries, TriedRig, mean, rebound_m_s, spread_s,
    typical,
};
use hertzchain_figures::{Chart, Colour, Figure, Marker, Series, VerdictMatrix};

/// Claims against readings: the default, one switch at a time, the closest.
///
/// What never moves needs no cells: claims with one verdict in all readings
/// are listed by it, and so are switches that move no verdict. Claims that
/// rounding flips are marked: a verdict is that of the constants as printed.
pub(super) fn readings(scan: &ReadingScan) -> Figure {
    let columns = columns(scan);
    let moved: Vec<&ReadingColumn> = columns.iter().filter(|c| c.is_shown(scan)).collect();
    let mut matrix = VerdictMatrix {
        columns: moved.iter().map(|column| column.name.clone()).collect(),
        ..VerdictMatrix::default()
    };
    let mut fixed: [Vec<String>; 4] = Default::default();
    for (i, claim) in scan.claims.iter().enumerate() {
        let name = name(scan, i, &claim.id);
        let verdicts: Vec<ClaimVerdict> = moved.iter().filter_map(|c| c.verdict(i)).collect();
        match verdicts.split_first() {
            Some((first, others)) if others.iter().all(|other| other == first) => {
                if let Some(list) = fixed.get_mut(place(*first)) {
                    list.push(name);
                }
            }
            _ => matrix.rows.push((name, verdicts)),
        }
    }
    for (verdict, claims) in ClaimVerdict::ALL.into_iter().zip(&fixed) {
        if !claims.is_empty() {
            matrix.throughout.push((verdict, format!("in all: {}", claims.join(", "))));
        }
    }
    let unmoved = columns.iter().filter(|column| !column.is_shown(scan));
    let unmoved: Vec<&str> = unmoved.map(|column| column.name.as_str()).collect();
    if !unmoved.is_empty() {
        matrix.notes.push(format!("As the default: {}.", unmoved.join("; ")));
    }
    if !scan.flipped_by_rounding.is_empty() {
        matrix.notes.push(format!("{FLIPPED} {ROUNDING}"));
    }
    matrix
        .figure()
        .title("Claims of the paper in different readings of it")
        .caption(&readings_caption(scan))
}

const ROUNDING: &str = "Not decidable in the default reading: there rounding of the printed constants \
    alone flips the verdict that they give as printed, which is shown.";

fn readings_caption(scan: &ReadingScan) -> String {
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
fn name(scan: &ReadingScan, claim: usize, id: &str) -> String {
    match scan.flipped_by_rounding.contains(&claim) {
        true => words(id) + FLIPPED,
        false => words(id),
    }
}

/// Place of a verdict in the lists below the table.
fn place(verdict: ClaimVerdict) -> usize {
    ClaimVerdict::ALL.iter().take_while(|listed| **listed != verdict).count()
}

/// One reading, or options of one switch with the same verdicts.
struct ReadingColumn<'a> {
    name: String,
    /// The switch that is changed; empty for the default and the closest.
    switch: &'static str,
    row: &'a ReadingRow,
}

impl ReadingColumn<'_> {
    /// The default and the closest are always shown.
    fn is_shown(&self, scan: &ReadingScan) -> bool {
        self.switch.is_empty() || self.row.verdicts != scan.default.verdicts
    }

    fn verdict(&self, claim: usize) -> Option<ClaimVerdict> {
        self.row.verdicts.get(claim).copied()
    }
}

fn columns(scan: &ReadingScan) -> Vec<ReadingColumn<'_>> {
    let always = |name: &str, row| ReadingColumn { name: name.to_owned(), switch: "", row };
    let mut columns = vec![always("default", &scan.default)];
    for row in &scan.single {
        let Some((switch, option)) = row.reading.changes().first().copied() else {
            continue;
        };
        match columns.last_mut() {
            Some(last) if last.switch == switch && last.row.verdicts == row.verdicts => {
                last.name += &format!(", {option}");
            }
            _ => columns.push(ReadingColumn { name: format!("{switch} = {option}"), switch, row }),
        }
    }
    columns.push(always("closest to the paper", scan.closest()));
    columns
}

fn words(id: &str) -> String {
    let word = |word: &str| match word {
        "tof" => "ToF".to_owned(),
        "hertz" => "Hertz".to_owned(),
        word => word.to_owned(),
    };
    id.split('-').map(word).collect::<Vec<_>>().join(" ")
}

/// All figures of the rig's claims by name.
pub fn rig_figures(evidence: &RigEvidence, claims: &RigClaims) -> Vec<(&'static str, Figure)> {
    vec![
        ("rig_verdicts", verdicts(claims)),
        ("rig_spreads", spreads(evidence)),
        ("rig_rebounds", rebounds(evidence)),
        ("rig_gaps", gaps(evidence)),
    ]
}

fn verdicts(claims: &RigClaims) -> Figure {
    let cell = |claim: usize| {
        let verdict = move |all: &[EvaluatedClaim]| all.get(claim).map(|own| own.verdict);
        move |(_, all): &(TriedRig, Vec<EvaluatedClaim>)| {
            verdict(all).unwrap_or(ClaimVerdict::NotDecidable)
        }
    };
    let rows = claims.evaluated.iter().enumerate().map(|(at, evaluated)| {
        (evaluated.claim.id.replace('-', " "), claims.rigs.iter().map(cell(at)).collect())
    });
    let matrix = VerdictMatrix {
        columns: claims.rigs.iter().map(|(rig, _)| rig.name.to_string()).collect(),
        rows: rows.collect(),
        ..VerdictMatrix::default()
    };
    matrix.figure().title("What the paper says of its rig, on virtual ones")
}

/// Spreads against each factor, the others as usual, beside what the striker's scatter adds.
fn spreads(evidence: &RigEvidence) -> Figure {
    let kinds: [(&str, Colour, Marker, Of); 3] = [
        ("reflected, with taps", Colour::GREEN, Marker::OpenSquare, |at| {
            spread_s(&at.tapped, TofBranch::Reflected)
        }),
        ("incident, with taps", Colour::BLUE, Marker::Circle, |at| {
            spread_s(&at.tapped, TofBranch::Incident)
        }),
        ("incident, without taps", Colour::VERMILION, Marker::Triangle, |at| {
            spread_s(&at.loose, TofBranch::Incident)
        }),
    ];
    let added_ns = evidence.rigs.first().map_or(f64::NAN, |usual| {
        let scatter = usual.with_scatter_s(TofBranch::Incident);
        1e9 * typical(scatter.map(|(_, scatter_s)| scatter_s)).value.exp()
    });
    let mut figure = Figure::double_column(120.0).columns(2).letters();
    for (at, factor) in FACTORS.iter().enumerate() {
        let rigs = one_at_a_time(evidence, at);
        let (first, rest) = factor.name.split_at(1);
        let name = first.to_uppercase() + rest;
        let label = match factor.unit {
            "" => name,
            unit => format!("{name} ({})", unit.trim()),
        };
        let mut chart = Chart::new(&label, "Spread of ToF (ns)").y_log();
        chart = chart.y_range(SPREADS_NS.0, SPREADS_NS.1);
        if rigs.iter().all(|(value, _)| *value > 0.0) {
            chart = chart.x_log();
        }
        for (name, colour, marker, of) in kinds {
            let points = spread(&rigs, factor.si, name, of);
            chart = chart.with(points.colour(colour).marker(marker));
        }
        let first = at == 0;
        chart = chart.h_line(added_ns, if first { "by the striker\u{2019}s ± 3 mm/s" } else { "" });
        figure = figure.panel(chart.legend(first));
    }
    figure
}

/// Range of spreads in ns, the same in all panels.
const SPREADS_NS: (f64, f64) = (50.0, 5e5);

type Of = fn(&SpeedSeries) -> f64;

/// Rigs that differ from the usual one in a factor at most, by its value.
fn one_at_a_time(evidence: &RigEvidence, factor: usize) -> Vec<(f64, &Observed)> {
    let usual = TriedRig::usual();
    let same = |rig: &TriedRig| {
        let pairs = rig.values.iter().zip(usual.values).enumerate();
        pairs.into_iter().all(|(at, (value, usual))| at == factor || *value == usual)
    };
    let rigs = evidence.rigs.iter().filter(|observed| same(&observed.rig));
    let mut rigs: Vec<(f64, &Observed)> =
        rigs.filter_map(|observed| Some((*observed.rig.values.get(factor)?, observed))).collect();
    rigs.sort_by(|one, other| one.0.total_cmp(&other.0));
    rigs
}

/// The geometric mean over all speeds, with its 95 % interval.
fn spread(rigs: &[(f64, &Observed)], si: f64, name: &str, of: Of) -> Series {
    let values: Vec<f64> = rigs.iter().map(|(value, _)| value / si).collect();
    let found = rigs.iter().map(|(_, observed)| {
        let log = typical(observed.speeds.iter().map(of));
        let ns = 1e9 * log.value.exp();
        (ns, ns * -(-log.error).exp_m1(), ns * log.error.exp_m1())
    });
    let found: Vec<(f64, f64, f64)> = found.collect();
    let part = |of: fn(&(f64, f64, f64)) -> f64| found.iter().map(of).collect::<Vec<f64>>();
    Series::points(name, &values, &part(|f| f.0)).y_errors(&part(|f| f.1), &part(|f| f.2))
}

fn rebounds(evidence: &RigEvidence) -> Figure {
    let mut chart = Chart::new("Striker speed $v_0$ (m/s)", "Rebound / $v_0$").x_log();
    for observed in shown(evidence) {
        let speeds: Vec<f64> = observed.speeds.iter().map(|at| at.speed_m_s).collect();
        let share = |at: &SpeedSeries| {
            let all: Vec<f64> = at.tapped.iter().map(rebound_m_s).collect();
            -mean(&all) / at.speed_m_s
        };
        let shares: Vec<f64> = observed.speeds.iter().map(share).collect();
        chart = chart.with(Series::points(&observed.rig.name, &speeds, &shares));
    }
    Figure::single_column(75.0).panel(chart.v_line(0.25, "the paper\u{2019}s 0.25 m/s"))
}

/// The usual rig and those that differ from it in friction or push.
fn shown(evidence: &RigEvidence) -> Vec<&Observed> {
    let same = |rig: &TriedRig| rig.values[2..] == TriedRig::usual().values[2..];
    let rigs = evidence.rigs.iter();
    rigs.filter(|observed| same(&observed.rig)).collect()
}

/// Gaps after the fastest shots and after the taps that follow, contact by contact, on the three
/// rigs that are left loosest, no two of the same friction and push.
fn gaps(evidence: &RigEvidence) -> Figure {
    let mut rigs: Vec<&Observed> = evidence.rigs.iter().collect();
    rigs.sort_by(|one, other| left_m(other).total_cmp(&left_m(one)));
    let friction_and_push = |observed: &Observed| [observed.rig.values[0], observed.rig.values[1]];
    let mut seen = Vec::new();
    rigs.retain(|observed| {
        let new = !seen.contains(&friction_and_push(observed));
        seen.push(friction_and_push(observed));
        new
    });
    let mut figure = Figure::double_column(65.0).columns(3).letters();
    for observed in rigs.into_iter().take(3) {
        if let Some(at) = observed.speeds.last() {
            figure = figure.panel(row(observed, at));
        }
    }
    figure
}

/// All gaps in m after the fastest shot, as a mean.
fn left_m(observed: &Observed) -> f64 {
    observed.speeds.last().map_or(0.0, |at| {
        let sums: Vec<f64> = at.tapped.iter().map(|shot| shot.gaps_after_m.iter().sum()).collect();
        mean(&sums)
    })
}

/// Gaps below this in m are shown in nm.
const SMALL_M: f64 = 1e-7;

fn row(observed: &Observed, at: &SpeedSeries) -> Chart {
    let before: Vec<&[f64]> = at.tapped.iter().map(|shot| &*shot.gaps_before_m).collect();
    let after: Vec<&[f64]> = at.tapped.iter().map(|shot| &*shot.gaps_after_m).collect();
    let (before_m, after_m) = (means(&before), means(&after));
    let all_m = before_m.iter().chain(&after_m);
    let (unit, unit_m) = match all_m.copied().fold(0.0, f64::max) < SMALL_M {
        true => ("nm", 1e-9),
        false => ("µm", 1e-6),
    };
    let chart = Chart::new("Contact", &format!("Gap ({unit})")).title(&held(&observed.rig));
    let kinds = [
        ("after a shot", after_m, Colour::VERMILION, Marker::Triangle),
        ("after taps", before_m, Colour::BLUE, Marker::Circle),
    ];
    kinds.into_iter().fold(chart, |chart, (name, gaps_m, colour, marker)| {
        let gaps: Vec<f64> = gaps_m.iter().map(|gap_m| gap_m / unit_m).collect();
        let numbers: Vec<f64> = (1..=gaps.len()).map(|contact| contact as f64).collect();
        let name = format!("{name}: {:.0} {unit} in all", gaps.iter().sum::<f64>());
        let points = Series::points(&name, &numbers, &gaps);
        chart.with(points.colour(colour).marker(marker))
    })
}

/// What holds the beads of a rig where they are, of the factors that are tried.
fn held(rig: &TriedRig) -> String {
    let [friction, push] = [0, 1].map(|at: usize| FACTORS[at].text(rig.values[at]));
    format!("{friction}, {push}")
}

fn means(rows: &[&[f64]]) -> Vec<f64> {
    let contacts = rows.first().map_or(0, |gaps_m| gaps_m.len());
    let mean_of = |contact: usize| {
        let all = rows.iter().filter_map(|gaps_m| gaps_m.get(contact));
        mean(&all.copied().collect::<Vec<f64>>())
    };
    (0..contacts).map(mean_of).collect()
}

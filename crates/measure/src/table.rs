//! Results as CSV, in SI.

use crate::records::no_formula;
use crate::signal::{Estimate, Flight, Picked, PowerLaw, Ratio, Summary};
use crate::{Case, Curves, Lost, Shot, SpeedRow};
use std::io::{self, Write};
use std::iter::once;

/// A number in a cell; empty where there is none.
fn cell(value: Option<f64>) -> String {
    let finite = value.filter(|value| value.is_finite());
    finite.map_or(String::new(), |value| format!("{value:e}"))
}

/// A text in a cell.
fn quoted(text: &str) -> String {
    let text = no_formula(text);
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.into_owned(),
    }
}

fn both(estimate: Option<Estimate>) -> [String; 2] {
    [
        cell(estimate.map(|e| e.value)),
        cell(estimate.map(|e| e.sigma)),
    ]
}

fn line(cells: impl IntoIterator<Item = String>) -> String {
    cells.into_iter().collect::<Vec<_>>().join(",") + "\n"
}

/// One line a shot.
#[must_use]
pub fn shots_csv(shots: &[Shot]) -> String {
    shot_lines(shots).collect()
}

/// Writes the same line by line: recordings may have any number of shots.
///
/// # Errors
/// Those of what is written to.
pub fn write_shots(shots: &[Shot], out: &mut dyn Write) -> io::Result<()> {
    shot_lines(shots).try_for_each(|line| out.write_all(line.as_bytes()))
}

fn shot_lines(shots: &[Shot]) -> impl Iterator<Item = String> {
    let titles = "file,shot,case,speed_m_s,speed_sigma_m_s,tof_incident_s,tof_incident_sigma_s,\
                    tof_reflected_s,tof_reflected_sigma_s,tof_correlation,wall_over_passing,\
                    wall_over_passing_sigma,returning_over_passing,returning_over_passing_sigma,\
                    passing_peak_v,wall_peak_v,returning_peak_v,\
                    passing_width_s,wall_width_s,returning_width_s,flags\n"
        .to_owned();
    once(titles).chain(shots.iter().map(shot_line))
}

fn shot_line(shot: &Shot) -> String {
    let flight = shot.flight.as_ref().ok();
    let picks = flight.map(|flight| &flight.picks);
    let picked = [
        picks.map(|picks| picks.incident),
        picks.map(|picks| picks.wall),
        picks.and_then(|picks| picks.reflected),
    ];
    let each = |of: fn(&Picked) -> f64| picked.map(|picked| cell(picked.as_ref().map(of)));
    let name = [
        quoted(&shot.file.display().to_string()),
        shot.shot.map_or(String::new(), |shot| shot.to_string()),
        quoted(&shot.case),
    ];
    let cells = name
        .into_iter()
        .chain(both(shot.speed_m_s))
        .chain(both(flight.map(|flight| flight.incident_s)))
        .chain(both(flight.and_then(|flight| flight.reflected_s)))
        .chain([cell(flight.and_then(Flight::correlation))])
        .chain(both(flight.map(|flight| flight.wall_over_incident)))
        .chain(both(
            flight.and_then(|flight| flight.reflected_over_incident),
        ))
        .chain(each(|picked| picked.height))
        .chain(each(|picked| picked.width_s))
        .chain([quoted(&shot.flags())]);
    line(cells)
}

/// One line a case and speed; last those at which no shot counts, without times.
#[must_use]
pub fn speeds_csv(curves: &Curves) -> String {
    let mut text = "case,speed_m_s,speed_error_m_s,shots,left_out".to_owned();
    for name in [
        "tof_incident_s",
        "tof_reflected_s",
        "wall_over_passing",
        "returning_over_passing",
    ] {
        text += &format!(",{name},{name}_deviation,{name}_error,{name}_count");
    }
    text += ",passing_width_s,wall_width_s,returning_width_s";
    text += ",tof_incident_shared_s,tof_reflected_shared_s";
    for time in ["tof_incident", "tof_reflected"] {
        text += &format!(",{time}_at_mean_speed_s,{time}_at_mean_speed_s_error");
    }
    text += ",speed_error_shots,returns_undecided,returns_missing";
    text += ",tof_correlation,tof_at_mean_speed_correlation\n";
    for case in &curves.cases {
        text.extend(case.rows.iter().map(|row| speed_line(&case.name, row)));
    }
    let cells = text
        .lines()
        .next()
        .map_or(0, |titles| titles.split(',').count());
    text.extend(curves.lost.iter().map(|lost| lost_line(lost, cells)));
    text
}

/// All its shots are left out, and what would be told of the others is empty.
fn lost_line(lost: &Lost, cells: usize) -> String {
    let told = [
        quoted(&lost.case),
        cell(Some(lost.speed_m_s)),
        String::new(),
        "0".to_owned(),
        lost.shots.to_string(),
    ];
    let empty = std::iter::repeat_n(String::new(), cells.saturating_sub(told.len()));
    line(told.into_iter().chain(empty))
}

fn speed_line(case: &str, row: &SpeedRow) -> String {
    let summarised = |summary: Option<Summary>| {
        [
            cell(summary.map(|s| s.mean)),
            cell(summary.map(|s| s.deviation)),
            cell(summary.map(|s| s.error)),
            summary.map_or(String::new(), |s| s.count.to_string()),
        ]
    };
    let cells = [quoted(case)]
        .into_iter()
        .chain(both(Some(row.speed_m_s)))
        .chain([row.shots.0.to_string(), row.shots.1.to_string()])
        .chain(summarised(Some(row.incident_s)))
        .chain(summarised(row.reflected_s))
        .chain(summarised(Some(row.wall_over_incident)))
        .chain(summarised(row.reflected_over_incident))
        .chain(row.widths_s.map(|width| cell(width.map(|w| w.mean))))
        .chain(row.shared_s.map(|shared_s| cell(Some(shared_s))))
        .chain(row.at_mean_speed_s.into_iter().flat_map(both))
        .chain([
            row.speed_error_shots.to_string(),
            row.returns_undecided.to_string(),
            row.returns_missing.to_string(),
            cell(row.correlation),
            cell(row.correlation_at_mean_speed),
        ]);
    line(cells)
}

/// One line a power law: of each case incident and reflected times of flight. It is supported or
/// not, or that is unknown; empty where nothing judges it.
/// Errors follow from those of the points, as they are; where the law is not
/// supported, they are too small by √(chi-square/degrees of freedom).
#[must_use]
pub fn laws_csv(curves: &Curves) -> String {
    let mut text = "case,time,prefactor_s,prefactor_error_s,exponent,exponent_error,r_squared,\
                    chi_square,degrees_of_freedom,probability,supported\n"
        .to_owned();
    for case in &curves.cases {
        let laws = [
            ("incident", &case.laws.incident),
            ("reflected", &case.laws.reflected),
        ];
        for (time, law) in laws {
            text.extend(law.iter().map(|law| law_line(case, time, law)));
        }
    }
    text
}

fn law_line(case: &Case, time: &str, law: &PowerLaw) -> String {
    let judged = law.chi_square.as_ref();
    let fitted = [
        law.prefactor,
        law.prefactor_error,
        law.exponent,
        law.exponent_error,
        law.r_squared,
    ];
    let cells = [quoted(&case.name), time.to_owned()]
        .into_iter()
        .chain(fitted.map(|value| cell(Some(value))))
        .chain([
            cell(judged.map(|judged| judged.value)),
            judged.map_or(String::new(), |judged| judged.freedom.to_string()),
            cell(judged.map(|judged| judged.probability)),
            match case.supports(law) {
                Ok(supported) => supported.map_or(String::new(), |supported| supported.to_string()),
                Err(_) => "unknown".to_owned(),
            },
        ]);
    line(cells)
}

/// One line a ratio; last the correlation of its error with that of the other time's ratio.
#[must_use]
pub fn ratios_csv(curves: &Curves) -> String {
    let mut text = "case,time,speed_m_s,ratio,ratio_error,correlation\n".to_owned();
    for wet in &curves.ratios {
        let correlation = |ratio: &Ratio| {
            let speeds = wet.incident.iter().map(|ratio| ratio.speed);
            let mut both = speeds.zip(&wet.correlations);
            both.find_map(|(speed, of)| of.filter(|_| speed == ratio.speed))
        };
        for (time, ratios) in [("incident", &wet.incident), ("reflected", &wet.reflected)] {
            let one = |ratio: &Ratio| {
                let name = [quoted(&wet.case), time.to_owned(), cell(Some(ratio.speed))];
                let last = [cell(correlation(ratio))];
                line(name.into_iter().chain(both(Some(ratio.ratio))).chain(last))
            };
            text.extend(ratios.iter().map(one));
        }
    }
    text
}

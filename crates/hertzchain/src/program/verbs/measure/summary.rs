//! What was measured, in short, for people.

use crate::program::{chi_square_text, format, heading, with_error};
use hertzchain_measure::signal::{Estimate, FitError, PowerLaw, Summary};
use hertzchain_measure::{Case, Curves, Measurement, Shot, SpeedRow};

const MOST_SHOTS: usize = 30;

/// Relative errors below this are the arithmetic's.
const ROUNDING: f64 = 1e-12;

pub(crate) fn text(measured: &Measurement, curves: &Curves, reference: &str) -> String {
    let mut text = counted(measured) + "\n";
    let few = curves.cases.is_empty() || measured.shots.len() <= MOST_SHOTS;
    if few && !measured.shots.is_empty() {
        text += &shots(&measured.shots);
    }
    for case in &curves.cases {
        text += &curve(case);
    }
    for lost in &curves.unmeasured {
        text += &format!(
            "{} at {} m/s: none of {} shot{} has a time of flight that counts\n",
            named(&lost.case),
            format::digits(lost.speed_m_s, 4),
            lost.shots,
            if lost.shots == 1 { "" } else { "s" }
        );
    }
    for wet in &curves.ratios {
        text += &format!("\n{}\n", heading(&format!("{} over {reference}", named(&wet.case))));
        for (time, ratios) in [("incident", &wet.incident), ("reflected", &wet.reflected)] {
            for ratio in ratios {
                let (value, error) = with_error(ratio.ratio.value, ratio.ratio.sigma);
                let speed = format::digits(ratio.speed, 4);
                text += &format!("  {time} at {speed} m/s: {value} ± {error}\n");
            }
        }
    }
    if !measured.shots.is_empty() && curves.cases.is_empty() && curves.unmeasured.is_empty() {
        text += "No speeds are known: give --shots for curves.\n";
    }
    text
}

fn counted(measured: &Measurement) -> String {
    let timed = measured.shots.iter().filter(|shot| shot.flight.is_ok());
    let flagged = measured.shots.iter().filter(|shot| !shot.flags().is_empty());
    let all = measured.shots.len() + measured.refused.len();
    format!(
        "{all} record{}, {} with times of flight, {} flagged, {} refused",
        if all == 1 { "" } else { "s" },
        timed.count(),
        flagged.count(),
        measured.refused.len()
    )
}

pub(crate) fn named(case: &str) -> &str {
    if case.is_empty() { "all shots" } else { case }
}

pub(crate) fn micro(of: Estimate) -> String {
    let (value, error) = with_error(1e6 * of.value, 1e6 * of.sigma);
    format!("{value} ± {error}")
}

/// A mean time in µs.
pub(crate) fn mean(of: &Summary) -> String {
    micro(Estimate { value: of.mean, sigma: of.error })
}

fn shots(shots: &[Shot]) -> String {
    let head = ["record", "v (m/s)", "incident (µs)", "reflected (µs)", "flags"];
    let row = |shot: &Shot| {
        let flight = shot.flight.as_ref().ok();
        let name = shot.file.file_name().unwrap_or_default().to_string_lossy();
        let number = shot.shot.map_or(String::new(), |shot| format!(" {shot}"));
        vec![
            format!("{name}{number}"),
            shot.speed_m_s.map_or(String::new(), |speed| format::digits(speed.value, 4)),
            flight.map_or(String::new(), |flight| micro(flight.incident_s)),
            flight.and_then(|flight| flight.reflected_s).map_or(String::new(), micro),
            shot.flags(),
        ]
    };
    let more = match shots.len().saturating_sub(MOST_SHOTS) {
        0 => String::new(),
        more => format!("… and {more} more; --out writes all\n"),
    };
    format::table(head, shots.iter().take(MOST_SHOTS).map(row)) + &more
}

/// How many shots count, and what does not.
fn counts(row: &SpeedRow) -> String {
    let (counted, out) = row.shots;
    let left_out = match out {
        0 => String::new(),
        out => format!(" (+{out} left out)"),
    };
    let undecided = match row.returns_undecided {
        0 => String::new(),
        open => format!(", {open} returns undecided"),
    };
    let missing = match row.returns_missing {
        0 => String::new(),
        missing => format!(", {missing} without a return"),
    };
    format!("{counted}{left_out}{undecided}{missing}")
}

fn curve(case: &Case) -> String {
    let head = [
        "v (m/s)",
        "shots",
        "incident (µs)",
        "s.d.",
        "reflected (µs)",
        "s.d.",
        "wall/incident",
        "reflected/incident",
    ];
    let mean = |summary: Option<Summary>| summary.map_or(String::new(), |summary| mean(&summary));
    let deviation = |summary: Option<Summary>| {
        let known = summary.map(|s| s.deviation).filter(|s| s.is_finite());
        known.map_or(String::new(), |s| format::digits(1e6 * s, 2))
    };
    let share =
        |summary: Option<Summary>| summary.map_or(String::new(), |s| format::digits(s.mean, 4));
    let rows = case.rows.iter().map(|row| {
        vec![
            format::digits(row.speed_m_s.value, 4),
            counts(row),
            mean(Some(row.incident_s)),
            deviation(Some(row.incident_s)),
            mean(row.reflected_s),
            deviation(row.reflected_s),
            share(Some(row.wall_over_incident)),
            share(row.reflected_over_incident),
        ]
    });
    format!(
        "\n{}\n{}{}{}",
        heading(named(&case.name)),
        format::table(head, rows),
        law("incident", case, &case.laws.incident),
        law("reflected", case, &case.laws.reflected)
    )
}

/// A fit, evaluated; too few speeds for one are plain to see. Errors are widened to
/// the points' scatter where that is larger.
pub(crate) fn law(name: &str, case: &Case, law: &Result<PowerLaw, FitError>) -> String {
    let Ok(law) = law else { return String::new() };
    // Of equal shots, what the arithmetic rounds is no error.
    let alike = law.prefactor_error < ROUNDING * law.prefactor;
    let reported = |error: f64| if alike { 0.0 } else { law.excess() * error };
    let (prefactor, error) = with_error(1e6 * law.prefactor, 1e6 * reported(law.prefactor_error));
    let exponent = match alike {
        // Without the sign of a zero.
        true => (law.exponent / ROUNDING).round() * ROUNDING + 0.0,
        false => law.exponent,
    };
    let (exponent, exponent_error) = with_error(exponent, reported(law.exponent_error));
    match law.exponent_error.is_finite() {
        true => format!(
            "{name}: ({prefactor} ± {error}) µs · v^({exponent} ± {exponent_error}){}\n",
            judgement(case, law)
        ),
        false => {
            format!(
                "{name}: {prefactor} µs · v^{exponent}, two speeds, which determine no errors\n"
            )
        }
    }
}

/// Whether the points follow the law within their errors.
fn judgement(case: &Case, law: &PowerLaw) -> String {
    let Some(evaluated) = &law.chi_square else {
        return match law.residuals.len() {
            2 => ", from two speeds, which cannot test it".to_owned(),
            _ => String::new(),
        };
    };
    let squares = format!(", {}", chi_square_text(*evaluated));
    let supported = case.supports(law);
    if supported.is_ok_and(|supported| supported != Some(false)) {
        return squares;
    }
    let widened = format!(
        "those given here are widened {} times, to the scatter about it",
        format::digits(law.excess(), 2)
    );
    match supported {
        Ok(_) => format!("{squares}: NOT a power law within the errors; {widened}"),
        Err(why) => format!(
            "{squares}: not a power law within the errors of times alone; {why} (the column `speed error` of the table of --shots, or \
             --speed-error, determines them), so this evaluates nothing; {widened}"
        ),
    }
}

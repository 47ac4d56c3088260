//! Results as CSV, in SI.

use crate::records::no_formula;
use crate::signal::{Estimate, Flight, PowerLaw, PulseKind, Ratio, Summary};
use crate::{Case, Curves, Shot, SpeedRow, UnmeasuredSpeed};
use std::io::{self, Write};
use std::iter::once;

/// Titles with the cells of one line; of a line of nothing only its titles count.
type Line = Vec<(String, String)>;

fn number(title: &str, value: Option<f64>) -> (String, String) {
    let finite = value.filter(|value| value.is_finite());
    let cell = finite.map_or(String::new(), |value| format!("{value:e}"));
    (title.to_owned(), cell)
}

fn words(title: &str, text: Option<impl ToString>) -> (String, String) {
    let text = text.map_or(String::new(), |text| text.to_string());
    let text = no_formula(&text);
    let cell = match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.into_owned(),
    };
    (title.to_owned(), cell)
}

fn estimate(title: &str, error: &str, of: Option<Estimate>) -> [(String, String); 2] {
    [number(title, of.map(|of| of.value)), number(error, of.map(|of| of.sigma))]
}

fn table(titles: Line, lines: impl Iterator<Item = Line>) -> impl Iterator<Item = String> {
    let joined = |cells: Vec<String>| cells.join(",") + "\n";
    let cells = move |line: Line| joined(line.into_iter().map(|cell| cell.1).collect());
    let titles = titles.into_iter().map(|cell| cell.0).collect();
    once(joined(titles)).chain(lines.map(cells))
}

/// One line a shot, with whether it counts in these curves.
pub fn shots_csv(shots: &[Shot], curves: &Curves) -> String {
    shot_lines(shots, curves).collect()
}

fn shot_lines<'a>(shots: &'a [Shot], curves: &Curves) -> impl Iterator<Item = String> + use<'a> {
    let keep = curves.keep_dubious;
    table(shot_line(None, keep), shots.iter().map(move |shot| shot_line(Some(shot), keep)))
}

/// Writes the same line by line: recordings may have any number of shots.
///
/// # Errors
/// Those of what is written to.
pub fn write_shots(shots: &[Shot], curves: &Curves, out: &mut dyn Write) -> io::Result<()> {
    let mut lines = shot_lines(shots, curves);
    lines.try_for_each(|line| out.write_all(line.as_bytes()))
}

fn shot_line(shot: Option<&Shot>, keep_dubious: bool) -> Line {
    let flight = shot.and_then(|shot| shot.flight.as_ref().ok());
    let picked = |kind| flight.and_then(|flight| flight.picks.pulse(kind));
    let mut line = vec![
        words("file", shot.map(|shot| shot.file.display())),
        words("shot", shot.and_then(|shot| shot.shot)),
        words("case", shot.map(|shot| &shot.case)),
    ];
    line.extend(estimate("speed_m_s", "speed_sigma_m_s", shot.and_then(|shot| shot.speed_m_s)));
    for (at, time) in ["incident", "reflected"].into_iter().enumerate() {
        let value = flight.and_then(|flight| flight.times_s()[at]);
        line.extend(estimate(&format!("tof_{time}_s"), &format!("tof_{time}_sigma_s"), value));
    }
    line.push(number("tof_correlation", flight.and_then(Flight::correlation)));
    for (name, ratio) in [
        ("wall", flight.map(|flight| flight.wall_over_incident)),
        ("reflected", flight.and_then(|flight| flight.reflected_over_incident)),
    ] {
        let title = format!("{name}_over_incident");
        line.extend(estimate(&title, &format!("{title}_sigma"), ratio));
    }
    let height = |kind| number(&format!("{kind}_peak_v"), picked(kind).map(|p| p.height));
    line.extend(PulseKind::ALL.map(height));
    let force_n = |kind| flight.and_then(|flight| flight.picks.force_n(kind));
    line.extend(PulseKind::ALL.map(|kind| number(&format!("{kind}_peak_n"), force_n(kind))));
    let width = |kind| number(&format!("{kind}_width_s"), picked(kind).map(|p| p.width_s));
    line.extend(PulseKind::ALL.map(width));
    for kind in PulseKind::ALL {
        let pick = picked(kind);
        line.push(number(&format!("{kind}_time_s"), pick.map(|pick| pick.time_s)));
        line.push(number(&format!("{kind}_snr"), pick.map(|pick| pick.signal_to_noise)));
        let squares = pick.and_then(|pick| pick.misfit).map(|misfit| misfit * misfit);
        line.push(number(&format!("{kind}_fit_chi2"), squares));
    }
    let reasons = shot.map(|shot| shot.reasons(keep_dubious));
    line.push(words(
        "counted",
        reasons.as_ref().map(|none| if none.is_empty() { "yes" } else { "no" }),
    ));
    line.push(words("not_counted_because", reasons.map(|codes| codes.join(" "))));
    line.push(words("flags", shot.map(Shot::flags)));
    line
}

/// One line a case and speed; last those at which no shot counts, without times.
pub fn speeds_csv(curves: &Curves) -> String {
    let rows = curves.cases.iter().flat_map(|case| {
        let rows = case.rows.iter();
        rows.map(|row| speed_line(Some(&case.name), Some(row), None))
    });
    let unmeasured = curves.unmeasured.iter();
    let unmeasured = unmeasured.map(|of| speed_line(Some(&of.case), None, Some(of)));
    table(speed_line(None, None, None), rows.chain(unmeasured)).collect()
}

fn speed_line(case: Option<&str>, row: Option<&SpeedRow>, none: Option<&UnmeasuredSpeed>) -> Line {
    let mut line = vec![words("case", case)];
    let exact = |value| Estimate { value, sigma: f64::NAN };
    let speed = row.map(|row| row.speed_m_s).or(none.map(|of| exact(of.speed_m_s)));
    line.extend(estimate("speed_m_s", "speed_error_m_s", speed));
    let shots = row.map(|row| row.shots).or(none.map(|of| (0, of.shots)));
    line.push(words("shots", shots.map(|shots| shots.0)));
    line.push(words("left_out", shots.map(|shots| shots.1)));
    let mut summarised = |title: &str, of: Option<Summary>| {
        line.extend([
            number(title, of.map(|of| of.mean)),
            number(&format!("{title}_deviation"), of.map(|of| of.deviation)),
            number(&format!("{title}_error"), of.map(|of| of.error)),
            words(&format!("{title}_count"), of.map(|of| of.count)),
        ]);
    };
    summarised("tof_incident_s", row.map(|row| row.incident_s));
    summarised("tof_reflected_s", row.and_then(|row| row.reflected_s));
    summarised("wall_over_incident", row.map(|row| row.wall_over_incident));
    summarised("reflected_over_incident", row.and_then(|row| row.reflected_over_incident));
    for kind in PulseKind::ALL {
        let width = row.and_then(|row| row.widths_s[kind as usize]);
        line.push(number(&format!("{kind}_width_s"), width.map(|width| width.mean)));
    }
    let times = ["tof_incident", "tof_reflected"].into_iter().enumerate();
    for (at, time) in times.clone() {
        let shared_s = row.map(|row| row.shared_s[at]);
        line.push(number(&format!("{time}_shared_s"), shared_s));
    }
    for (at, time) in times {
        let title = format!("{time}_at_mean_speed_s");
        let moved = row.and_then(|row| row.at_mean_speed_s[at]);
        line.extend(estimate(&title, &format!("{title}_error"), moved));
    }
    line.extend([
        words("speed_error_shots", row.map(|row| row.speed_error_shots)),
        words("returns_undecided", row.map(|row| row.returns_undecided)),
        words("returns_missing", row.map(|row| row.returns_missing)),
        number("tof_correlation", row.and_then(|row| row.correlation)),
        number("tof_at_mean_speed_correlation", row.and_then(|row| row.correlation_at_mean_speed)),
    ]);
    line
}

/// One line a power law: of each case incident and reflected times of flight. It is supported or
/// not, or that is unknown; empty without chi-square. Errors follow from those of the points; where
/// the law is not supported, they are too small by √(chi-square/degrees of freedom).
pub fn laws_csv(curves: &Curves) -> String {
    let lines = curves.cases.iter().flat_map(|case| {
        let laws = [("incident", &case.laws.incident), ("reflected", &case.laws.reflected)];
        let found = laws.map(|(time, law)| Some((case, time, law.as_ref().ok()?)));
        found.into_iter().flatten()
    });
    table(law_line(None), lines.map(|law| law_line(Some(law)))).collect()
}

fn law_line(of: Option<(&Case, &str, &PowerLaw)>) -> Line {
    let law = of.map(|of| of.2);
    let chi_square = law.and_then(|law| law.chi_square);
    let supported = of.and_then(|(case, _, law)| match case.supports(law) {
        Ok(supported) => supported.map(|supported| supported.to_string()),
        Err(_) => Some("unknown".to_owned()),
    });
    vec![
        words("case", of.map(|of| &of.0.name)),
        words("time", of.map(|of| of.1)),
        number("prefactor_s", law.map(|law| law.prefactor)),
        number("prefactor_error_s", law.map(|law| law.prefactor_error)),
        number("exponent", law.map(|law| law.exponent)),
        number("exponent_error", law.map(|law| law.exponent_error)),
        number("r_squared", law.map(|law| law.r_squared)),
        number("chi_square", chi_square.map(|of| of.value)),
        words("degrees_of_freedom", chi_square.map(|of| of.freedom)),
        number("probability", chi_square.map(|of| of.probability)),
        words("supported", supported),
    ]
}

/// One line a ratio; last the correlation of its error with that of the other time's ratio.
pub fn ratios_csv(curves: &Curves) -> String {
    let mut lines = Vec::new();
    for wet in &curves.ratios {
        let correlation = |ratio: &Ratio| {
            let speeds = wet.incident.iter().map(|ratio| ratio.speed);
            let mut both = speeds.zip(&wet.correlations);
            both.find_map(|(speed, of)| of.filter(|_| speed == ratio.speed))
        };
        for (time, ratios) in [("incident", &wet.incident), ("reflected", &wet.reflected)] {
            let line = |ratio| ratio_line(Some((&wet.case, time, ratio)), correlation(ratio));
            lines.extend(ratios.iter().map(line));
        }
    }
    table(ratio_line(None, None), lines.into_iter()).collect()
}

fn ratio_line(of: Option<(&String, &str, &Ratio)>, correlation: Option<f64>) -> Line {
    let mut line = vec![
        words("case", of.map(|of| of.0)),
        words("time", of.map(|of| of.1)),
        number("speed_m_s", of.map(|of| of.2.speed)),
    ];
    line.extend(estimate("ratio", "ratio_error", of.map(|of| of.2.ratio)));
    line.push(number("correlation", correlation));
    line
}

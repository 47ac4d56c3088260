//! Everything measured, as JSON in SI.

use hertzchain_measure::signal::{Estimate, FitError, Picked, PowerLaw, PulseKind, Ratio, Summary};
use hertzchain_measure::{
    Case, Curves, MeasureError, Measurement, Note, Shot, SpeedRow, UnmeasuredSpeed, WetOverDry,
};
use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::{Value, json};
use std::io;

/// Shots, curves, ratios and what was refused.
pub fn json(measured: &Measurement, curves: &Curves) -> Value {
    let all = serde_json::to_value(Report { measured, curves });
    all.expect("texts, numbers and lists of them are JSON")
}

/// Writes the same, indented, shot by shot: as JSON a shot takes ten times the memory that
/// it has as numbers, and recordings may have any number of them.
///
/// # Errors
/// Those of what is written to.
pub fn write_json(
    measured: &Measurement,
    curves: &Curves,
    mut out: &mut dyn io::Write,
) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut out, &Report { measured, curves })?;
    out.write_all(b"\n")
}

/// Everything, under its names.
struct Report<'a> {
    measured: &'a Measurement,
    curves: &'a Curves,
}

impl Serialize for Report<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { measured, curves } = self;
        let mut all = serializer.serialize_map(None)?;
        let low_pass = measured
            .bandwidth
            .map(|of| json!({ "corner_hz": of.corner_hz, "order": of.order, "bessel": of.bessel }));
        all.serialize_entry("low_pass", &low_pass)?;
        all.serialize_entry("cases", &Each(&curves.cases, case))?;
        all.serialize_entry("lost", &Each(&curves.unmeasured, unmeasured))?;
        all.serialize_entry("notes", &Each(&measured.notes, note))?;
        all.serialize_entry("ratios", &Each(&curves.ratios, wet_over_dry))?;
        all.serialize_entry(
            "refused",
            &Each(&measured.refused, |one: &MeasureError| json!(one.to_string())),
        )?;
        let shot = |of: &_| shot(of, curves.keep_dubious);
        all.serialize_entry("shots", &Each(&measured.shots, shot))?;
        all.serialize_entry("unmatched", &measured.unmatched)?;
        all.end()
    }
}

/// A list of which one member at a time is JSON.
struct Each<'a, T, F: Fn(&T) -> Value>(&'a [T], F);

impl<T, F: Fn(&T) -> Value> Serialize for Each<'_, T, F> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.iter().map(&self.1))
    }
}

fn unmeasured(lost: &UnmeasuredSpeed) -> Value {
    json!({ "case": lost.case, "speed_m_s": lost.speed_m_s, "shots": lost.shots })
}

fn note(note: &Note) -> Value {
    let files = note.files.iter().map(|file| file.display().to_string());
    json!({ "note": note.text, "files": files.collect::<Value>() })
}

fn wet_over_dry(wet: &WetOverDry) -> Value {
    json!({
        "case": wet.case,
        "incident": wet.incident.iter().map(ratio).collect::<Value>(),
        "reflected": wet.reflected.iter().map(ratio).collect::<Value>(),
        "correlations": wet.correlations,
    })
}

fn estimate(of: Estimate) -> Value {
    json!({ "value": of.value, "sigma": of.sigma })
}

/// A shot, where dubious ones count or not.
pub(crate) fn shot(shot: &Shot, keep_dubious: bool) -> Value {
    let mut all = json!({
        "file": shot.file.display().to_string(),
        "shot": shot.shot,
        "case": shot.case,
        "speed_m_s": shot.speed_m_s.map(estimate),
        "flags": shot.remarks(),
        "not_counted": shot.reasons(keep_dubious),
    });
    match &shot.flight {
        Err(error) => all["missing"] = json!(error.to_string()),
        Ok(flight) => {
            all["tof_incident_s"] = estimate(flight.incident_s);
            all["tof_reflected_s"] = flight.reflected_s.map_or(Value::Null, estimate);
            all["tof_correlation"] = json!(flight.correlation());
            all["wall_over_incident"] = estimate(flight.wall_over_incident);
            all["reflected_over_incident"] =
                flight.reflected_over_incident.map_or(Value::Null, estimate);
            let picks = &flight.picks;
            let pulse = |of: &Picked, kind| {
                let mut all = picked(of);
                all["height_n"] = json!(picks.force_n(kind));
                all
            };
            all["incident"] = pulse(&picks.incident, PulseKind::Incident);
            all["wall"] = pulse(&picks.wall, PulseKind::Wall);
            let back = picks.reflected.as_ref();
            all["reflected"] = back.map_or(Value::Null, |back| pulse(back, PulseKind::Reflected));
        }
    }
    all
}

fn picked(of: &Picked) -> Value {
    json!({
        "time_s": of.time_s,
        "time_sigma_s": of.sigma_s,
        "height_v": of.height,
        "width_s": of.width_s,
        "signal_to_noise": of.signal_to_noise,
        "fit_chi_square": of.misfit.map(|misfit| misfit * misfit),
    })
}

fn case(case: &Case) -> Value {
    json!({
        "case": case.name,
        "speeds": case.rows.iter().map(row).collect::<Value>(),
        "power_law_incident": law(case, &case.laws.incident),
        "power_law_reflected": law(case, &case.laws.reflected),
    })
}

pub(crate) fn row(row: &SpeedRow) -> Value {
    json!({
        "speed_m_s": estimate(row.speed_m_s),
        "speed_error_shots": row.speed_error_shots,
        "shots": row.shots.0,
        "left_out": row.shots.1,
        "returns_undecided": row.returns_undecided,
        "returns_missing": row.returns_missing,
        "tof_incident_s": summary(&row.incident_s),
        "tof_reflected_s": row.reflected_s.as_ref().map(summary),
        "wall_over_incident": summary(&row.wall_over_incident),
        "reflected_over_incident": row.reflected_over_incident.as_ref().map(summary),
        "tof_incident_shared_s": row.shared_s[0],
        "tof_reflected_shared_s": row.shared_s[1],
        "tof_incident_at_mean_speed_s": row.at_mean_speed_s[0].map(estimate),
        "tof_reflected_at_mean_speed_s": row.at_mean_speed_s[1].map(estimate),
        "tof_correlation": row.correlation,
        "tof_at_mean_speed_correlation": row.correlation_at_mean_speed,
        "widths_s": row.widths_s.map(|width| width.map(|width| width.mean)),
    })
}

fn summary(of: &Summary) -> Value {
    json!({
        "mean": of.mean,
        "deviation": of.deviation,
        "error": of.error,
        "count": of.count,
        "weighted_mean": of.weighted.value,
        "weighted_error": of.weighted.sigma,
        "chi_square": of.chi_square,
    })
}

/// Whether a law is supported is null where nothing determines, and then says why.
pub(crate) fn law(case: &Case, of: &Result<PowerLaw, FitError>) -> Value {
    match of {
        Err(error) => json!({ "missing": error.to_string() }),
        Ok(law) => json!({
            "prefactor_s": law.prefactor,
            "prefactor_error_s": law.prefactor_error,
            "exponent": law.exponent,
            "exponent_error": law.exponent_error,
            "covariance": law.covariance,
            "r_squared": law.r_squared,
            "chi_square": law.chi_square.map(|evaluated| evaluated.value),
            "degrees_of_freedom": law.chi_square.map(|evaluated| evaluated.freedom),
            "probability": law.chi_square.map(|evaluated| evaluated.probability),
            "supported": case.supports(law).ok().flatten(),
            "supported_unknown_because": case.supports(law).err(),
        }),
    }
}

fn ratio(of: &Ratio) -> Value {
    json!({ "speed_m_s": of.speed, "ratio": of.ratio.value, "error": of.ratio.sigma })
}

#[cfg(test)]
#[path = "tests/results.rs"]
mod tests;

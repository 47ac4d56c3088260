//! Changes of the numbers that claims must not survive.

use super::agreeing::dry;
use crate::claims::{Evidence, ShotPoint};

/// Changes all points of a case.
pub fn each(evidence: &mut Evidence, case: &str, change: impl Fn(&mut ShotPoint)) {
    let curve = evidence.curves.iter_mut().find(|curve| curve.case == case).unwrap();
    curve.points.iter_mut().for_each(change);
}

/// Closing the gaps changes the way back by this share of what it takes longer.
fn closed(share: f64) -> impl Fn(&mut ShotPoint) {
    move |p| p.excess_s[1] = (1.0 - share) * p.excess_s[0]
}

/// Bends both ToFs in log–log.
fn bend(p: &mut ShotPoint) {
    let factor = 1.0 + 0.2 * p.speed_m_s.ln().powi(2);
    p.tof_incident_s *= factor;
    p.tof_reflected_s *= factor;
}

/// Bends both by less than a figure shows and more than 20 shots leave open.
fn bend_slightly(p: &mut ShotPoint) {
    let factor = 1.0 + 0.005 * p.speed_m_s.ln().powi(2);
    p.tof_incident_s *= factor;
    p.tof_reflected_s *= factor;
}

fn lengthen(p: &mut ShotPoint) {
    p.tof_incident_s *= 1.2;
}

fn shorten(p: &mut ShotPoint) {
    p.tof_incident_s /= 1.2;
}

fn falling_ratio(p: &mut ShotPoint) {
    p.tof_incident_s *= p.speed_m_s.powf(-0.05);
}

fn only_rising_ratio(p: &mut ShotPoint) {
    p.tof_incident_s = 0.99 * dry(p.speed_m_s).0 * p.speed_m_s.powf(0.01);
}

/// A ratio that falls over most speeds and yet ends above where it began.
fn rising_once(p: &mut ShotPoint) {
    let rise = if p.speed_m_s > 1.2 { 1.2 } else { 1.0 };
    p.tof_incident_s = 0.99 * rise * dry(p.speed_m_s).0 * p.speed_m_s.powf(-0.05);
}

/// A ratio that rises over all speeds but the last.
fn lower_at_the_end(p: &mut ShotPoint) {
    if p.speed_m_s > 1.2 {
        p.tof_incident_s /= 1.2;
    }
}

/// A ratio that passes 1 upward, downward and upward again.
fn back_and_forth(p: &mut ShotPoint) {
    if (0.2..0.5).contains(&p.speed_m_s) {
        p.tof_incident_s *= 1.2;
    }
}

pub type Change = fn(&mut Evidence);

/// For every claim a change of the numbers that it must not survive.
pub const BREAKS: &[(&str, Change)] = &[
    ("pulse-order", |e| each(e, "gear", |p| p.widths_s = [p.tof_incident_s / 2.9; 3])),
    ("tof-falls", |e| each(e, "pump", |p| p.tof_incident_s = 7e-4 * p.speed_m_s)),
    ("amplitude-rises", |e| each(e, "motor", |p| p.wall_peak_n = 1.0 / p.speed_m_s)),
    ("return-longer", |e| each(e, "dry", |p| p.tof_reflected_s = 0.99 * p.tof_incident_s)),
    ("loosening", |e| each(e, "dry", closed(0.01))),
    ("gaps", |e| each(e, "dry", |p| p.loosened_m = -1e-7)),
    ("return-error-bars", |e| {
        each(e, "dry", |p| p.tof_reflected_s = 7e-4 * p.speed_m_s.powf(-0.1))
    }),
    ("dry-incident-power-law-fit", |e| each(e, "dry", bend)),
    ("dry-incident-power-law-residuals", |e| each(e, "dry", bend_slightly)),
    ("dry-reflected-power-law-fit", |e| each(e, "dry", bend)),
    ("dry-reflected-power-law-residuals", |e| each(e, "dry", bend_slightly)),
    ("viscoelastic-power-law-fit", |e| each(e, "hertz-viscoelastic", bend)),
    ("viscoelastic-power-law-residuals", |e| each(e, "hertz-viscoelastic", bend_slightly)),
    ("viscoelastic-not-enough", |e| {
        each(e, "hertz-viscoelastic", |p| {
            // The dry exponent, but for a scatter of a thousandth.
            let scatter = 1.0 + 1e-3 * (1e3 * p.speed_m_s).sin();
            let (incident, reflected) = dry(p.speed_m_s);
            (p.tof_incident_s, p.tof_reflected_s) = (incident * scatter, reflected * scatter);
        });
    }),
    ("pump-below", |e| each(e, "pump", lengthen)),
    ("pump-above", |e| each(e, "pump", shorten)),
    ("pump-crosses-once", |e| each(e, "pump", back_and_forth)),
    ("pump-crossing", |e| each(e, "pump", |p| p.tof_incident_s *= 1.003)),
    ("gear-below", |e| each(e, "gear", lengthen)),
    ("motor-above", |e| each(e, "motor", shorten)),
    ("oil-either-way", |e| each(e, "pump", lengthen)),
    ("pump-rises", |e| each(e, "pump", rising_once)),
    ("pump-rises-log", |e| each(e, "pump", rising_once)),
    ("pump-ends-higher", |e| each(e, "pump", lower_at_the_end)),
    ("pump-dips", |e| each(e, "pump", only_rising_ratio)),
    ("gear-like-pump", |e| each(e, "gear", falling_ratio)),
    ("motor-like-gear", |e| each(e, "gear", falling_ratio)),
    ("wet-power-laws-fit", |e| each(e, "motor", bend)),
    ("wet-power-laws-residuals", |e| each(e, "motor", bend_slightly)),
    ("fluid-attenuates", |e| each(e, "pump", |p| p.wall_peak_n *= 2.0)),
    ("motor-split", |e| each(e, "motor", |p| p.second_returning_peak_n *= 0.5)),
    ("peaks-overlap", |e| each(e, "dry", |p| p.wall_peak_n *= 1.5)),
    ("tof-curves-agree", |e| each(e, "dry", |p| p.tof_reflected_s *= 1.01)),
    ("ratio-curves-agree", |e| each(e, "gear", shorten)),
    ("dynamic-viscosity-pump", |e| e.oils[0].density_kg_m3 *= 1.02),
    ("dynamic-viscosity-gear", |e| e.oils[1].density_kg_m3 *= 1.02),
    ("dynamic-viscosity-motor", |e| e.oils[2].density_kg_m3 *= 1.02),
    ("gear-viscosity", |e| e.oils[0].density_kg_m3 *= 1.05),
    ("pump-motor-viscosity", |e| e.oils[2].density_kg_m3 *= 1.5),
    ("pump-motor-ratios", |e| each(e, "motor", |p| p.tof_incident_s /= 1.05)),
    ("viscosity-no-simple-role", |e| {
        each(e, "pump", shorten);
        each(e, "gear", lengthen);
    }),
    ("trend-against-viscosity", |e| each(e, "gear", falling_ratio)),
    ("relaxation-time", |e| e.viscosity_over_modulus_s *= 1.1),
    ("relaxation-order", |e| e.viscosity_over_modulus_s /= 2.0),
    ("no-rebound", |e| each(e, "dry", |p| p.striker_rebound_m_s = -0.1)),
];

//! Tables of a reproduction as CSV.

use super::ReproduceError;
use super::cases::{CASES, Cases, OILS, SPEEDS_M_S};
use crate::claims::{Curve, Evidence, ShotPoint, TofBranch};
use hertzchain_chain::{BeadPair, Chain};
use std::fmt::Write as _;

pub(crate) struct TableText(pub(crate) String);

impl TableText {
    pub(crate) fn new(header: &str) -> Self {
        Self(format!("{header}\n"))
    }

    /// Numbers with thirteen digits, what is not a number as an empty field.
    pub(crate) fn row(&mut self, names: &[&str], speed_m_s: Option<f64>, numbers: &[f64]) {
        let mut fields: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        fields.extend(speed_m_s.map(|speed| speed.to_string()));
        let number = |n: &f64| match n.is_finite() {
            true => format!("{n:.12e}"),
            false => String::new(),
        };
        fields.extend(numbers.iter().map(number));
        let _ = writeln!(self.0, "{}", fields.join(","));
    }
}

fn curves(evidence: &Evidence) -> impl Iterator<Item = &Curve> {
    CASES.iter().filter_map(|case| evidence.curve(case))
}

pub(crate) fn tof_csv(evidence: &Evidence) -> String {
    let mut csv = TableText::new(
        "case,speed_m_s,tof_incident_s,tof_reflected_s,sensor_peak_n,wall_peak_n,\
         returning_peak_n,striker_rebound_m_s,accuracy_reached",
    );
    for curve in curves(evidence) {
        for p in &curve.points {
            csv.row(&[&curve.case], Some(p.speed_m_s), &tof_row(p));
        }
    }
    csv.0
}

fn tof_row(p: &ShotPoint) -> [f64; 7] {
    [
        p.tof_incident_s,
        p.tof_reflected_s,
        p.sensor_peak_n,
        p.wall_peak_n,
        p.returning_peak_n,
        p.striker_rebound_m_s,
        p.accuracy_reached,
    ]
}

pub(super) fn ratios_csv(evidence: &Evidence) -> String {
    let mut csv = TableText::new("case,speed_m_s,ratio_incident,ratio_reflected,accuracy_reached");
    for case in OILS {
        for r in evidence.ratios(case) {
            let numbers = [r.incident, r.reflected, r.accuracy_reached];
            csv.row(&[case], Some(r.speed_m_s), &numbers);
        }
    }
    csv.0
}

/// Fits T = prefactor · v^exponent, one row a case and branch; all speeds
/// weigh the same. Residuals are relative; in the last column they are in
/// standard errors of the paper's 20-shot means, from a fit weighted by these.
pub(super) fn power_laws_csv(evidence: &Evidence) -> String {
    let mut csv = TableText::new(
        "case,branch,prefactor_s,prefactor_error_s,exponent,exponent_error,r_squared,\
         residual_rms,residual_largest,weighted_residual_largest_in_standard_errors",
    );
    for curve in curves(evidence) {
        for branch in TofBranch::BOTH {
            if let Some(row) = power_law_row(curve, branch) {
                csv.row(&[&curve.case, branch.name()], None, &row);
            }
        }
    }
    csv.0
}

fn power_law_row(curve: &Curve, branch: TofBranch) -> Option<[f64; 8]> {
    let fit = curve.power_law(branch).ok()?;
    let weighted = curve.weighted_power_law(branch).ok()?;
    let squares: f64 = fit.residuals.iter().map(|r| r * r).sum();
    let errors = curve.standard_errors_s(branch);
    let tofs = curve.tofs_s(branch);
    let scaled = weighted.residuals.iter().zip(errors.iter().zip(&tofs));
    let scaled = scaled.map(|(r, (error, tof))| (r.exp_m1() * tof / error).abs());
    Some([
        fit.prefactor,
        fit.prefactor_error,
        fit.exponent,
        fit.exponent_error,
        fit.r_squared,
        (squares / fit.residuals.len() as f64).sqrt(),
        fit.largest_deviation(),
        scaled.fold(0.0, f64::max),
    ])
}

/// Relative residuals of points from their power laws, and standard errors of 20-shot means.
pub(super) fn power_law_residuals_csv(evidence: &Evidence) -> String {
    let mut csv = TableText::new("case,branch,speed_m_s,tof_s,residual,standard_error");
    for curve in curves(evidence) {
        for branch in TofBranch::BOTH {
            let Ok(fit) = curve.power_law(branch) else {
                continue;
            };
            let errors = curve.standard_errors_s(branch);
            for ((p, residual), error) in curve.points.iter().zip(&fit.residuals).zip(&errors) {
                let tof = p.tof_s(branch);
                let numbers = [tof, residual.exp_m1(), error / tof];
                csv.row(&[&curve.case, branch.name()], Some(p.speed_m_s), &numbers);
            }
        }
    }
    csv.0
}

/// What the oils are, and what stands for them in the contacts at each speed.
pub(crate) fn oils_csv(cases: &Cases) -> Result<String, ReproduceError> {
    let mut csv = TableText::new(
        "case,speed_m_s,kinematic_viscosity_m2_s,density_kg_m3,dynamic_viscosity_pa_s,\
         effective_young_modulus_pa,effective_poisson_ratio,effective_viscosity_pa_s,\
         effective_stiffness_n_m3_2,effective_relaxation_time_s",
    );
    for oil in cases.oils() {
        let experiment = cases.get(&oil.case)?;
        for speed in SPEEDS_M_S {
            let (chain, _) = experiment.chain(Some(speed))?;
            let (kinematic, density) = (oil.kinematic_viscosity_m2_s, oil.density_kg_m3);
            let liquid = [kinematic, density, oil.dynamic_viscosity_pa_s()];
            let numbers: Vec<f64> = liquid.into_iter().chain(effective(&chain)).collect();
            csv.row(&[&oil.case], Some(speed), &numbers);
        }
    }
    Ok(csv.0)
}

/// Y, ν, η, K and A of a wet contact between two beads.
fn effective(chain: &Chain) -> [f64; 5] {
    let wet = chain.sections.iter().find_map(|section| section.material);
    let (Some(material), Some(bead)) = (wet, chain.beads.first()) else {
        return [f64::NAN; 5];
    };
    let pair = BeadPair {
        left: material,
        right: material,
        radius_m: 0.5 * bead.radius_m,
        mass_kg: 0.5 * bead.mass_kg,
    };
    [
        material.young_modulus_pa,
        material.poisson_ratio,
        material.shear_viscosity_pa_s,
        pair.hertz_stiffness(),
        material.relaxation_time_s(),
    ]
}

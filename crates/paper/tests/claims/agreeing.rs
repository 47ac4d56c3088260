//! Numbers made up so that everything the paper says is true.

use crate::claims::{
    Curve, Evidence, MeasuredKind, PrintedOil, ShotPoint, TofBranch, evidence::Digitised,
};

/// Speeds in m/s.
const SPEEDS_M_S: [f64; 12] =
    [0.075, 0.1, 0.1396, 0.2, 0.28, 0.3993, 0.5, 0.6, 0.75, 1.0, 1.152, 1.23];

fn point(speed_m_s: f64, incident_s: f64, reflected_s: f64) -> ShotPoint {
    ShotPoint {
        speed_m_s,
        tof_incident_s: incident_s,
        tof_reflected_s: reflected_s,
        sensor_peak_n: 190.0 * speed_m_s.powf(1.1),
        wall_peak_n: 270.0 * speed_m_s.powf(1.0),
        returning_peak_n: 75.0 * speed_m_s.powf(0.9),
        second_returning_peak_n: 0.0,
        widths_s: [50e-6; 3],
        striker_separation_m_s: 0.001,
        striker_rebound_m_s: 0.0,
        // Closing the gaps takes seven tenths of it away, and more of slow shots.
        excess_s: [1.0, 0.2 + 0.1 * speed_m_s].map(|part| part * (reflected_s - incident_s)),
        loosened_m: 2e-5,
        accuracy_reached: 1e-10,
        peak_accuracy: 1e-9,
        second_peak_accuracy_n: 1e-9,
        width_accuracy: 1e-9,
        striker_accuracy_m_s: 1e-9,
        excess_accuracy_s: 1e-13,
        loosened_accuracy_m: 1e-14,
    }
}

fn curve(case: &str, tofs: impl Fn(f64) -> (f64, f64)) -> Curve {
    let points = SPEEDS_M_S.map(|v| {
        let (incident, reflected) = tofs(v);
        point(v, incident, reflected)
    });
    Curve { case: case.to_owned(), points: points.to_vec() }
}

pub fn dry(v: f64) -> (f64, f64) {
    (680e-6 * v.powf(-0.178), 720e-6 * v.powf(-0.18))
}

/// A ratio that rises slowly, with one speed lifted so that it falls there.
fn wet(case: &str, level: f64, lifted_m_s: f64) -> Curve {
    let mut wet = curve(case, |v| {
        let lift = if v == lifted_m_s { 1.002 } else { 1.0 };
        let ratio = level * (v / 1.1).powf(0.004) * lift;
        (ratio * dry(v).0, ratio * dry(v).1)
    });
    for p in &mut wet.points {
        p.wall_peak_n *= 0.8;
        p.returning_peak_n *= 0.5;
        p.second_returning_peak_n = 0.6 * p.returning_peak_n;
    }
    wet
}

fn oil(case: &str, kinematic_viscosity_m2_s: f64, density_kg_m3: f64) -> PrintedOil {
    PrintedOil { case: case.to_owned(), kinematic_viscosity_m2_s, density_kg_m3 }
}

fn measured(what: MeasuredKind, case: &str, value: f64, standard_error: f64) -> Digitised {
    Digitised { what, case: case.to_owned(), speed_m_s: 0.1, value, standard_error }
}

/// Numbers made up so that everything the paper says is true.
pub fn agreeing() -> Evidence {
    let sensor_over_wall = 190.0 / 270.0 * 0.1_f64.powf(0.1);
    Evidence {
        curves: vec![
            curve("hertz", |v| (630e-6 * v.powf(-0.2), 632e-6 * v.powf(-0.2))),
            curve("hertz-viscoelastic", |v| (657e-6 * v.powf(-0.194), 688e-6 * v.powf(-0.187))),
            curve("dry", dry),
            wet("pump", 1.0, 0.075),
            wet("gear", 0.97, 0.075),
            wet("motor", 1.05, 0.1),
        ],
        oils: vec![
            oil("pump", 55e-6, 870.0),
            oil("gear", 133e-6, 898.0),
            oil("motor", 68.5e-6, 842.6),
        ],
        viscosity_over_modulus_s: 1.5e-7,
        digitised: vec![
            measured(MeasuredKind::SensorOverWall, "dry", sensor_over_wall, 0.01),
            measured(MeasuredKind::Tof(TofBranch::Incident), "dry", dry(0.1).0, 1e-6),
            measured(MeasuredKind::Tof(TofBranch::Reflected), "dry", dry(0.1).1 + 5e-7, 1e-6),
            measured(MeasuredKind::Ratio, "gear", 0.97 * (0.1_f64 / 1.1).powf(0.004), 1e-3),
        ],
    }
}

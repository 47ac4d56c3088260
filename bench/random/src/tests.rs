//! The integration against numbers known otherwise.

use crate::reference::{Reference, largest};
use crate::row::{Ball, Far, Law, Material, Row};

/// The paper's row of 40 steel balls.
fn paper(speed_m_s: f64, laws: &[Law]) -> Row {
    let ball = Ball {
        radius_m: 6.35e-3,
        mass_kg: 8.54e-3,
        material: 0,
    };
    Row {
        title: String::new(),
        materials: vec![Material {
            young_pa: 213e9,
            poisson: 0.3,
            viscosity_pa_s: 3.2e4,
        }],
        striker: ball,
        speed_m_s,
        beads: vec![ball; 40],
        sections: vec![(0, laws.to_vec())],
        far: Far::HalfBead,
        push: None,
        incline_deg: 0.0,
        gaps: Vec::new(),
        clipped: false,
        sensor: 7,
    }
}

/// Incident and reflected time of flight in s.
fn flights(row: &Row) -> [f64; 2] {
    let reference = Reference::new(row, 4e-3).unwrap();
    let [sensor, wall] = &reference.maxima;
    let hit = largest(wall, |_| true).unwrap();
    let passed = largest(sensor, |maximum| maximum.time_s < hit.time_s).unwrap();
    let until_s = hit.time_s + 3.0 * (hit.time_s - passed.time_s);
    let back = |time_s: f64| time_s > hit.time_s && time_s < until_s;
    let back = largest(sensor, |maximum| back(maximum.time_s)).unwrap();
    [hit.time_s - passed.time_s, back.time_s - hit.time_s]
}

/// Against docs of the design: ToFs printed to 1e-12 s there.
#[test]
fn times_of_flight_of_the_paper_s_rows_agree_with_other_integrations() {
    let visco = [Law::ElasticHertz, Law::Viscoelastic];
    let dry = [
        Law::ElasticHertz,
        Law::Viscoelastic,
        Law::Cubic { coefficient: 77.0 },
    ];
    let known = [
        (1.0, &visco[..1], [630.841591, 632.265715]),
        (0.5, &visco[..], [751.270959, 783.036376]),
        (1.23, &dry[..], [660.261248, 699.493431]),
    ];
    for (speed_m_s, laws, right_us) in known {
        let found = flights(&paper(speed_m_s, laws));
        for (found_s, right_us) in found.into_iter().zip(right_us) {
            // The digits known, and a few of the last one.
            assert!(
                (1e6 * found_s - right_us).abs() < 2e-6,
                "{found:?} {right_us}"
            );
        }
    }
}

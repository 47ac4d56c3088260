use super::*;
use crate::claims::{ClaimVerdict, Curve, MeasuredKind, ShotPoint, claims, evidence::Digitised};
use std::cell::RefCell;

/// A peak whose difference from a measured one is this many standard errors,
/// computed to an accuracy.
fn peaks(difference: f64, accuracy: f64) -> Evidence {
    let point = ShotPoint {
        speed_m_s: 1.0,
        tof_incident_s: 1.0,
        tof_reflected_s: 1.0,
        sensor_peak_n: 1.0 + difference,
        wall_peak_n: 1.0,
        returning_peak_n: 1.0,
        second_returning_peak_n: 0.0,
        widths_s: [1.0; 3],
        striker_separation_m_s: 0.0,
        striker_rebound_m_s: 0.0,
        excess_s: [0.0; 2],
        loosened_m: 0.0,
        accuracy_reached: accuracy,
        peak_accuracy: accuracy,
        second_peak_accuracy_n: accuracy,
        width_accuracy: accuracy,
        striker_accuracy_m_s: accuracy,
        excess_accuracy_s: accuracy,
        loosened_accuracy_m: accuracy,
    };
    Evidence {
        curves: vec![Curve { case: "dry".to_owned(), points: vec![point] }],
        digitised: vec![Digitised {
            what: MeasuredKind::SensorOverWall,
            case: "dry".to_owned(),
            speed_m_s: 1.0,
            value: 1.0,
            standard_error: 1.0,
        }],
        ..Evidence::default()
    }
}

#[test]
fn shots_are_as_accurate_as_it_takes_to_tell_the_side_and_no_more() {
    let evaluators: Vec<Evaluator> = claims().unwrap();
    let overlap = evaluators.into_iter().filter(|j| j.claim.id == "peaks-overlap");
    let overlap: Vec<Evaluator> = overlap.collect();
    // Two standard errors are allowed.
    for (difference, expected) in [(1.0, 1), (1.999, 2), (1.999_999_999, 3)] {
        let asked = RefCell::new(Vec::new());
        let gather = |accuracy: f64| {
            asked.borrow_mut().push(accuracy);
            Ok(peaks(difference, accuracy))
        };
        let evidence = sharpened(&overlap, &[1e-2, 1e-4, 1e-6], &gather).unwrap();
        assert_eq!(asked.borrow()[..], [1e-2, 1e-4, 1e-6][..expected]);
        let finding = overlap[0].decide(&evidence);
        assert_eq!(finding.leaning, ClaimVerdict::Holds);
        // The last one is nearer than the finest accuracy can resolve.
        assert_eq!(finding.is_open(), difference > 1.9999, "{finding:?}");
    }
}

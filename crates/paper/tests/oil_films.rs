//! Films of the paper's oils, beside what must follow from their numbers.

use super::*;
use crate::claims::{Curve, ShotPoint};
use crate::reproduce::read_off;
use crate::tests::Silent;
use hertzchain_experiment::preset;
use hertzchain_sim::{Plan, shoot};

/// Curves whose incident times are 1 s dry and these ratios wet, oil by oil.
fn evidence(ratio: impl Fn(usize) -> f64) -> Evidence {
    let (plan, _) = Plan::from_experiment(&preset("hertz").unwrap(), Some(1.0)).unwrap();
    let plan = plan.for_flights().with_accuracy(1e-3);
    let shot = read_off(&plan, 1.0, &shoot(&plan).unwrap());
    let point = |speed_m_s: f64, tof_incident_s: f64| ShotPoint {
        speed_m_s,
        tof_incident_s,
        accuracy_reached: 1e-6,
        ..shot.clone()
    };
    let curve = |case: &str, first: Option<usize>| {
        let times = |at: usize| first.map_or(1.0, |first| ratio(first + at));
        let points = SPEEDS_M_S.iter().enumerate().map(|(at, speed)| point(*speed, times(at)));
        Curve { case: case.to_owned(), points: points.collect() }
    };
    let wet = OILS.iter().enumerate();
    let wet = wet.map(|(oil, case)| curve(case, Some(oil * SPEEDS_M_S.len())));
    Evidence {
        curves: std::iter::once(curve("dry", None)).chain(wet).collect(),
        ..Evidence::default()
    }
}

#[test]
fn every_claim_on_ratios_that_is_asked_for_exists() {
    assert_eq!(evaluators().unwrap().len(), CLAIMS.len());
}

#[test]
fn the_common_factor_is_the_one_that_the_ratios_were_made_with() {
    let made = |factor: f64| evidence(|place| 1.0 - 0.01 * place as f64 * factor.powf(0.3));
    let scaled: Vec<Evidence> = FACTORS.map(made).into();
    for factor in [0.06, 0.2, 0.9] {
        let found = nearest_factor(&scaled, &made(factor));
        // A hundredth of the logarithms' range is 3.5 %; the polynomial misses a percent.
        assert!((found / factor - 1.0).abs() < 0.04, "{found} of {factor}");
    }
}

#[test]
fn ranges_hold_all_corners_and_widen_with_rounding() {
    let scaled: Vec<Evidence> = FACTORS.map(|factor| evidence(|_| 1.0 - 0.01 * factor.ln())).into();
    let corners = [evidence(|_| 0.9), evidence(|_| 0.97)];
    let found = ranges(&corners, &scaled, &[0.0, 0.5, 0.0]);
    let off = |found: [f64; 2], expected: [f64; 2]| {
        (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs())
    };
    // Rounding of differences over a hundredth.
    assert!(off(found[0][4], [0.9, 0.97]) < 1e-9, "{found:?}");
    assert!(off(found[1][0], [0.895, 0.975]) < 1e-9, "{found:?}");
}

#[test]
fn a_row_with_an_effective_material_is_taken_for_that_material() {
    let cases = Cases::new(&Reading::default()).unwrap();
    let row = material::WetRow::new(&cases, "gear", 0.3).unwrap();
    let found = row.matching(row.shot(&[[0.25, 11.4]]).unwrap()[0]).unwrap();
    // Shots to 1e-6, matched to 1e-5.
    assert!((found.stiffness_ratio / 0.25_f64.exp() - 1.0).abs() < 1e-4, "{found:?}");
    assert!((found.viscosity_pa_s / 11.4_f64.exp() - 1.0).abs() < 1e-2, "{found:?}");
}

#[test]
fn a_film_shortens_the_time_of_a_fast_shot_as_another_program_says() {
    // bench/film/row.py with α = 0, extrapolated from steps of 20 and 10 ns: 0.98607 to 0.98617.
    let shots = FilmShots::new((1e-3, &[1.2]), Vec::new()).unwrap();
    let films = shots.run(&[FilmVariant::ISOVISCOUS], "", &Silent).unwrap();
    for ratio in incident(&films[0]) {
        assert!((ratio - 0.9861).abs() < 1e-3, "{ratio}");
    }
}

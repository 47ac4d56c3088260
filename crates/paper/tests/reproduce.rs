//! The paper's chains in the default reading, and what rounding does to them.

use super::Silent;
use crate::claims::{ClaimVerdict, Evidence, ShotPoint, TofBranch, claims};
use crate::readings::{DryPoisson, rounding::Draw, scan};
use crate::reproduce::tables::{oils_csv, tof_csv};
use crate::reproduce::{Cases, SPEEDS_M_S};
use crate::reproduce::{Effort, Gathering, ReproduceOptions, gather};
use hertzchain_chain::Sensor;
use hertzchain_experiment::{Reading, preset};
use hertzchain_sim::{Plan, shoot};

fn gathered(speeds_m_s: &[f64], accuracy: f64, effort: Effort<'_>) -> Evidence {
    let cases = &Cases::new(&Reading::default()).unwrap();
    let how = Gathering { cases, speeds_m_s, accuracy, effort };
    gather(&how, None, &|| {}).unwrap()
}

#[test]
fn times_of_flight_are_those_of_an_independent_integration() {
    let evidence = gathered(&[0.075, 0.5, 1.23], 1e-8, Effort::Checked);
    // From bench/reference/tof.csv, right to 1e-9.
    let known = [
        ("hertz-viscoelastic", 0.5, 7.512709591640e-4, 7.830363759420e-4),
        ("dry", 0.075, 1.086942703759e-3, 1.120470789504e-3),
        ("dry", 1.23, 6.602612483984e-4, 6.994934309488e-4),
        ("motor", 0.075, 1.067775531256e-3, 1.261853802063e-3),
        ("gear", 1.23, 6.407197637342e-4, 7.084182818768e-4),
        ("pump", 0.5, 7.612586965738e-4, 8.414799589833e-4),
    ];
    for (case, speed, incident, reflected) in known {
        let p = evidence.curve(case).unwrap().at(speed).unwrap();
        for (branch, known) in TofBranch::BOTH.into_iter().zip([incident, reflected]) {
            let off = (p.tof_s(branch) / known - 1.0).abs();
            // The rerun that estimates what was reached is itself wrong by a fraction.
            assert!(off < 2.0 * p.accuracy_reached.max(1e-9), "{case} {speed}: {off:e}");
        }
    }
}

#[test]
fn every_time_of_flight_keeps_the_accuracy_that_is_asked() {
    let asked = ReproduceOptions::default().accuracy;
    // Speeds at which wet chains amplify errors most.
    let evidence = gathered(&[0.075, 0.2, 0.28, 1.0], asked, Effort::Checked);
    for curve in &evidence.curves {
        for p in &curve.points {
            let (case, speed, reached) = (&curve.case, p.speed_m_s, p.accuracy_reached);
            assert!(reached <= asked, "{case} at {speed} m/s: {reached:e}");
        }
    }
}

/// Numbers of a point with their absolute accuracies.
fn with_accuracies(p: &ShotPoint) -> Vec<(f64, f64)> {
    let tofs = [p.tof_incident_s, p.tof_reflected_s].map(|t| (t, p.accuracy_reached * t));
    let peaks = [p.sensor_peak_n, p.wall_peak_n, p.returning_peak_n];
    let peaks = peaks.map(|peak| (peak, p.peak_accuracy * peak));
    let widths = p.widths_s.map(|width| (width, p.width_accuracy * width));
    let others = [
        (p.second_returning_peak_n, p.second_peak_accuracy_n),
        (p.striker_separation_m_s, p.striker_accuracy_m_s),
        (p.striker_rebound_m_s, p.striker_accuracy_m_s),
        (p.loosened_m, p.loosened_accuracy_m),
        (p.excess_s[0], p.excess_accuracy_s),
        (p.excess_s[1], p.excess_accuracy_s),
    ];
    tofs.into_iter().chain(peaks).chain(widths).chain(others).collect()
}

#[test]
fn lean_shots_have_all_that_claims_ask_for_as_right_as_they_say() {
    let evaluators = claims().unwrap();
    // Speeds with and without rebound, and that of the split pulse.
    let speeds = [0.16, 0.3993, 1.05];
    let lean = gathered(&speeds, 1e-5, Effort::Lean(&evaluators));
    let fine = gathered(&speeds, 1e-8, Effort::Checked);
    let curves = lean.curves.iter().zip(&fine.curves);
    let points =
        curves.flat_map(|(a, b)| a.points.iter().zip(&b.points).map(|pair| (&a.case, pair)));
    for (case, (lean, fine)) in points {
        let numbers = with_accuracies(lean).into_iter().zip(with_accuracies(fine));
        for (i, ((one, off), (other, as_off))) in numbers.enumerate() {
            let what = format!("{case} at {} m/s, number {i}", lean.speed_m_s);
            // The fine shot is as right as it says up to twice: its check errs too.
            assert!(
                one.is_nan() || (one - other).abs() <= off + 2.0 * as_off,
                "{what}: {one:e} {other:e} {off:e}"
            );
        }
        let followed = evaluators.iter().any(|j| j.needs_end(case, lean.speed_m_s));
        assert_eq!(!lean.striker_rebound_m_s.is_nan(), followed, "{case}");
        assert_eq!(!lean.loosened_m.is_nan(), followed, "{case}");
    }
    for evaluator in &evaluators {
        assert_eq!(
            evaluator.decide(&lean).leaning,
            evaluator.decide(&fine).leaning,
            "{}",
            evaluator.claim.id
        );
    }
}

#[test]
fn the_second_returning_peak_is_the_top_that_fine_samples_show() {
    let motor = preset("motor").unwrap();
    let (plan, _) = Plan::from_experiment(&motor, Some(0.3993)).unwrap();
    let sensors = vec![Sensor::Bead(plan.sensor_bead)];
    let shot = shoot(&plan.with_accuracy(1e-8).watching(sensors, Some(2e-8))).unwrap();
    let (trace, passage) = (shot.trace.unwrap(), shot.passage.unwrap());
    let first = passage.reflected.unwrap();
    // Seven beads to the striker's end and back, at the speed of 33 beads.
    let no_echo_s = first.time_s + 14.0 / 33.0 * passage.tof_reflected_s().unwrap();
    let samples = trace.columns[0].windows(3).zip(&trace.time_s[1..]);
    let tops = samples.filter(|(w, time)| {
        let apart = (**time - first.time_s).abs() > 0.25 * passage.reflected_width_s.unwrap();
        let returning = **time > passage.wall.time_s && **time < no_echo_s;
        w[1] > w[0] && w[1] >= w[2] && apart && returning
    });
    let sampled = tops.map(|(w, _)| w[1]).fold(0.0, f64::max);
    let evidence = gathered(&[0.3993], 1e-8, Effort::Checked);
    let found = evidence.curve("motor").unwrap().points[0].second_returning_peak_n;
    // 20 ns beside the top of a pulse of 50 µs a sample is low by less than 1e-6.
    assert!((sampled / found - 1.0).abs() < 1e-6, "{sampled} {found}");
}

#[test]
fn default_reading_gives_the_ratios_known_from_an_independent_integration() {
    let evidence = gathered(&[0.075, 0.12, 0.15, 0.5, 0.56, 1.0, 1.23], 1e-6, Effort::Lean(&[]));
    let ratio = |case: &str, i: usize| evidence.ratios(case)[i].incident;
    // Bounds as wide as the two digits in which they are stated.
    assert!((0..7).all(|i| (0.965..0.995).contains(&ratio("gear", i))));
    assert!((ratio("motor", 0) - 0.98).abs() < 0.005 && ratio("motor", 1) < 1.0025);
    assert!(ratio("motor", 2) > 1.0 && (ratio("motor", 5) - 1.03).abs() < 0.005);
    assert!((ratio("pump", 0) - 0.90).abs() < 0.005);
    assert!(ratio("pump", 3) < 1.0 && ratio("pump", 4) > 1.0 && ratio("pump", 6) < 1.005);
}

#[test]
fn tables_have_a_row_for_every_case_and_speed() {
    assert!(SPEEDS_M_S.len() >= 25);
    let evidence = gathered(&[0.25, 1.0], 1e-4, Effort::Lean(&[]));
    let csv = tof_csv(&evidence);
    assert_eq!(csv.lines().count(), 1 + 6 * 2);
    assert!(csv.starts_with(
        "case,speed_m_s,tof_incident_s,tof_reflected_s,sensor_peak_n,wall_peak_n,\
         returning_peak_n,striker_rebound_m_s,accuracy_reached\nhertz,0.25,"
    ));
    let oils = oils_csv(&Cases::new(&Reading::default()).unwrap()).unwrap();
    assert_eq!(oils.lines().count(), 1 + 3 * SPEEDS_M_S.len());
}

#[test]
fn draws_stay_within_half_a_unit_of_the_last_digit() {
    let motor = preset("motor").unwrap();
    let mut largest = 0.0_f64;
    for index in 0..200 {
        let draw = Draw::new(7, index, DryPoisson::TwoDigits);
        let (chain, _) = draw.of("motor", &motor).unwrap().chain(Some(1.0)).unwrap();
        let bead = chain.beads[0];
        assert!((bead.mass_kg - 8.54e-3).abs() <= 0.005e-3);
        assert!((bead.radius_m - 6.35e-3).abs() <= 0.005e-3);
        let wet = chain.sections[1].material.unwrap();
        // Sums and products round in the last bit.
        assert!((wet.young_modulus_pa - 193e9).abs() <= 0.5e9 * (1.0 + 1e-9));
        assert!((wet.poisson_ratio - 0.36).abs() <= 0.0005 * (1.0 + 1e-9));
        largest = largest.max((wet.young_modulus_pa - 193e9).abs());
    }
    assert!(largest > 0.45e9, "200 draws fill the interval: {largest}");
}

#[test]
fn a_draw_depends_on_its_seed_and_index_alone() {
    let draw = |seed, index| Draw::new(seed, index, DryPoisson::TwoDigits);
    assert_eq!(draw(1, 5), draw(1, 5));
    assert_ne!(draw(1, 5), draw(1, 6));
    assert_ne!(draw(1, 5), draw(2, 5));
}

#[test]
fn scan_tries_every_option_once_and_says_what_it_left_out() {
    // A coarse scan: verdicts differ from the fine one, its bookkeeping does not.
    let scan = scan(4, &[0.1, 0.24, 0.5, 1.23], 1e-3, &Silent).unwrap();
    let options: usize = Reading::switches().iter().map(|s| s.options.len() - 1).sum();
    assert_eq!(scan.single.len(), options);
    assert!(scan.product.len() <= 4);
    let sizes: usize = scan.product_of.iter().map(|(_, options)| options.len()).product();
    assert_eq!(scan.product.len(), sizes);
    assert!(scan.rows().all(|row| row.score() <= scan.closest().score()));
    for row in scan.as_close() {
        assert_eq!(row.score(), scan.closest().score());
        assert!(row.reading.changes().len() >= scan.closest().reading.changes().len());
    }
    let moved = |name: &str| {
        let rows = scan.single.iter().filter(|row| row.reading.changes()[0].0 == name);
        rows.filter(|row| row.verdicts != scan.default.verdicts).count() > 0
    };
    for switch in Reading::switches() {
        let in_product = scan.product_of.iter().any(|(name, _)| *name == switch.name);
        let left_out = scan.left_out.iter().any(|(name, _)| *name == switch.name);
        assert_eq!(moved(switch.name), in_product || left_out, "{}", switch.name);
    }
}

#[test]
fn closing_the_gaps_behind_the_pulse_hardly_shortens_the_way_back() {
    let evidence = gathered(&[0.1, 0.5, 1.2], 1e-8, Effort::Checked);
    for p in &evidence.curve("dry").unwrap().points {
        let [open_s, closed_s] = p.excess_s;
        let by_tofs = p.tof_reflected_s - p.tof_incident_s;
        // The same two times subtracted: rounding.
        assert!((open_s - by_tofs).abs() < 1e-15, "{p:?}");
        assert!((1.0 - closed_s / open_s).abs() < 0.01, "{p:?}");
    }
    let loosening = claims().unwrap();
    let mut loosening = loosening.iter().filter(|c| c.claim.id == "loosening");
    let finding = loosening.next().unwrap().decide(&evidence);
    assert_eq!(finding.verdict, ClaimVerdict::Fails, "{finding:?}");
    assert!(finding.detail.contains("without losses"), "{finding:?}");
}

#[test]
fn the_way_back_without_gaps_is_asked_for_only_by_its_claims() {
    let evaluators = claims().unwrap();
    let lean = gathered(&[0.5], 1e-4, Effort::Lean(&evaluators));
    let known = |case: &str| !lean.curve(case).unwrap().points[0].excess_s[1].is_nan();
    assert!(known("dry") && !known("pump") && !known("hertz"));
}

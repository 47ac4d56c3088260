//! Every number that decides a claim is as accurate as it says.

use super::agreeing::agreeing;
use super::breaks::{BREAKS, each};
use super::{decide, dry};
use crate::claims::{ClaimVerdict, Evidence, ShotPoint, claims};

/// The numbers as made up and after every change that breaks a claim.
fn all_evidence() -> Vec<Evidence> {
    let broken = BREAKS.iter().map(|(_, change)| {
        let mut evidence = agreeing();
        change(&mut evidence);
        evidence
    });
    broken.chain([agreeing()]).collect()
}

#[test]
fn only_what_is_counted_far_from_a_change_is_exact() {
    for evidence in all_evidence() {
        for evaluator in claims().unwrap() {
            let finding = evaluator.decide(&evidence);
            let exact = finding.accuracy == 0.0;
            let far = finding.nearest_change;
            let far = far.is_some_and(|change| change.margin > change.accuracy);
            assert!(!exact || far, "{}: {finding:?}", evaluator.claim.id);
        }
    }
}

#[test]
fn a_count_that_a_reading_could_change_is_as_unsure_as_that() {
    let mut evidence = agreeing();
    each(&mut evidence, "pump", |p| {
        if p.speed_m_s == 0.5 {
            p.tof_incident_s = dry(p.speed_m_s).0 * (1.0 - 1e-7);
            p.accuracy_reached = 1e-6;
        }
    });
    let finding = decide("pump-crosses-once", &evidence);
    assert_eq!(finding.verdict, ClaimVerdict::NotDecidable);
    assert_eq!(finding.leaning, ClaimVerdict::Holds);
    // Above 1 there, the ratio would pass 1 upward twice and downward once.
    assert_eq!((finding.value, finding.accuracy), (1.0, 1.0));
    let nearest = finding.nearest_change.unwrap();
    assert!(nearest.margin < nearest.accuracy, "{nearest:?}");
}

#[test]
fn a_ratio_of_1_at_the_only_passage_leaves_the_count_exact() {
    let mut evidence = agreeing();
    // Whichever side these lie on: one of them alone makes no other passage, both
    // together may pass 1 back and forth.
    let near_1 = |evidence: &mut Evidence, speed: f64| {
        each(evidence, "pump", |p| {
            if p.speed_m_s == speed {
                p.tof_incident_s = dry(speed).0;
                p.accuracy_reached = 1e-6;
            }
        });
    };
    near_1(&mut evidence, 1.0);
    let one = decide("pump-crosses-once", &evidence);
    assert_eq!((one.verdict, one.accuracy), (ClaimVerdict::Holds, 0.0));
    near_1(&mut evidence, 1.152);
    let two = decide("pump-crosses-once", &evidence);
    assert_eq!((two.verdict, two.accuracy), (ClaimVerdict::NotDecidable, 1.0));
}

/// Signs from a counter, without pattern enough to matter.
struct Signs(u64);

impl Signs {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        if self.0 >> 63 == 0 { 1.0 } else { -1.0 }
    }

    /// Moves every number of a shot by its accuracy, up or down.
    fn shake(&mut self, p: &mut ShotPoint) {
        for tof in [&mut p.tof_incident_s, &mut p.tof_reflected_s] {
            *tof *= 1.0 + self.next() * p.accuracy_reached;
        }
        for peak in [&mut p.sensor_peak_n, &mut p.wall_peak_n, &mut p.returning_peak_n] {
            *peak *= 1.0 + self.next() * p.peak_accuracy;
        }
        p.second_returning_peak_n += self.next() * p.second_peak_accuracy_n;
        for width in &mut p.widths_s {
            *width *= 1.0 + self.next() * p.width_accuracy;
        }
        p.striker_separation_m_s += self.next() * p.striker_accuracy_m_s;
        p.striker_rebound_m_s += self.next() * p.striker_accuracy_m_s;
        for excess in &mut p.excess_s {
            *excess += self.next() * p.excess_accuracy_s;
        }
        p.loosened_m += self.next() * p.loosened_accuracy_m;
    }
}

/// Numbers of unlike accuracy, so that none can stand for another.
fn coarse() -> Evidence {
    let mut evidence = agreeing();
    for curve in &mut evidence.curves {
        for p in &mut curve.points {
            p.accuracy_reached = 1e-8 * (1.0 + p.speed_m_s);
            p.peak_accuracy = 1e-7;
            p.second_peak_accuracy_n = 1e-6;
            p.width_accuracy = 1e-6;
            p.striker_accuracy_m_s = 1e-7;
            p.excess_accuracy_s = 1e-12;
            p.loosened_accuracy_m = 1e-12;
        }
    }
    evidence
}

#[test]
fn a_value_stays_within_its_accuracy_when_every_number_is_off_by_its_own() {
    let evidence = coarse();
    let mut signs = Signs(1);
    for _ in 0..200 {
        let mut shaken = evidence.clone();
        for curve in &mut shaken.curves {
            curve.points.iter_mut().for_each(|p| signs.shake(p));
        }
        for evaluator in claims().unwrap() {
            let (exact, off) = (evaluator.decide(&evidence), evaluator.decide(&shaken));
            let change = (off.value - exact.value).abs();
            // Bounds are of first order: the second is smaller by the accuracies,
            // and rounding of the made-up numbers by more.
            assert!(
                change <= exact.accuracy * 1.001 + 1e-14,
                "{}: {change:e} of {:e}",
                evaluator.claim.id,
                exact.accuracy
            );
        }
    }
}

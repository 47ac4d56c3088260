//! Verdicts follow from numbers: on numbers made to agree with the paper every
//! claim holds, and each can be made to fail by changing them.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

mod accuracy;
mod agreeing;
mod breaks;

use crate::claims::{
    Claim, ClaimFinding, ClaimVerdict, EvaluatedClaim, Evaluator, Evidence, MEANING, Needs, claims,
    claims_markdown, evaluate_all, predicates::find as predicate, read,
};
use agreeing::{agreeing, dry};
use breaks::{BREAKS, each};

fn evaluator(id: &str) -> Evaluator {
    let all = claims().unwrap();
    all.into_iter().find(|evaluator| evaluator.claim.id == id).unwrap()
}

fn decide(id: &str, evidence: &Evidence) -> ClaimFinding {
    evaluator(id).decide(evidence)
}

#[test]
fn every_claim_holds_on_numbers_that_agree_with_the_paper() {
    let evidence = agreeing();
    for evaluator in claims().unwrap() {
        let finding = evaluator.decide(&evidence);
        assert_eq!(finding.verdict, ClaimVerdict::Holds, "{}: {finding:?}", evaluator.claim.id);
    }
}

#[test]
fn every_verdict_flips_when_its_numbers_change() {
    for evaluator in claims().unwrap() {
        let id = &evaluator.claim.id;
        let change = BREAKS.iter().find(|(name, _)| name == id);
        let (_, change) = change.unwrap_or_else(|| panic!("nothing breaks `{id}`"));
        let mut evidence = agreeing();
        change(&mut evidence);
        let verdict = evaluator.decide(&evidence).verdict;
        assert!(matches!(verdict, ClaimVerdict::Fails | ClaimVerdict::InPart), "{id}: {verdict}");
    }
}

/// Whether a finding's number lies where the claim says that it must.
fn on_the_right_side(claim: &Claim, finding: &ClaimFinding) -> bool {
    match claim.needs {
        Needs::Above => finding.value > claim.threshold,
        Needs::Below => finding.value < claim.threshold,
        Needs::Within => finding.deviation().unwrap().abs() < claim.threshold,
    }
}

#[test]
fn what_a_claim_says_it_needs_is_what_decides_it() {
    for evaluator in claims().unwrap() {
        let claim = &evaluator.claim;
        let met = evaluator.decide(&agreeing());
        assert!(on_the_right_side(claim, &met), "{}: {met:?}", claim.id);
        let (_, change) = BREAKS.iter().find(|(name, _)| *name == claim.id).unwrap();
        let mut evidence = agreeing();
        change(&mut evidence);
        let broken = evaluator.decide(&evidence);
        let by_upper_bound = claim.at_most.is_some_and(|most| broken.value > most);
        assert!(!on_the_right_side(claim, &broken) || by_upper_bound, "{}: {broken:?}", claim.id);
    }
}

#[test]
fn only_numbers_that_the_paper_prints_have_a_deviation() {
    for evaluator in claims().unwrap() {
        let finding = evaluator.decide(&agreeing());
        let printed = !evaluator.claim.expected.is_empty();
        assert_eq!(finding.expected.is_some(), printed, "{}", evaluator.claim.id);
        assert_eq!(evaluator.claim.needs == Needs::Within, printed, "{}", evaluator.claim.id);
    }
}

#[test]
fn the_page_has_every_number_of_a_claim_in_one_unit() {
    let evaluated = evaluate_all(&claims().unwrap(), &agreeing(), &[]);
    let page = claims_markdown(&evaluated, "as made up");
    for line in [
        "- Computed: 0.119434 Pa s (kinematic viscosity times density).",
        "- The paper: 0.119 Pa s. Deviation: +0.000434 Pa s.",
        "- Needed: 0.119 ± 0.0005 Pa s. Half a unit of the last printed digit.",
        "- Needed: 1.1 ± 0.05 m/s. ",
        "- Needed: above 1e-9 m, at most 0.001 m. ",
        "- The paper: -6 log10(s). Deviation: -0.823909 log10(s).",
        "- Needed: above 0.5, in part above 0.05. ",
        "in part when not all but at least 50 % are;",
    ] {
        assert!(page.contains(line), "{line}\n{page}");
    }
}

#[test]
fn the_share_of_rising_speeds_is_as_sure_as_the_turning_points() {
    // A parabola that turns halfway along an axis rises over half of it.
    let (from, to): (f64, f64) = (0.075, 1.23);
    let linear: fn(f64) -> f64 = |speed| speed;
    for (id, axis) in [("pump-rises", linear), ("pump-rises-log", f64::ln)] {
        let mut evidence = agreeing();
        each(&mut evidence, "pump", |p| {
            let turn = 0.5 * (axis(from) + axis(to));
            let ratio = 1.0 + 0.01 * (axis(p.speed_m_s) - turn).powi(2);
            p.tof_incident_s = dry(p.speed_m_s).0 * ratio;
        });
        let finding = decide(id, &evidence);
        assert_eq!(finding.verdict, ClaimVerdict::NotDecidable, "{id}: {finding:?}");
        // A parabola is found exactly, up to rounding of the ratios.
        assert!((finding.value - 0.5).abs() < 1e-9, "{id}: {finding:?}");
    }
}

#[test]
fn a_rise_over_few_speeds_is_one_over_most_of_the_figures_axis() {
    let mut evidence = agreeing();
    // Falls up to 0.4 m/s, which is 60 % of ln(speed) and 28 % of the axis.
    each(&mut evidence, "pump", |p| {
        let ratio = 1.0 + 0.01 * (p.speed_m_s / 0.4).ln().powi(2);
        p.tof_incident_s = dry(p.speed_m_s).0 * ratio;
    });
    assert_eq!(decide("pump-rises", &evidence).verdict, ClaimVerdict::Holds);
    assert_eq!(decide("pump-rises-log", &evidence).verdict, ClaimVerdict::Fails);
}

#[test]
fn oils_either_way_at_one_speed_alone_are_half_of_the_main_result() {
    let mut evidence = agreeing();
    // Every oil on its own side of 1 at all speeds: gear below, pump and motor above.
    each(&mut evidence, "pump", |p| p.tof_incident_s *= 1.2);
    let finding = decide("oil-either-way", &evidence);
    assert_eq!(finding.verdict, ClaimVerdict::InPart, "{finding:?}");
    assert!(finding.value < 0.0, "{finding:?}");
    each(&mut evidence, "gear", |p| p.tof_incident_s *= 1.2);
    assert_eq!(decide("oil-either-way", &evidence).verdict, ClaimVerdict::Fails);
}

#[test]
fn a_page_of_claims_says_above_its_table_what_a_failure_means() {
    let evaluated = evaluate_all(&claims().unwrap(), &agreeing(), &[]);
    let page = claims_markdown(&evaluated, MEANING);
    let table = page.find("| claim |").unwrap();
    assert!(page.find("does not give").unwrap() < table);
}

#[test]
fn gaps_of_more_than_a_millimetre_are_no_small_gaps() {
    let mut evidence = agreeing();
    each(&mut evidence, "dry", |p| p.loosened_m = 2e-3);
    assert_ne!(decide("gaps", &evidence).verdict, ClaimVerdict::Holds);
}

#[test]
fn loosening_that_makes_little_of_the_difference_holds_in_part() {
    for (share, verdict) in
        [(0.6, ClaimVerdict::Holds), (0.3, ClaimVerdict::InPart), (0.01, ClaimVerdict::Fails)]
    {
        let mut evidence = agreeing();
        each(&mut evidence, "dry", |p| p.excess_s[1] = (1.0 - share) * p.excess_s[0]);
        let finding = decide("loosening", &evidence);
        assert_eq!(finding.verdict, verdict, "{share}: {finding:?}");
        // Rounding of a difference.
        assert!((finding.value - share).abs() < 1e-12, "{finding:?}");
    }
}

#[test]
fn a_split_that_the_figure_could_just_show_holds_in_part() {
    for (second, verdict) in
        [(0.6, ClaimVerdict::Holds), (0.2, ClaimVerdict::InPart), (0.02, ClaimVerdict::Fails)]
    {
        let mut evidence = agreeing();
        each(&mut evidence, "motor", |p| {
            p.second_returning_peak_n = second * p.returning_peak_n;
        });
        assert_eq!(decide("motor-split", &evidence).verdict, verdict, "{second}");
    }
}

#[test]
fn a_claim_that_more_speeds_break_than_meet_fails() {
    for (from_m_s, verdict) in [(0.45, ClaimVerdict::InPart), (0.3, ClaimVerdict::Fails)] {
        let mut evidence = agreeing();
        // From 0.45 m/s on there are six of the twelve speeds, from 0.3 m/s on seven.
        each(&mut evidence, "motor", |p| {
            if p.speed_m_s > from_m_s {
                p.tof_incident_s = 0.9 * dry(p.speed_m_s).0;
            }
        });
        let finding = decide("motor-above", &evidence);
        assert_eq!(finding.verdict, verdict, "{finding:?}");
    }
}

#[test]
fn claims_without_numbers_are_not_decidable() {
    let nothing = Evidence { viscosity_over_modulus_s: f64::NAN, ..Evidence::default() };
    for evaluator in claims().unwrap() {
        let verdict = evaluator.decide(&nothing).verdict;
        assert_eq!(verdict, ClaimVerdict::NotDecidable, "{}", evaluator.claim.id);
    }
}

#[test]
fn a_difference_within_the_accuracy_decides_nothing() {
    let mut evidence = agreeing();
    each(&mut evidence, "motor", |p| {
        p.tof_incident_s = dry(p.speed_m_s).0 * (1.0 + 1e-7);
        p.accuracy_reached = 1e-6;
    });
    assert_eq!(decide("motor-above", &evidence).verdict, ClaimVerdict::NotDecidable);
}

#[test]
fn a_crossing_elsewhere_is_one_crossing_with_a_speed_and_not_that_of_the_paper() {
    let mut evidence = agreeing();
    each(&mut evidence, "pump", |p| {
        p.tof_incident_s = dry(p.speed_m_s).0 * (p.speed_m_s / 0.53).powf(0.02);
    });
    assert_eq!(decide("pump-crosses-once", &evidence).verdict, ClaimVerdict::Holds);
    let finding = decide("pump-crossing", &evidence);
    assert_eq!(finding.verdict, ClaimVerdict::Fails);
    // The ratio is linear in ln v up to 0.02² over the interval.
    assert!((finding.value - 0.53).abs() < 1e-3, "{finding:?}");
}

#[test]
fn a_ratio_that_is_1_within_its_accuracy_crosses_nowhere_for_sure() {
    let mut evidence = agreeing();
    each(&mut evidence, "pump", |p| {
        p.tof_incident_s = dry(p.speed_m_s).0 * (1.0 + 1e-7 * p.speed_m_s.ln());
        p.accuracy_reached = 1e-6;
    });
    assert_eq!(decide("pump-crosses-once", &evidence).verdict, ClaimVerdict::NotDecidable);
}

#[test]
fn a_verdict_that_one_draw_changes_is_not_decidable_and_has_a_range() {
    let printed = agreeing();
    let mut draw = printed.clone();
    draw.viscosity_over_modulus_s = 1.6e-7;
    let draws = [printed.clone(), draw];
    let evaluated = evaluate_all(&claims().unwrap(), &printed, &draws);
    let relaxation = evaluated.iter().find(|j| j.claim.id == "relaxation-time").unwrap();
    assert_eq!(relaxation.finding.verdict, ClaimVerdict::Holds);
    assert_eq!(relaxation.verdict, ClaimVerdict::NotDecidable);
    let rounded = relaxation.rounded.as_ref().unwrap();
    assert_eq!(rounded.range, Some((1.5e-7, 1.6e-7)));
    let other = evaluated.iter().find(|j| j.claim.id == "gear-below").unwrap();
    assert_eq!(other.verdict, ClaimVerdict::Holds);
}

/// The verdict on motor oil's ratios when one draw computes them to 1e-6 and
/// the lowest of them is off 1 by this much.
fn motor_above_with_a_draw(off: f64) -> EvaluatedClaim {
    let printed = agreeing();
    let mut draw = printed.clone();
    each(&mut draw, "motor", |p| {
        p.accuracy_reached = 1e-6;
        if p.speed_m_s == 0.5 {
            p.tof_incident_s = dry(p.speed_m_s).0 * (1.0 + off);
        }
    });
    assert!(decide("motor-above", &draw).is_open());
    let evaluated = evaluate_all(&claims().unwrap(), &printed, &[draw]);
    let motor = evaluated.into_iter().find(|j| j.claim.id == "motor-above");
    motor.unwrap()
}

#[test]
fn a_draw_that_is_too_coarse_to_tell_but_lies_on_the_same_side_flips_nothing() {
    let evaluated = motor_above_with_a_draw(1e-7);
    assert_eq!(evaluated.verdict, ClaimVerdict::Holds, "{evaluated:?}");
    assert_eq!(evaluated.rounded.unwrap().open, 1);
}

#[test]
fn a_draw_on_the_other_side_flips_however_coarse_it_is() {
    let evaluated = motor_above_with_a_draw(-1e-7);
    assert_eq!(evaluated.finding.verdict, ClaimVerdict::Holds);
    assert_eq!(evaluated.verdict, ClaimVerdict::NotDecidable);
    // One ratio of several is below 1 then.
    assert_eq!(evaluated.rounded.unwrap().verdicts, [0, 1, 0, 0]);
}

#[test]
fn the_page_tells_the_range_of_what_rounding_flips_and_how_many_draws_have_a_value() {
    let printed = agreeing();
    let mut draw = printed.clone();
    each(&mut draw, "pump", |p| p.tof_incident_s *= 1.1);
    let evaluated = evaluate_all(&claims().unwrap(), &printed, &[printed.clone(), draw]);
    let crossing = evaluated.iter().find(|j| j.claim.id == "pump-crossing");
    assert_eq!(crossing.unwrap().verdict, ClaimVerdict::NotDecidable);
    let page = claims_markdown(&evaluated, "as made up");
    let line =
        "2 draws: holds in 1, fails in 1; computed: 1.09999 to 1.09999 m/s in the 1 that have it.";
    assert!(page.contains(line), "{page}");
}

#[test]
fn there_are_more_than_fifteen_claims_and_each_says_why() {
    let all = claims().unwrap();
    assert!(all.len() > 15);
    for evaluator in all {
        let claim = evaluator.claim;
        for text in [&claim.statement, &claim.paper, &claim.value, &claim.reason] {
            assert!(text.len() > 4, "{claim:?}");
        }
    }
}

#[test]
fn a_claim_file_with_an_unknown_predicate_is_refused() {
    let text = r#"
        [[claim]]
        id = "a"
        statement = "s"
        paper = "p"
        predicate = "guess"
        needs = "above"
        threshold = 1.0
        value = "v"
        reason = "r"
    "#;
    let error = read(text, predicate).unwrap_err().to_string();
    assert!(error.contains("guess"), "{error}");
}

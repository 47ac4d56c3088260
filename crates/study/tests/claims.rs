//! Verdicts follow from numbers: on numbers made to agree with the paper every
//! claim holds, and each can be made to fail by changing them.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that cannot go on should fail"
)]

use hertzchain_study::claims::{
    Claim, Curve, DigitisedPeak, Evidence, Finding, Judge, Needs, Oil, Point, Verdict, claims,
    claims_markdown, judge_all, judge_all_rounded, read,
};
use hertzchain_study::reproduce::SCAN_SPEEDS_M_S;

fn point(speed_m_s: f64, incident_s: f64, reflected_s: f64) -> Point {
    Point {
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
        loosened_m: 2e-5,
        accuracy_reached: 1e-10,
    }
}

fn curve(case: &str, tofs: impl Fn(f64) -> (f64, f64)) -> Curve {
    let points = SCAN_SPEEDS_M_S.map(|v| {
        let (incident, reflected) = tofs(v);
        point(v, incident, reflected)
    });
    Curve {
        case: case.to_owned(),
        points: points.to_vec(),
    }
}

fn dry(v: f64) -> (f64, f64) {
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

fn oil(case: &str, kinematic_viscosity_m2_s: f64, density_kg_m3: f64) -> Oil {
    Oil {
        case: case.to_owned(),
        kinematic_viscosity_m2_s,
        density_kg_m3,
    }
}

/// Numbers made up so that everything the paper says is true.
fn agreeing() -> Evidence {
    let sensor_over_wall = 190.0 / 270.0 * 0.1_f64.powf(0.1);
    Evidence {
        curves: vec![
            curve("hertz", |v| (630e-6 * v.powf(-0.2), 632e-6 * v.powf(-0.2))),
            curve("hertz-viscoelastic", |v| {
                (657e-6 * v.powf(-0.194), 688e-6 * v.powf(-0.187))
            }),
            curve("dry", dry),
            wet("pump", 1.0, 0.075),
            wet("gear", 0.97, 0.075),
            wet("motor", 1.05, 0.1),
            curve("dry-held", |v| (dry(v).0, 1.02 * dry(v).0)),
        ],
        oils: vec![
            oil("pump", 55e-6, 870.0),
            oil("gear", 133e-6, 898.0),
            oil("motor", 68.5e-6, 842.6),
        ],
        viscosity_over_modulus_s: 1.5e-7,
        digitised: vec![DigitisedPeak {
            case: "dry".to_owned(),
            speed_m_s: 0.1,
            sensor_over_wall,
            standard_error: 0.01,
        }],
    }
}

fn judge(id: &str) -> Judge {
    let all = claims().unwrap();
    all.into_iter().find(|judge| judge.claim.id == id).unwrap()
}

fn decide(id: &str, evidence: &Evidence) -> Finding {
    judge(id).decide(evidence)
}

#[test]
fn every_claim_holds_on_numbers_that_agree_with_the_paper() {
    let evidence = agreeing();
    for judge in claims().unwrap() {
        let finding = judge.decide(&evidence);
        assert_eq!(
            finding.verdict,
            Verdict::Holds,
            "{}: {finding:?}",
            judge.claim.id
        );
    }
}

/// Changes all points of a case.
fn each(evidence: &mut Evidence, case: &str, change: impl Fn(&mut Point)) {
    let curve = evidence
        .curves
        .iter_mut()
        .find(|curve| curve.case == case)
        .unwrap();
    curve.points.iter_mut().for_each(change);
}

fn reflected_as_incident(p: &mut Point) {
    p.tof_reflected_s = p.tof_incident_s;
}

/// Bends both ToFs in log–log.
fn bend(p: &mut Point) {
    let factor = 1.0 + 0.2 * p.speed_m_s.ln().powi(2);
    p.tof_incident_s *= factor;
    p.tof_reflected_s *= factor;
}

/// Bends both by less than a figure shows and more than 20 shots leave open.
fn bend_slightly(p: &mut Point) {
    let factor = 1.0 + 0.005 * p.speed_m_s.ln().powi(2);
    p.tof_incident_s *= factor;
    p.tof_reflected_s *= factor;
}

fn lengthen(p: &mut Point) {
    p.tof_incident_s *= 1.2;
}

fn shorten(p: &mut Point) {
    p.tof_incident_s /= 1.2;
}

fn falling_ratio(p: &mut Point) {
    p.tof_incident_s *= p.speed_m_s.powf(-0.05);
}

fn only_rising_ratio(p: &mut Point) {
    p.tof_incident_s = dry(p.speed_m_s).0 * p.speed_m_s.powf(0.01);
}

/// A ratio that falls over most speeds and yet ends above where it began.
fn rising_once(p: &mut Point) {
    let rise = if p.speed_m_s > 1.2 { 1.2 } else { 1.0 };
    p.tof_incident_s = rise * dry(p.speed_m_s).0 * p.speed_m_s.powf(-0.05);
}

/// A ratio that rises over all speeds but the last.
fn lower_at_the_end(p: &mut Point) {
    if p.speed_m_s > 1.2 {
        p.tof_incident_s /= 1.2;
    }
}

/// A ratio that passes 1 upward, downward and upward again.
fn back_and_forth(p: &mut Point) {
    if (0.2..0.5).contains(&p.speed_m_s) {
        p.tof_incident_s *= 1.2;
    }
}

type Change = fn(&mut Evidence);

/// For every claim a change of the numbers that it must not survive.
const BREAKS: &[(&str, Change)] = &[
    ("pulse-order", |e| {
        each(e, "gear", |p| p.widths_s = [p.tof_incident_s / 2.9; 3])
    }),
    ("tof-falls", |e| {
        each(e, "pump", |p| p.tof_incident_s = 7e-4 * p.speed_m_s)
    }),
    ("amplitude-rises", |e| {
        each(e, "motor", |p| p.wall_peak_n = 1.0 / p.speed_m_s)
    }),
    ("return-longer", |e| {
        each(e, "dry", |p| p.tof_reflected_s = 0.99 * p.tof_incident_s)
    }),
    ("loosening", |e| each(e, "dry", reflected_as_incident)),
    ("gaps", |e| each(e, "dry", |p| p.loosened_m = -1e-7)),
    ("return-error-bars", |e| {
        each(e, "dry", |p| {
            p.tof_reflected_s = 7e-4 * p.speed_m_s.powf(-0.1)
        })
    }),
    ("dry-incident-power-law-fit", |e| each(e, "dry", bend)),
    ("dry-incident-power-law-residuals", |e| {
        each(e, "dry", bend_slightly)
    }),
    ("dry-reflected-power-law-fit", |e| each(e, "dry", bend)),
    ("dry-reflected-power-law-residuals", |e| {
        each(e, "dry", bend_slightly)
    }),
    ("viscoelastic-power-law-fit", |e| {
        each(e, "hertz-viscoelastic", bend)
    }),
    ("viscoelastic-power-law-residuals", |e| {
        each(e, "hertz-viscoelastic", bend_slightly)
    }),
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
    ("pump-crossing", |e| {
        each(e, "pump", |p| p.tof_incident_s *= 1.003)
    }),
    ("gear-below", |e| each(e, "gear", lengthen)),
    ("motor-above", |e| each(e, "motor", shorten)),
    ("ratios-rise", |e| each(e, "gear", rising_once)),
    ("ratios-end-higher", |e| each(e, "motor", lower_at_the_end)),
    ("ratios-dip", |e| each(e, "motor", only_rising_ratio)),
    ("gear-like-pump", |e| each(e, "gear", falling_ratio)),
    ("motor-like-gear", |e| each(e, "gear", falling_ratio)),
    ("wet-power-laws-fit", |e| each(e, "motor", bend)),
    ("wet-power-laws-residuals", |e| {
        each(e, "motor", bend_slightly)
    }),
    ("fluid-attenuates", |e| {
        each(e, "pump", |p| p.wall_peak_n *= 2.0)
    }),
    ("motor-split", |e| {
        each(e, "motor", |p| p.second_returning_peak_n *= 0.5)
    }),
    ("peaks-overlap", |e| {
        each(e, "dry", |p| p.wall_peak_n *= 1.5)
    }),
    ("dynamic-viscosities", |e| e.oils[2].density_kg_m3 *= 1.02),
    ("gear-viscosity", |e| e.oils[0].density_kg_m3 *= 1.05),
    ("viscosity-no-simple-role", |e| {
        each(e, "pump", shorten);
        each(e, "gear", lengthen);
    }),
    ("trend-against-viscosity", |e| {
        each(e, "gear", falling_ratio)
    }),
    ("relaxation-time", |e| e.viscosity_over_modulus_s *= 1.1),
    ("relaxation-order", |e| e.viscosity_over_modulus_s /= 2.0),
    ("no-rebound", |e| {
        each(e, "dry", |p| p.striker_rebound_m_s = -0.1)
    }),
];

#[test]
fn every_verdict_flips_when_its_numbers_change() {
    for judge in claims().unwrap() {
        let id = &judge.claim.id;
        let change = BREAKS.iter().find(|(name, _)| name == id);
        let (_, change) = change.unwrap_or_else(|| panic!("nothing breaks `{id}`"));
        let mut evidence = agreeing();
        change(&mut evidence);
        let verdict = judge.decide(&evidence).verdict;
        assert!(
            matches!(verdict, Verdict::Fails | Verdict::InPart),
            "{id}: {verdict}"
        );
    }
}

/// Whether a finding's number lies where the claim says that it must.
fn on_the_right_side(claim: &Claim, finding: &Finding) -> bool {
    match claim.needs {
        Needs::Above => finding.value > claim.threshold,
        Needs::Below => finding.value < claim.threshold,
        Needs::Within => finding.deviation().unwrap().abs() < claim.threshold,
    }
}

#[test]
fn what_a_claim_says_it_needs_is_what_decides_it() {
    for judge in claims().unwrap() {
        let claim = &judge.claim;
        let met = judge.decide(&agreeing());
        assert!(on_the_right_side(claim, &met), "{}: {met:?}", claim.id);
        let (_, change) = BREAKS.iter().find(|(name, _)| *name == claim.id).unwrap();
        let mut evidence = agreeing();
        change(&mut evidence);
        let broken = judge.decide(&evidence);
        let by_upper_bound = claim.at_most.is_some_and(|most| broken.value > most);
        assert!(
            !on_the_right_side(claim, &broken) || by_upper_bound,
            "{}: {broken:?}",
            claim.id
        );
    }
}

#[test]
fn only_numbers_that_the_paper_prints_have_a_deviation() {
    for judge in claims().unwrap() {
        let finding = judge.decide(&agreeing());
        let printed = !judge.claim.expected.is_empty();
        assert_eq!(finding.expected.is_some(), printed, "{}", judge.claim.id);
        assert_eq!(
            judge.claim.needs == Needs::Within,
            printed,
            "{}",
            judge.claim.id
        );
    }
}

#[test]
fn the_page_has_every_number_of_a_claim_in_one_unit() {
    let judged = judge_all(&claims().unwrap(), &agreeing());
    let page = claims_markdown(&judged, "as made up");
    for line in [
        "- Computed: 0.119434 Pa s (the one of kinematic viscosity times density that is farthest off).",
        "- The paper: 0.119 Pa s. Deviation: +0.000434 Pa s.",
        "- Needed: 0.119 ± 0.0005 Pa s. Half a unit of the last printed digit.",
        "- Needed: 1.1 ± 0.05 m/s. ",
        "- Needed: above 1e-9 m, at most 0.001 m. ",
        "- The paper: -6 log10(s). Deviation: -0.823909 log10(s).",
        "- Needed: above 0.5, in part above 0.05. ",
    ] {
        assert!(page.contains(line), "{line}\n{page}");
    }
}

#[test]
fn gaps_of_more_than_a_millimetre_are_no_small_gaps() {
    let mut evidence = agreeing();
    each(&mut evidence, "dry", |p| p.loosened_m = 2e-3);
    assert_ne!(decide("gaps", &evidence).verdict, Verdict::Holds);
}

#[test]
fn a_split_that_the_figure_could_just_show_holds_in_part() {
    for (second, verdict) in [
        (0.6, Verdict::Holds),
        (0.2, Verdict::InPart),
        (0.02, Verdict::Fails),
    ] {
        let mut evidence = agreeing();
        each(&mut evidence, "motor", |p| {
            p.second_returning_peak_n = second * p.returning_peak_n;
        });
        assert_eq!(
            decide("motor-split", &evidence).verdict,
            verdict,
            "{second}"
        );
    }
}

#[test]
fn claims_without_numbers_are_not_decidable() {
    let nothing = Evidence {
        viscosity_over_modulus_s: f64::NAN,
        ..Evidence::default()
    };
    for judge in claims().unwrap() {
        let verdict = judge.decide(&nothing).verdict;
        assert_eq!(verdict, Verdict::NotDecidable, "{}", judge.claim.id);
    }
}

#[test]
fn a_difference_within_the_accuracy_decides_nothing() {
    let mut evidence = agreeing();
    each(&mut evidence, "motor", |p| {
        p.tof_incident_s = dry(p.speed_m_s).0 * (1.0 + 1e-7);
        p.accuracy_reached = 1e-6;
    });
    assert_eq!(
        decide("motor-above", &evidence).verdict,
        Verdict::NotDecidable
    );
}

#[test]
fn a_crossing_elsewhere_is_one_crossing_with_a_speed_and_not_that_of_the_paper() {
    let mut evidence = agreeing();
    each(&mut evidence, "pump", |p| {
        p.tof_incident_s = dry(p.speed_m_s).0 * (p.speed_m_s / 0.53).powf(0.02);
    });
    assert_eq!(
        decide("pump-crosses-once", &evidence).verdict,
        Verdict::Holds
    );
    let finding = decide("pump-crossing", &evidence);
    assert_eq!(finding.verdict, Verdict::Fails);
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
    assert_eq!(
        decide("pump-crosses-once", &evidence).verdict,
        Verdict::NotDecidable
    );
}

#[test]
fn a_verdict_that_one_draw_changes_is_not_decidable_and_has_a_range() {
    let printed = agreeing();
    let mut draw = printed.clone();
    draw.viscosity_over_modulus_s = 1.6e-7;
    let draws = [printed.clone(), draw];
    let judged = judge_all_rounded(&claims().unwrap(), &printed, &printed, &draws);
    let relaxation = judged
        .iter()
        .find(|j| j.claim.id == "relaxation-time")
        .unwrap();
    assert_eq!(relaxation.finding.verdict, Verdict::Holds);
    assert_eq!(relaxation.verdict, Verdict::NotDecidable);
    let rounded = relaxation.rounded.as_ref().unwrap();
    assert_eq!(rounded.range, Some((1.5e-7, 1.6e-7)));
    let other = judged.iter().find(|j| j.claim.id == "gear-below").unwrap();
    assert_eq!(other.verdict, Verdict::Holds);
}

#[test]
fn there_are_more_than_fifteen_claims_and_each_says_why() {
    let all = claims().unwrap();
    assert!(all.len() > 15);
    for judge in all {
        let claim = judge.claim;
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
    let error = read(text).unwrap_err().to_string();
    assert!(error.contains("guess"), "{error}");
}

//! Verdicts on the rig follow from numbers.

use super::Silent;
use super::small::{TEXT, experiment};
use crate::claims::{ClaimFinding, ClaimVerdict, Needs};
use crate::rig_claims::{
    FACTORS, Observed, RigClaims, RigDesign, RigEvidence, SpeedSeries, TriedRig, claims, observe,
    series_csv, typical,
};
use hertzchain_chain::settle::State;
use hertzchain_experiment::{Experiment, preset};
use hertzchain_sim::rig::Shot;

/// Standard deviation of these is 1.
const UNIT: [f64; 8] = [-1.0, 1.0, -1.0, 1.0, -0.866, 0.866, -0.866, 0.866];

/// What the striker's 0.003 m/s adds to the incident ToF.
fn scatter_s(speed_m_s: f64) -> f64 {
    0.2 * tof_s(speed_m_s) / speed_m_s * 0.003
}

fn tof_s(speed_m_s: f64) -> f64 {
    630e-6 * speed_m_s.powf(-0.2)
}

/// Shots that spread by a multiple of what the striker adds, incident and
/// reflected.
fn shots(speed_m_s: f64, spread: [f64; 2], of: impl Fn(f64, &mut Shot)) -> Vec<Shot> {
    let shot = |unit: &f64| {
        let off_s = unit * scatter_s(speed_m_s);
        let mut shot = Shot {
            incident_s: tof_s(speed_m_s) + spread[0] * off_s,
            reflected_s: 1.05 * tof_s(speed_m_s) + spread[1] * off_s,
            peaks_s: [0.0; 3],
            peaks_n: [0.0; 3],
            rebound_m_s: f64::NAN,
            before: nowhere(),
            after: nowhere(),
            overlaps_before_m: Vec::new(),
            gaps_before_m: vec![0.0; 40],
            gaps_after_m: vec![0.0; 40],
            rest_s: 0.02,
        };
        of(*unit, &mut shot);
        shot
    };
    UNIT.iter().map(shot).collect()
}

/// Claims look at gaps, not at where bodies are.
fn nowhere() -> State {
    State { displacement_m: Vec::new(), velocity_m_s: Vec::new(), bridged: Vec::new() }
}

/// A rig that shows all that the paper says.
fn agreeing() -> RigEvidence {
    let at_speed = |speed_m_s: f64| SpeedSeries {
        speed_m_s,
        loose: shots(speed_m_s, [3.0, 4.0], |unit, shot| {
            shot.rebound_m_s = -0.3 * speed_m_s + 0.02 * unit;
        }),
        tapped: shots(speed_m_s, [0.1, 2.0], |_, shot| {
            if speed_m_s > 0.25 {
                shot.rebound_m_s = -0.3 * speed_m_s;
                shot.gaps_after_m[20] = 1e-5;
            }
        }),
    };
    let speeds = [0.08, 0.12, 0.2, 0.3, 0.5, 0.8, 1.2];
    RigEvidence {
        rigs: vec![Observed { rig: TriedRig::usual(), speeds: speeds.map(at_speed).to_vec() }],
        wet: Vec::new(),
    }
}

/// What a change does to every shot.
type Change = fn(&mut Shot, f64);

/// Claims, whether the shots with taps are changed or those without, and how.
const BREAKS: &[(&str, bool, Change)] = &[
    ("rebounds-differ", false, |shot, speed_m_s| {
        shot.rebound_m_s = -0.3 * speed_m_s;
    }),
    ("loose-spread", false, towards_mean),
    ("taps-shrink-own", false, towards_mean),
    ("taps-shrink-seen", false, towards_mean),
    ("return-longer", true, |shot, _| shot.reflected_s *= 0.9),
    ("return-spreads-own", true, |shot, speed_m_s| {
        shot.reflected_s = 1.05 * tof_s(speed_m_s);
    }),
    ("return-spreads-seen", true, |shot, speed_m_s| {
        shot.incident_s = tof_s(speed_m_s) + 3.0 * (shot.reflected_s - 1.05 * tof_s(speed_m_s));
    }),
    ("gaps-left", true, |shot, _| shot.gaps_after_m.fill(0.0)),
    ("gaps-closed", true, |shot, _| shot.gaps_before_m[3] = 1e-7),
    ("no-rebound-slow", true, |shot, speed_m_s| {
        shot.rebound_m_s = -0.3 * speed_m_s;
    }),
    ("rebound-fast", true, |shot, _| shot.rebound_m_s = f64::NAN),
];

fn towards_mean(shot: &mut Shot, speed_m_s: f64) {
    let mean_s = tof_s(speed_m_s);
    shot.incident_s = mean_s + 0.01 * (shot.incident_s - mean_s);
}

fn decide(id: &str, evidence: &RigEvidence) -> ClaimFinding {
    let all = claims().unwrap();
    let evaluator = all.into_iter().find(|evaluator| evaluator.claim.id == id).unwrap();
    evaluator.decide(evidence)
}

fn broken((_, tapped, change): &(&str, bool, Change)) -> RigEvidence {
    let mut evidence = agreeing();
    for at in &mut evidence.rigs[0].speeds {
        let shots = if *tapped { &mut at.tapped } else { &mut at.loose };
        shots.iter_mut().for_each(|shot| change(shot, at.speed_m_s));
    }
    evidence
}

#[test]
fn every_claim_holds_on_a_rig_that_agrees_with_the_paper() {
    for evaluator in claims().unwrap() {
        let finding = evaluator.decide(&agreeing());
        let id = &evaluator.claim.id;
        assert_eq!(finding.verdict, ClaimVerdict::Holds, "{id}: {finding:?}");
    }
}

#[test]
fn every_verdict_flips_when_its_numbers_change() {
    for evaluator in claims().unwrap() {
        let claim = &evaluator.claim;
        let change = BREAKS.iter().find(|(id, ..)| id == &claim.id).unwrap();
        let finding = evaluator.decide(&broken(change));
        assert_eq!(finding.verdict, ClaimVerdict::Fails, "{}: {finding:?}", claim.id);
        let other_side = match claim.needs {
            Needs::Below => finding.value >= claim.threshold,
            Needs::Above | Needs::Within => finding.value <= claim.threshold,
        };
        assert!(other_side, "{}: {finding:?}", claim.id);
    }
}

#[test]
fn a_claim_that_half_of_the_rigs_show_holds_in_part() {
    let mut evidence = agreeing();
    let failing = BREAKS.iter().find(|(id, ..)| *id == "loose-spread");
    evidence.rigs.extend(broken(failing.unwrap()).rigs);
    assert_eq!(decide("loose-spread", &evidence).verdict, ClaimVerdict::InPart);
}

#[test]
fn gaps_of_a_millimetre_are_not_small() {
    let mut evidence = agreeing();
    for at in &mut evidence.rigs[0].speeds {
        at.tapped.iter_mut().for_each(|shot| shot.gaps_after_m[0] = 2e-3);
    }
    assert_eq!(decide("gaps-left", &evidence).verdict, ClaimVerdict::Fails);
}

#[test]
fn what_was_not_seen_is_not_decidable() {
    let nothing = RigEvidence::default();
    let mut blind = agreeing();
    for at in &mut blind.rigs[0].speeds {
        for shot in at.tapped.iter_mut().chain(&mut at.loose) {
            (shot.incident_s, shot.reflected_s) = (f64::NAN, f64::NAN);
        }
    }
    for evaluator in claims().unwrap() {
        let verdict = evaluator.decide(&nothing).verdict;
        assert_eq!(verdict, ClaimVerdict::NotDecidable, "{}", evaluator.claim.id);
    }
    // Missing pulses are not a spread of nothing.
    for id in ["loose-spread", "taps-shrink-own", "return-spreads-own", "return-longer"] {
        assert_eq!(decide(id, &blind).verdict, ClaimVerdict::NotDecidable, "{id}");
    }
}

#[test]
fn series_without_pulses_do_not_count_beside_those_that_have_them() {
    let mut evidence = agreeing();
    let before = decide("loose-spread", &evidence);
    for shot in &mut evidence.rigs[0].speeds[2].loose {
        shot.incident_s = f64::NAN;
    }
    let after = decide("loose-spread", &evidence);
    assert_eq!(after.verdict, ClaimVerdict::Holds);
    // All series spread three times as much as the striker adds.
    assert!((after.value / before.value - 1.0).abs() < 0.05, "{after:?}");
}

#[test]
fn strikers_that_all_stay_do_not_rebound_differently() {
    let mut evidence = agreeing();
    for at in &mut evidence.rigs[0].speeds {
        at.loose.iter_mut().for_each(|shot| shot.rebound_m_s = f64::NAN);
    }
    assert_eq!(decide("rebounds-differ", &evidence).verdict, ClaimVerdict::Fails);
}

/// Of numbers e^±1 the logarithm's mean is 0, its standard error by theory
/// √(1/n) with n in place of n − 1, as any bootstrap has it.
#[test]
fn the_bootstrap_s_error_of_a_mean_is_that_of_theory() {
    let numbers: Vec<f64> =
        (0..20).map(|at| if at % 2 == 0 { 1f64.exp() } else { (-1f64).exp() }).collect();
    let found = typical(numbers.iter().copied());
    assert!(found.value.abs() < 1e-12);
    let expected = 1.96 * (1f64 / 20.0).sqrt();
    // A thousand draws give a standard deviation to 1/√2000; four times that.
    assert!((found.error / expected - 1.0).abs() < 4.0 / 44.7, "{found:?}");
}

#[test]
fn the_design_tries_every_level_of_every_factor_about_the_preset() {
    let design = RigDesign::about(preset("paper").unwrap());
    assert_eq!(design.rigs[0], TriedRig::usual());
    for (at, factor) in FACTORS.iter().enumerate() {
        let usual = design.experiment.get(factor.path).unwrap();
        // Rounding of a unit's conversion.
        assert!((usual - factor.usual()).abs() <= 1e-12 * usual, "{}", factor.name);
        for level in factor.levels {
            let single = |rig: &TriedRig| {
                let others = FACTORS.iter().enumerate().filter(|(other, _)| *other != at);
                let mut others = others.map(|(other, factor)| rig.values[other] == factor.usual());
                rig.values[at] == level && others.all(|usual| usual)
            };
            assert!(design.rigs.iter().any(single), "{} {level}", factor.name);
        }
    }
    let mut names: Vec<&str> = design.rigs.iter().map(|rig| &*rig.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), design.rigs.len());
}

/// Two dry rigs and a wet one with twelve beads, three speeds, three shots.
fn small() -> RigDesign {
    RigDesign {
        rigs: vec![TriedRig::usual(), TriedRig::but(0, 0.2), TriedRig::with_case(1, "wet")],
        speeds: 3,
        shots: 2,
        first: 1,
        ..RigDesign::about(experiment(&[]))
    }
}

#[test]
fn a_small_design_is_run_and_judged_whatever_the_threads() {
    let design = small();
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1);
    let one = alone.build().unwrap().install(|| observe(&design, &Silent));
    let evidence = observe(&design, &Silent).unwrap();
    let csv = series_csv(&evidence);
    assert_eq!(csv, series_csv(&one.unwrap()));
    // Three rigs, three speeds, with taps and without, and the header.
    assert_eq!(csv.lines().count(), 19);
    assert_eq!((evidence.rigs.len(), evidence.wet.len()), (2, 1));
    let claims = RigClaims::evaluate(&design, &evidence).unwrap();
    let page = claims.markdown();
    for evaluated in &claims.evaluated {
        assert!(page.contains(&evaluated.claim.statement));
        // Gaps, rebounds and times of flight are there at every speed.
        assert!(evaluated.finding.value.is_finite(), "{}", evaluated.claim.id);
    }
    assert!(page.contains("| as the preset |") && page.contains("| friction 0.2 |"));
    assert!(page.contains("| as the preset, wet |"));
    // Oil changes times, and counts in no verdict on all.
    let [dry, wet] =
        [&evidence.rigs[0], &evidence.wet[0]].map(|seen| seen.speeds[2].tapped[0].incident_s);
    assert!((wet / dry - 1.0).abs() > 1e-3, "{dry} {wet}");
    let only_dry = RigEvidence { wet: Vec::new(), ..evidence.clone() };
    let again = RigClaims::evaluate(&design, &only_dry).unwrap();
    for (one, two) in claims.evaluated.iter().zip(&again.evaluated) {
        assert_eq!(one.finding.value.to_bits(), two.finding.value.to_bits());
    }
    let rigs = claims.json()["rigs"].as_array().unwrap().len();
    assert_eq!(rigs, 3);
}

#[test]
fn an_experiment_without_a_push_is_no_rig_to_vary() {
    let text = TEXT
        .replace("[near_end]\npush = \"spring\"\nforce = \"0.24 N\"\nstiffness = \"100 N/m\"", "");
    let design =
        RigDesign { experiment: Experiment::from_text("small.toml", &text).unwrap(), ..small() };
    let error = observe(&design, &Silent).unwrap_err().to_string();
    assert!(error.contains("near_end.force"), "{error}");
}

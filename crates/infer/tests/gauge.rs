//! The oil gauge on simulated oils.

use crate::common::{Noise, Truth, chains, speeds_between};
use hertzchain_experiment::{Experiment, preset};
use hertzchain_infer::gauge::{Chains, Gauge, Pair, known_oils, oils};
use hertzchain_infer::{Data, Observable};
use hertzchain_measure::signal::Estimate;

const SPEEDS_M_S: [f64; 3] = [0.2, 0.5, 1.2];

fn gauge(wet: Data, seed: u64) -> Gauge {
    let (dry_model, wet_model) = (preset("dry").unwrap(), preset("pump").unwrap());
    let chains = chains(&dry_model, &wet_model);
    let dry = Truth::of(&dry_model, &SPEEDS_M_S).measured(seed);
    Gauge::new(&chains, dry, wet).unwrap()
}

fn wet(experiment: &Experiment, seed: u64) -> Data {
    Truth::of(experiment, &SPEEDS_M_S).measured(100 + seed)
}

#[test]
fn the_tables_oils_are_those_of_the_presets() {
    let oils = known_oils().unwrap();
    for (name, oil) in [("motor", &oils[0]), ("gear", &oils[1]), ("pump", &oils[2])] {
        for speed in [0.1, 1.0] {
            let (chain, _) = preset(name).unwrap().chain(Some(speed)).unwrap();
            let pair = chain.pair(20).unwrap();
            let (k, a) = oil.contact(pair.radius_m, speed);
            // v^b computed twice: rounding.
            assert!((k / pair.hertz_stiffness() - 1.0).abs() < 1e-12, "{name}");
            assert!((a / pair.left.relaxation_time_s() - 1.0).abs() < 1e-12, "{name}");
        }
    }
}

#[test]
fn each_oil_is_recognised_and_the_others_rejected() {
    for (seed, (name, called)) in
        [("motor", "motor oil"), ("gear", "gear oil"), ("pump", "pump oil")].into_iter().enumerate()
    {
        let gauge = gauge(wet(&preset(name).unwrap(), seed as u64), seed as u64);
        let verdict = gauge.verdict(&known_oils().unwrap()).unwrap();
        let allowed: Vec<&str> = verdict.allowed().map(|found| found.oil.as_str()).collect();
        assert_eq!(allowed.len(), 1, "{name}: {verdict:?}");
        assert!(allowed[0].starts_with(called), "{name}: {allowed:?}");
        assert!(verdict.sentence().starts_with("Of the known oils only "));
    }
}

#[test]
fn an_unknown_oil_is_none_of_these_until_it_has_a_row() {
    let unknown = preset("motor").unwrap().set(&[("motor-oil.young_modulus", 205e9)]).unwrap();
    let gauge = gauge(wet(&unknown, 7), 7);
    let mut table = known_oils().unwrap();
    let verdict = gauge.verdict(&table).unwrap();
    assert!(verdict.sentence().starts_with("None of these"), "{}", verdict.sentence());
    let mut row = table[0].clone();
    row.young_modulus_pa = Some(205e9);
    row.name = "mine".to_owned();
    table.push(row);
    assert_eq!(
        gauge.verdict(&table).unwrap().sentence(),
        "Of the known oils only mine gives these times."
    );
}

/// Friction holds another load in a tapped row than its file says, and another one in each.
#[test]
fn a_push_of_its_own_for_each_chain_finds_the_oil_that_the_files_push_hides() {
    let paper = preset("paper").unwrap();
    let [dry_model, wet_model] = ["dry", "pump"].map(|name| paper.case(name).unwrap().unwrap());
    let push = ["near_end.force".to_owned()];
    let held = wet_model.set(&[("near_end.force", 0.2)]).unwrap();
    let measured = |of: &Experiment, seed| {
        let data = Truth::of(of, &SPEEDS_M_S).measured(seed);
        data.only(&[Observable::Incident])
    };
    let said = |own: &[String]| {
        let chains = Chains { own, ..chains(&dry_model, &wet_model) };
        let gauge = Gauge::new(&chains, measured(&dry_model, 11), measured(&held, 12)).unwrap();
        let verdict = gauge.verdict(&known_oils().unwrap()).unwrap();
        (verdict.sentence(), gauge.doubts(&verdict, None))
    };
    let (sentence, doubts) = said(&[]);
    assert!(sentence.starts_with("None of these"));
    assert!(doubts.unwrap().contains("--own near_end.force"));
    let (sentence, doubts) = said(&push);
    assert!(sentence.starts_with("Of the known oils only pump oil"));
    assert_eq!(doubts, None);
}

/// Who gives the wet table for the dry one reads so, and of no liquid.
#[test]
fn a_wet_curve_in_the_dry_ones_place_is_told() {
    let (dry_model, wet_model) = (preset("dry").unwrap(), preset("pump").unwrap());
    let chains = chains(&dry_model, &wet_model);
    let reported = |[dry, wet]: [&Experiment; 2]| {
        let gauge = Gauge::new(
            &chains,
            Truth::of(dry, &SPEEDS_M_S).measured(21),
            Truth::of(wet, &SPEEDS_M_S).measured(22),
        );
        let gauge = gauge.unwrap();
        gauge.doubts(&gauge.verdict(&[]).unwrap(), None)
    };
    let swapped = reported([&wet_model, &dry_model]).unwrap();
    assert!(swapped.contains("--dry names the curve of the dry chain"), "{swapped}");
    assert_eq!(reported([&dry_model, &wet_model]), None);
}

/// What is done already is not advised: a load for each chain, but returns are used.
#[test]
fn with_loads_of_their_own_the_advice_is_to_leave_returns_out() {
    let paper = preset("paper").unwrap();
    let [dry_model, wet_model] = ["dry", "pump"].map(|name| paper.case(name).unwrap().unwrap());
    let chains = Chains { own: &["near_end.force".to_owned()], ..chains(&dry_model, &wet_model) };
    let measured = |of: &Experiment, seed| Truth::of(of, &SPEEDS_M_S).measured(seed);
    let gauge = Gauge::new(&chains, measured(&dry_model, 31), measured(&wet_model, 32)).unwrap();
    let [motor, pump] = [0, 2].map(|at| known_oils().unwrap().remove(at));
    let doubts = |oil| gauge.doubts(&gauge.verdict(&[oil]).unwrap(), None);
    let of_none = doubts(motor).unwrap();
    assert!(of_none.contains("incident times alone (--use incident)"), "{of_none}");
    assert!(!of_none.contains("--own"), "{of_none}");
    assert_eq!(doubts(pump), None);
}

#[test]
fn stiffness_and_relaxation_time_come_back_speed_by_speed() {
    let pump = preset("pump").unwrap();
    let gauge = gauge(wet(&pump, 3), 3);
    let oil = known_oils().unwrap().remove(2);
    for row in gauge.rows() {
        let contact = row.contact.unwrap();
        let (k, a) = oil.contact(gauge.radius_m, row.speed_m_s);
        let covariance = contact.first.covariance;
        for (of, exact) in [k, a].into_iter().enumerate() {
            let pull = (contact.first.ln[of] - exact.ln()) / covariance[of][of].sqrt();
            // Sixteen numbers: of a hundred seeds one would fail.
            assert!(pull.abs() < 3.5, "{}: {of}: {pull}", row.speed_m_s);
        }
        assert!(contact.combination.is_none());
    }
    assert_eq!(gauge.to_add(), None);
}

/// Below 0.15 m/s another pair has the smaller A: neighbours determine which is the true one.
#[test]
fn of_several_pairs_that_of_the_smooth_curve_is_taken() {
    let pump = preset("pump").unwrap();
    let noise = Noise { speed_m_s: 1e-5, time_s: 1e-8, correlation: 0.0 };
    let wet = Truth::of(&pump, &speeds_between(0.09, 0.6, 7)).measured_with(noise, 5);
    let gauge = gauge(wet, 5);
    let oil = known_oils().unwrap().remove(2);
    let mut smaller = 0;
    for row in gauge.rows() {
        let contact = row.contact.unwrap();
        let exact = oil.contact(gauge.radius_m, row.speed_m_s).1.ln();
        let miss = |pair: &Pair| (pair.ln[1] - exact).abs();
        for other in &contact.others {
            assert!(miss(&contact.first) < miss(other), "{}: {contact:?}", row.speed_m_s);
            smaller += usize::from(other.ln[1] < contact.first.ln[1]);
        }
    }
    assert!(smaller >= 2, "the smallest A would have done as well");
}

/// At these speeds the true pair lies between pairs that belong to nothing.
#[test]
fn the_true_pair_is_among_those_of_two_times() {
    let pump = preset("pump").unwrap();
    let noise = Noise { speed_m_s: 1e-5, time_s: 1e-8, correlation: 0.0 };
    let wet = Truth::of(&pump, &[0.0759, 0.0967, 0.1251]).measured_with(noise, 8);
    let gauge = gauge(wet, 8);
    let oil = known_oils().unwrap().remove(2);
    let rows = gauge.rows();
    for row in &rows {
        let contact = row.contact.as_ref().unwrap();
        let (k, a) = oil.contact(gauge.radius_m, row.speed_m_s);
        // Within three of the pair's own errors, which the dry numbers' dominate.
        let is_true = |pair: &Pair| {
            let [(own_k, k_error), (own_a, a_error)] = pair.estimates();
            (own_k - k).abs() < 3.0 * k_error && (own_a - a).abs() < 3.0 * a_error
        };
        assert!(contact.pairs().into_iter().any(is_true), "{row:?}");
        assert_eq!(contact.is_complete, Some(true), "{row:?}");
    }
    let open = rows.iter().filter(|row| !row.contact.as_ref().unwrap().is_known());
    assert!(open.count() > 0, "{rows:?}");
    let reported = gauge.ambiguous(&rows).unwrap();
    assert!(reported.contains("Branch ambiguous at 0.0759"), "{reported}");
}

/// A ratio of peaks beside both times: a third equation for two numbers.
#[test]
fn a_row_that_no_pair_gives_is_told_as_such() {
    let pump = preset("pump").unwrap();
    let truth = Truth::of(&pump, &[0.0967]);
    let reported = |times: f64| {
        let noise = Noise { speed_m_s: 1e-5, time_s: 1e-8, correlation: 0.0 };
        let mut wet = truth.measured_with(noise, 9);
        let ratio = times * truth.curve[0][3].unwrap();
        wet.rows[0].values[3] = Some(Estimate { value: ratio, sigma: 0.005 * ratio });
        gauge(wet, 9).rows().remove(0).contact
    };
    let contact = reported(1.0).unwrap();
    let (_, a) = known_oils().unwrap().remove(2).contact(6.35e-3 / 2.0, 0.0967);
    assert!(contact.pairs().iter().any(|pair| (pair.ln[1] - a.ln()).abs() < 0.1), "{contact:?}");
    let why = reported(3.0).unwrap_err();
    assert!(why.contains("does not follow"), "{why}");
}

#[test]
fn incident_times_alone_tell_one_combination_and_what_to_add() {
    let pump = preset("pump").unwrap();
    let gauge = gauge(wet(&pump, 4).only(&[Observable::Incident]), 4);
    let oil = known_oils().unwrap().remove(2);
    for row in gauge.rows() {
        let contact = row.contact.unwrap();
        let combination = contact.combination.unwrap();
        let (k, a) = oil.contact(gauge.radius_m, row.speed_m_s);
        let exact = k.ln() + combination.exponent * (a / combination.reference_s).ln();
        // The exponent is that at the dry A; to the pump oil's A, up to four times as
        // large, it bends the combination by some percent.
        assert!((contact.first.ln[0] - exact).abs() < 0.1, "{}: {combination:?}", row.speed_m_s);
    }
    assert!(gauge.to_add().unwrap().contains("reflected"));
}

#[test]
fn a_users_oil_may_be_given_by_its_contact() {
    let text = "name,stiffness_prefactor,stiffness_exponent,relaxation_prefactor_s,relaxation_exponent\n\
                mine,9e9,-0.1,8e-7,-0.2\n";
    let oil = &oils("mine.csv", text).unwrap()[0];
    assert_eq!(oil.contact(0.003, 1.0), (9e9, 8e-7));
    for (row, words) in [
        (",9e9,0,8e-7,0", "without a name"),
        ("mine,9e9,0,,", "expected either"),
        ("mine,fast,0,8e-7,0", "`fast` is no number"),
        ("mine,-1,0,8e-7,0", "expected more than 0"),
        ("mine,9e9,-0.1,8e-7,-0.2\nmine,8e9,,8e-7,", "mine stands in the table twice"),
    ] {
        let text = text.replace("mine,9e9,-0.1,8e-7,-0.2", row);
        let error = oils("mine.csv", &text).unwrap_err().to_string();
        let line = format!("mine.csv, line {}", 1 + row.lines().count());
        assert!(error.contains(&line) && error.contains(words), "{error}");
    }
    let text =
        "name,young_modulus_pa,poisson_prefactor,viscosity_prefactor_pa_s\nmine,2e11,1.2,6e4\n";
    let error = oils("mine.csv", text).unwrap_err().to_string();
    let reported = "mine.csv, line 2: poisson_prefactor is 1.2";
    assert!(error.starts_with(reported), "{error}");
}

//! The gauge with a stated form: K and A as power laws of speed.

use crate::common::{Truth, model, speeds_m_s};
use hertzchain_experiment::preset;
use hertzchain_infer::gauge::{Chains, Description, Gauge, Law, Oil, PowerForm, known_oils};
use hertzchain_infer::{Data, Observable};

/// K₀ in N/m^{3/2}, k, A₀ in s, a: a liquid whose contacts are power laws.
const MINE: [f64; 4] = [8.6e9, -0.03, 8.5e-7, -0.25];

const INCIDENT: [Observable; 1] = [Observable::Incident];

fn mine() -> Oil {
    let law = |at: usize| Law {
        prefactor: MINE[at],
        exponent: MINE[at + 1],
    };
    Oil {
        name: "mine".to_owned(),
        description: Description::Contact {
            stiffness: law(0),
            relaxation_s: law(2),
        },
        source: String::new(),
    }
}

fn gauge(wet: Data, speeds: &[f64], seed: u64) -> Gauge {
    let (dry_model, wet_model) = (preset("dry").unwrap(), preset("pump").unwrap());
    let free = ["aisi316.eta".to_owned(), "dry.B".to_owned()];
    let chains = Chains {
        dry: &dry_model,
        wet: &wet_model,
        free: &free,
        own: &[],
        accuracy: 1e-5,
    };
    let dry = Truth::of(&dry_model, speeds).measured(seed);
    Gauge::new(&chains, dry, wet).unwrap()
}

/// What is measured of the liquid, at the paper's noise.
fn measured(speeds: &[f64], seed: u64) -> Data {
    let wet = model(&preset("pump").unwrap(), &["wet.K:power", "wet.A:power"]);
    Truth::at(&wet, &MINE, speeds).measured(seed)
}

/// How far laws are from the true ones, in their errors.
fn pulls(form: &PowerForm) -> [f64; 4] {
    let exact = [MINE[0].ln(), MINE[1], MINE[2].ln(), MINE[3]];
    let sd = form.sd();
    [0, 1, 2, 3].map(|at| (form.values[at] - exact[at]) / sd[at])
}

fn said(gauge: &Gauge, form: &PowerForm) -> String {
    let mut oils = known_oils().unwrap();
    oils.push(mine());
    gauge.verdict_of_laws(form, &oils).unwrap().sentence()
}

#[test]
fn laws_come_back_from_incident_times_alone_and_name_the_liquid() {
    let speeds = speeds_m_s(16);
    let gauge = gauge(measured(&speeds, 101).only(&INCIDENT), &speeds, 1);
    assert!(gauge.to_add().unwrap().contains("--form power"));
    let form = gauge.power_form().unwrap();
    for pull in pulls(&form) {
        // Of a thousand seeds, four numbers each, two would fail.
        assert!(pull.abs() < 3.5, "{pull}: {form:?}");
    }
    assert_eq!(form.undetermined, Vec::<String>::new());
    // K at the middle of the speeds, where it is known best, is told to percents.
    let middle = form.at(0.3);
    assert!(middle.ln_sd[0] < 0.05, "{middle:?}");
    let exact = MINE[0].ln() + MINE[1] * 0.3_f64.ln();
    assert!(
        (middle.ln[0] - exact).abs() < 3.5 * middle.ln_sd[0],
        "{middle:?}"
    );
    let said = said(&gauge, &form);
    assert!(said.starts_with("It is mine"), "{said}");
}

#[test]
fn reflected_times_make_the_laws_tighter() {
    let speeds = speeds_m_s(8);
    let (both, one) = (
        measured(&speeds, 102),
        measured(&speeds, 102).only(&INCIDENT),
    );
    let [both, one] = [both, one].map(|wet| gauge(wet, &speeds, 2).power_form().unwrap());
    for (pull, at) in pulls(&both).into_iter().zip(0..) {
        assert!(pull.abs() < 3.5, "{pull}: {both:?}");
        // By far: what incident times confuse, returns tell.
        assert!(
            both.sd()[at] < 0.5 * one.sd()[at],
            "{:?} {:?}",
            both.sd(),
            one.sd()
        );
    }
}

/// The paper's oils are power laws of viscosity and Poisson ratio, not of K and A.
#[test]
fn the_papers_oils_are_recognised_by_the_laws_they_would_give_and_an_unknown_one_is_none() {
    let speeds = speeds_m_s(7);
    let unknown = preset("motor").unwrap();
    let unknown = unknown.set(&[("motor-oil.young_modulus", 205e9)]).unwrap();
    for (seed, (experiment, begins)) in [
        (preset("motor").unwrap(), "It is motor oil"),
        (preset("gear").unwrap(), "It is gear oil"),
        (preset("pump").unwrap(), "It is pump oil"),
        (unknown, "None of these"),
    ]
    .into_iter()
    .enumerate()
    {
        let wet = Truth::of(&experiment, &speeds).measured(200 + seed as u64);
        let gauge = gauge(wet, &speeds, 20 + seed as u64);
        let form = gauge.power_form().unwrap();
        let said = said(&gauge, &form);
        assert!(said.starts_with(begins), "{begins}: {said} {form:?}");
    }
}

#[test]
fn too_few_numbers_for_both_laws_are_told() {
    let speeds = [0.2, 0.5, 1.0];
    let gauge = gauge(measured(&speeds, 3).only(&INCIDENT), &speeds, 3);
    let error = gauge.power_form().unwrap_err().to_string();
    assert!(error.contains("3 measured values for 4 numbers"), "{error}");
}

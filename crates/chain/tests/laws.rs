//! What every law of the registry must obey.

use crate::common;
use crate::common::ensemble::{fire_one, settings};
use crate::common::{close, cubic, hertz, row, viscoelastic};
use hertzchain_chain::laws::{
    Closed, Columns, DampingCubic, LAWS, Law, Nature, Parameter, Source, law,
};
use hertzchain_chain::{BeadPair, InstructionSet, System};
use std::sync::Arc;

/// A law with every required parameter at a value of the right size.
fn sample(row: &hertzchain_chain::laws::Row) -> Arc<dyn Law> {
    let value = |p: &Parameter| match p.name {
        "yield_pressure" => 1e9,
        "volume" => 1e-10,
        "exponent" => 1.8,
        "rate_exponent" => 1.3,
        name if name.contains("ratio") => 0.2,
        _ => p.least.max(1.0) * 50.0,
    };
    let given: Vec<_> = row
        .info
        .parameters
        .iter()
        .filter(|p| matches!(p.source, Source::Required | Source::Liquid))
        .map(|p| (p.name, value(p)))
        .collect();
    row.build(&given).unwrap()
}

/// Laws that push: a bridge has tests of its own.
fn pushing() -> impl Iterator<Item = &'static hertzchain_chain::laws::Row> {
    let pulls = [Nature::Dissipative, Nature::Adhesive];
    LAWS.iter().filter(move |row| !pulls.contains(&row.info.nature))
}

fn columns(law: &dyn Law) -> Columns {
    let pair =
        BeadPair { left: common::STEEL, right: common::STEEL, radius_m: 3e-3, mass_kg: 4e-3 };
    Columns::from_rows(&[law.coefficients(&pair).unwrap()])
}

#[test]
fn elastic_force_is_the_derivative_of_the_energy() {
    for row in pushing() {
        let law = sample(row);
        let k = columns(&*law);
        for overlap in [1e-9_f64, 1e-7, 3e-6, 2e-5] {
            // Unloading from twice as deep, where a law remembers.
            let largest = 2.0 * overlap;
            let step = 1e-4 * overlap;
            let energy = |d: f64| law.energy(&k, 0, d, largest);
            let slope = (8.0 * (energy(overlap + step) - energy(overlap - step))
                - energy(overlap + 2.0 * step)
                + energy(overlap - 2.0 * step))
                / (12.0 * step);
            let closed = Closed { largest, ..Closed::new(overlap, 0.0) };
            let force = law.force(&k, 0, closed);
            // Five-point slope at 1e-4: rounding 1e-12, and the kink where
            // an unloaded contact lets go.
            assert!(
                (slope - force).abs() <= 1e-9 * force.abs(),
                "{}: {slope} {force}",
                row.info.name
            );
        }
    }
}

#[test]
fn dissipation_is_never_negative() {
    for row in LAWS.iter().filter(|row| row.info.nature == Nature::Dissipative) {
        let law = sample(row);
        let k = columns(&*law);
        for overlap in [0.0, 1e-9, 1e-6, 1e-4] {
            for rate in [-2.0, -1e-3, 0.0, 1e-3, 2.0] {
                let power = law.force(&k, 0, Closed::new(overlap, rate)) * rate;
                assert!(power >= 0.0, "{} at {overlap} and {rate}: {power}", row.info.name);
            }
        }
    }
}

#[test]
fn a_loading_and_unloading_cycle_loses_energy_where_a_contact_remembers() {
    for row in LAWS.iter().filter(|row| row.info.nature == Nature::ElasticPlastic) {
        let law = sample(row);
        let k = columns(&*law);
        let (deepest, steps) = (2e-5, 20_000);
        let depth = |i: i32| deepest * f64::from(i) / f64::from(steps);
        let force = |overlap, largest: f64| {
            law.force(&k, 0, Closed { largest, ..Closed::new(overlap, 0.0) })
        };
        let loading: f64 = (0..steps).map(|i| force(depth(i), depth(i))).sum();
        let unloading: f64 = (0..steps).map(|i| force(depth(i), deepest)).sum();
        assert!(unloading < 0.9 * loading, "{}", row.info.name);
        assert!(
            (force(deepest, deepest) / force(depth(steps - 1), depth(steps - 1)) - 1.0).abs()
                < 1e-3
        );
    }
}

#[test]
fn elastic_laws_give_no_force_at_zero_overlap() {
    for row in pushing() {
        let law = sample(row);
        assert_eq!(law.force(&columns(&*law), 0, Closed::new(0.0, 1.0)), 0.0, "{}", row.info.name);
    }
}

/// Two bodies at a distance, moving apart or together, feel nothing.
#[test]
fn no_gated_law_acts_across_a_gap() {
    use hertzchain_chain::{Chain, FarEnd, Gap, Initial, Section, Start};
    for row in LAWS.iter().filter(|row| row.info.gated) {
        let section = Section { contacts: 0..=2, laws: vec![sample(row)], material: None };
        let chain = Chain {
            start: Start::Free,
            far: FarEnd::Free,
            sections: vec![section],
            gaps: vec![Gap { contact: 1, gap_m: 1e-3 }],
            initial: vec![Initial { bead: 1, displacement_m: 0.0, velocity_m_s: 0.5 }],
            ..common::row(2, 1.0, vec![])
        };
        let outcome = common::run_for(&chain, 1e-8, 1e-3);
        assert_eq!(outcome.velocity_m_s[1..3], [0.5, 0.0], "{}", row.info.name);
    }
}

#[test]
fn columns_give_the_same_bits_as_single_contacts() {
    for row in LAWS {
        let law = sample(row);
        let pair = |radius_m| BeadPair {
            left: common::STEEL,
            right: common::STEEL,
            radius_m,
            mass_kg: 4e-3,
        };
        let rows: Vec<_> =
            (1..=9).map(|i| law.coefficients(&pair(1e-3 * f64::from(i))).unwrap()).collect();
        let k = Columns::from_rows(&rows);
        let overlap: Vec<f64> = (0..9).map(|i| 1e-6 * f64::from(i)).collect();
        let root: Vec<f64> = overlap.iter().map(|d| d.sqrt()).collect();
        let rate: Vec<f64> = (0..9).map(|i| 0.1 * f64::from(i - 4)).collect();
        let seen = hertzchain_chain::laws::Contacts {
            overlap: &overlap,
            root: &root,
            rate: &rate,
            largest: &overlap,
        };
        for set in InstructionSet::available() {
            let mut forces = [0.0_f64; 9];
            law.add_forces(set, &k, 0, seen, &mut forces);
            for i in 0..9 {
                let single = 0.0 + law.force(&k, i, Closed::new(overlap[i], rate[i]));
                let (bits, name) = (single.to_bits(), row.info.name);
                assert_eq!(forces[i].to_bits(), bits, "{name} with {}", set.name());
            }
        }
    }
}

#[test]
fn every_law_cites_an_entry_of_the_bibliography() {
    let bibliography = include_str!("../../../references.bib");
    for row in LAWS {
        let key = format!("{{{},", row.info.reference);
        assert!(bibliography.contains(&key), "{} cites {}", row.info.name, row.info.reference);
    }
}

#[test]
fn a_missing_an_unknown_and_an_impossible_parameter_are_refused() {
    let cubic = hertzchain_chain::laws::find("damping_cubic").unwrap();
    let message = |given: &[(&str, f64)]| cubic.build(given).unwrap_err().to_string();
    assert!(message(&[]).contains("needs `coefficient`"));
    assert!(message(&[("coeficient", 1.0)]).contains("no parameter `coeficient`"));
    assert!(message(&[("coefficient", -1.0)]).contains("at least 0"));
    assert!(message(&[("coefficient", f64::NAN)]).contains("finite"));
}

/// Restitution of two equal balls under one damping law beside Hertz's.
fn restitution(damping: Arc<dyn Law>, speed: f64, tension: hertzchain_chain::Tension) -> f64 {
    use hertzchain_chain::FarEnd;
    let chain = hertzchain_chain::Chain {
        far: FarEnd::Free,
        tension,
        ..common::row(1, speed, vec![common::hertz(), damping])
    };
    let outcome = common::run_for(&chain, 1e-11, 1e-3);
    let balance = outcome.budget.unwrap().relative_residual();
    assert!(
        balance.abs() < 1e-9,
        "energy residual {balance:e} at {speed} {tension:?} {:?}",
        outcome.work
    );
    (outcome.velocity_m_s[1] - outcome.velocity_m_s[0]) / speed
}

#[test]
fn restitution_of_every_damping_law_matches_an_independent_integration() {
    use hertzchain_chain::Tension::{Allowed, Clipped};
    let text = include_str!("../../../bench/reference/numbers.json");
    let cases: serde_json::Value = serde_json::from_str(text).unwrap();
    let mut seen = 0;
    for row in LAWS.iter().filter(|row| row.info.nature == Nature::Dissipative) {
        let name = format!("restitution/{}", row.info.name);
        let Some(case) = cases.as_array().unwrap().iter().find(|case| case["case"] == *name) else {
            // Forces of `damping_viscoelastic` with another factor, which a test below holds, and of
            // `damping_cubic`, also across gaps.
            let of_others = ["damping_brilliantov_1996", "damping_cubic_ungated"];
            assert!(
                of_others.contains(&row.info.name),
                "{name}: no case in bench/reference; add one, or the law to these with what holds it"
            );
            continue;
        };
        let given = parameters(row, &case["parameters"]);
        for (speed, label) in [(0.1, "0.1"), (0.5, "0.5")] {
            let law = || row.build(&given).unwrap();
            let expected = common::reference(&name, &format!("restitution_at_{label}_m_s"));
            // Both integrations are right to about 1e-9.
            close(restitution(law(), speed, Allowed), expected, 2e-8);
            let clipped = common::reference(&name, &format!("restitution_clipped_at_{label}_m_s"));
            close(restitution(law(), speed, Clipped), clipped, 2e-8);
            seen += 1;
        }
    }
    assert!(seen >= 10, "only {seen} comparisons");
}

/// Law parameters from the symbols of the reference case.
fn parameters<'a>(
    row: &'a hertzchain_chain::laws::Row,
    from: &serde_json::Value,
) -> Vec<(&'a str, f64)> {
    let symbols = |name: &str| match name {
        "relaxation_time" => vec!["A_s"],
        "damping_ratio" => vec!["alpha"],
        "coefficient" => vec!["gamma", "c", "B"],
        "overlap_exponent" => vec!["overlap_exponent"],
        "rate_exponent" => vec!["rate_exponent"],
        _ => vec![],
    };
    let value = |name| symbols(name).into_iter().find_map(|symbol| from[symbol].as_f64());
    row.info.parameters.iter().filter_map(|p| Some((p.name, value(p.name)?))).collect()
}

/// [Thornton1997]'s closed form, held against the work of the law by the
/// reference program.
#[test]
fn restitution_of_an_elastic_plastic_collision_matches_its_closed_form() {
    let row = hertzchain_chain::laws::find("elastic_plastic_thornton").unwrap();
    for (speed, label) in [(0.5, "0.5"), (1.0, "1.0")] {
        let laws = vec![row.build(&[("yield_pressure", 3e9)]).unwrap()];
        let chain = hertzchain_chain::Chain {
            far: hertzchain_chain::FarEnd::Free,
            ..common::row(1, speed, laws)
        };
        let outcome = common::run_for(&chain, 1e-11, 1e-3);
        let restitution = (outcome.velocity_m_s[1] - outcome.velocity_m_s[0]) / speed;
        let quantity = format!("restitution_closed_form_at_{label}_m_s");
        let expected = common::reference("restitution/elastic_plastic_thornton", &quantity);
        close(restitution, expected, 1e-8);
        let budget = outcome.budget.unwrap();
        assert!(budget.dissipated[0].energy_j > 0.0);
        assert!(budget.relative_residual().abs() < 1e-9, "{budget:?}");
    }
}

#[test]
fn viscoelastic_damping_with_time_and_stiffness_given_needs_no_material() {
    let rigid = BeadPair {
        left: hertzchain_chain::Material::RIGID,
        right: hertzchain_chain::Material::RIGID,
        radius_m: 0.25,
        mass_kg: 0.5,
    };
    for name in ["damping_viscoelastic", "damping_brilliantov_1996"] {
        let row = hertzchain_chain::laws::find(name).unwrap();
        let law = row.build(&[("relaxation_time", 0.5), ("stiffness", 4.0)]);
        // (3/2) A K, exact in binary.
        assert_eq!(law.unwrap().coefficients(&rigid).unwrap(), [3.0], "{name}");
    }
}

/// Sums that the ensemble loop runs in one go, in another order law by law.
#[test]
fn fused_sums_are_those_of_their_laws() {
    let idle = law(DampingCubic { coefficient_kg_s_m2: 0.0 });
    let sums = [
        (vec![hertz()], vec![hertz(), idle]),
        (vec![hertz(), viscoelastic()], vec![viscoelastic(), hertz()]),
        (vec![hertz(), viscoelastic(), cubic()], vec![cubic(), hertz(), viscoelastic()]),
    ];
    for (fused, by_law) in sums {
        let fly = |laws| {
            let system = System::new(&row(12, 0.5, laws)).unwrap();
            fire_one(&system, (0.05, 1e-3), &settings(12)).velocity_m_s
        };
        for (one, other) in fly(fused).into_iter().zip(fly(by_law)) {
            assert!((one - other).abs() < 1e-12, "{one} {other}");
        }
    }
}

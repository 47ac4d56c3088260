//! Which K a damping law has that shares it with the elastic contact.

use crate::{Experiment, Mistakes};
use hertzchain_chain::laws::{LAWS, Nature, Source};
use hertzchain_chain::wave::{Limits, Method, run};
use hertzchain_chain::{Chain, System};
use std::f64::consts::PI;

/// Laws that share K, with what else they need.
const SHARING: [&str; 5] = [
    "law = \"damping_viscoelastic\", relaxation_time",
    "law = \"damping_brilliantov_1996\", relaxation_time",
    "law = \"damping_tsuji\", damping_ratio",
    "law = \"film_entrained\", viscosity",
    "law = \"film_drained\", viscosity",
];

const STEEL: &str = "[materials.steel]\nyoung_modulus = \"213 GPa\"\npoisson_ratio = 0.3\n";

fn dimensionless(laws: &str) -> Result<Experiment, Mistakes> {
    let text = format!(
        "units = \"dimensionless\"\n[striker]\nspeed = 1\n[[beads]]\n[[contacts]]\nlaws = [{laws}]\n\
         [far_end]\nkind = \"free\"\n"
    );
    Experiment::from_text("stiffness.toml", &text)
}

fn steel(laws: &str) -> Result<Experiment, Mistakes> {
    let text = format!(
        "{STEEL}[striker]\nspeed = \"0.5 m/s\"\n[[beads]]\nradius = \"6.35 mm\"\nmass = \"8.54 g\"\n\
         material = \"steel\"\n[[contacts]]\nlaws = [{laws}]\n[far_end]\nkind = \"free\"\n"
    );
    Experiment::from_text("stiffness.toml", &text)
}

fn chain(experiment: Result<Experiment, Mistakes>) -> Chain {
    experiment.unwrap().chain(None).unwrap().0
}

/// The number that the last law of contact 0 hands to the wave loop.
fn coefficient(chain: &Chain) -> f64 {
    let law = chain.sections[0].laws.last().unwrap();
    law.coefficients(&chain.pair(0).unwrap()).unwrap()[0]
}

/// K that the last law works with in a chain: its number over that with K = 1,
/// squared where the equation has the root.
fn stiffness(chain: &Chain, with_one: &Chain) -> f64 {
    let ratio = coefficient(chain) / coefficient(with_one);
    match chain.sections[0].laws.last().unwrap().info().name {
        "damping_tsuji" => ratio * ratio,
        _ => ratio,
    }
}

/// K in a dimensionless chain of `elastic`, a sharing law and what it is given.
fn stiffness_without_units(elastic: &str, law: &str, given: &str) -> f64 {
    let of = |given: &str| chain(dimensionless(&format!("{elastic}, {{ {law} = 0.3{given} }}")));
    stiffness(&of(given), &of(", stiffness = 1"))
}

/// The same in N/m^{3/2} between balls of steel.
fn stiffness_of_steel(elastic: &str, law: &str, given: &str) -> f64 {
    let value = match law {
        law if law.contains("ratio") => "0.3",
        law if law.contains("viscosity") => "\"1 Pa s\"",
        _ => "\"1 us\"",
    };
    let of = |given: &str| chain(steel(&format!("{elastic}, {{ {law} = {value}{given} }}")));
    stiffness(&of(given), &of(", stiffness = \"1 N/m^(3/2)\""))
}

fn close(value: f64, expected: f64, relative: f64) {
    let off = (value / expected - 1.0).abs();
    assert!(off <= relative, "{value} is not {expected}: {off:e}");
}

#[test]
fn every_law_that_shares_k_is_tested_here() {
    let sharing = LAWS.iter().filter(|row| {
        let mut parameters = row.info.parameters.iter();
        parameters.any(|p| p.source == Source::Hertz && p.name == "stiffness")
    });
    let names: Vec<&str> = sharing.map(|row| row.info.name).collect();
    assert_eq!(names.len(), SHARING.len(), "{names:?}");
    // A law beside an elastic one whose equation names K has the contact's.
    let of_k = LAWS.iter().filter(|row| {
        let beside = matches!(row.info.nature, Nature::Dissipative | Nature::WithState);
        beside && row.info.equation.contains('K')
    });
    let of_k: Vec<&str> = of_k.map(|row| row.info.name).collect();
    assert_eq!(of_k, names);
}

#[test]
fn restitution_of_a_stiff_dimensionless_contact_is_tsuji_s_closed_form() {
    let ratio: f64 = 0.5;
    let laws = "{ law = \"elastic_hertz\", stiffness = 4 }, \
                { law = \"damping_tsuji\", damping_ratio = 0.5 }";
    let system = System::new(&chain(dimensionless(laws))).unwrap();
    let scheme = Method::dormand_prince(1e-11);
    // A contact of K = 4 and m = 1 is over after about 2.
    let outcome = run(&system, &scheme, Limits::until(10.0), &mut []).unwrap();
    let restitution = outcome.velocity_m_s[1] - outcome.velocity_m_s[0];
    let expected = (-PI * ratio / (5.0 - ratio * ratio).sqrt()).exp();
    // The integration is right to about 1e-9.
    close(restitution, expected, 1e-8);
}

#[test]
fn damping_takes_the_stiffness_that_elastic_hertz_gives() {
    let hertz = |value: &str| format!("{{ law = \"elastic_hertz\", stiffness = {value} }}");
    for law in SHARING {
        // Roundings of a few products and a root.
        let found = stiffness_without_units(&hertz("4"), law, "");
        close(found, 4.0, 1e-14);
        let found = stiffness_of_steel(&hertz("\"1e9 N/m^(3/2)\""), law, "");
        close(found, 1e9, 1e-14);
    }
}

#[test]
fn what_a_damping_law_is_given_itself_goes_before() {
    let hertz = "{ law = \"elastic_hertz\", stiffness = 4 }";
    for law in SHARING {
        let found = stiffness_without_units(hertz, law, ", stiffness = 9");
        // Roundings of a few products and a root.
        close(found, 9.0, 1e-14);
    }
}

#[test]
fn where_no_stiffness_is_given_the_materials_or_one_decide() {
    let hertz = "\"elastic_hertz\"";
    let of_steel = chain(steel(hertz)).pair(0).unwrap().hertz_stiffness();
    for law in SHARING {
        // Roundings of a few products and a root.
        close(stiffness_without_units(hertz, law, ""), 1.0, 1e-14);
        close(stiffness_of_steel(hertz, law, ""), of_steel, 1e-14);
    }
}

#[test]
fn stiffnesses_of_several_hertz_laws_add_or_must_all_be_given() {
    let law = SHARING[0];
    // The second one has K = 1 in a chain without materials.
    let hertz = "{ law = \"elastic_hertz\", stiffness = 4 }, \"elastic_hertz\"";
    let found = stiffness_without_units(hertz, law, "");
    // Roundings of a few products.
    close(found, 5.0, 1e-14);

    let hertz = hertz.replace("= 4", "= \"1e9 N/m^(3/2)\"");
    let laws = format!("{hertz}, {{ {law} = \"1 us\" }}");
    let refused = steel(&laws).unwrap_err().to_string();
    let words = ["`damping_viscoelastic` is not clear", "expected a `stiffness`"];
    assert!(words.iter().all(|w| refused.contains(w)), "{refused}");
}

#[test]
fn sections_do_not_share_their_stiffness_with_others() {
    let damping = "{ law = \"damping_viscoelastic\", relaxation_time = 0.3 }";
    let laws = format!(
        "{{ law = \"elastic_hertz\", stiffness = 4 }}]\nto = 0\n[[contacts]]\nfrom = 1\n\
         laws = [\"elastic_hertz\", {damping}"
    );
    let text = format!(
        "units = \"dimensionless\"\n[striker]\nspeed = 1\n[[beads]]\ncount = 2\n[[contacts]]\n\
         laws = [{laws}]\n"
    );
    let both = chain(Experiment::from_text("stiffness.toml", &text));
    let law = both.sections[1].laws.last().unwrap();
    let number = law.coefficients(&both.pair(1).unwrap()).unwrap()[0];
    // (3/2) A K with K = 1: roundings of two products.
    close(number, 0.45, 1e-14);
}

/// Beads of two sizes before a plane.
fn unlike(laws: &str) -> Result<Experiment, Mistakes> {
    let text = format!(
        "{STEEL}shear_viscosity = \"3e4 Pa s\"\n[striker]\nspeed = \"0.5 m/s\"\nmass = \"5 g\"\n[[beads]]\nrepeat = 2\n\
         cell = [{{ radius = \"6 mm\", mass = \"5 g\", material = \"steel\" }}, \
         {{ radius = \"3 mm\", mass = \"1 g\", material = \"steel\" }}]\n\
         [[contacts]]\nlaws = [{laws}]\n[far_end]\nkind = \"plane\"\n"
    );
    Experiment::from_text("stiffness.toml", &text)
}

/// The first number of each contact's first and last law.
fn coefficients(experiment: &Experiment) -> Vec<[f64; 2]> {
    let (chain, _) = experiment.chain(None).unwrap();
    let of = |contact: usize| {
        let mut all = chain.sections.iter();
        let section = all.find(|section| section.contacts.contains(&contact)).unwrap();
        let pair = chain.pair(contact).unwrap();
        [section.laws.first(), section.laws.last()]
            .map(|law| law.unwrap().coefficients(&pair).unwrap()[0])
    };
    (0..=chain.beads.len()).map(of).collect()
}

#[test]
fn a_number_with_its_contact_scales_the_others_and_one_without_holds_for_all() {
    let laws = |hertz: &str, damping: &str| {
        let text = format!(
            "{{ law = \"elastic_hertz\"{hertz} }}, {{ law = \"damping_viscoelastic\"{damping} }}"
        );
        coefficients(&unlike(&text).unwrap())
    };
    let own = laws("", "");
    let k = own[2][0];
    let stiffer = laws(&format!(", stiffness = \"{} N/m^1.5\", contact = 2", 2.0 * k), "");
    for (at, (stiffer, own)) in stiffer.iter().zip(&own).enumerate() {
        // Roundings of a few products; the damping has the contact's K.
        close(stiffer[0] / own[0], 2.0, 1e-14);
        close(stiffer[1] / own[1], 2.0, 1e-14);
        assert_eq!(stiffer[0] == 2.0 * k, (1..=3).contains(&at), "{at}");
    }
    // Written out beside the damping, the same K gives the same chain.
    let scaled = format!(", stiffness = \"{} N/m^1.5\", contact = 2", 2.0 * k);
    assert_eq!(laws(&scaled, &scaled), stiffer);
    let one = laws(&format!(", stiffness = \"{k} N/m^1.5\""), "");
    assert!(one.iter().all(|of| of[0] == k));
    let slower = laws("", ", relaxation_time = \"1 us\", contact = 1");
    for (slower, own) in slower.iter().zip(&own) {
        // A is of the material alone, and one material has one A.
        close(slower[0], own[0], 0.0);
        close(slower[1], 1.5 * 1e-6 * own[0], 1e-9 * own[0]);
    }
}

#[test]
fn setting_what_materials_give_keeps_ratios_and_what_the_file_gives_its_one_value() {
    let bare = unlike("\"elastic_hertz\"").unwrap();
    let path = "contacts[0].laws.elastic_hertz.stiffness";
    let reference = bare.reference(path).unwrap();
    assert_eq!((reference.contact, reference.contacts), (Some(1), 0..=4));
    let own = coefficients(&bare);
    let set = |experiment: &Experiment, value: f64| {
        let changed = experiment.set(&[(path, value)]).unwrap();
        (coefficients(&changed), changed)
    };
    let (same, again) = set(&bare, own[1][0]);
    // The reference contact's own number gives the contacts' own, to the last digit.
    assert_eq!(same[1], own[1]);
    let (twice, _) = set(&again, 2.0 * own[1][0]);
    for (twice, own) in twice.iter().zip(&own) {
        close(twice[0] / own[0], 2.0, 1e-14);
    }
    let given = unlike("{ law = \"elastic_hertz\", stiffness = \"5e9 N/m^1.5\" }").unwrap();
    assert_eq!(given.reference(path).unwrap().contact, None);
    let (one, _) = set(&given, 6e9);
    assert!(one.iter().all(|of| of[0] == 6e9));
}

#[test]
fn a_contact_outside_the_chain_or_without_a_number_of_materials_is_refused() {
    let refused = |laws: &str| format!("{:?}", unlike(laws).unwrap_err());
    let beyond = "{ law = \"elastic_hertz\", stiffness = \"5e9 N/m^1.5\", contact = 9 }";
    assert!(refused(beyond).contains("contact 9 is outside the chain"));
    let cubic = "\"elastic_hertz\", { law = \"damping_cubic\", coefficient = 1, contact = 1 }";
    assert!(refused(cubic).contains("has no parameter `contact`"));
    let idle = "{ law = \"elastic_hertz\", contact = 1 }";
    assert!(refused(idle).contains("says whose value"), "{}", refused(idle));
}

//! The files that come with the program, against the numbers they stand for.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::{examples, film_presets, preset, presets};
use hertzchain_chain::{Bead, BeadPair, Chain, FarEnd, Material, Start};

fn chain(name: &str, speed_m_s: Option<f64>) -> Chain {
    preset(name).unwrap().chain(speed_m_s).unwrap().0
}

fn relative(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

/// Two equal spheres in contact.
fn pair(material: Material, radius_m: f64, mass_kg: f64) -> BeadPair {
    BeadPair { left: material, right: material, radius_m: radius_m / 2.0, mass_kg: mass_kg / 2.0 }
}

#[test]
fn every_file_parses_without_warnings_and_has_its_name() {
    for file in presets().iter().chain(film_presets()).chain(examples()) {
        let experiment = preset(file.name).unwrap();
        let (chain, warnings) = experiment.chain(None).unwrap();
        assert!(!chain.beads.is_empty());
        assert_eq!(experiment.name(), format!("{}.toml", file.name));
        assert_eq!(experiment.title(), file.title());
        assert_eq!(experiment.text(), file.text);
        assert!(warnings.is_empty(), "{}: {warnings:?}", file.name);
    }
}

#[test]
fn dry_chain_has_the_stiffness_and_relaxation_time_of_its_steel() {
    let chain = chain("dry", None);
    let bead = chain.beads[0];
    let pair = pair(bead.material, bead.radius_m, bead.mass_kg);
    // Eleven digits are known of each.
    assert!(relative(pair.hertz_stiffness(), 8.792_630_379_6e9) < 1e-11);
    assert!(relative(bead.material.relaxation_time_s(), 3.385_289_514_9e-7) < 1e-10);
    assert_eq!(bead.mass_kg, 0.00854);
    assert_eq!(bead.radius_m, 0.00635);
    assert_eq!(chain.beads.len(), 40);
    assert!(
        matches!(chain.start, Start::Striker { bead: b, speed_m_s } if b == bead && speed_m_s == 0.5)
    );
    assert!(matches!(chain.far, FarEnd::HalfBead { radius_m, .. } if radius_m == 0.00635));
}

#[test]
fn losses_of_the_paper_s_dry_chains_are_those_of_their_names() {
    let laws = |name: &str| {
        let chain = chain(name, None);
        assert_eq!(chain.sections.len(), 1);
        assert_eq!(chain.sections[0].contacts, 0..=40);
        let names = chain.sections[0].laws.iter().map(|law| law.info().name);
        names.collect::<Vec<_>>()
    };
    assert_eq!(laws("hertz"), ["elastic_hertz"]);
    assert_eq!(laws("hertz-viscoelastic"), ["elastic_hertz", "damping_viscoelastic"]);
    assert_eq!(laws("dry"), ["elastic_hertz", "damping_viscoelastic", "damping_cubic"]);
}

#[test]
fn oils_follow_the_printed_power_laws_of_speed() {
    let table = [
        ("motor", 193e9, 66177.1, -0.206, 0.360, -0.165, 0.057_718),
        ("gear", 225e9, 107_299.0, -0.640, 0.390, -0.127, 0.119_434),
        ("pump", 216e9, 81405.3, -0.302, 0.314, -0.274, 0.047_85),
    ];
    for (name, young, eta, eta_power, nu, nu_power, dynamic) in table {
        let chain = chain(name, Some(0.25));
        let [dry, wet] = &chain.sections[..] else { panic!("{name} has two sections") };
        assert_eq!((dry.contacts.clone(), wet.contacts.clone()), (0..=6, 7..=40));
        assert_eq!((dry.laws.len(), wet.laws.len()), (3, 2));
        assert!(dry.material.is_none());
        let oil = wet.material.unwrap();
        assert_eq!(oil.young_modulus_pa, young);
        assert_eq!(oil.poisson_ratio, nu * 0.25f64.powf(nu_power));
        assert_eq!(oil.shear_viscosity_pa_s, eta * 0.25f64.powf(eta_power));
        assert_eq!(oil.bulk_viscosity_pa_s, oil.shear_viscosity_pa_s);
        let experiment = preset(name).unwrap();
        let liquid = experiment.liquid().unwrap().dynamic_viscosity_pa_s().unwrap();
        // The products of the printed values, by hand, to their last digit.
        assert!(relative(liquid, dynamic) < 1e-5, "{name}: {liquid}");
    }
}

#[test]
fn an_effective_poisson_ratio_above_one_half_is_a_warning() {
    let (_, warnings) = preset("pump").unwrap().chain(Some(0.075)).unwrap();
    assert_eq!(warnings.len(), 1);
    let line = warnings[0].one_line();
    assert!(line.contains("`pump-oil` is 0.638503 at 0.075 m/s"), "{line}");
    assert!(warnings[0].text().contains("prefactor = 0.314"));
    // 0.314 v^-0.274 reaches 1/2 at 0.183 m/s.
    assert!(preset("pump").unwrap().chain(Some(0.184)).unwrap().1.is_empty());
}

#[test]
fn dimer_repeats_its_cell_and_takes_masses_from_densities() {
    let chain = chain("dimer-steel-ptfe", None);
    assert_eq!(chain.beads.len(), 40);
    let steel = 4.0 / 3.0 * std::f64::consts::PI * 4.76e-3f64.powi(3) * 8000.0;
    // One rounding a product.
    assert!(relative(chain.beads[0].mass_kg, steel) < 1e-15);
    assert!(relative(chain.beads[1].mass_kg / steel, 2178.0 / 8000.0) < 1e-15);
    assert_eq!(chain.beads[38], chain.beads[0]);
    assert_eq!(chain.beads[39], chain.beads[1]);
    assert!(
        matches!(chain.far, FarEnd::HalfBead { material, .. } if material == chain.beads[0].material)
    );
}

#[test]
fn tapered_radii_are_a_geometric_series_from_the_striker_on() {
    let chain = chain("tapered", None);
    let Start::Striker { bead, .. } = chain.start else { panic!("a striker") };
    for (index, found) in chain.beads.iter().enumerate() {
        let radius = bead.radius_m * 0.95f64.powi(index as i32 + 1);
        // A power against products: a few roundings.
        assert!(relative(found.radius_m, radius) < 1e-14);
        assert!(relative(found.mass_kg / bead.mass_kg, (radius / bead.radius_m).powi(3)) < 1e-14);
    }
}

#[test]
fn vertical_chain_stands_upright_on_a_half_space() {
    let chain = chain("vertical-on-specimen", None);
    // 90 · π/180 is rounded twice.
    assert!((chain.incline_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert!(matches!(chain.far, FarEnd::Plane { material } if material.young_modulus_pa == 3.1e9));
}

#[test]
fn an_unknown_preset_names_the_nearest() {
    let error = preset("pmup").unwrap_err();
    let text = error.to_string();
    assert!(text.contains("hertz-viscoelastic") && text.contains("did you mean `pump`"), "{text}");
}

/// Hertz stiffness of two bodies, as the laws of a contact see them.
fn stiffness(chain: &Chain, contact: usize, left: &Bead, right: (f64, Material)) -> f64 {
    let section = chain.sections.iter().find(|s| s.contacts.contains(&contact));
    let pair = BeadPair {
        left: left.material,
        right: right.1,
        radius_m: (1.0 / left.radius_m + 1.0 / right.0).recip(),
        mass_kg: left.mass_kg,
    };
    section.unwrap().laws[0].coefficients(&pair).unwrap()[0]
}

#[test]
fn examples_have_the_masses_and_stiffnesses_of_an_independent_program() {
    let body = |bead: &Bead| (bead.radius_m, bead.material);
    // Sixteen digits of the other program; the order of products differs.
    let same = |found: f64, expected: f64| assert!(relative(found, expected) < 4e-15, "{found}");

    let dimer = chain("dimer-steel-ptfe", None);
    let [steel, ptfe, ..] = &dimer.beads[..] else { panic!("two beads") };
    same(steel.mass_kg, 0.003614094086506307);
    same(ptfe.mass_kg, 0.000983937115051342);
    same(stiffness(&dimer, 1, steel, body(ptfe)), 119414718.64581832);

    let intruder = chain("light-intruder", None);
    assert_eq!((intruder.beads.len(), intruder.beads[19].mass_kg), (40, 0.0010675));
    let light = stiffness(&intruder, 20, &intruder.beads[19], body(&intruder.beads[20]));
    same(light, 7179152642.276926);

    let pressed = chain("precompressed", None);
    same(pressed.beads[0].mass_kg, 0.00208568241876724);
    let uniform = stiffness(&pressed, 1, &pressed.beads[0], body(&pressed.beads[1]));
    same(uniform, 7404415573.845457);
    assert_eq!(pressed.push.force_n(), 30.0);

    let heavy = chain("heavy-striker", None);
    let Start::Striker { bead, .. } = &heavy.start else { panic!("a striker") };
    same(bead.mass_kg, 5.0 * 0.00854);
    same(stiffness(&heavy, 0, bead, body(&heavy.beads[0])), 9877478598.039879);

    let vertical = chain("vertical-on-specimen", None);
    let last = vertical.beads.last().unwrap();
    let FarEnd::Plane { material } = vertical.far else { panic!("a plane") };
    same(last.mass_kg, 0.02823437411966145);
    same(stiffness(&vertical, 20, last, (f64::INFINITY, material)), 452179960.5782284);
}

#[test]
fn a_vertical_chain_rests_under_its_own_weight() {
    let (system, _) = preset("vertical-on-specimen").unwrap().system(None).unwrap();
    let overlap = |contact| system.static_contact(contact).overlap_m;
    // The law is inverted by bisection; the other program takes a power.
    assert!(relative(overlap(1), 9.303316424286104e-8) < 1e-13);
    assert!(relative(overlap(19), 6.624303059702357e-7) < 1e-13);
}

#[test]
fn an_exponent_section_has_its_own_law_in_its_own_unit() {
    let chain = chain("exponent-section", None);
    let ranges: Vec<_> = chain.sections.iter().map(|s| s.contacts.clone()).collect();
    assert_eq!(ranges, [0..=14, 15..=25, 26..=40]);
    let pair = pair(chain.beads[0].material, 0.00635, 0.00854);
    let law = &chain.sections[1].laws[0];
    assert_eq!(law.coefficients(&pair).unwrap(), [2.5e12, 2.0]);
}

//! Liquids: viscosity over temperature, and what a film takes from them.

use super::mistakes::{check, only};
use crate::{Experiment, film_presets, preset};

fn viscosity(oil: &str, temperature: &str) -> f64 {
    let film = preset(&format!("{oil}-film")).unwrap();
    let film = film.set_text(&[("liquid.temperature", temperature)]).unwrap();
    film.liquid().unwrap().dynamic_viscosity_pa_s().unwrap()
}

#[test]
fn an_oil_has_its_two_viscosities_at_their_temperatures() {
    // Rounding of two logarithms.
    let near =
        |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-12, "{found}");
    near(viscosity("gear", "40 degC"), 133e-6 * 898.0);
    near(viscosity("gear", "313.15 K"), 133e-6 * 898.0);
    // The density falls by 6.5e-4 of itself a kelvin.
    near(viscosity("gear", "100 °C"), 14.5e-6 * 898.0 * (1.0 - 0.039));
}

#[test]
fn viscosities_between_agree_with_another_program() {
    // bench/film/oils.py at 20, 25 and 40 °C.
    for (oil, expected) in [
        ("pump", [0.1450318980970267, 0.10651219017730396, 0.04784999999999999]),
        ("motor", [0.14452855599823528, 0.11239436038140822, 0.05771809999999997]),
        ("gear", [0.40776289343228117, 0.29017480580863025, 0.11943399999999993]),
    ] {
        for (temperature, expected) in ["20 degC", "25 degC", "40 degC"].iter().zip(expected) {
            let found = viscosity(oil, temperature);
            assert!((found / expected - 1.0).abs() < 1e-12, "{oil} at {temperature}: {found}");
        }
    }
}

/// The film's η in Pa s and α in 1/Pa of an experiment.
fn film(experiment: &Experiment) -> Vec<f64> {
    let mut laws = experiment.sections().iter().flat_map(|section| &section.laws);
    let film = laws.find(|law| law.name() == "film_entrained").unwrap();
    film.given.iter().map(|(_, value)| *value).collect()
}

#[test]
fn a_film_takes_from_the_liquid_what_its_law_leaves_out() {
    let pump = preset("pump-film").unwrap();
    assert_eq!(film(&pump), [viscosity("pump", "25 degC"), 16e-9]);
    let own = pump.set(&[("viscosity", 0.2)]).unwrap();
    assert_eq!(film(&own), [0.2, 16e-9]);
    let thinner = pump.set(&[("liquid.temperature", 313.15)]).unwrap();
    assert!((film(&thinner)[0] / 0.04785 - 1.0).abs() < 1e-9, "{:?}", film(&thinner));
    // The oil of a case is that of its contacts, the file's own too.
    let cases = "[[campaign.cases]]\nname = \"hot\"\n\
                 liquid = { kinematic_viscosity = \"10 cSt\", density = \"1 g/ml\", pressure_viscosity = \"9 1/GPa\" }\n";
    let text = format!("{}\n{cases}", pump.text());
    let case = Experiment::from_text("cases.toml", &text).unwrap().case("hot").unwrap().unwrap();
    let [viscosity, thickening] = film(&case)[..] else { panic!("{:?}", film(&case)) };
    assert!((viscosity / 0.01 - 1.0).abs() < 1e-12 && thickening == 9e-9, "{viscosity}");
}

#[test]
fn an_oil_that_lacks_what_a_film_needs_is_a_mistake_at_the_film() {
    let text = film_presets()[0].text;
    let at = 1 + text.lines().position(|line| line.contains("\"film_entrained\"")).unwrap();
    let without = |key: &str| {
        let kept = text.lines().map(|line| if line.starts_with(key) { "" } else { line });
        kept.collect::<Vec<_>>().join("\n")
    };
    let words = ["needs `viscosity`", "\"… Pa s\"", "kinematic_viscosity_40"];
    check(&only(&without("density")), at, "\"film_entrained\"", &words);
    let words = ["needs `pressure_viscosity`", "\"… 1/Pa\"", "0 for an oil"];
    check(&only(&without("pressure_viscosity")), at, "\"film_entrained\"", &words);
}

#[test]
fn viscosities_that_do_not_go_together_are_mistakes_at_their_place() {
    let text = film_presets()[0].text;
    let changed = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        only(&text.replacen(from, to, 1)).one_line()
    };
    let has = |line: String, words: &str| assert!(line.contains(words), "{line}");
    has(changed("kinematic_viscosity_100 =", "# "), "the viscosity at 100 °C is missing");
    has(changed("\"7.7 cSt\"", "\"77 cSt\""), "not thinner at 100 °C");
    has(changed("[liquid]\n", "[liquid]\nkinematic_viscosity = \"9 cSt\"\n"), "has no temperature");
    let one = text.replacen("kinematic_viscosity_100 =", "# ", 1);
    let one = only(&one.replacen("kinematic_viscosity_40 =", "kinematic_viscosity =", 1));
    has(one.one_line(), "one viscosity does not say what it is at this temperature");
    has(changed("\"7.7 cSt\"", "\"0.7 cSt\""), "must be from 2 cSt to 2e7 cSt");
    has(changed("\"25 degC\"", "\"25\""), "`temperature` has no unit");
    has(changed("\"25 degC\"", "\"25 K\""), "must be from -50 degC to 200 degC");
    has(changed("\"25 degC\"", "\"25 s\""), "expected a temperature in K, such as \"25 degC\"");
}

/// A film and a bridge of a liquid with these keys.
fn bridged(liquid: &str) -> String {
    let text = film_presets()[0].text.replacen("[liquid]\n", &format!("[liquid]\n{liquid}\n"), 1);
    text.replacen("\"film_entrained\"", "\"film_entrained\", \"capillary_bridge\"", 1)
}

#[test]
fn a_bridge_takes_surface_and_volume_from_the_liquid() {
    let bridge = |experiment: &Experiment| {
        let mut laws = experiment.sections().iter().flat_map(|section| section.laws.clone());
        laws.find(|law| law.name() == "capillary_bridge").unwrap().given
    };
    let text = bridged("surface_tension = \"30 mN/m\"\nvolume = \"0.1 µl\"");
    let oil = Experiment::from_text("bridge.toml", &text).unwrap();
    assert_eq!(bridge(&oil), [("surface_tension", 0.03), ("volume", 1e-10)]);
    let wetting = oil.set_text(&[("liquid.contact_angle", "30 deg")]).unwrap();
    assert_eq!(bridge(&wetting)[2].0, "contact_angle");
    // 2πRγ cos θ in each contact of the row's wet section, at rest beside 0.24 N.
    let (chain, _) = wetting.chain(None).unwrap();
    let system = hertzchain_chain::System::new(&chain).unwrap();
    let [dry, wet] = [3, 20].map(|contact| system.static_contact(contact).overlap_m);
    let pull_n = 2.0 * std::f64::consts::PI * 6.35e-3 * 0.03 * 0.75_f64.sqrt();
    // A difference of two overlaps, to 1e-13 of each.
    let more = (wet / dry).powf(1.5) - 1.0;
    assert!((more / (pull_n / 0.24) - 1.0).abs() < 1e-9, "{more}");
}

#[test]
fn a_liquid_without_volume_or_with_a_negative_one_is_a_mistake() {
    let problem = only(&bridged("surface_tension = \"30 mN/m\"")).one_line();
    assert!(problem.contains("needs `volume`"), "{problem}");
    let problem = only(&bridged("volume = \"-1 µl\"")).one_line();
    assert!(problem.contains("0 or more"), "{problem}");
    let problem = only(&bridged("contact_angle = \"91 deg\"")).one_line();
    assert!(problem.contains("between 0 and 90 deg"), "{problem}");
    let problem = only(&bridged("volume = \"1 mm\"")).one_line();
    assert!(problem.contains("expected a volume"), "{problem}");
}

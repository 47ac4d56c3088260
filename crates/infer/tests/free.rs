//! Names of free numbers.

use hertzchain_experiment::preset;
use hertzchain_infer::{Form, FreeNumber, FreeNumbers, Model, Speeds};

fn starts(name: &str, asked: &str) -> Vec<(String, f64)> {
    let number = FreeNumber::find(&preset(name).unwrap(), asked, None).unwrap();
    let parameters = number.parameters(&[0.1, 1.0]);
    parameters.into_iter().map(|p| (p.name, p.start)).collect()
}

fn refused(name: &str, asked: &str) -> String {
    let number = FreeNumber::find(&preset(name).unwrap(), asked, None);
    number.unwrap_err().to_string()
}

#[test]
fn short_names_and_paths_name_the_same_numbers() {
    let one = |name: &str, value: f64| vec![(name.to_owned(), value)];
    assert_eq!(starts("dry", "eta"), one("eta", 3.2e4));
    assert_eq!(starts("dry", "shear_viscosity"), one("shear_viscosity", 3.2e4));
    assert_eq!(starts("dry", "B"), one("B", 77.0));
    assert_eq!(starts("pump", "pump-oil.Y"), one("pump-oil.Y", 216e9));
    assert_eq!(starts("pump", "dry.B"), one("dry.B", 77.0));
    assert_eq!(starts("dry", "wall_gain"), one("wall_gain", 1.0));
    assert_eq!(starts("dry", "eta1"), one("eta1", 3.2e4));
    // The bulk viscosity is the shear one where the file gives none.
    assert_eq!(starts("dry", "eta2"), one("eta2", 3.2e4));
    // The file has four materials, its dry chain one.
    assert_eq!(starts("paper", "eta"), one("eta", 3.2e4));
    assert_eq!(starts("paper", "preload"), one("preload", 0.24));
    // A film's own, where [liquid] gives them.
    let oil = preset("pump-film").unwrap().liquid().unwrap().dynamic_viscosity_pa_s().unwrap();
    assert_eq!(starts("pump-film", "viscosity"), one("viscosity", oil));
    let path = "contacts[1].laws.film_entrained.pressure_viscosity";
    assert_eq!(starts("pump-film", path), one(path, 16e-9));
    assert_eq!(starts("pump-film", "pressure_viscosity"), one("pressure_viscosity", 16e-9));
}

#[test]
fn stiffness_and_relaxation_time_start_where_the_materials_put_them() {
    // DESIGN: K and A of the paper's dry contacts.
    let (k, a) = (starts("dry", "K")[0].1, starts("dry", "A")[0].1);
    assert!((k / 8.792_630_379_6e9 - 1.0).abs() < 1e-9, "{k}");
    assert!((a / 3.385_289_514_9e-7 - 1.0).abs() < 1e-9, "{a}");
}

#[test]
fn laws_of_speed_stay_laws_and_become_one_value_a_speed_if_asked() {
    let law =
        vec![("wet.eta.prefactor".to_owned(), 81405.3), ("wet.eta.exponent".to_owned(), -0.302)];
    assert_eq!(starts("pump", "wet.eta"), law);
    let each = starts("pump", "wet.eta:each");
    let expected = 81405.3 * 0.1_f64.powf(-0.302);
    assert_eq!(each[0], ("wet.eta@0.1".to_owned(), expected));
    assert_eq!(each[1], ("wet.eta@1".to_owned(), 81405.3));
    let number = FreeNumber::find(&preset("dry").unwrap(), "eta:each", None).unwrap();
    let named = |speeds: &[f64]| -> Vec<String> {
        let parameters = number.parameters(speeds);
        parameters.into_iter().map(|p| p.name).collect()
    };
    assert_eq!(named(&[0.084271312, 1.23]), ["eta@0.08427", "eta@1.23"]);
    assert_eq!(named(&[0.500001, 0.500002]), ["eta@0.500001", "eta@0.500002"]);
    let number = FreeNumber::find(&preset("dry").unwrap(), "K:power", None).unwrap();
    assert_eq!((number.form, number.parameters(&[]).len()), (Form::PowerLaw, 2));
}

#[test]
fn what_can_not_be_free_is_told_with_what_could() {
    let ambiguous = refused("pump", "eta");
    assert!(ambiguous.contains("aisi316.eta") && ambiguous.contains("pump-oil.eta"), "{ambiguous}");
    let ambiguous = refused("pump", "K");
    assert!(
        ambiguous.contains("contacts[0].K") && ambiguous.contains("contacts[1].K"),
        "{ambiguous}"
    );
    assert_eq!(refused("hertz", "B"), "B: this experiment has no cubic damping");
    assert!(refused("dry", "preload").contains("[near_end]"));
    assert!(refused("dry", "young_modulu").contains("did you mean"));
    assert!(refused("dry", "beads[0].count").contains("counts something"));
    assert!(refused("dry", "eta:linear").contains("expected `power` or `each`"));
    assert!(refused("dry", "incline").contains("--start incline=VALUE"));
    let dry = preset("dry").unwrap();
    let twice = ["eta", "aisi316.eta"].map(|name| FreeNumber::find(&dry, name, None).unwrap());
    let error = FreeNumbers::new(twice.into()).unwrap_err();
    assert!(error.to_string().contains("are the same number"), "{error}");
}

#[test]
fn a_law_as_parameters_is_the_law_of_the_file() {
    let pump = preset("pump").unwrap();
    let numbers = ["wet.eta", "wet.nu"].map(|name| FreeNumber::find(&pump, name, None).unwrap());
    let numbers = FreeNumbers::new(numbers.into()).unwrap();
    let point: Vec<f64> = numbers.parameters(&[]).iter().map(|p| p.start).collect();
    assert_eq!(point, [81405.3, -0.302, 0.314, -0.274]);
    let speeds = Speeds::of_rows(&[0.3, 0.9]);
    let free = Model::new(&pump, numbers).unwrap().curves(&[point], &speeds);
    let none = FreeNumbers::new(Vec::new()).unwrap();
    let fixed = Model::new(&pump, none).unwrap().curves(&[Vec::new()], &speeds);
    let both = free[0].clone().unwrap().into_iter().zip(fixed[0].clone().unwrap());
    for (free, fixed) in both {
        // v^b computed by us or by the experiment: the same digits but the last,
        // which a row of 40 contacts may make ten thousand times as large.
        assert!((free[0].unwrap() / fixed[0].unwrap() - 1.0).abs() < 1e-11);
    }
}

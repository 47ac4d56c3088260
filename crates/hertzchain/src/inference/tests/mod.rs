use super::*;
use crate::options::FitOptions as Fit;
use crate::options::parsed as arguments;

fn fit(more: &[&str]) -> Fit {
    let begin = ["data.csv", "--preset=dry", "--free=eta"];
    let words = begin.iter().chain(more).map(|word| (*word).to_owned());
    arguments("fit", &words.collect::<Vec<_>>()).unwrap()
}

#[test]
fn a_number_that_use_names_and_the_table_has_not_is_told() {
    let text =
        "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error\n0.3,1e-3,7e-4,1e-7\n";
    let reported = |words: &[&str]| {
        let measured = fit(words).measured;
        let data = parsed("a.csv", text, &measured, None).unwrap();
        assumed(&data, &measured)
    };
    let why = reported(&["--use=incident,returning-ratio"]).unwrap();
    let column = Observable::ReturningOverPassing.column();
    assert!(why.starts_with(&format!("a.csv: --use asks for `{column}`")), "{why}");
    // No user asked for reflected times by name.
    assert_eq!(reported(&[]), None);
    assert_eq!(reported(&["--use=incident"]), None);
}

#[test]
fn numbers_are_set_by_short_names_too_and_mistakes_stand_on_the_command_line() {
    let set = |words: &str| experiment(&fit(&[&format!("--set={words}")]).modelled, None);
    let cubic = "contacts[0].laws.damping_cubic.coefficient";
    for name in ["B", "damping_cubic.coefficient"] {
        let changed = set(&format!("{name}=50 kg s/m^2")).unwrap();
        assert_eq!(changed.get(cubic).unwrap(), 50.0);
    }
    let wet = ["data.csv", "--preset=motor", "--free=B", "--set=wet.eta=5e4 Pa s"];
    let wet = arguments::<Fit>("fit", &wet.map(str::to_owned)).unwrap();
    let wet = experiment(&wet.modelled, None).unwrap();
    let law = |part: &str| wet.get(&format!("motor-oil.shear_viscosity.{part}")).unwrap();
    assert_eq!((law("prefactor"), law("exponent")), (5e4, 0.0));
    for (words, expected) in [
        ("B=50", "has no unit; expected a cubic damping"),
        ("wall_gain=50", "--free alone knows it"),
        ("nothing=50", "there is no number `nothing`"),
    ] {
        let Err(Failure::User(why)) = set(words) else { unreachable!("{words} was set") };
        assert!(why.starts_with(&format!("--set {words}: ")) && why.contains(expected), "{why}");
    }
}

#[test]
fn a_case_may_be_a_number_and_a_bound_none() {
    let options = serde_json::json!({
        "free": "eta", "case": 1, "bounds": { "eta": [1e4, null], "B": [null, "inf"] }
    });
    let fit: Fit = crate::options::from_json("fit", options).unwrap();
    assert_eq!(fit.measured.case.as_deref(), Some("1"));
    let mut parameters = ["eta", "B"].map(|name| hertzchain_infer::Parameter::new(name, "", 3e4));
    known::apply(&fit.freed, &mut parameters).unwrap();
    let ends = parameters.map(|parameter| [parameter.lower, parameter.upper]);
    assert_eq!(ends, [[1e4, f64::INFINITY], [f64::NEG_INFINITY, f64::INFINITY]]);
}

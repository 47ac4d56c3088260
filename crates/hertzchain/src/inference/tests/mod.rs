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
fn a_short_name_that_is_set_is_told_with_its_path() {
    for (name, words) in [
        ("B", "write --set contacts[0].laws.damping_cubic.coefficient=VALUE"),
        ("eta", "write --set materials.aisi316.shear_viscosity=VALUE"),
        ("wall_gain", "--free alone knows it"),
        ("nothing", "there is no number `nothing`"),
    ] {
        let set = format!("--set={name}=50");
        let modelled = fit(&[&set]).modelled;
        let Err(Failure::User(why)) = experiment(&modelled, None) else {
            unreachable!("{name} was set")
        };
        assert!(why.starts_with(&format!("--set {name}: ")) && why.contains(words), "{why}");
    }
    let path = ["--set=damping_cubic.coefficient=50 kg s/m^2"];
    assert!(experiment(&fit(&path).modelled, None).is_ok());
}

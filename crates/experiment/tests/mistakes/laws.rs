//! Contact laws and their parameters.

use super::{DRY, after, check, line_of, only, refused};
use crate::Experiment;

#[test]
fn a_law_s_missing_parameter_is_shown_with_its_unit() {
    let finding =
        after("{ law = \"damping_cubic\", coefficient = \"77 kg s/m^2\" }", "\"damping_cubic\"");
    let words = ["law `damping_cubic` needs `coefficient`", "kg s/m^2", "coefficient B"];
    check(&finding, line_of("law = \"damping_cubic\""), "\"damping_cubic\"", &words);
}

#[test]
fn laws_and_their_parameters_are_looked_up_in_the_registry() {
    let finding = after("\"elastic_hertz\"", "\"elastic_herz\"");
    let words = ["no law `elastic_herz`", "did you mean `elastic_hertz`", "damping_tsuji"];
    check(&finding, line_of("\"elastic_hertz\""), "\"elastic_herz\"", &words);
    let finding = after("coefficient = \"77 kg s/m^2\"", "coefficient = \"77 kg s/m\"");
    let words = ["`coefficient` is a quantity in kg m^-1 s", "a cubic damping in kg s/m^2"];
    check(&finding, line_of("law = \"damping_cubic\""), "\"77 kg s/m\"", &words);
    let finding =
        after("coefficient = \"77 kg s/m^2\"", "coefficient = \"77 kg s/m^2\", coeff = 1");
    assert!(finding.one_line().contains("no parameter `coeff`"), "{}", finding.one_line());
}

#[test]
fn a_unit_follows_the_exponent_beside_it() {
    let law = |text: &str| DRY.replacen("\"elastic_hertz\"", text, 1);
    let power = |unit: &str, n: &str| {
        law(&format!("{{ law = \"elastic_power\", stiffness = \"1e9 {unit}\", exponent = {n} }}"))
    };
    for (unit, n) in
        [("N/m^1.7", "1.7"), ("N/m^(4/3)", "1.3333333333"), ("N/m", "1"), ("N/mm^2", "2")]
    {
        let file = Experiment::from_text("test.toml", &power(unit, n));
        assert!(file.is_ok(), "{unit}: {}", file.unwrap_err());
    }
    let finding = only(&power("N/m^1.5", "2"));
    assert!(finding.one_line().contains("in N/m^2"), "{}", finding.one_line());
}

#[test]
fn a_law_that_needs_a_material_asks_for_one() {
    let law = "{ law = \"elastic_plastic_thornton\", yield_pressure = 1 }";
    let text = format!(
        "units = \"dimensionless\"\n[striker]\nspeed = 1\n[[beads]]\n[[contacts]]\n\
         laws = [{law}]\n"
    );
    let words = ["can't be used on contact 0", "name one in [[beads]]"];
    check(&refused(&text), 6, law, &words);
}

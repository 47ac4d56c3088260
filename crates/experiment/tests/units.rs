//! Quantities in text against exact decimals and against an independent
//! calculator.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::units::{parse_quantity, parse_unit};
use proptest::prelude::*;

fn value(text: &str) -> f64 {
    parse_quantity(text).unwrap_or_else(|e| panic!("{text}: {e}")).value
}

fn mistake(text: &str) -> String {
    parse_quantity(text).unwrap_err().to_string()
}

#[test]
fn powers_of_ten_are_exact() {
    assert_eq!(value("6.35 mm"), 0.00635);
    assert_eq!(value("8.54 g"), 0.00854);
    assert_eq!(value("213 GPa"), 213e9);
    assert_eq!(value("133 cSt"), 133e-6);
    assert_eq!(value("0.87 g/cm^3"), 870.0);
    assert_eq!(value("5µm"), 5e-6);
    assert_eq!(value("5 μm"), 5e-6);
    assert_eq!(value("5 um"), 5e-6);
    assert_eq!(value("8.79e9 N/m^(3/2)"), 8.79e9);
    assert_eq!(value("8.79e9 N/m^1.5"), 8.79e9);
    assert_eq!(value("1e-3 N s m^-1"), 1e-3);
    assert_eq!(value("77 kg s/m²"), 77.0);
    assert_eq!(value("77 kg·s·m⁻²"), 77.0);
    assert_eq!(value("9.80665 m/s**2"), 9.80665);
    assert_eq!(value("1.5e+2 kN/(mm s)"), 1.5e8);
    assert_eq!(value("-3 mm"), -0.003);
    assert_eq!(value(".5e1"), 5.0);
    assert_eq!(value("1 in"), 0.0254);
    assert_eq!(value("0.1 in"), 0.00254);
    assert_eq!(value("3 min"), 180.0);
    assert_eq!(value("5 %"), 0.05);
    assert!(crate::units::parse_in("5 %", "m/s").is_err());
    assert_eq!(value("2 1/s"), 2.0);
    assert_eq!(value("1 ml"), 1e-6);
    assert_eq!(value("12 dyn/cm"), 12e-3);
    assert_eq!(value("25 degC"), 298.15);
    assert_eq!(value("0 °C"), 273.15);
    // A difference, and a scale that is no factor.
    assert_eq!(value("2 K/s"), 2.0);
    assert!(mistake("2 degC/s").contains("not a known unit"), "{}", mistake("2 degC/s"));
}

#[test]
fn angles_have_a_dimension_of_their_own() {
    assert_eq!(value("180 deg"), std::f64::consts::PI);
    let angle = parse_unit("deg").unwrap().dimension;
    assert!(!angle.agrees_with(&parse_unit("1").unwrap().dimension));
    assert!(
        !parse_unit("rad/s").unwrap().dimension.agrees_with(&parse_unit("Hz").unwrap().dimension)
    );
}

#[test]
fn exponents_of_prefixes_follow_the_unit() {
    // 10^(3/2·3) is irrational: one power and one product.
    let found = value("1 N/mm^(3/2)");
    assert!((found / 1e3f64.powf(1.5) - 1.0).abs() < 4e-16);
    assert_eq!(value("1 N/mm^2"), 1e6);
    assert_eq!(value("4 (mm^2)^(1/2)"), 4e-3);
}

#[test]
fn half_a_unit_of_the_last_digit_is_what_rounding_hides() {
    let half = |text: &str| parse_quantity(text).unwrap().half_digit;
    assert_eq!(half("216 GPa"), 0.5e9);
    assert_eq!(half("6.350 mm"), 0.5e-6);
    assert_eq!(half("0.314"), 0.0005);
    assert_eq!(half("3.2e4 Pa s"), 500.0);
}

#[test]
fn mistakes_say_what_and_where() {
    assert_eq!(mistake("6.35 mn"), "`mn` is not a known unit; did you mean `mN`?");
    assert_eq!(mistake("213 Gpa"), "`Gpa` is not a known unit; did you mean `GPa`?");
    assert_eq!(mistake("nan"), "`nan` is not a finite number");
    assert_eq!(mistake("-inf m"), "`-inf m` is not a finite number");
    assert_eq!(mistake("six mm"), "`six mm` does not start with a number");
    assert_eq!(mistake("1e400 m"), "`1e400 m` is too large a number");
    assert_eq!(mistake("1 m^"), "an exponent such as 2, -1, 1.5 or (3/2) is missing");
    assert_eq!(mistake("1 m^(1/0)"), "an exponent is divided by 0");
    assert_eq!(mistake("1 (m"), "a closing parenthesis is missing");
    assert!(mistake("1 N/m s").contains("two ways"), "{}", mistake("1 N/m s"));
    assert!(mistake("").contains("missing"));
    let error = parse_quantity("6.35 mn").unwrap_err();
    assert_eq!(&"6.35 mn"[error.at], "mn");
}

/// The value of a quantity in SI by another program; it prints ten digits.
fn oracle(text: &str, unit: &str) -> f64 {
    let mut context = fend_core::Context::new();
    let question = format!("({text}) / (1 {unit}) to unitless");
    let answer =
        fend_core::evaluate(&question, &mut context).unwrap_or_else(|e| panic!("{question}: {e}"));
    let number = answer.get_main_result().trim_start_matches("approx. ").to_owned();
    number.parse().unwrap_or_else(|_| panic!("{question} = {number}"))
}

#[test]
fn units_agree_with_an_independent_calculator() {
    for (text, unit) in [
        ("6.35 mm", "m"),
        ("213 GPa", "Pa"),
        ("77 kg s/m^2", "kg s/m^2"),
        ("3.7 uJ", "kg m^2/s^2"),
        ("12 mW", "kg m^2/s^3"),
        ("1.2 bar", "Pa"),
        ("0.8426 g/cm^3", "kg/m^3"),
        ("4.7 kN/mm", "N/m"),
        ("2.5 l", "m^3"),
        ("7 t", "kg"),
        ("45 kHz", "s^-1"),
        ("2.5 h", "s"),
        ("30 deg", "rad"),
        ("2 micron", "m"),
    ] {
        let (ours, theirs) = (value(text), oracle(text, unit));
        // The calculator's ten digits.
        assert!((ours / theirs - 1.0).abs() < 1e-9, "{text}: {ours} against {theirs}");
    }
}

proptest! {
    #[test]
    fn a_prefix_is_a_shift_of_the_decimal_point(digits in 1u64..1_000_000_000, decimals in 0usize..9) {
        let text = format!("{digits}e-{decimals}");
        let shifted = |tens: i64| format!("{digits}e{}", tens - decimals as i64).parse::<f64>().unwrap();
        for (prefix, tens) in [("", 0), ("m", -3), ("µ", -6), ("n", -9), ("k", 3), ("c", -2)] {
            prop_assert_eq!(value(&format!("{text} {prefix}m")), shifted(tens));
        }
    }

    #[test]
    fn any_text_gives_a_finite_quantity_or_a_mistake_within_it(text in ".{0,40}") {
        match parse_quantity(&text) {
            Ok(quantity) => prop_assert!(quantity.value.is_finite()),
            Err(error) => prop_assert!(error.at.end <= text.len(), "{:?}", error),
        }
    }

    #[test]
    fn any_unit_like_text_is_read_or_refused(text in "[0-9.eE+-]{0,6} ?[mkgsNPa/^*()0-9. ²⁻-]{0,24}") {
        if let Ok(quantity) = parse_quantity(&text) {
            prop_assert!(quantity.value.is_finite());
        }
    }
}

use super::*;

#[test]
fn cells_are_short_and_give_the_number_back() {
    for (value, text) in [
        (0.0, "0"),
        (-0.25, "-0.25"),
        (1.1e-4, "1.1e-4"),
        (-3.2e-300, "-3.2e-300"),
        (5e20, "5e20"),
        (630.841591, "630.841591"),
    ] {
        assert_eq!(cell(value), text);
        assert_eq!(text.parse::<f64>().unwrap(), value);
    }
    assert_eq!(cell(f64::NAN), "");
    // The longest numbers have seventeen digits and their exponent.
    assert!(cell(-std::f64::consts::PI * 1e-200).len() < 25);
}

#[test]
fn names_lose_their_units_and_laws_keep_their_names() {
    let json = serde_json::json!({
        "tof_incident_s": 1.0, "rebound": { "end_m_s": 2.0 }, "dissipated_j": { "law_s": 0.0 }, "steps": 3
    });
    let plain = named(json.clone(), Units::Dimensionless);
    let expected = serde_json::json!({
        "tof_incident": 1.0, "rebound": { "end": 2.0 }, "dissipated": { "law_s": 0.0 }, "steps": 3
    });
    assert_eq!(plain, expected);
    assert_eq!(named(json.clone(), Units::Si), json);
}

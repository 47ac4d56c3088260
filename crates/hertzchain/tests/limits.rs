//! Parameters at bounds: a limit on the other side in place of a standard error.

use crate::common::{curve, folder, json, run, with_errors};

#[test]
fn a_parameter_at_its_bound_has_a_limit_by_profile_and_no_standard_error() {
    let folder = folder("limit");
    let data = curve(&folder, "dry");
    // The curve's own B is 77.
    let fit =
        ["fit", &data, "-p", "dry", "--free", "eta,B", "--start", "B=90", "--bounds", "B=78:200"];
    let found = json(&with_errors(&[&fit[..], &["--json"]].concat()));
    let b = &found["parameters"][1];
    assert_eq!((&b["value"], &b["at_bound"]), (&78.0.into(), &true.into()));
    assert!(b["standard_error"].is_null(), "{b}");
    assert_eq!(b["limit"]["side"], "at most");
    let limits = ["percent_68", "percent_95"].map(|share| b["limit"][share].as_f64().unwrap());
    // Without the bound: 77 ± sd. Within it χ² rises from its value at 78, as a parabola around 77.
    let free = json(&with_errors(&[&fit[..6], &["--start", "B=90", "--json"]].concat()));
    // Twelve numbers, and what a bound holds is not fitted.
    let freedom = |of: &serde_json::Value| of["chi_square"]["freedom"].as_u64().unwrap();
    assert_eq!((freedom(&found), freedom(&free)), (11, 10));
    let sd = free["parameters"][1]["standard_error"].as_f64().unwrap();
    let best = free["parameters"][1]["value"].as_f64().unwrap();
    for (limit, rise) in limits.into_iter().zip([1.0, 3.841_459]) {
        let parabola = best + ((78.0 - best).powi(2) + rise * sd * sd).sqrt();
        // The problem is not quite linear over some standard errors.
        assert!((limit - parabola).abs() < 0.05 * sd, "{limit} {parabola} {sd}");
    }
    let text = String::from_utf8(run(&with_errors(&fit)).stdout).unwrap();
    assert!(text.contains("at its bound: at most "), "{text}");
    assert!(text.contains("(95 %) by profile"), "{text}");
    assert!(found["parameters"][0]["limit"].is_null());
}

#[test]
fn an_incline_that_is_none_has_a_limit_too() {
    let data = curve(&folder("limit-incline"), "dry");
    let fit =
        ["fit", &data, "-p", "dry", "--free", "eta,incline", "--start", "incline=1e-3", "--json"];
    let found = json(&with_errors(&fit));
    let incline = &found["parameters"][1];
    assert_eq!(incline["lower"], 0.0);
    let limit = |share: &str| incline["limit"][share].as_f64().unwrap();
    let (narrow, wide) = (limit("percent_68"), limit("percent_95"));
    assert!(0.0 < narrow && narrow < wide, "{incline}");
    // χ² at the limit, by a fit with the incline set there.
    let set = format!("incline={wide}rad");
    let held = ["fit", &data, "-p", "dry", "--free", "eta", "--set", &set, "--json"];
    let held = json(&with_errors(&held));
    let chi_square = |of: &serde_json::Value| of["chi_square"]["value"].as_f64().unwrap();
    let risen = chi_square(&held) - chi_square(&found);
    // What is minimised holds ln σ, which slopes change a little.
    assert!((risen - 3.84).abs() < 0.05, "{risen}");
}

//! design at the command line.

use crate::common::{curve, folder, json, refused, run, with_errors};
use serde_json::Value;

#[test]
fn a_design_ranks_what_to_measure() {
    let folder = folder("design");
    let data = curve(&folder, "dry");
    let design = ["design", &data, "-p", "dry", "--free", "eta,B", "--target", "B", "--json"];
    let found = json(&with_errors(&design));
    let now = found["standard_errors_now"][0].as_f64().unwrap();
    let ranked = found["ranked"].as_array().unwrap();
    assert!(ranked.len() > 30);
    let nats = |one: &Value| one["information_nats"].as_f64().unwrap();
    for pair in ranked.windows(2) {
        // What differs by less than a thousandth ranks by cost.
        assert!(nats(&pair[0]) + 1e-3 >= nats(&pair[1]));
    }
    assert!(ranked[0]["standard_errors"][0].as_f64().unwrap() < now);
    let message = refused(&with_errors(&["design", &data, "--free", "eta", "--target", "B"]));
    assert!(message.contains("--target B is not free; free are eta"), "{message}");
    let fast = ["design", &data, "--free", "eta", "--speeds", "0.1,500"];
    assert!(refused(&with_errors(&fast)).contains("it looks like mm/s"));
    // Errors of what the data leave open are not reported as if they meant something.
    let three = ["design", &data, "--free", "Y,nu,eta"];
    let text = String::from_utf8(run(&with_errors(&three)).stdout).unwrap();
    assert!(text.contains("Not determined so far"), "{text}");
    assert!(text.contains("free K and A instead"), "{text}");
    // Nor is noise ranked: two combinations can be determined, and the third by nothing.
    let found = json(&with_errors(&[&three[..], &["--json"]].concat()));
    let names = serde_json::json!(["combination 1", "combination 2"]);
    assert_eq!(found["parameters"], names);
    let reported = found["not_identifiable"].to_string();
    for words in ["nu up 1.00 % with", "So none of Y, nu, eta can be tightened by itself"] {
        assert!(reported.contains(words), "{words}: {reported}");
    }
    // A start from where no minimum is found determines nothing.
    let far = ["design", &data, "--free", "Y,eta,B", "--start", "B=1e5"];
    let reported = refused(&with_errors(&far));
    assert!(reported.contains("found no minimum"), "{reported}");
}

#[test]
fn a_ranking_by_a_model_that_the_data_do_not_follow_is_told_to_be_worth_no_more() {
    let folder = folder("design-unfit");
    let data = curve(&folder, "dry");
    let ranked = |eta: &str| {
        let eta = format!("shear_viscosity={eta} Pa s");
        let design = ["design", &data, "-p", "dry", "--free", "B", "--speeds", "0.5"];
        let design = with_errors(&[&design[..], &["--set", &eta]].concat());
        let text = String::from_utf8(run(&design).stdout).unwrap();
        (text, json(&[&design[..], &["--json"]].concat()))
    };
    // The curve's own viscosity, and a third of it.
    let (text, found) = ranked("3.2e4");
    assert!(text.starts_with("Now: B"), "{text}");
    assert_eq!(found["follows_data"], true);
    let (text, found) = ranked("1e4");
    assert!(text.starts_with("warning: the model does not follow the data"), "{text}");
    assert_eq!(found["follows_data"], false);
}

#[test]
fn the_unit_of_costs_changes_no_ranking() {
    let folder = folder("design-costs");
    let data = curve(&folder, "dry");
    let ranked = |cost: &str| {
        let costs = ["incident", "reflected", "ratio", "sensor", "preload"];
        let costs = costs.map(|of| format!("{of}={cost}")).join(",");
        let design = ["design", &data, "-p", "dry", "--free", "eta,B", "--target", "B", "--json"];
        let found = json(&with_errors(&[&design[..], &["--costs", &costs]].concat()));
        let names = found["ranked"].as_array().unwrap().iter().map(|one| one["measure"].clone());
        names.collect::<Vec<_>>()
    };
    let plain = ranked("1");
    for cost in ["600", "0.001"] {
        assert_eq!(ranked(cost), plain, "{cost}");
    }
}

#[test]
fn an_error_of_ratios_holds_for_ratios_that_the_table_does_not_have() {
    let folder = folder("design-ratios");
    let data = curve(&folder, "dry");
    let error = |ratio: &str| {
        let design = ["design", &data, "-p", "dry", "--free", "eta,B", "--speeds", "1"];
        let design = [&design[..], &["--target", "B", "--ratio-error", ratio, "--json"]].concat();
        let found = json(&with_errors(&design));
        let ranked = found["ranked"].as_array().unwrap();
        let ratio = ranked.iter().find(|one| one["measure"].as_str().unwrap().contains("ratio"));
        ratio.unwrap()["standard_errors"][0].as_f64().unwrap()
    };
    // Errors of speeds leave less to ratios.
    assert!(error("1e-4") < 0.98 * error("5e-3"));
}

//! What fit, gauge and design write: tables that agree with the JSON.

use crate::common::{curve, folder, json, with_errors};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Lines of a table as cells, quotes taken off.
fn lines(text: &str) -> Vec<Vec<String>> {
    let mut lines = vec![vec![String::new()]];
    let mut quoted = false;
    for letter in text.trim_end_matches('\n').chars() {
        let line = lines.last_mut().unwrap();
        match letter {
            // Two quotes in quotes are one: the first ends, the second begins again.
            '"' => {
                quoted = !quoted;
                let cell = line.last_mut().unwrap();
                if quoted && !cell.is_empty() {
                    cell.push('"');
                }
            }
            ',' if !quoted => line.push(String::new()),
            '\n' if !quoted => lines.push(vec![String::new()]),
            _ => line.last_mut().unwrap().push(letter),
        }
    }
    lines
}

/// A table of a folder: titles, and lines that are all as long.
fn table(folder: &Path, name: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let text = fs::read_to_string(folder.join(name)).unwrap();
    let mut all = lines(&text);
    let titles = all.remove(0);
    assert!(all.iter().all(|line| line.len() == titles.len()), "{name}: {text}");
    (titles, all)
}

/// Whether a column of a table holds what each of these values holds under a key.
fn holds(folder: &Path, name: &str, column: &str, values: &Value, pointer: &str) {
    let (titles, lines) = table(folder, name);
    let at = titles.iter().position(|title| title == column).unwrap();
    let values = values.as_array().unwrap();
    assert_eq!(lines.len(), values.len(), "{name}");
    for (line, value) in lines.iter().zip(values) {
        let value = value.pointer(pointer).unwrap_or(&Value::Null);
        let cell = &line[at];
        let same = match value {
            Value::Null => cell.is_empty(),
            Value::Number(number) => cell.parse::<f64>().ok() == number.as_f64(),
            Value::String(words) => cell == words,
            Value::Bool(is) => cell.parse() == Ok(*is),
            other => unreachable!("{other} is no cell"),
        };
        assert!(same, "{name}, {column}: {cell} is not {value}");
    }
}

/// A matrix of a table.
fn matrix(folder: &Path, name: &str) -> Vec<Vec<f64>> {
    let (_, lines) = table(folder, name);
    let numbers = |line: Vec<String>| line[1..].iter().map(|cell| cell.parse().unwrap()).collect();
    lines.into_iter().map(numbers).collect()
}

fn rows(value: &Value) -> Vec<Vec<f64>> {
    serde_json::from_value(value.clone()).unwrap()
}

#[test]
fn tables_of_a_fit_agree_with_its_json() {
    let folder = folder("tables");
    let data = curve(&folder, "dry");
    let out = folder.join("out");
    let fit = [
        "fit",
        &data,
        "-p",
        "dry",
        "--free",
        "eta,B",
        "--method",
        "profile",
        "--starts",
        "3",
        "--json",
        "--against",
        "hertz-viscoelastic=eta",
        "--against",
        "dry=eta,B",
        "-o",
        out.to_str().unwrap(),
    ];
    let found = json(&with_errors(&fit));
    for column in
        ["name", "unit", "value", "standard_error", "at_bound", "start", "lower", "upper", "scale"]
    {
        holds(&out, "parameters.csv", column, &found["parameters"], &format!("/{column}"));
    }
    assert_eq!(matrix(&out, "covariance.csv"), rows(&found["covariance"]));
    assert_eq!(matrix(&out, "correlation.csv"), rows(&found["correlation"]));
    holds(&out, "singular-values.csv", "singular_value", &found["singular_values"], "");
    holds(&out, "singular-values.csv", "B", &found["directions"], "/1");
    holds(&out, "starts.csv", "eta to (Pa s)", &found["starts"], "/to/0");
    holds(&out, "starts.csv", "cost", &found["starts"], "/cost");
    for (column, pointer) in [
        ("model", "/model"),
        ("aic", "/aic"),
        ("bic", "/bic"),
        ("weight", "/weight"),
        ("prediction_error", "/cross_validation/mean"),
    ] {
        holds(&out, "comparison.csv", column, &found["comparison"]["models"], pointer);
    }
    let curves: Vec<Value> = (found["profiles"].as_array().unwrap().iter())
        .flat_map(|of| of["chi_square_rise"].as_array().unwrap().clone())
        .collect();
    holds(&out, "profiles.csv", "chi_square_rise", &Value::from(curves), "");
    let ends: Vec<Value> = (found["profiles"].as_array().unwrap().iter())
        .flat_map(|of| of["intervals"].as_array().unwrap().clone())
        .collect();
    holds(&out, "intervals.csv", "upper", &Value::from(ends.clone()), "/upper");
    holds(&out, "intervals.csv", "chi_square_rise", &Value::from(ends), "/rise");
    let (_, summary) = table(&out, "summary.csv");
    let chi_square = summary.iter().find(|line| line[0] == "chi_square").unwrap();
    assert_eq!(chi_square[1].parse::<f64>().ok(), found["chi_square"]["value"].as_f64());
    assert_eq!(table(&out, "fit.csv").1.len(), 12);
}

#[test]
fn tables_of_a_posterior_agree_with_its_json_and_with_each_other() {
    let folder = folder("posterior-tables");
    let data = curve(&folder, "dry");
    let out = folder.join("out");
    let fit = [
        "fit",
        &data,
        "-p",
        "dry",
        "--free",
        "eta,B",
        "--method",
        "posterior",
        "--json",
        "-o",
        out.to_str().unwrap(),
    ];
    let found = json(&with_errors(&fit));
    let all = &found["posterior"]["parameters"];
    for (column, pointer) in [
        ("name", "/name"),
        ("mean", "/mean"),
        ("median", "/median"),
        ("lower_68", "/interval_68/0"),
        ("upper_95", "/interval_95/1"),
        ("r_hat", "/r_hat"),
        ("effective_samples", "/effective_samples"),
    ] {
        holds(&out, "posterior.csv", column, all, pointer);
    }
    let (titles, samples) = table(&out, "samples.csv");
    assert_eq!(titles, ["eta (Pa s)", "B (kg s/m^2)"]);
    for at in 0..2 {
        let values = samples.iter().map(|line| line[at].parse::<f64>().unwrap());
        let mean = values.sum::<f64>() / samples.len() as f64;
        let reported = all[at]["mean"].as_f64().unwrap();
        // Sums of the same numbers in another order: rounding.
        assert!((mean / reported - 1.0).abs() < 1e-9, "{mean} {reported}");
    }
}

#[test]
fn tables_of_a_gauge_and_a_design_agree_with_their_json() {
    let folder = folder("other-tables");
    // Few of this oil's speeds allow several pairs: laws go through the others.
    let (dry, motor) = (curve(&folder, "dry"), curve(&folder, "motor"));
    let (run_gauge, run_design) = (folder.join("gauged"), folder.join("designed"));
    let gauge = ["gauge", &motor, "--dry", &dry, "--json", "-o", run_gauge.to_str().unwrap()];
    let found = json(&with_errors(&gauge));
    for (column, pointer) in [
        ("name", "/name"),
        ("distance", "/distance"),
        ("possible", "/possible"),
        ("farthest_standard_errors", "/farthest/standard_errors"),
    ] {
        holds(&run_gauge, "oils.csv", column, &found["oils"], pointer);
    }
    holds(&run_gauge, "dry.csv", "standard_error", &found["dry"], "/standard_error");
    let (titles, pairs) = table(&run_gauge, "contacts.csv");
    let taken = titles.iter().position(|title| title == "taken").unwrap();
    let taken: Vec<_> = pairs.iter().filter(|line| line[taken] == "true").collect();
    let rows = found["contacts"].as_array().unwrap().iter();
    // Where the branch is not known no pair stands before the others.
    let known: Vec<&Value> = rows.filter(|row| row["branch"] != "unknown").collect();
    assert_eq!(taken.len(), known.len());
    for (line, row) in taken.iter().zip(known) {
        assert_eq!(line[2].parse::<f64>().ok(), row["stiffness"]["value"].as_f64());
        assert_eq!(line[4].parse::<f64>().ok(), row["relaxation_time_s"]["value"].as_f64());
    }
    let others = found["contacts"].as_array().unwrap().iter();
    let others: usize = others.map(|row| row["others"].as_array().unwrap().len()).sum();
    assert_eq!(pairs.len(), 6 + others);
    let (_, summary) = table(&run_gauge, "summary.csv");
    assert_eq!(Some(summary[0][1].as_str()), found["verdict"].as_str());

    let design = [
        "design",
        &dry,
        "-p",
        "dry",
        "--free",
        "eta,B",
        "--json",
        "-o",
        run_design.to_str().unwrap(),
    ];
    let found = json(&with_errors(&design));
    for (name, key) in [("design.csv", "ranked"), ("series.csv", "series")] {
        holds(&run_design, name, "measure", &found[key], "/measure");
        holds(&run_design, name, "B_error (kg s/m^2)", &found[key], "/standard_errors/1");
    }
    holds(&run_design, "now.csv", "standard_error", &found["standard_errors_now"], "");
}

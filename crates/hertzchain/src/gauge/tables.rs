//! What the gauge says as tables (CSV), in SI: views of `gauge.json`.

use super::GaugeResult;
use crate::csv::{Column, Table, columns, list, quantities, view};
use hertzchain_infer::gauge::{Branch, Contact, Pair};
use serde_json::{Value, json};

const CONTACTS: &str = "line,speed_m_s,stiffness (N/m^1.5)=k,stiffness_error (N/m^1.5)=k_error,\
     relaxation_time_s=a,relaxation_time_s_error=a_error,ln_covariance,combination_exponent,\
     combination_reference_s,taken,missing,branch,scan_complete";

const FILM: &str = "line,speed_m_s,name=film/name,unit=film/unit,value=film/value,\
     standard_error=film/standard_error,missing";

const OILS: &str = "name,distance,chi_square,freedom,probability,possible,farthest=farthest/what,\
     farthest_standard_errors=farthest/standard_errors";

/// Every table of a result, whose JSON is `found`: files' names and what stands in them.
pub fn tables(run_gauge: &GaugeResult, found: &Value) -> Vec<Table> {
    let mut all = vec![
        ("summary.csv", summary(run_gauge, found)),
        ("dry.csv", view(list(&found["dry"]), &columns("name,unit,value,standard_error"))),
    ];
    if run_gauge.film.is_some() {
        let whole = list(&found["film"]["parameters"]);
        all.push(("contacts.csv", view(list(&found["contacts"]), &columns(FILM))));
        all.push(("film.csv", view(whole, &columns("name,unit,value,standard_error"))));
        return all;
    }
    all.push(("contacts.csv", view(&contacts(run_gauge), &columns(CONTACTS))));
    all.push(("oils.csv", oils(list(&found["oils"]))));
    let failed = list(&found["failed"]);
    all.extend((!failed.is_empty()).then(|| ("failed.csv", view(failed, &columns("name,why")))));
    all
}

fn summary(run_gauge: &GaugeResult, found: &Value) -> String {
    let mut all = found.clone();
    all["dry_goodness"] = json!(run_gauge.gauge.dry_goodness().chi_square.map(|of| json!({
        "value": of.value, "freedom": of.freedom, "probability": of.probability,
    })));
    let mut shown = "verdict,doubts,to_add,dry_chi_square=dry_goodness/value,\
                     dry_freedom=dry_goodness/freedom,dry_probability=dry_goodness/probability"
        .to_owned();
    if run_gauge.film.is_some() {
        shown += ",film_chi_square=film/chi_square,film_freedom=film/freedom,\
                  film_probability=film/probability";
    }
    quantities(&all, &columns(&shown))
}

/// One line a pair of K and A that a speed allows, the one taken first if any is; one line a
/// speed that determines a combination, or nothing.
fn contacts(run_gauge: &GaugeResult) -> Vec<Value> {
    let lines = run_gauge.rows.iter().flat_map(|row| {
        let mut lines = match &row.contact {
            Err(why) => vec![json!({ "missing": why })],
            Ok(contact) => pairs(contact),
        };
        for line in &mut lines {
            (line["line"], line["speed_m_s"]) = (row.line.into(), row.speed_m_s.into());
        }
        lines
    });
    lines.collect()
}

fn pairs(contact: &Contact) -> Vec<Value> {
    let pair = |pair: &Pair| {
        let [(k, k_error), (a, a_error)] = pair.estimates();
        let ln_covariance = pair.covariance[0][1];
        json!({ "k": k, "k_error": k_error, "a": a, "a_error": a_error, "ln_covariance": ln_covariance, "taken": false })
    };
    let mut taken = pair(&contact.first);
    if let Some(combination) = &contact.combination {
        taken = json!({
            "k": taken["k"], "k_error": taken["k_error"],
            "combination_exponent": combination.exponent,
            "combination_reference_s": combination.reference_s,
        });
    }
    taken["taken"] = (contact.branch != Branch::Unknown).into();
    taken["branch"] = contact.branch.name().into();
    taken["scan_complete"] = contact.is_complete.into();
    std::iter::once(taken).chain(contact.others.iter().map(pair)).collect()
}

/// One line an oil, nearest first, with the numbers that it has for itself.
fn oils(oils: &[Value]) -> String {
    let own = list(oils.first().map_or(&Value::Null, |oil| &oil["own"])).iter().enumerate();
    let own = own.flat_map(|(at, own)| -> [Column; 2] {
        let name = own["name"].as_str().unwrap_or_default();
        let place = |key| format!("/own/{at}/{key}");
        [(name.to_owned(), place("value")), (format!("{name} error"), place("standard_error"))]
    });
    view(oils, &columns(OILS).into_iter().chain(own).collect::<Vec<_>>())
}

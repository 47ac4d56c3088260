//! The JSON Schema describes the files that the program reads.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::{Experiment, examples, film_presets, presets, schema};
use hertzchain_chain::laws::LAWS;
use serde_json::{Value, json};

/// The part of JSON Schema that the schema uses; anything else is an error.
fn conforms(value: &Value, schema: &Value) -> Result<(), String> {
    for (keyword, rule) in schema.as_object().unwrap() {
        let conditional = |then| conforms(value, rule).is_ok() == then;
        let holds = match keyword.as_str() {
            "$schema" | "title" | "description" | "examples" => true,
            "if" if conditional(true) => return conforms(value, &schema["then"]),
            "if" => return conforms(value, &schema["else"]),
            "then" | "else" => continue,
            "type" => types(rule).contains(&type_of(value)) || is_whole(value, rule),
            "const" => value == rule,
            "enum" => rule.as_array().unwrap().contains(value),
            "pattern" => value.as_str().is_none_or(starts_with_a_number),
            "minimum" => value.as_f64().is_none_or(|v| v >= rule.as_f64().unwrap()),
            "maximum" => value.as_f64().is_none_or(|v| v <= rule.as_f64().unwrap()),
            "exclusiveMinimum" => value.as_f64().is_none_or(|v| v > rule.as_f64().unwrap()),
            "exclusiveMaximum" => value.as_f64().is_none_or(|v| v < rule.as_f64().unwrap()),
            "minItems" => value.as_array().is_none_or(|v| v.len() as u64 >= rule.as_u64().unwrap()),
            "required" => {
                rule.as_array().unwrap().iter().all(|k| value.get(k.as_str().unwrap()).is_some())
            }
            "items" => {
                for member in value.as_array().into_iter().flatten() {
                    conforms(member, rule)?;
                }
                true
            }
            "properties" if schema.get("additionalProperties").is_some() => true,
            "properties" => rule.as_object().unwrap().iter().all(|(key, rule)| {
                value.get(key).is_none_or(|member| conforms(member, rule).is_ok())
            }),
            "additionalProperties" => return members(value, schema),
            "anyOf" => rule.as_array().unwrap().iter().any(|s| conforms(value, s).is_ok()),
            "oneOf" => {
                rule.as_array().unwrap().iter().filter(|s| conforms(value, s).is_ok()).count() == 1
            }
            other => return Err(format!("unknown keyword {other}")),
        };
        if !holds {
            return Err(format!("{value} does not fit {keyword} {rule}"));
        }
    }
    Ok(())
}

/// Every member by its property, or by `additionalProperties`.
fn members(value: &Value, schema: &Value) -> Result<(), String> {
    if !value.is_object() {
        return Err(format!("{value} is no table"));
    }
    for required in schema.get("required").and_then(Value::as_array).into_iter().flatten() {
        let key = required.as_str().unwrap();
        value.get(key).ok_or(format!("{key} is missing"))?;
    }
    for (key, member) in value.as_object().unwrap() {
        match schema.get("properties").and_then(|p| p.get(key)) {
            Some(rule) => conforms(member, rule)?,
            None if schema["additionalProperties"].is_object() => {
                conforms(member, &schema["additionalProperties"])?
            }
            None => return Err(format!("{key} is not allowed")),
        }
    }
    Ok(())
}

fn types(rule: &Value) -> Vec<&str> {
    match rule {
        Value::String(text) => vec![text],
        _ => rule.as_array().unwrap().iter().map(|t| t.as_str().unwrap()).collect(),
    }
}

fn type_of(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "boolean",
        Value::Number(_) => "number",
        Value::String(_) => "string",
        Value::Array(_) => "array",
        Value::Object(_) => "object",
    }
}

fn is_whole(value: &Value, rule: &Value) -> bool {
    types(rule).contains(&"integer") && value.is_i64()
}

fn starts_with_a_number(text: &str) -> bool {
    let bare = text.trim_start().trim_start_matches(['-', '+']);
    let bare = bare.strip_prefix('.').unwrap_or(bare);
    bare.starts_with(|c: char| c.is_ascii_digit())
}

fn json_of(text: &str) -> Value {
    toml::from_str(text).unwrap()
}

#[test]
fn every_file_conforms() {
    for file in presets().iter().chain(film_presets()).chain(examples()) {
        let fits = conforms(&json_of(file.text), &schema());
        assert!(fits.is_ok(), "{}: {fits:?}", file.name);
    }
}

#[test]
fn mistakes_do_not_conform() {
    let dry = json_of(presets()[0].text);
    for (pointer, wrong) in [
        ("/beads/0/count", json!(0)),
        ("/beads/0/radius", json!("long")),
        ("/materials/aisi316/poisson_ratio", json!(1.0)),
        ("/far_end/kind", json!("wall")),
        ("/contacts/0/laws/0", json!("elastic_herz")),
        ("/contacts/0/laws/2", json!("damping_cubic")),
        ("/sensors/bead", json!("seven")),
        ("/striker", json!({})),
    ] {
        let mut changed = dry.clone();
        *changed.pointer_mut(pointer).unwrap() = wrong;
        assert!(conforms(&changed, &schema()).is_err(), "{pointer}");
    }
}

#[test]
fn plain_numbers_conform_where_the_program_reads_them() {
    let read = |text: &str| Experiment::from_text("plain.toml", text).is_ok();
    let file = |units: &str, speed: &str, laws: &str| {
        format!(
            "units = \"{units}\"\n[striker]\nspeed = {speed}\nmass = 1\n[[beads]]\ncount = 8\n\
             [[contacts]]\nlaws = [{laws}]\n[far_end]\nkind = \"half-bead\"\n"
        )
    };
    let hertz = "\"elastic_hertz\"";
    let linear = "\"elastic_hertz\", { law = \"damping_linear\", coefficient = 1.0 }";
    let dimensionless = file("dimensionless", "1", linear);
    let si = dimensionless.replace("units = \"dimensionless\"\n", "");
    let texts = [file("dimensionless", "1", hertz), dimensionless, si, file("SI", "1", hertz)];
    for (text, reads) in texts.iter().zip([true, true, false, false]) {
        assert_eq!(read(text), reads, "{text}");
        let fits = conforms(&json_of(text), &schema());
        assert_eq!(fits.is_ok(), reads, "{text}: {fits:?}");
    }
}

#[test]
fn every_law_of_the_registry_is_there() {
    let text = schema().to_string();
    for row in LAWS {
        assert!(text.contains(&format!("\"const\":\"{}\"", row.info.name)), "{}", row.info.name);
        for parameter in row.info.parameters {
            assert!(text.contains(&format!("\"{}\":{{", parameter.name)));
        }
    }
}

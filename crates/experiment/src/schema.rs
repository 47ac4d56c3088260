//! JSON Schema of the experiment file, from the declared keys and the
//! registry of contact laws, for editors.

use crate::contacts::{CONTACT, limits_of};
use crate::keys::{Fields, Key, KeyKind, Need, ROOT, ValueLimits, Variants};
use crate::units;
use crate::values::Units;
use hertzchain_chain::laws::{LAWS, Parameter, Row, Source};
use serde_json::{Map, Value, json};

/// A quantity starts with a number.
const QUANTITY: &str = r"^\s*[-+]?(\d|\.\d)";

/// JSON Schema (draft 2020-12) of an experiment file.
///
/// Plain numbers stand for quantities with a dimension in dimensionless files alone.
pub fn schema() -> Value {
    let dimensionless = json!({
        "properties": { "units": { "const": "dimensionless" } }, "required": ["units"],
    });
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "hertzchain experiment",
        "if": dimensionless,
        "then": table(&ROOT, None, Units::Dimensionless),
        "else": table(&ROOT, None, Units::Si),
    })
}

/// A table; `tag` is a deciding key and its value.
fn table(fields: &Fields, tag: Option<(&str, &str)>, units: Units) -> Value {
    let mut properties: Map<String, Value> =
        (fields.keys.iter()).map(|key| (key.name.to_owned(), property(key, units))).collect();
    let always = fields.keys.iter().filter(|key| key.need == Need::Always);
    let mut required: Vec<&str> = always.map(|key| key.name).collect();
    if let Some((key, value)) = tag {
        properties.insert(key.to_owned(), json!({ "const": value }));
        required.push(key);
    }
    json!({
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

fn property(key: &Key, units: Units) -> Value {
    let mut schema = kind(&key.kind, units);
    let unit = match &key.kind {
        KeyKind::Quantity(unit, limits) | KeyKind::Scaled(unit, limits) if *unit != "1" => {
            format!(", in {unit}, {}", limits.words)
        }
        KeyKind::Quantity(_, limits) | KeyKind::Scaled(_, limits) => format!(", {}", limits.words),
        _ => String::new(),
    };
    if let Some(object) = schema.as_object_mut() {
        object.insert("description".to_owned(), json!(format!("{}{unit}", key.about)));
    }
    schema
}

fn kind(kind: &KeyKind, units: Units) -> Value {
    match kind {
        KeyKind::Quantity(unit, limits) => quantity(unit, limits, units),
        KeyKind::Scaled(unit, limits) => {
            json!({ "anyOf": [quantity(unit, limits, units), power_law(unit, units)] })
        }
        KeyKind::Quantities(unit) => list(quantity(unit, &ValueLimits::ANY, units)),
        KeyKind::Count { least, most } => json!({
            "type": "integer", "minimum": least, "maximum": most,
        }),
        KeyKind::Counts => json!({
            "type": "array", "items": { "type": "integer", "minimum": 0 },
        }),
        KeyKind::Choice(options) => json!({ "enum": options }),
        KeyKind::Text => json!({ "type": "string" }),
        KeyKind::Flag => json!({ "type": "boolean" }),
        KeyKind::Table(fields) => table(fields, None, units),
        KeyKind::Tables(fields) => list(table(fields, None, units)),
        KeyKind::Named(fields) => json!({
            "type": "object", "additionalProperties": table(fields, None, units),
        }),
        KeyKind::Variants(variants) => one_of(variants, units),
        KeyKind::Laws => list(law(units)),
    }
}

fn list(items: Value) -> Value {
    json!({ "type": "array", "minItems": 1, "items": items })
}

/// What a quantity is written as: one with a dimension has its unit.
fn types(unit: &str, units: Units) -> Value {
    match unit != "1" && units == Units::Si {
        true => json!("string"),
        false => json!(["string", "number"]),
    }
}

fn quantity(unit: &str, limits: &ValueLimits, units: Units) -> Value {
    let mut schema = json!({ "type": types(unit, units), "pattern": QUANTITY });
    let (least, most) = match limits.closed {
        true => ("minimum", "maximum"),
        false => ("exclusiveMinimum", "exclusiveMaximum"),
    };
    let Some(object) = schema.as_object_mut() else {
        return schema;
    };
    // Limits of quantities with a dimension are those of their SI values.
    if unit != "1" && limits.least > 0.0 {
        object.insert("exclusiveMinimum".to_owned(), json!(0.0));
    }
    if limits.least == 0.0 || unit == "1" && limits.least > f64::MIN {
        object.insert(least.to_owned(), json!(limits.least));
    }
    if unit == "1" && limits.most < f64::MAX {
        object.insert(most.to_owned(), json!(limits.most));
    }
    if let Ok(found) = units::parse_unit(unit)
        && unit != "1"
    {
        object.insert("examples".to_owned(), json!([found.dimension.example()]));
    }
    schema
}

fn power_law(unit: &str, units: Units) -> Value {
    json!({
        "type": "object",
        "description": "prefactor · speed^exponent, speed of the striker in m/s",
        "properties": {
            "prefactor": quantity(unit, &ValueLimits::ANY, units),
            "exponent": quantity("1", &ValueLimits::ANY, units),
        },
        "required": ["prefactor", "exponent"],
        "additionalProperties": false,
    })
}

fn one_of(variants: &Variants, units: Units) -> Value {
    let option = |(name, fields): &(&str, Fields)| table(fields, Some((variants.tag, name)), units);
    let options: Vec<Value> = variants.options.iter().map(option).collect();
    json!({ "oneOf": options })
}

/// A law by its name where nothing is required, or as a table.
fn law(units: Units) -> Value {
    let required = |row: &Row| row.info.parameters.iter().any(is_required);
    let bare = LAWS.iter().filter(|row| !required(row));
    let names: Vec<&str> = bare.map(|row| row.info.name).collect();
    let tables = LAWS.iter().map(|row| law_table(row, units));
    let options: Vec<Value> = std::iter::once(json!({ "enum": names })).chain(tables).collect();
    json!({ "oneOf": options })
}

fn is_required(parameter: &Parameter) -> bool {
    parameter.source == Source::Required
}

fn law_table(row: &Row, units: Units) -> Value {
    let mut properties = Map::new();
    properties.insert("law".to_owned(), json!({ "const": row.info.name }));
    for parameter in row.info.parameters {
        let about = match parameter.unit {
            "1" => parameter.meaning.to_owned(),
            unit => format!("{}, in {unit}", parameter.meaning),
        };
        let mut schema = quantity(parameter.unit, &limits_of(parameter), units);
        schema["description"] = json!(about);
        properties.insert(parameter.name.to_owned(), schema);
    }
    if row.info.parameters.iter().any(|p| p.source.is_derived()) {
        let about = "contact that K or A belongs to; the section's others keep their ratios to it, as materials and \
                     radii give them. All have the same without it";
        let schema = json!({ "type": "integer", "minimum": 0, "description": about });
        properties.insert(CONTACT.to_owned(), schema);
    }
    let needed = row.info.parameters.iter().filter(|p| is_required(p));
    let required: Vec<&str> = std::iter::once("law").chain(needed.map(|p| p.name)).collect();
    json!({
        "type": "object",
        "description": row.info.equation,
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

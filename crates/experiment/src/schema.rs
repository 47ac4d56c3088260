//! JSON Schema of the experiment file, from the declared keys and the
//! registry of contact laws, for editors.

use crate::keys::{Fields, Key, Kind, Limits, Need, ROOT, Variants};
use crate::units;
use hertzchain_chain::laws::{LAWS, Parameter, Row, Source};
use serde_json::{Map, Value, json};

/// A quantity starts with a number.
const QUANTITY: &str = r"^\s*[-+]?(\d|\.\d)";

/// JSON Schema (draft 2020-12) of an experiment file.
///
/// It is wider than the program's own check in one point: it lets plain
/// numbers stand for quantities, since dimensionless files have them.
#[must_use]
pub fn schema() -> Value {
    let mut schema = table(&ROOT, None);
    if let Some(object) = schema.as_object_mut() {
        let dialect = "https://json-schema.org/draft/2020-12/schema";
        object.insert("$schema".to_owned(), json!(dialect));
        object.insert("title".to_owned(), json!("hertzchain experiment"));
    }
    schema
}

/// A table; `tag` is a deciding key and its value.
fn table(fields: &Fields, tag: Option<(&str, &str)>) -> Value {
    let mut properties: Map<String, Value> = (fields.keys.iter())
        .map(|key| (key.name.to_owned(), property(key)))
        .collect();
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

fn property(key: &Key) -> Value {
    let mut schema = kind(&key.kind);
    let unit = match &key.kind {
        Kind::Quantity(unit, limits) | Kind::Scaled(unit, limits) if *unit != "1" => {
            format!(", in {unit}, {}", limits.words)
        }
        Kind::Quantity(_, limits) | Kind::Scaled(_, limits) => format!(", {}", limits.words),
        _ => String::new(),
    };
    if let Some(object) = schema.as_object_mut() {
        object.insert(
            "description".to_owned(),
            json!(format!("{}{unit}", key.about)),
        );
    }
    schema
}

fn kind(kind: &Kind) -> Value {
    match kind {
        Kind::Quantity(unit, limits) => quantity(unit, limits),
        Kind::Scaled(unit, limits) => json!({ "anyOf": [quantity(unit, limits), power_law(unit)] }),
        Kind::Quantities(unit) => list(quantity(unit, &Limits::ANY)),
        Kind::Count { least, most } => json!({
            "type": "integer", "minimum": least, "maximum": most,
        }),
        Kind::Counts => json!({
            "type": "array", "items": { "type": "integer", "minimum": 0 },
        }),
        Kind::Choice(options) => json!({ "enum": options }),
        Kind::Text => json!({ "type": "string" }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Table(fields) => table(fields, None),
        Kind::Tables(fields) => list(table(fields, None)),
        Kind::Named(fields) => json!({
            "type": "object", "additionalProperties": table(fields, None),
        }),
        Kind::Variants(variants) => one_of(variants),
        Kind::Laws => list(law()),
    }
}

fn list(items: Value) -> Value {
    json!({ "type": "array", "minItems": 1, "items": items })
}

fn quantity(unit: &str, limits: &Limits) -> Value {
    let mut schema = json!({ "type": ["string", "number"], "pattern": QUANTITY });
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

fn power_law(unit: &str) -> Value {
    json!({
        "type": "object",
        "description": "prefactor · speed^exponent, speed of the striker in m/s",
        "properties": {
            "prefactor": quantity(unit, &Limits::ANY),
            "exponent": quantity("1", &Limits::ANY),
        },
        "required": ["prefactor", "exponent"],
        "additionalProperties": false,
    })
}

fn one_of(variants: &Variants) -> Value {
    let option = |(name, fields): &(&str, Fields)| table(fields, Some((variants.tag, name)));
    let options: Vec<Value> = variants.options.iter().map(option).collect();
    json!({ "oneOf": options })
}

/// A law by its name where nothing is required, or as a table.
fn law() -> Value {
    let required = |row: &Row| row.info.parameters.iter().any(is_required);
    let bare = LAWS.iter().filter(|row| !required(row));
    let names: Vec<&str> = bare.map(|row| row.info.name).collect();
    let tables = LAWS.iter().map(law_table);
    let options: Vec<Value> = std::iter::once(json!({ "enum": names }))
        .chain(tables)
        .collect();
    json!({ "oneOf": options })
}

fn is_required(parameter: &Parameter) -> bool {
    parameter.source == Source::Required
}

fn law_table(row: &Row) -> Value {
    let mut properties = Map::new();
    properties.insert("law".to_owned(), json!({ "const": row.info.name }));
    for parameter in row.info.parameters {
        let about = match parameter.unit {
            "1" => parameter.meaning.to_owned(),
            unit => format!("{}, in {unit}", parameter.meaning),
        };
        let schema = json!({
            "type": ["string", "number"], "pattern": QUANTITY, "description": about,
        });
        properties.insert(parameter.name.to_owned(), schema);
    }
    let needed = row.info.parameters.iter().filter(|p| is_required(p));
    let required: Vec<&str> = std::iter::once("law")
        .chain(needed.map(|p| p.name))
        .collect();
    json!({
        "type": "object",
        "description": row.info.equation,
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

//! Descriptions of a chain as JSON.

use super::{Refusal, Reply};
use hertzchain_sim::{Group, Row, Value};
use serde::Serialize;
use serde_json::Value as Json;

/// Lines that belong together.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GroupReply {
    /// What they are about.
    pub title: String,
    /// The lines.
    pub rows: Vec<RowReply>,
}

/// A name with its value and unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RowReply {
    /// What it is.
    pub name: String,
    /// A number, words, a range as two numbers, or rows.
    pub value: Json,
    /// Unit; empty for plain numbers and words.
    pub unit: String,
}

pub(super) fn groups(groups: &[Group]) -> Vec<GroupReply> {
    let group = |group: &Group| GroupReply {
        title: group.title.clone(),
        rows: group.rows.iter().map(row).collect(),
    };
    groups.iter().map(group).collect()
}

fn row(row: &Row) -> RowReply {
    RowReply { name: row.name.trim().to_owned(), value: value(&row.value), unit: row.unit.clone() }
}

fn value(of: &Value) -> Json {
    match of {
        Value::Number(number) => Json::from(*number),
        Value::Count(count) => Json::from(*count),
        Value::Range(least, most) => Json::from(vec![*least, *most]),
        Value::Text(text) => Json::from(text.as_str()),
        Value::Parts(parts) => {
            let rows: Vec<RowReply> = parts.iter().map(row).collect();
            serde_json::to_value(rows).unwrap_or_default()
        }
    }
}

/// What a verb of the program says, as it is.
pub(super) fn reported(said: Result<Json, String>) -> Result<Reply, Refusal> {
    said.map(Reply::Json).map_err(Refusal::Error)
}

//! Descriptions of a chain as JSON.

use hertzchain_sim::{Group, Row, Value};
use serde_json::{Value as Json, json};

/// Lines that belong together under their titles: of each its name, a number, words, a range as two
/// numbers or rows, and its unit.
pub(super) fn groups(groups: &[Group]) -> Json {
    let group = |group: &Group| json!({ "title": group.title, "rows": rows(&group.rows) });
    groups.iter().map(group).collect()
}

fn rows(rows: &[Row]) -> Json {
    let row = |row: &Row| {
        let value = match &row.value {
            Value::Parts(parts) => self::rows(parts),
            other => json!(other),
        };
        json!({ "name": row.name.trim(), "value": value, "unit": row.unit })
    };
    rows.iter().map(row).collect()
}

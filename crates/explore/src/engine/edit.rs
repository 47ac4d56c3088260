//! Changes of an experiment's text that leave the rest of it, comments too, as it is.

use super::Refusal;
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, TableLike, Value};

/// A key of a table or an index of a list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Step {
    /// Index from 0.
    Index(usize),
    /// Key.
    Key(String),
}

/// One change of a text.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Edit {
    /// What leads to the value; an index past the end of a list adds to it.
    pub path: Vec<Step>,
    /// What to put there, as typed or as JSON; nothing removes what is there.
    pub value: Option<Json>,
}

/// Longest text of an experiment, in bytes.
const LONGEST_TEXT: usize = 256 * 1024;

/// Most keys of a path: no value of an experiment is half as deep, and nested tables take their reader's stack.
const DEEPEST: usize = 32;

/// Returns a text after changes.
pub(super) fn edited(text: &str, edits: &[Edit]) -> Result<String, Refusal> {
    check_length(text)?;
    if edits.is_empty() {
        return Ok(text.to_owned());
    }
    let mut document: DocumentMut = text.parse().map_err(Refusal::words)?;
    for edit in edits {
        let [before @ .., last] = edit.path.as_slice() else {
            return Err(Refusal::words("an edit needs a path"));
        };
        if before.len() >= DEEPEST {
            let asked = edit.path.len();
            return Err(Refusal::Error(format!(
                "a path of {asked} keys: expected at most {DEEPEST}"
            )));
        }
        let mut item = document.as_item_mut();
        for (at, step) in before.iter().enumerate() {
            item = inner(item, step, edit.path.get(at + 1))
                .ok_or_else(|| Refusal::Error(format!("no value at {}", shown(&edit.path))))?;
        }
        match &edit.value {
            None => remove(item, last),
            Some(value) => put(item, last, value),
        }
        .ok_or_else(|| Refusal::Error(format!("no place for a value at {}", shown(&edit.path))))?;
    }
    Ok(document.to_string())
}

/// Refuses a text that is longer than an experiment can be.
pub(super) fn check_length(text: &str) -> Result<(), Refusal> {
    match text.len() > LONGEST_TEXT {
        true => Err(Refusal::Error(format!(
            "the experiment has {} bytes: expected at most {LONGEST_TEXT}",
            text.len()
        ))),
        false => Ok(()),
    }
}

/// A path as the experiment file's messages write it.
fn shown(path: &[Step]) -> String {
    let steps = path.iter().enumerate().map(|(at, step)| match step {
        Step::Index(index) => format!("[{index}]"),
        Step::Key(key) if at == 0 => key.clone(),
        Step::Key(key) => format!(".{key}"),
    });
    steps.collect()
}

/// The value at a step; a table or a list is made where `next` needs one and there is none.
fn inner<'a>(item: &'a mut Item, step: &Step, next: Option<&Step>) -> Option<&'a mut Item> {
    match step {
        Step::Key(key) => {
            let inline = item.is_inline_table();
            let table = item.as_table_like_mut()?;
            if table.get(key).is_none() {
                table.insert(key, made(next, inline));
            }
            table.get_mut(key)
        }
        Step::Index(index) => {
            if let Some(tables) = item.as_array_of_tables_mut()
                && *index == tables.len()
            {
                tables.push(Table::new());
            }
            item.get_mut(*index)
        }
    }
}

fn made(next: Option<&Step>, inline: bool) -> Item {
    match (next, inline) {
        (Some(Step::Index(_)), false) => Item::ArrayOfTables(ArrayOfTables::new()),
        (Some(Step::Index(_)), true) => Item::Value(Value::Array(Array::new())),
        (_, true) => Item::Value(Value::InlineTable(InlineTable::new())),
        (_, false) => Item::Table(Table::new()),
    }
}

fn remove(item: &mut Item, step: &Step) -> Option<()> {
    match (step, item) {
        (Step::Key(key), item) => item.as_table_like_mut()?.remove(key).map(drop),
        (Step::Index(index), Item::ArrayOfTables(tables)) => {
            (*index < tables.len()).then(|| drop(tables.remove(*index)))
        }
        (Step::Index(index), Item::Value(Value::Array(array))) => {
            (*index < array.len()).then(|| drop(array.remove(*index)))
        }
        _ => None,
    }
}

fn put(item: &mut Item, step: &Step, json: &Json) -> Option<()> {
    match (step, item) {
        (Step::Key(key), Item::Table(table)) => {
            let mut fresh = of_json(json)?;
            if let (Some(old), Item::Value(new)) =
                (table.get(key).and_then(Item::as_value), &mut fresh)
            {
                // Comments behind the old value stay.
                *new.decor_mut() = old.decor().clone();
            }
            match table.get_mut(key) {
                Some(place) => *place = fresh,
                None => drop(table.insert(key, fresh)),
            }
            Some(())
        }
        (Step::Key(key), Item::Value(Value::InlineTable(table))) => {
            let value = value_of(json)?;
            match table.get_mut(key) {
                Some(place) => *place = value.decorated_as(place),
                None => drop(table.insert(key, value)),
            }
            Some(())
        }
        (Step::Index(index), Item::ArrayOfTables(tables)) => {
            let fresh = table_of(json)?;
            match tables.get_mut(*index) {
                Some(place) => *place = fresh,
                None => tables.push(fresh),
            }
            Some(())
        }
        (Step::Index(index), Item::Value(Value::Array(array))) => {
            let value = value_of(json)?;
            match array.get_mut(*index) {
                Some(place) => *place = value.decorated_as(place),
                None => array.push(value),
            }
            Some(())
        }
        _ => None,
    }
}

trait DecoratedAs {
    fn decorated_as(self, other: &Self) -> Self;
}

impl DecoratedAs for Value {
    fn decorated_as(mut self, other: &Self) -> Self {
        *self.decor_mut() = other.decor().clone();
        self
    }
}

/// A value of a table of its own: objects become tables, lists of objects lists of tables.
fn of_json(json: &Json) -> Option<Item> {
    match json {
        Json::Object(_) => table_of(json).map(Item::Table),
        Json::Array(members) if !members.is_empty() && members.iter().all(Json::is_object) => {
            let tables: Option<Vec<Table>> = members.iter().map(table_of).collect();
            Some(Item::ArrayOfTables(tables?.into_iter().collect()))
        }
        _ => value_of(json).map(Item::Value),
    }
}

fn table_of(json: &Json) -> Option<Table> {
    let entries = json.as_object()?.iter();
    let values = entries.map(|(key, json)| Some((key.clone(), Item::Value(value_of(json)?))));
    values.collect()
}

fn value_of(json: &Json) -> Option<Value> {
    match json {
        Json::Null => None,
        Json::Bool(flag) => Some((*flag).into()),
        Json::String(text) => Some(text.as_str().into()),
        Json::Number(number) => match number.as_i64() {
            Some(whole) => Some(whole.into()),
            None => number.as_f64().map(Value::from),
        },
        Json::Array(members) => {
            let values: Option<Array> = members.iter().map(value_of).collect();
            values.map(Value::Array)
        }
        Json::Object(entries) => {
            let values = entries.iter().map(|(key, json)| Some((key.as_str(), value_of(json)?)));
            let table: Option<InlineTable> = values.collect();
            table.map(Value::InlineTable)
        }
    }
}

/// Returns a text's tables, lists and values as JSON.
pub(super) fn tree(text: &str) -> Option<Json> {
    let document: DocumentMut = text.parse().ok()?;
    Some(json_of_table(document.as_table()))
}

fn json_of_table(table: &dyn TableLike) -> Json {
    let entries = table.iter().map(|(key, item)| (key.to_owned(), json_of(item)));
    Json::Object(entries.collect())
}

fn json_of(item: &Item) -> Json {
    match item {
        Item::None => Json::Null,
        Item::Value(value) => json_of_value(value),
        Item::Table(table) => json_of_table(table),
        Item::ArrayOfTables(tables) => tables.iter().map(|table| json_of_table(table)).collect(),
    }
}

fn json_of_value(value: &Value) -> Json {
    match value {
        Value::String(text) => text.value().as_str().into(),
        Value::Integer(whole) => (*whole.value()).into(),
        Value::Float(number) => (*number.value()).into(),
        Value::Boolean(flag) => (*flag.value()).into(),
        Value::Datetime(date) => date.value().to_string().into(),
        Value::Array(array) => array.iter().map(json_of_value).collect(),
        Value::InlineTable(table) => json_of_table(table),
    }
}

//! Tables as text (CSV), as every result file has them: views of JSON, which has the same numbers.

use crate::table::cell;
use csv::WriterBuilder;
use hertzchain_measure::records::no_formula;
use serde_json::Value;

/// A file's name and what stands in it.
pub(crate) type Table = (&'static str, String);

/// A table of titles and lines. Words are quoted where they hold a comma, a quote or the end of a
/// line; numbers have the fewest digits that give them back exactly; null is an empty cell.
pub(crate) fn table<T: AsRef<str>, L: IntoIterator<Item = Value>>(
    titles: impl IntoIterator<Item = T>,
    lines: impl IntoIterator<Item = L>,
) -> String {
    // Lines of any length, so that writing to memory has no way to fail.
    let mut writer = WriterBuilder::new().flexible(true).from_writer(Vec::new());
    let mut write = |cells: Vec<String>| {
        let written = writer.write_record(cells);
        debug_assert!(written.is_ok(), "{written:?}");
    };
    write(titles.into_iter().map(|title| no_formula(title.as_ref()).into_owned()).collect());
    lines.into_iter().for_each(|line| write(line.into_iter().map(text).collect()));
    // Memory takes all there is, and cells are text: neither of both can fail.
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}

fn text(value: Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(words) => no_formula(&words).into_owned(),
        Value::Number(number) if number.is_f64() => cell(number.as_f64().unwrap_or(f64::NAN)),
        other => other.to_string(),
    }
}

/// A column's title, and where its value stands in a line's JSON: a pointer.
pub(crate) type Column = (String, String);

/// Columns by their titles, separated by commas; `title=place` where a value's place, such as
/// `limit/percent_68`, is not its title.
pub(crate) fn columns(titles: &str) -> Vec<Column> {
    let column = |title: &str| {
        let (title, place) = title.split_once('=').unwrap_or((title, title));
        (title.to_owned(), format!("/{place}"))
    };
    titles.split(',').map(column).collect()
}

/// A table of JSON objects, one a line; what an object does not have is an empty cell.
pub(crate) fn view(lines: &[Value], columns: &[Column]) -> String {
    let titles = columns.iter().map(|(title, _)| title);
    let line = |line: &Value| {
        let cell = |(_, place): &Column| line.pointer(place).cloned().unwrap_or_default();
        columns.iter().map(cell).collect::<Vec<_>>()
    };
    table(titles, lines.iter().map(line))
}

/// Members of a list; none of what is no list.
pub(crate) fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// A table with a line a column, for one object: its numbers by name.
pub(crate) fn quantities(of: &Value, columns: &[Column]) -> String {
    let value = |place: &str| of.pointer(place).cloned().unwrap_or_default();
    let lines = columns.iter().map(|(title, place)| [title.as_str().into(), value(place)]);
    table(["quantity", "value"], lines)
}

/// A square table: names along and down.
pub(crate) fn square(names: &[String], rows: &Value) -> String {
    let titles = std::iter::once("name").chain(names.iter().map(String::as_str));
    let lines = names
        .iter()
        .zip(list(rows))
        .map(|(name, row)| std::iter::once(name.as_str().into()).chain(list(row).iter().cloned()));
    table(titles, lines)
}

#[cfg(test)]
#[path = "tests/csv.rs"]
mod tests;

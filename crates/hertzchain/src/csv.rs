//! Tables as text (CSV), as every result file has them.

use crate::table::cell;
use csv::{Writer, WriterBuilder};
use hertzchain_measure::records::no_formula;

/// A table under way: a line of titles, then lines of as many cells.
#[derive(Debug)]
pub(crate) struct Csv(Writer<Vec<u8>>);

/// A cell.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Cell {
    /// Words, in quotes where they hold a comma, a quote or the end of a line.
    Words(String),
    /// A number with the fewest digits that give it back exactly; nothing if it is not
    /// finite.
    Number(f64),
    /// Nothing.
    Empty,
}

impl From<&str> for Cell {
    fn from(words: &str) -> Self {
        Self::Words(words.to_owned())
    }
}

impl From<String> for Cell {
    fn from(words: String) -> Self {
        Self::Words(words)
    }
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<usize> for Cell {
    fn from(count: usize) -> Self {
        Self::Words(count.to_string())
    }
}

impl From<bool> for Cell {
    fn from(is: bool) -> Self {
        Self::Words(is.to_string())
    }
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Empty, Into::into)
    }
}

impl Cell {
    fn text(self) -> String {
        match self {
            Self::Number(number) if number.is_finite() => cell(number),
            Self::Words(words) => no_formula(&words).into_owned(),
            Self::Number(_) | Self::Empty => String::new(),
        }
    }
}

impl Csv {
    /// A table with these titles.
    pub(crate) fn new<T: Into<Cell>>(titles: impl IntoIterator<Item = T>) -> Self {
        // Lines of any length, so that writing to memory has no way to fail.
        let writer = WriterBuilder::new().flexible(true).from_writer(Vec::new());
        Self(writer).with(titles)
    }

    /// The same with a line more.
    pub(crate) fn with<T: Into<Cell>>(mut self, cells: impl IntoIterator<Item = T>) -> Self {
        let cells = cells.into_iter().map(|cell| cell.into().text());
        let written = self.0.write_record(cells);
        debug_assert!(written.is_ok(), "{written:?}");
        self
    }

    /// The same with a line more for each item.
    pub(crate) fn with_all<I, T: Into<Cell>, L: IntoIterator<Item = T>>(
        self,
        items: impl IntoIterator<Item = I>,
        line: impl Fn(I) -> L,
    ) -> Self {
        let items = items.into_iter();
        items.fold(self, |table, item| table.with(line(item)))
    }

    /// As text.
    pub(crate) fn text(self) -> String {
        // Memory takes all there is, and cells are text: neither of both can fail.
        let bytes = self.0.into_inner().unwrap_or_default();
        String::from_utf8(bytes).unwrap_or_default()
    }
}

/// A square table: names along and down.
pub(crate) fn square(names: &[&str], value: impl Fn(usize, usize) -> Option<f64>) -> Csv {
    let titles = std::iter::once("name").chain(names.iter().copied());
    let line = |(i, name): (usize, &&str)| {
        let values = (0..names.len()).map(|j| Cell::from(value(i, j)));
        std::iter::once(Cell::from(*name)).chain(values).collect::<Vec<_>>()
    };
    Csv::new(titles).with_all(names.iter().enumerate(), line)
}

#[cfg(test)]
#[path = "tests/csv.rs"]
mod tests;

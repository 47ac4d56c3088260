//! What is wrong with a table, and where.

use std::fmt;

/// A cell of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// File.
    pub file: String,
    /// Line, from 1.
    pub line: u64,
    /// Column's title.
    pub column: String,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, line {}, {}", self.file, self.line, self.column)
    }
}

/// Why a table can't be fitted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DataError {
    /// The text is no table.
    #[error("{file}: {what}")]
    NoTable {
        /// File.
        file: String,
        /// What is wrong.
        what: String,
    },
    /// A column that a fit needs.
    #[error("{file}: no column `{column}`; expected {expected}")]
    NoColumn {
        /// File.
        file: String,
        /// The column.
        column: String,
        /// What would do.
        expected: String,
    },
    /// A case that is not there, or one of several must be chosen.
    #[error("{file}: {what}; its cases are {}", .cases.join(", "))]
    Case {
        /// File.
        file: String,
        /// What is wrong.
        what: String,
        /// Cases of the table.
        cases: Vec<String>,
    },
    /// A cell that can't be what it should.
    #[error("{place}: {what}")]
    Cell {
        /// Which.
        place: Place,
        /// What is wrong, and what was expected.
        what: String,
    },
    /// A table without rows that tell anything.
    #[error("{file}: no row has any of the numbers that are used (--use)")]
    Empty {
        /// File.
        file: String,
    },
}

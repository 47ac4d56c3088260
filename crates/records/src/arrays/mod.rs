//! Arrays of numbers, alone or several by name in one file.

mod named;
mod table;

pub(crate) use named::{Arrays, INTERVALS, RATES, open};
pub(crate) use table::{Axes, Table};

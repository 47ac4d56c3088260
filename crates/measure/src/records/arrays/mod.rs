//! Arrays of numbers, alone or several by name in one file.

mod clock;
mod named;
mod table;

pub(crate) use clock::{LOOKED_AT, clock, of_step, rises};
pub(crate) use named::{Arrays, INTERVALS, RATES, open};
pub(crate) use table::{Axes, Table};

//! All tests of the crate from outside, as one program: linked once.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

mod common;
mod damaged;
mod formats;
mod limits;
mod long_rows;
mod odd;
mod series;
mod tdms;
mod times;
mod times_by_python;
mod whole;
mod words;

//! All tests of the crate from outside, as one program: linked once.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

mod common;
mod cradle;
mod engine;
mod page;
mod server;

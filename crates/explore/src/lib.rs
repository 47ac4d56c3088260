//! The explorer: a page on which a row's wave is seen and every number of it can be turned.
//!
//! [`engine::answer`] is the one function behind the page: a [`Request`] in, a [`Reply`] out, both
//! JSON. [`server::serve`] puts it behind a page on this machine alone. What is no simulation,
//! measuring and fitting, comes from the crate above by [`Verbs`].

pub mod engine;
pub mod server;

use std::ffi::OsStr;
use std::io;

pub use engine::{Recording, Refusal, Reply, Request, Verbs, answer};
pub use server::{ServerError, Settings, serve};

/// Opens an address in the user's browser.
///
/// # Errors
/// A system without a browser.
pub fn open(address: impl AsRef<OsStr>) -> io::Result<()> {
    ::open::that_detached(address)
}

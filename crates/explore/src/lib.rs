//! The explorer: a page on which a row's wave is seen and every number of it can be turned.
//!
//! [`engine::answer`] is the one function behind the page: a [`Request`] in, a [`Reply`] out, both
//! JSON. [`server::serve`] puts it behind a page on this machine alone; [`respond`] makes it a program
//! that WebAssembly runs inside the page. What is no simulation, measuring and fitting, comes from the
//! crate above by [`Verbs`].

pub mod engine;
mod respond;
#[cfg(not(target_family = "wasm"))]
pub mod server;

pub use engine::{Recording, Refusal, Reply, Request, Verbs, answer};
pub use respond::respond;
#[cfg(not(target_family = "wasm"))]
pub use server::{ServerError, Settings, open, serve};

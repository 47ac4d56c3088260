//! The explorer: a page on which a row's wave is seen and every number of it can be turned.
#![doc = include_str!("../README.md")]

pub mod engine;
mod respond;
#[cfg(not(target_family = "wasm"))]
pub mod server;

pub use engine::{Recording, Refusal, Request, Verbs, answer};
pub use respond::respond;
#[cfg(not(target_family = "wasm"))]
pub use server::{ServerError, Settings, open, serve};

//! The reference paper of Labbé, Vergara and Olivares, and all of it computed anew.
#![doc = include_str!("../README.md")]

pub mod claims;
pub mod figures;
pub mod oil_films;
pub mod readings;
pub mod reproduce;
pub mod rig_claims;

#[cfg(test)]
#[path = "../tests/mod.rs"]
mod tests;

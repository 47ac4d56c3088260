//! The reference paper of Labbé, Vergara and Olivares: what it states, how it can be read,
//! and all of it computed anew.
//!
//! [`claims`] holds the paper's statements against computed numbers, [`readings`] tries
//! every way in which its model can be understood, [`rig_claims`] evaluates what it says of its rig
//! by virtual ones, and [`reproduce`] computes everything with tables.

pub mod claims;
pub mod figures;
pub mod readings;
pub mod reproduce;
pub mod rig_claims;

//! Physics of a row of beads: materials, contact laws, chains, the wave loop,
//! sensors on a chain, theory.
//!
//! This crate has no files, no clock, no randomness and no threads: the same
//! input gives the same bits. Symbols and conventions are those of
//! `docs/reference/conventions.md`: body 0 is the striker, beads are 1..=N, contact `c`
//! sits between bodies `c` and `c + 1`, contact N between bead N and the far
//! end; positions and velocities point from the striker to the wall.
#![doc = include_str!("../README.md")]

mod chain;
pub mod ensemble;
mod instruction_set;
pub mod laws;
mod material;
mod motion;
pub mod observe;
mod sensor;
pub mod settle;
mod system;
pub mod theory;
pub mod wave;

pub use self::{
    chain::{
        Bead, Chain, ChainError, FarEnd, Gap, Initial, Push, STANDARD_GRAVITY_M_S2, Section, Start,
        Tension,
    },
    instruction_set::InstructionSet,
    material::{BeadPair, Material},
    motion::Motion,
    sensor::Sensor,
    system::System,
};

//! The exact solitary wave of a touching lattice: shape and dimensional wave.

mod grid;
mod shape;
mod solver;
mod wave;

pub use self::{
    shape::{SolitaryShape, kinetic_share_by_virial},
    wave::SolitaryWave,
};

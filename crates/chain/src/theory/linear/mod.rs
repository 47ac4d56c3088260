//! Small motions about a preloaded rest: stiffness, dispersion, normal modes.
//!
//! Exact for infinitesimal amplitudes, as long as every contact keeps its
//! preload; a solitary wave or a large pulse is none of this. Bead spacings
//! are the unit of length: wave numbers in radians per bead (dimer: per cell
//! of two beads), speeds in beads (cells) per second.

mod dimer;
mod modes;
mod uniform;

pub use self::{
    dimer::{BandEdges, Dimer},
    modes::{Ends, Mode, normal_modes},
    uniform::{UniformChain, contact_stiffness_n_m},
};

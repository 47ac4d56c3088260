//! All tests of the crate from outside, as one program: linked once.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

mod arrows;
mod bad_input;
mod bad_input_shot;
mod bibliography;
mod campaign;
mod ensembles;
mod exponents;
mod inference;
mod inference_options;
mod inference_results;
mod legends;
mod limits;
mod measure;
mod program;
mod shards;
mod sweeps;
mod tables;
mod whole_loop;

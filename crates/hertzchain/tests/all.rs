//! All tests of the crate from outside, as one program: linked once.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

mod arrows;
mod bad_input;
mod bad_input_shot;
mod bibliography;
mod campaign;
mod common;
mod design;
mod ensembles;
mod exponents;
mod fit;
mod fit_doubts;
mod fit_mistakes;
mod fit_models;
mod fit_options;
mod gauge;
mod improbable;
mod joint;
mod legends;
mod limits;
mod live;
mod measure;
mod pipes;
mod program;
mod pulses;
mod result_tables;
mod resume;
mod shards;
mod sweeps;
mod tables;
mod whole_loop;

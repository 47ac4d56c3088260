//! Many shots at once, as fast as the machine can.
//!
//! Where [`crate::wave`] follows one shot with steps that end at every
//! opening and closing, this loop takes equal steps through everything, with
//! a multistep method that needs one force pass a step. Eight shots run side
//! by side, or sixteen in single precision, each in a lane of its own with its
//! own laws and step; or one shot alone, as many bodies at a time. A shot's
//! bits depend on neither its lane nor its neighbours.
//!
//! Its accuracy is a property of the step: see `docs/explanation/numerics.md`.

mod aligned;
mod behind;
mod block;
mod bodies;
mod changes;
mod column;
mod edge;
mod fire;
mod fused;
mod number;
mod passing;
mod peaks;
mod record;
mod section;
mod touch;
mod weights;
mod window;

pub use self::{
    fire::{LaneResult, Precision, Settings, Shot, fire, fire_each},
    passing::End,
};

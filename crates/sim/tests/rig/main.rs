//! The virtual rig.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::rig;

mod amplifier;
mod campaign;
mod departures;
mod forecast;
mod instruments;
mod poisoned;
mod record;
mod series;
mod small;
mod wave;

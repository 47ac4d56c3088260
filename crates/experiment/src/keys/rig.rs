//! Keys of `[rig]`: what stands around the chain, in words, for drawings and
//! reports. Nothing is computed from them.

use super::tables::{number_of, part, positive, text};
use super::{Fields, Key};

/// Keys that every part of the apparatus may have.
const NAME: Key = text("name", "what drawings and reports call it");
const MASS: Key = positive("mass", "kg", "its mass");
const LENGTH: Key = positive("length", "m", "its length");

macro_rules! part {
    ($name:literal) => {
        part!($name, &[NAME, MASS, LENGTH])
    };
    ($name:literal, $keys:expr) => {
        Fields {
            title: concat!("[rig.", $name, "]"),
            keys: $keys,
        }
    };
}

static ACTUATOR: Fields = part!("actuator");
static REPOSITIONER: Fields = part!("repositioner");
static PHOTOGATE: Fields = part!("photogate");
static SPRINGS: Fields = part!(
    "springs",
    &[
        NAME,
        positive("force", "N", "force on bead 1 at rest"),
        LENGTH,
    ]
);
static SENSOR: Fields = part!("sensor");
static RECORDER: Fields = part!(
    "recorder",
    &[
        NAME,
        number_of("bits", 1, "bits of a sample"),
        positive("rate", "Hz", "samples a second"),
    ]
);
static STOP: Fields = part!("stop");
static END_STRUCTURE: Fields = part!("end_structure");
static BAR: Fields = part!("bar");

/// The whole table.
pub(crate) static RIG: Fields = Fields {
    title: "[rig]",
    keys: &[
        text("beads", "what the beads are made of, in words"),
        part("actuator", &ACTUATOR, "what launches the striker"),
        part(
            "repositioner",
            &REPOSITIONER,
            "what brings the striker back to its place",
        ),
        part("photogate", &PHOTOGATE, "what measures the striker's speed"),
        part("springs", &SPRINGS, "springs that hold bead 1"),
        part(
            "sensor",
            &SENSOR,
            "force sensors in the sensor bead and at the wall",
        ),
        part("recorder", &RECORDER, "what both sensors are wired to"),
        part("stop", &STOP, "what the far end is fixed to"),
        part(
            "end_structure",
            &END_STRUCTURE,
            "the structure that carries the stop",
        ),
        part("bar", &BAR, "a separate mass against noise"),
    ],
};

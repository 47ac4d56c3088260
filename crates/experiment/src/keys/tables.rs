//! Every table of an experiment file.

use super::campaign::CAMPAIGN;
use super::ends::{DRIVEN, FAR_END, NEAR_END, STRIKER};
use super::rig::RIG;
use super::{Fields, Key, Kind, Limits, Need, ranges};
use crate::reading;
use std::f64::consts::FRAC_PI_2;

/// Longest chain: what fits into memory with all that a shot needs.
pub(crate) const MOST_BEADS: i64 = 2_000_000;

/// A positive quantity within the range of its unit.
pub(super) const fn positive(name: &'static str, unit: &'static str, about: &'static str) -> Key {
    Key::new(name, Kind::Quantity(unit, range_of(unit)), about)
}

const fn range_of(unit: &str) -> Limits {
    match unit.as_bytes() {
        b"m" => ranges::LENGTH,
        b"kg" => ranges::MASS,
        b"s" => ranges::TIME,
        b"Hz" => ranges::FREQUENCY,
        b"m/s" => ranges::SPEED,
        b"kg/m^3" => ranges::DENSITY,
        _ => Limits::POSITIVE,
    }
}

pub(super) const fn not_negative(
    name: &'static str,
    unit: &'static str,
    about: &'static str,
) -> Key {
    Key::new(name, Kind::Quantity(unit, Limits::NOT_NEGATIVE), about)
}

/// A displacement of body 0, either way.
pub(super) const fn either_way(name: &'static str, about: &'static str) -> Key {
    Key::new(name, Kind::Quantity("m", ranges::DISPLACEMENT), about)
}

pub(super) const fn number_of(name: &'static str, least: i64, about: &'static str) -> Key {
    let most = MOST_BEADS;
    Key::new(name, Kind::Count { least, most }, about)
}

pub(super) const fn text(name: &'static str, about: &'static str) -> Key {
    Key::new(name, Kind::Text, about)
}

/// A table within a table.
pub(super) const fn part(name: &'static str, fields: &'static Fields, about: &'static str) -> Key {
    Key::new(name, Kind::Table(fields), about)
}

pub(super) const MATERIAL_NAME: Key = text("material", "name of a material");

const POISSON: Limits = Limits::new(-1.0, 1.0, false, "between -1 and 1");
const ACCURACY: Limits = Limits::new(1e-13, 1e-2, true, "between 1e-13 and 1e-2");
const INCLINE: Limits = Limits::new(0.0, FRAC_PI_2, true, "between 0 and 90 deg");
const FRICTION: Limits = Limits::new(0.0, 10.0, true, "from 0 to 10");
const RATIO: Limits = Limits::new(0.0, 100.0, false, "positive and below 100");

static MATERIAL: Fields = Fields {
    title: "[materials.NAME]",
    keys: &[
        Key::new(
            "young_modulus",
            Kind::Scaled("Pa", ranges::YOUNG_MODULUS),
            "Young modulus Y",
        )
        .needed(Need::Always),
        Key::new(
            "poisson_ratio",
            Kind::Scaled("1", POISSON),
            "Poisson ratio ν",
        )
        .needed(Need::Always),
        Key::new(
            "shear_viscosity",
            Kind::Scaled("Pa s", ranges::VISCOSITY),
            "shear viscosity η1; default 0",
        ),
        Key::new(
            "bulk_viscosity",
            Kind::Scaled("Pa s", ranges::VISCOSITY),
            "bulk viscosity η2; default: as shear_viscosity",
        ),
        positive("density", "kg/m^3", "density, for beads without a mass"),
    ],
};

static CELL: Fields = Fields {
    title: "a member of cell",
    keys: &[
        number_of("count", 1, "beads alike in a row; default 1"),
        positive("radius", "m", "radius").needed(Need::InSi),
        positive("mass", "kg", "mass; default: from the material's density"),
        MATERIAL_NAME.needed(Need::InSi),
    ],
};

static BEADS: Fields = Fields {
    title: "[[beads]]",
    keys: &[
        number_of("count", 1, "beads in the group; default 1"),
        positive("radius", "m", "radius"),
        Key::new(
            "radius_ratio",
            Kind::Quantity("1", RATIO),
            "radius of a bead over that of the one before, for tapered chains",
        ),
        positive("mass", "kg", "mass; default: from the material's density"),
        MATERIAL_NAME,
        number_of("repeat", 1, "repetitions of the cell"),
        Key::new(
            "cell",
            Kind::Tables(&CELL),
            "beads of a unit cell, in order",
        ),
    ],
};

pub(super) static SECTION: Fields = Fields {
    title: "[[contacts]]",
    keys: &[
        number_of("from", 0, "first contact; default 0, before bead 1"),
        number_of("to", 0, "last contact; default the wall contact"),
        Key::new("laws", Kind::Laws, "contact laws whose forces add").needed(Need::Always),
        text(
            "material",
            "effective material of both sides, in place of the beads' own",
        ),
        Key::new(
            "wet",
            Kind::Flag,
            "whether the contacts are wet, for readings",
        ),
    ],
};

static TRACK: Fields = Fields {
    title: "[track]",
    keys: &[
        Key::new(
            "incline",
            Kind::Quantity("rad", INCLINE),
            "incline, the wall below; default 0",
        ),
        Key::new(
            "gravity",
            Kind::Quantity("m/s^2", ranges::GRAVITY),
            "gravity; default 9.80665 m/s^2",
        ),
        Key::new(
            "friction",
            Kind::Quantity("1", FRICTION),
            "dry friction of beads on the track, between shots; default 0.05",
        ),
    ],
};

static SUSPENSION: Fields = Fields {
    title: "[suspension]",
    keys: &[
        positive("length", "m", "length of the threads on which beads hang").needed(Need::Always),
    ],
};

static GAP: Fields = Fields {
    title: "[[gaps]]",
    keys: &[
        number_of("contact", 0, "contact").needed(Need::Always),
        Key::new(
            "gap",
            Kind::Quantity("m", ranges::GAP),
            "gap before the shot",
        )
        .needed(Need::Always),
    ],
};

static INITIAL: Fields = Fields {
    title: "[[initial]]",
    keys: &[
        number_of("bead", 1, "bead").needed(Need::Always),
        Key::new(
            "displacement",
            Kind::Quantity("m", ranges::DISPLACEMENT),
            "displacement from rest; default 0",
        ),
        Key::new(
            "velocity",
            Kind::Quantity("m/s", ranges::VELOCITY),
            "velocity; default 0",
        ),
    ],
};

static SENSORS: Fields = Fields {
    title: "[sensors]",
    keys: &[
        number_of(
            "bead",
            1,
            "sensor bead n of the ToF; default 7, or 1 in a chain below 8",
        ),
        Key::new("beads", Kind::Counts, "further bead sensors"),
        Key::new("contacts", Kind::Counts, "contacts whose force is wanted"),
        Key::new("positions", Kind::Counts, "bodies whose position is wanted"),
        Key::new(
            "velocities",
            Kind::Counts,
            "bodies whose velocity is wanted",
        ),
        Key::new(
            "channel",
            Kind::Flag,
            "one channel that adds sensor bead and wall",
        ),
    ],
};

static SOLVER: Fields = Fields {
    title: "[solver]",
    keys: &[
        Key::new(
            "method",
            Kind::Choice(crate::spec::METHODS),
            "default adaptive",
        ),
        Key::new(
            "accuracy",
            Kind::Quantity("1", ACCURACY),
            "relative; default 1e-6",
        ),
        positive("step", "s", "step of a fixed-step method"),
        positive(
            "duration",
            "s",
            "default: until the reflected pulse has passed the sensor",
        ),
    ],
};

pub(super) static LIQUID: Fields = Fields {
    title: "[liquid]",
    keys: &[
        text("name", "name of the liquid"),
        positive("kinematic_viscosity", "m^2/s", "kinematic viscosity"),
        positive("density", "kg/m^3", "density"),
    ],
};

static READING: Fields = Fields {
    title: "[reading]",
    keys: reading::KEYS,
};

/// The whole file.
pub(crate) static ROOT: Fields = Fields {
    title: "an experiment file",
    keys: &[
        text("title", "what the experiment is"),
        Key::new(
            "units",
            Kind::Choice(&["SI", "dimensionless"]),
            "default SI",
        ),
        Key::new(
            "tension",
            Kind::Choice(&["allowed", "clipped"]),
            "whether contacts may pull",
        ),
        Key::new(
            "materials",
            Kind::Named(&MATERIAL),
            "what bodies are made of",
        ),
        part("striker", &STRIKER, "the ball that hits the chain"),
        Key::new(
            "driven",
            Kind::Variants(&DRIVEN),
            "prescribed motion of body 0",
        ),
        Key::new("beads", Kind::Tables(&BEADS), "groups of beads, in order").needed(Need::Always),
        Key::new(
            "contacts",
            Kind::Tables(&SECTION),
            "sections of contacts with their laws",
        )
        .needed(Need::InSi),
        Key::new(
            "far_end",
            Kind::Variants(&FAR_END),
            "what bead N leans on; default half-bead",
        ),
        Key::new("near_end", Kind::Variants(&NEAR_END), "what pushes bead 1"),
        part("track", &TRACK, "incline and gravity"),
        part("suspension", &SUSPENSION, "threads of a cradle"),
        Key::new("gaps", Kind::Tables(&GAP), "gaps before the shot"),
        Key::new(
            "initial",
            Kind::Tables(&INITIAL),
            "deviations of beads from rest",
        ),
        part("sensors", &SENSORS, "where the chain is watched"),
        part("solver", &SOLVER, "how the motion is computed"),
        part("liquid", &LIQUID, "the liquid of wet contacts, for reports"),
        part(
            "rig",
            &RIG,
            "what stands around the chain, for drawings and reports; computes nothing",
        ),
        part(
            "campaign",
            &CAMPAIGN,
            "what a rig does of itself, shot after shot, and the numbers of its parts",
        ),
        part("reading", &READING, "choices that the paper leaves open"),
    ],
};

//! Every table of an experiment file, a line a key.

use super::Kind::{Choice, Count, Counts, Flag, Laws, Named, Quantities, Scaled, Table, Tables};
use super::Kind::{Quantity, Text, Variants as OneOf};
use super::{Fields, Key, Kind, Limits, Need, Variants, ranges};
use crate::reading;
use crate::spec::{CHANNELS, KINDS, METHODS, ORDERS, TRIGGERS};
use std::f64::consts::FRAC_PI_2;

/// Longest chain: what fits into memory with all that a shot needs.
pub(crate) const MOST_BEADS: i64 = 2_000_000;

/// The keys of a table: `name: kind, "meaning";`, with the need of one that is not optional.
macro_rules! table {
    ($title:expr; $($name:ident $(($need:ident))?: $kind:expr, $about:literal;)*) => {
        Fields {
            title: $title,
            keys: &[$(Key {
                name: stringify!($name),
                kind: $kind,
                need: table!(need $($need)?),
                about: $about,
            },)*],
        }
    };
    (need $need:ident) => { Need::$need };
    (need) => { Need::Never };
}

/// A positive quantity within the range of its unit.
const fn positive(unit: &'static str) -> Kind {
    let limits = match unit.as_bytes() {
        b"m" => ranges::LENGTH,
        b"kg" => ranges::MASS,
        b"s" => ranges::TIME,
        b"Hz" => ranges::FREQUENCY,
        b"m/s" => ranges::SPEED,
        b"kg/m^3" => ranges::DENSITY,
        _ => Limits::POSITIVE,
    };
    Quantity(unit, limits)
}

const fn not_negative(unit: &'static str) -> Kind {
    Quantity(unit, Limits::NOT_NEGATIVE)
}

/// A whole number of things that a chain has.
const fn from(least: i64) -> Kind {
    let most = MOST_BEADS;
    Count { least, most }
}

const POISSON: Limits = Limits::new(-1.0, 1.0, false, "between -1 and 1");
const ACCURACY: Limits = Limits::new(1e-13, 1e-2, true, "between 1e-13 and 1e-2");
const INCLINE: Limits = Limits::new(0.0, FRAC_PI_2, true, "between 0 and 90 deg");
const FRICTION: Limits = Limits::new(0.0, 10.0, true, "from 0 to 10");
const RATIO: Limits = Limits::new(0.0, 100.0, false, "positive and below 100");
const SPREAD: Limits = Limits::new(0.0, 0.1, true, "from 0 to 0.1");
const BITS: Kind = Count { least: 2, most: 16 };
const SEED: Kind = Count {
    least: 0,
    most: 1 << 52,
};
const DISPLACEMENT: Kind = Quantity("m", ranges::DISPLACEMENT);
const VISCOSITY: Kind = Scaled("Pa s", ranges::VISCOSITY);

static MATERIAL: Fields = table! { "[materials.NAME]";
    young_modulus(Always): Scaled("Pa", ranges::YOUNG_MODULUS), "Young modulus Y";
    poisson_ratio(Always): Scaled("1", POISSON), "Poisson ratio ν";
    shear_viscosity: VISCOSITY, "shear viscosity η1; default 0";
    bulk_viscosity: VISCOSITY, "bulk viscosity η2; default: as shear_viscosity";
    density: positive("kg/m^3"), "density, for beads without a mass";
};

static CELL: Fields = table! { "a member of cell";
    count: from(1), "identical beads in a row; default 1";
    radius(InSi): positive("m"), "radius";
    mass: positive("kg"), "mass; default: from the material's density";
    material(InSi): Text, "name of a material";
};

static BEADS: Fields = table! { "[[beads]]";
    count: from(1), "beads in the group; default 1";
    radius: positive("m"), "radius";
    radius_ratio: Quantity("1", RATIO), "radius of a bead over that of the one before, for tapered chains";
    mass: positive("kg"), "mass; default: from the material's density";
    material: Text, "name of a material";
    repeat: from(1), "repetitions of the cell";
    cell: Tables(&CELL), "beads of a unit cell, in order";
};

static SECTION: Fields = table! { "[[contacts]]";
    from: from(0), "first contact; default 0, before bead 1";
    to: from(0), "last contact; default the wall contact";
    laws(Always): Laws, "contact laws whose forces add";
    material: Text, "effective material of both sides, in place of the beads' own";
    wet: Flag, "whether the contacts are wet, for readings";
};

static STRIKER: Fields = table! { "[striker]";
    speed(Always): positive("m/s"), "speed toward the chain at first touch";
    radius: positive("m"), "radius; default: as bead 1";
    mass: positive("kg"), "mass; default: as bead 1, or from the material's density";
    material: Text, "name of a material";
};

static DRIVEN: Variants = Variants {
    title: "[driven]",
    tag: "motion",
    options: &[
        (
            "sine",
            table! { "[driven] with motion = \"sine\"";
                amplitude(Always): DISPLACEMENT, "largest displacement";
                frequency(Always): positive("Hz"), "frequency";
                radius: positive("m"), "radius of the driven body; default: as bead 1";
                material: Text, "name of a material";
            },
        ),
        (
            "pulse",
            table! { "[driven] with motion = \"pulse\"";
                amplitude(Always): DISPLACEMENT, "largest displacement";
                duration(Always): positive("s"), "duration of the push";
                radius: positive("m"), "radius of the driven body; default: as bead 1";
                material: Text, "name of a material";
            },
        ),
        (
            "table",
            table! { "[driven] with motion = \"table\"";
                times: Quantities("s"), "times, increasing";
                positions: Quantities("m"), "positions, one a time";
                file: Text, "CSV file with columns time_s,position_m, beside this file";
                radius: positive("m"), "radius of the driven body; default: as bead 1";
                material: Text, "name of a material";
            },
        ),
    ],
};

static FAR_END: Variants = Variants {
    title: "[far_end]",
    tag: "kind",
    options: &[
        (
            "half-bead",
            table! { "[far_end] with kind = \"half-bead\"";
                radius: positive("m"), "radius of the half-bead; default: as bead N";
                material: Text, "name of a material";
            },
        ),
        (
            "plane",
            table! { "[far_end] with kind = \"plane\"";
                material: Text, "name of a material";
            },
        ),
        (
            "stop",
            table! { "[far_end] with kind = \"stop\"";
                mass(Always): positive("kg"), "mass of the stop";
                radius: positive("m"), "radius of the half-bead; default: as bead N";
                material: Text, "name of a material";
            },
        ),
        (
            "plane-stop",
            table! { "[far_end] with kind = \"plane-stop\"";
                mass(Always): positive("kg"), "mass of the stop";
                material: Text, "name of a material";
            },
        ),
        (
            "periodic",
            table! { "[far_end] with kind = \"periodic\"";
                force: not_negative("N"), "static force around the ring; default 0";
            },
        ),
        ("free", table! { "[far_end] with kind = \"free\""; }),
    ],
};

static NEAR_END: Variants = Variants {
    title: "[near_end]",
    tag: "push",
    options: &[
        (
            "constant",
            table! { "[near_end] with push = \"constant\"";
                force(Always): not_negative("N"), "force on bead 1";
            },
        ),
        (
            "spring",
            table! { "[near_end] with push = \"spring\"";
                force(Always): not_negative("N"), "force on bead 1 at rest";
                stiffness(Always): not_negative("N/m"), "stiffness of the spring";
            },
        ),
    ],
};

static TRACK: Fields = table! { "[track]";
    incline: Quantity("rad", INCLINE), "incline, the wall below; default 0";
    gravity: Quantity("m/s^2", ranges::GRAVITY), "gravity; default 9.80665 m/s^2";
    friction: Quantity("1", FRICTION), "dry friction of beads on the track, between shots; default 0.05";
};

static SUSPENSION: Fields = table! { "[suspension]";
    length(Always): positive("m"), "length of the threads on which beads hang";
};

static GAP: Fields = table! { "[[gaps]]";
    contact(Always): from(0), "contact";
    gap(Always): Quantity("m", ranges::GAP), "gap before the shot";
};

static INITIAL: Fields = table! { "[[initial]]";
    bead(Always): from(1), "bead";
    displacement: DISPLACEMENT, "displacement from rest; default 0";
    velocity: Quantity("m/s", ranges::VELOCITY), "velocity; default 0";
};

static SENSORS: Fields = table! { "[sensors]";
    bead: from(1), "sensor bead n of the ToF; default 7, or 1 in a chain below 8";
    beads: Counts, "further bead sensors";
    contacts: Counts, "contacts whose force is wanted";
    positions: Counts, "bodies whose position is wanted";
    velocities: Counts, "bodies whose velocity is wanted";
    channel: Flag, "one channel that adds sensor bead and wall";
};

static SOLVER: Fields = table! { "[solver]";
    method: Choice(METHODS), "default adaptive";
    accuracy: Quantity("1", ACCURACY), "relative; default 1e-6";
    step: positive("s"), "step of a fixed-step method";
    duration: positive("s"), "default: until the reflected pulse has passed the sensor";
};

static LIQUID: Fields = table! { "[liquid]";
    name: Text, "name of the liquid";
    kinematic_viscosity: positive("m^2/s"), "kinematic viscosity";
    density: positive("kg/m^3"), "density";
};

/// A part of `[rig]` that has a name, a mass and a length.
macro_rules! solid {
    ($title:literal) => {
        &table! { $title;
            name: Text, "what drawings and reports call it";
            mass: positive("kg"), "its mass";
            length: positive("m"), "its length";
        }
    };
}

/// What stands around the chain, for drawings and reports: nothing is computed from it.
pub(crate) static RIG: Fields = table! { "[rig]";
    beads: Text, "what the beads are made of, in words";
    actuator: Table(solid!("[rig.actuator]")), "what launches the striker";
    repositioner: Table(solid!("[rig.repositioner]")), "what brings the striker back to its place";
    photogate: Table(solid!("[rig.photogate]")), "what measures the striker's speed";
    springs: Table(&table! { "[rig.springs]";
        name: Text, "what drawings and reports call it";
        force: positive("N"), "force on bead 1 at rest";
        length: positive("m"), "its length";
    }), "springs that hold bead 1";
    sensor: Table(solid!("[rig.sensor]")), "force sensors in the sensor bead and at the wall";
    recorder: Table(&table! { "[rig.recorder]";
        name: Text, "what drawings and reports call it";
        bits: from(1), "bits of a sample";
        rate: positive("Hz"), "samples a second";
    }), "what both sensors are wired to";
    stop: Table(solid!("[rig.stop]")), "what the far end is fixed to";
    end_structure: Table(solid!("[rig.end_structure]")), "the structure that carries the stop";
    bar: Table(solid!("[rig.bar]")), "a separate mass against noise";
};

static CASE: Fields = table! { "[[campaign.cases]]";
    name(Always): Text, "name of the case, in names of files";
    contacts: Tables(&SECTION), "sections of contacts in place of the file's own";
    liquid: Table(&LIQUID), "liquid in place of the file's own, for reports";
};

static LAYING: Fields = table! { "[campaign.laying]";
    gap_scatter: not_negative("m"), "mean of the random gaps of a chain as it is laid; default 5 um";
    radius_spread: Quantity("1", SPREAD), "standard deviation of bead radii over their mean; default 0";
};

static ACTUATOR: Fields = table! { "[campaign.actuator]";
    resolution: positive("m/s"), "step of the speeds that can be programmed; default 0.15 mm/s";
    spread: not_negative("m/s"), "standard deviation of the speed from shot to shot; default 3 mm/s";
    least_speed: positive("m/s"), "slowest shot; default 0.05 m/s";
    most_speed: positive("m/s"), "fastest shot; default 2.5 m/s";
    placing: not_negative("m"), "standard deviation of the place to which the striker is brought back; default 20 um";
};

static PHOTOGATE: Fields = table! { "[campaign.photogate]";
    error: not_negative("m/s"), "standard deviation of a measured speed; default 0.5 mm/s";
    way: positive("m"), "way of the striker from the gate to bead 1; default 1 mm";
};

static AMPLIFIER: Fields = table! { "[campaign.amplifier]";
    sensitivity: positive("C/N"), "charge of the sensor bead's disc; default 10 pC/N";
    wall_sensitivity: positive("C/N"), "charge of the wall's disc; default: as sensitivity";
    gain: positive("V/C"), "voltage for a charge; default 1 mV/pC";
    low_pass: positive("Hz"), "frequency above which the response falls; default 180 kHz";
    order: Choice(ORDERS), "order of the low-pass; default second";
    kind: Choice(KINDS), "kind of the low-pass; default butterworth";
    high_pass: positive("Hz"), "frequency below which the response falls; default 0.5 Hz";
    noise: not_negative("V"), "standard deviation of each sample's noise; default 1.5 mV";
};

static RECORDER: Fields = table! { "[campaign.recorder]";
    bits: BITS, "bits of a sample; default 16";
    sampling: positive("Hz"), "samples a second; default 1 MHz";
    range: positive("V"), "largest voltage either way; default 10 V";
    offset: Quantity("V", Limits::ANY), "voltage of no signal; default 0";
    record: positive("s"), "length of a record; default 0.1 s";
    before: not_negative("s"), "part of a record before the trigger; default 2 ms";
    trigger: Choice(TRIGGERS), "what starts a record; default photogate";
    level: Quantity("V", Limits::ANY), "voltage that triggers, with trigger = \"level\"; default 20 mV";
    channels: Choice(CHANNELS), "both sensors summed in one channel or each in a separate one; default summed";
};

static CAMPAIGN: Fields = table! { "[campaign]";
    seed: SEED, "seed of all that is random; default 1";
    speeds: Quantities("m/s"), "programmed speeds; default that of the striker";
    slowest: positive("m/s"), "slowest of speeds in equal ratios";
    fastest: positive("m/s"), "fastest of them";
    speed_count: from(2), "how many there are";
    shots: from(1), "shots of a series, all at one speed; default 20";
    taps: from(0), "taps before a shot; default 40";
    tap_speed: positive("m/s"), "speed of the striker in a tap; default 0.18 m/s";
    cases: Tables(&CASE), "chains to be measured; default this file's one";
    laying: Table(&LAYING), "how a chain is laid before a series";
    actuator: Table(&ACTUATOR), "what launches the striker";
    photogate: Table(&PHOTOGATE), "what measures the striker's speed";
    amplifier: Table(&AMPLIFIER), "what turns forces into voltages";
    recorder: Table(&RECORDER), "what turns voltages into records";
};

static READING: Fields = Fields {
    title: "[reading]",
    keys: reading::KEYS,
};

pub(crate) static ROOT: Fields = table! { "an experiment file";
    title: Text, "what the experiment is";
    units: Choice(&["SI", "dimensionless"]), "default SI";
    tension: Choice(&["allowed", "clipped"]), "whether contacts may pull";
    materials: Named(&MATERIAL), "what bodies are made of";
    striker: Table(&STRIKER), "the ball that hits the chain";
    driven: OneOf(&DRIVEN), "prescribed motion of body 0";
    beads(Always): Tables(&BEADS), "groups of beads, in order";
    contacts(InSi): Tables(&SECTION), "sections of contacts with their laws";
    far_end: OneOf(&FAR_END), "what bead N leans on; default half-bead";
    near_end: OneOf(&NEAR_END), "what pushes bead 1";
    track: Table(&TRACK), "incline and gravity";
    suspension: Table(&SUSPENSION), "threads of a cradle";
    gaps: Tables(&GAP), "gaps before the shot";
    initial: Tables(&INITIAL), "deviations of beads from rest";
    sensors: Table(&SENSORS), "where the chain is watched";
    solver: Table(&SOLVER), "how the motion is computed";
    liquid: Table(&LIQUID), "the liquid of wet contacts, for reports";
    rig: Table(&RIG), "what stands around the chain, for drawings and reports; computes nothing";
    campaign: Table(&CAMPAIGN), "what a rig does of itself, shot after shot, and the numbers of its parts";
    reading: Table(&READING), "choices that the paper leaves open";
};

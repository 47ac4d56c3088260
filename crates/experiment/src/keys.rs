//! The keys of an experiment file, declared once: the check of a file, its
//! reading, the JSON Schema and the parameter paths all go by these tables.

use crate::reading::READING;
use crate::report::nearest_word;
use crate::rig::{Actuator, Amplifier, Laying, Photogate, RIG, Recorder};
use crate::settings::{Liquid, Method};
use crate::values::Units;
pub(crate) use KeyKind::{
    Choice, Count, Counts, Flag, Laws, Named, Quantities, Quantity, Scaled, Table, Tables, Text,
    Variants as OneOf,
};
use std::f64::consts::FRAC_PI_2;

/// The keys of one table.
#[derive(Debug)]
pub(crate) struct Fields {
    /// The table as written in a file: "[striker]".
    pub(crate) title: &'static str,
    pub(crate) keys: &'static [Key],
}

#[derive(Debug)]
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) kind: KeyKind,
    pub(crate) need: Need,
    /// Its meaning, in a few words.
    pub(crate) about: &'static str,
}

/// Whether a key must be there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Need {
    Always,
    /// In SI files; a dimensionless one has a default.
    InSi,
    Never,
}

/// The kind of value that a key has.
#[derive(Debug)]
pub(crate) enum KeyKind {
    /// A quantity in this SI unit; "1" for a plain number.
    Quantity(&'static str, ValueLimits),
    /// A quantity, or a power law of the striker's speed.
    Scaled(&'static str, ValueLimits),
    /// Quantities in this SI unit.
    Quantities(&'static str),
    /// A whole number within limits.
    Count {
        least: i64,
        most: i64,
    },
    /// Whole numbers from 0.
    Counts,
    Choice(&'static [&'static str]),
    Text,
    Flag,
    Table(&'static Fields),
    /// `[[name]]`
    Tables(&'static Fields),
    /// `[name.anything]`
    Named(&'static Fields),
    Variants(&'static Variants),
    /// Rows of the contact-law registry.
    Laws,
}

/// A table whose keys depend on the value of one of them.
#[derive(Debug)]
pub(crate) struct Variants {
    pub(crate) title: &'static str,
    pub(crate) tag: &'static str,
    pub(crate) options: &'static [(&'static str, Fields)],
}

/// Values that a quantity may have, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ValueLimits {
    pub(crate) least: f64,
    pub(crate) most: f64,
    /// Whether the ends themselves are accepted.
    pub(crate) closed: bool,
    /// The range in words: "positive".
    pub(crate) words: &'static str,
}

impl Fields {
    pub(crate) fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    pub(crate) fn names(&self) -> Vec<&'static str> {
        self.keys.iter().map(|key| key.name).collect()
    }

    /// The key that another word was probably meant for.
    pub(crate) fn slip_of(&self, word: &str) -> Option<&'static str> {
        let lower = word.to_lowercase();
        let means = |key: &&str| {
            let mut rows = SYNONYMS.iter().filter(|(_, meant)| meant == key);
            rows.any(|(words, _)| words.split(' ').any(|other| other == lower))
        };
        let meant = self.names().into_iter().find(means);
        meant.or_else(|| nearest_word(word, self.names()))
    }
}

impl Variants {
    /// The keys that go with a value of the tag.
    pub(crate) fn fields(&self, tag: &str) -> Option<&'static Fields> {
        let option = self.options.iter().find(|(name, _)| *name == tag);
        option.map(|(_, fields)| fields)
    }
}

impl ValueLimits {
    pub(crate) const ANY: Self = Self::open(f64::MIN, f64::MAX, true, "finite");
    const POSITIVE: Self = Self::open(0.0, f64::INFINITY, false, "positive");
    const NOT_NEGATIVE: Self = Self::closed(0.0, f64::MAX, "0 or more");

    const fn open(least: f64, most: f64, closed: bool, words: &'static str) -> Self {
        Self { least, most, closed, words }
    }

    /// Both ends included.
    pub(crate) const fn closed(least: f64, most: f64, words: &'static str) -> Self {
        Self::open(least, most, true, words)
    }

    /// The limits in a file of this unit system: physical ranges are of SI
    /// values, and dimensionless numbers need only be computable.
    pub(crate) fn within(self, units: Units, unit: &str) -> Self {
        match units {
            Units::Si => self,
            Units::Dimensionless if unit == "1" => self,
            Units::Dimensionless if self.least > 0.0 => PLAIN,
            Units::Dimensionless if self.least == 0.0 && self.closed => Self::NOT_NEGATIVE,
            Units::Dimensionless => Self::ANY,
        }
    }

    pub(crate) fn hold(&self, value: f64) -> bool {
        let inside = value > self.least && value < self.most;
        inside || (self.closed && (value == self.least || value == self.most))
    }
}

// Ranges of numbers that a chain of solid bodies can have. They are far wider than any material
// or laboratory and only keep out slips such as a missing exponent, whose consequences (no
// overlap that a number can hold, a pulse that never arrives) could not be reported at their
// place in the file. A rigid body is within them.

/// Of any quantity that is not 0, in SI or dimensionless.
pub(crate) const SMALLEST: f64 = 1e-100;
pub(crate) const LARGEST: f64 = 1e100;
/// Stands for a positive range in a dimensionless file.
const PLAIN: ValueLimits = ValueLimits::closed(SMALLEST, LARGEST, "positive, from 1e-100 to 1e100");

/// From a cluster of atoms to a moon.
pub(crate) const LENGTH: ValueLimits = ValueLimits::closed(1e-9, 1e6, "from 1 nm to 1000 km");
/// From less than an atom's thousandth to a planet.
pub(crate) const MASS: ValueLimits = ValueLimits::closed(1e-30, 1e25, "from 1e-30 kg to 1e25 kg");
/// From a creep to a hundred times any bullet.
pub(crate) const SPEED: ValueLimits = ValueLimits::closed(1e-12, 1e6, "from 1e-12 m/s to 1e6 m/s");

const GAP_WIDTH: ValueLimits = ValueLimits::closed(0.0, 1e6, "from 0 to 1000 km");
/// From a thousandth of an aerogel's to fifty times that of osmium.
const DENSITY: ValueLimits = ValueLimits::closed(1e-3, 1e6, "from 1e-3 kg/m^3 to 1e6 kg/m^3");
/// From a gel too soft to stand to a billion times diamond, for rigid walls.
const YOUNG_MODULUS: ValueLimits = ValueLimits::closed(1.0, 1e21, "from 1 Pa to 1e21 Pa");
/// Of a bead that starts moving, either way.
const VELOCITY: ValueLimits = ValueLimits::closed(-1e6, 1e6, "from -1e6 m/s to 1e6 m/s");
/// From light crossing an atom to thirty years.
const TIME: ValueLimits = ValueLimits::closed(1e-18, 1e9, "from 1e-18 s to 1e9 s");
const FREQUENCY: ValueLimits = ValueLimits::closed(1e-9, 1e18, "from 1e-9 Hz to 1e18 Hz");
/// Up to the surface of a dense star.
const GRAVITY: ValueLimits = ValueLimits::closed(0.0, 1e12, "from 0 to 1e12 m/s^2");
const POISSON: ValueLimits = ValueLimits::open(-1.0, 1.0, false, "between -1 and 1");
const ACCURACY: ValueLimits = ValueLimits::closed(1e-13, 1e-2, "between 1e-13 and 1e-2");
pub(crate) const QUARTER_TURN: ValueLimits =
    ValueLimits::closed(0.0, FRAC_PI_2, "between 0 and 90 deg");
const FRICTION: ValueLimits = ValueLimits::closed(0.0, 10.0, "from 0 to 10");
const RATIO: ValueLimits = ValueLimits::open(0.0, 100.0, false, "positive and below 100");
const DISPLACEMENT: KeyKind =
    Quantity("m", ValueLimits::closed(-1e6, 1e6, "from -1000 km to 1000 km"));
/// Up to the Earth's mantle and beyond.
const VISCOSITY: KeyKind = Scaled("Pa s", ValueLimits::closed(0.0, 1e24, "from 0 to 1e24 Pa s"));
/// Of radii over their mean.
pub(crate) const SPREAD: KeyKind = Quantity("1", ValueLimits::closed(0.0, 0.1, "from 0 to 0.1"));
pub(crate) const VOLTAGE: KeyKind = Quantity("V", ValueLimits::ANY);

/// Where ASTM D341 holds.
pub(crate) const OIL: KeyKind =
    Quantity("m^2/s", ValueLimits::closed(2e-6, 20.0, "from 2 cSt to 2e7 cSt"));
pub(crate) const OIL_TEMPERATURE: ValueLimits =
    ValueLimits::closed(223.15, 473.15, "from -50 degC to 200 degC");

/// Longest chain: what fits into memory with all that a shot needs.
pub(crate) const MOST_BEADS: i64 = 2_000_000;

/// A positive quantity within the range of its unit.
pub(crate) const fn positive(unit: &'static str) -> KeyKind {
    let limits = match unit.as_bytes() {
        b"m" => LENGTH,
        b"kg" => MASS,
        b"s" => TIME,
        b"Hz" => FREQUENCY,
        b"m/s" => SPEED,
        b"kg/m^3" => DENSITY,
        _ => ValueLimits::POSITIVE,
    };
    Quantity(unit, limits)
}

pub(crate) const fn not_negative(unit: &'static str) -> KeyKind {
    Quantity(unit, ValueLimits::NOT_NEGATIVE)
}

/// A whole number of things that a chain has.
pub(crate) const fn from(least: i64) -> KeyKind {
    let most = MOST_BEADS;
    Count { least, most }
}

/// The keys of a table: `name: kind, "meaning";`, with the need of one that is not optional.
macro_rules! table {
    ($title:expr; $($name:ident $(($need:ident))?: $kind:expr, $about:expr;)*) => {
        $crate::keys::Fields {
            title: $title,
            keys: &[$($crate::keys::Key {
                name: stringify!($name),
                kind: $kind,
                need: $crate::keys::table!(need $($need)?),
                about: $about,
            },)*],
        }
    };
    (need $need:ident) => { $crate::keys::Need::$need };
    (need) => { $crate::keys::Need::Never };
}
pub(crate) use table;

/// A table whose keys go with the value of its tag: `"value" { keys }`, keys as in `table!`.
macro_rules! variants {
    ($title:literal $tag:ident; $($option:literal { $($keys:tt)* })*) => {
        Variants {
            title: $title,
            tag: stringify!($tag),
            options: &[$((
                $option,
                table! {
                    concat!($title, " with ", stringify!($tag), " = \"", $option, "\"");
                    $($keys)*
                },
            ),)*],
        }
    };
}

/// An enum whose options are names in a file; the first is the default.
macro_rules! choice {
    ($(#[$meta:meta])* $Type:ident {
        $first:literal => $First:ident: $first_doc:literal,
        $($text:literal => $Option:ident: $doc:literal,)*
    }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub enum $Type {
            #[doc = $first_doc]
            #[default]
            $First,
            $(#[doc = $doc] $Option,)*
        }

        impl $Type {
            pub(crate) const NAMES: &[&str] = &[$first, $($text,)*];

            /// Its name in a file.
            pub const fn name(self) -> &'static str {
                Self::NAMES[self as usize]
            }

            pub(crate) fn from_name(name: &str) -> Option<Self> {
                match name {
                    $first => Some(Self::$First),
                    $($text => Some(Self::$Option),)*
                    _ => None,
                }
            }
        }
    };
}
pub(crate) use choice;

static MATERIAL: Fields = table! { "[materials.NAME]";
    young_modulus(Always): Scaled("Pa", YOUNG_MODULUS), "Young modulus Y";
    poisson_ratio(Always): Scaled("1", POISSON), "Poisson ratio ν";
    shear_viscosity: VISCOSITY, "shear viscosity η1; default 0";
    bulk_viscosity: VISCOSITY, "bulk viscosity η2; default: as shear_viscosity";
    density: positive("kg/m^3"), "density, for beads without a mass";
    yield_strength: positive("Pa"), "yield strength, to report first yield";
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
    mass: positive("kg"), "mass; default: as bead 1, or from the material's density if it differs in size or material";
    material: Text, "name of a material";
};

static DRIVEN: Variants = variants! { "[driven]" motion;
    "sine" {
        amplitude(Always): DISPLACEMENT, "amplitude a of x = a sin(2πft)";
        frequency(Always): positive("Hz"), "frequency f";
        radius: positive("m"), "radius of the driven body; default: as bead 1";
        material: Text, "name of a material";
    }
    "pulse" {
        amplitude(Always): DISPLACEMENT, "amplitude a of x = a sin²(πt/T)";
        duration(Always): positive("s"), "duration T of the push";
        radius: positive("m"), "radius of the driven body; default: as bead 1";
        material: Text, "name of a material";
    }
    "table" {
        times: Quantities("s"), "times, increasing";
        positions: Quantities("m"), "positions, one a time, relative to the first; joined by cubics with the slopes of parabolas through three points, at rest at both ends";
        file: Text, "CSV file with columns time_s,position_m, beside this file";
        radius: positive("m"), "radius of the driven body; default: as bead 1";
        material: Text, "name of a material";
    }
};

static FAR_END: Variants = variants! { "[far_end]" kind;
    "half-bead" {
        radius: positive("m"), "radius of the half-bead; default: as bead N";
        material: Text, "name of a material";
    }
    "plane" {
        material: Text, "name of a material";
    }
    "stop" {
        mass(Always): positive("kg"), "mass of the stop";
        radius: positive("m"), "radius of the half-bead; default: as bead N";
        material: Text, "name of a material";
    }
    "plane-stop" {
        mass(Always): positive("kg"), "mass of the stop";
        material: Text, "name of a material";
    }
    "periodic" {
        force: not_negative("N"), "static force around the ring; default 0";
    }
    "free" {}
};

static NEAR_END: Variants = variants! { "[near_end]" push;
    "constant" {
        force(Always): not_negative("N"), "force on bead 1";
    }
    "spring" {
        force(Always): not_negative("N"), "force on bead 1 at rest";
        stiffness(Always): not_negative("N/m"), "stiffness of the spring";
    }
};

static TRACK: Fields = table! { "[track]";
    incline: Quantity("rad", QUARTER_TURN), "incline, the wall below; default 0";
    gravity: Quantity("m/s^2", GRAVITY), "gravity; default 9.80665 m/s^2, 0 in dimensionless files";
    friction: Quantity("1", FRICTION), "dry friction of beads on the track, between shots; default 0.05";
};

static SUSPENSION: Fields = table! { "[suspension]";
    length(Always): positive("m"), "length of the threads on which beads hang";
};

static GAP: Fields = table! { "[[gaps]]";
    contact: from(0), "contact";
    from: from(0), "first of several contacts; default the first";
    to: from(0), "last of them; default the last";
    gap(Always): Quantity("m", GAP_WIDTH), "gap before the shot";
};

static INITIAL: Fields = table! { "[[initial]]";
    bead(Always): from(1), "bead";
    displacement: DISPLACEMENT, "displacement from rest; default 0";
    velocity: Quantity("m/s", VELOCITY), "velocity; default 0";
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
    method: Choice(Method::NAMES), "default adaptive";
    accuracy: Quantity("1", ACCURACY), "relative; default 1e-6";
    step: positive("s"), "step of a fixed-step method";
    duration: positive("s"), "default: until the reflected pulse has passed the sensor and the striker is away";
};

static CASE: Fields = table! { "[[campaign.cases]]";
    name(Always): Text, "name of the case, in names of files";
    contacts: Tables(&SECTION), "sections of contacts in place of the file's own";
    liquid: Table(&Liquid::FIELDS), "liquid in place of the file's own";
};

const SEED: KeyKind = Count { least: 0, most: 1 << 52 };

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
    laying: Table(&Laying::FIELDS), "how a chain is laid before a series";
    actuator: Table(&Actuator::FIELDS), "what launches the striker";
    photogate: Table(&Photogate::FIELDS), "what measures the striker's speed";
    amplifier: Table(&Amplifier::FIELDS), "what turns forces into voltages";
    recorder: Table(&Recorder::FIELDS), "what turns voltages into records";
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
    liquid: Table(&Liquid::FIELDS), "the liquid of wet contacts";
    rig: Table(&RIG), "what stands around the chain, for drawings and reports; computes nothing";
    campaign: Table(&CAMPAIGN), "what a rig does of itself, shot after shot, and the numbers of its parts";
    reading: Table(&READING), "choices that the paper leaves open";
};

/// Where a key belongs that stands in the wrong table, in words.
pub(crate) fn home(key: &str) -> Option<String> {
    let tables_of = |kind: &'static KeyKind| -> Vec<(&str, &Fields)> {
        match kind {
            Table(fields) | Tables(fields) | Named(fields) => vec![(fields.title, fields)],
            OneOf(variants) => {
                let options = variants.options.iter();
                options.map(|(_, fields)| (variants.title, fields)).collect()
            }
            _ => Vec::new(),
        }
    };
    if let Some(found) = ROOT.key(key) {
        return Some(match tables_of(&found.kind).first() {
            Some((title, _)) => format!("into a table of its own, {title}"),
            None => "at the top of the file, before the first table".to_owned(),
        });
    }
    let mut tables = ROOT.keys.iter().flat_map(|key| tables_of(&key.kind));
    let (_, holding) = tables.find(|(_, fields)| fields.key(key).is_some())?;
    Some(format!("into {}", holding.title))
}

/// Other words for a key, and the key.
const SYNONYMS: &[(&str, &str)] = &[
    ("velocity v v0 impact_speed", "speed"),
    ("speed v v0", "velocity"),
    ("position offset x", "displacement"),
    ("n number length num beads", "count"),
    ("e y young youngs_modulus modulus elastic_modulus", "young_modulus"),
    ("nu ν poisson poissons_ratio", "poisson_ratio"),
    ("viscosity eta η", "shear_viscosity"),
    ("rho ρ", "density"),
    ("r", "radius"),
    ("m", "mass"),
    ("angle inclination tilt slope", "incline"),
    ("g", "gravity"),
    ("tolerance tol rtol precision", "accuracy"),
    ("dt time_step timestep step_size", "step"),
    ("time t_end end_time t_max tmax", "duration"),
    ("solver integrator name kind", "method"),
    ("law forces model", "laws"),
    ("first start begin", "from"),
    ("last end until", "to"),
    ("size width distance", "gap"),
    ("wall end far stop boundary", "far_end"),
    ("impactor projectile hammer", "striker"),
    ("chain balls spheres particles grains", "beads"),
    ("name description", "title"),
    ("path csv", "file"),
];

/// Advice on a key that is no synonym of another.
pub(crate) fn advice_on_key(table: &str, key: &str) -> Option<&'static str> {
    match (table, key) {
        ("[[contacts]]", "contact" | "contacts") => {
            Some("`from` and `to` say which contacts, both of them included")
        }
        (_, "diameter") => Some("write `radius`, half the diameter"),
        ("[[beads]]" | "a member of cell" | "[striker]", "young_modulus" | "poisson_ratio") => {
            Some("write a table [materials.NAME] and name it: `material = \"NAME\"`")
        }
        _ => None,
    }
}

/// Advice on an option that does not exist.
pub(crate) fn advice_on_option(key: &str, word: &str) -> Option<&'static str> {
    match (key, word.to_lowercase().as_str()) {
        ("motion", "file" | "csv" | "data") => {
            Some("write motion = \"table\" with file = \"name.csv\"")
        }
        ("kind", "fixed" | "wall" | "rigid") => {
            Some("\"half-bead\" is half of bead N held fast, \"plane\" a flat wall")
        }
        ("kind", "open" | "none") => Some("write kind = \"free\""),
        ("kind", "ring") => Some("write kind = \"periodic\""),
        ("method", "rk45" | "dopri5" | "dormand-prince") => Some("write method = \"adaptive\""),
        ("method", "rk" | "runge-kutta") => Some("write method = \"rk4\""),
        ("method", "velocity-verlet" | "leapfrog") => Some("write method = \"verlet\""),
        ("push", "free" | "none") => Some("leave [near_end] out: nothing then pushes bead 1"),
        ("units", "si units" | "mks" | "metric") => Some("write units = \"SI\""),
        ("units", "none" | "reduced" | "natural") => Some("write units = \"dimensionless\""),
        _ => None,
    }
}

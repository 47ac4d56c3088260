//! Keys of `[campaign]`: what a rig does of itself, shot after shot, and the
//! numbers of its parts.

use super::tables::{LIQUID, SECTION, not_negative, number_of, part, positive, text};
use super::{Fields, Key, Kind, Limits, Need, ranges};
use crate::spec::{CHANNELS, KINDS, ORDERS, TRIGGERS};

const SPREAD: Limits = Limits::new(0.0, 0.1, true, "from 0 to 0.1");

const fn quantity(
    name: &'static str,
    unit: &'static str,
    limits: Limits,
    about: &'static str,
) -> Key {
    Key::new(name, Kind::Quantity(unit, limits), about)
}

const fn choice(name: &'static str, options: &'static [&'static str], about: &'static str) -> Key {
    Key::new(name, Kind::Choice(options), about)
}

static CASE: Fields = Fields {
    title: "[[campaign.cases]]",
    keys: &[
        text("name", "name of the case, in names of files").needed(Need::Always),
        Key::new(
            "contacts",
            Kind::Tables(&SECTION),
            "sections of contacts in place of the file's own",
        ),
        part(
            "liquid",
            &LIQUID,
            "liquid in place of the file's own, for reports",
        ),
    ],
};

static LAYING: Fields = Fields {
    title: "[campaign.laying]",
    keys: &[
        not_negative(
            "gap_scatter",
            "m",
            "mean of the random gaps of a chain as it is laid; default 5 um",
        ),
        quantity(
            "radius_spread",
            "1",
            SPREAD,
            "standard deviation of bead radii over their mean; default 0",
        ),
    ],
};

static ACTUATOR: Fields = Fields {
    title: "[campaign.actuator]",
    keys: &[
        positive(
            "resolution",
            "m/s",
            "step of the speeds that can be programmed; default 0.15 mm/s",
        ),
        not_negative(
            "spread",
            "m/s",
            "standard deviation of the speed from shot to shot; default 3 mm/s",
        ),
        positive("least_speed", "m/s", "slowest shot; default 0.05 m/s"),
        positive("most_speed", "m/s", "fastest shot; default 2.5 m/s"),
        not_negative(
            "placing",
            "m",
            "standard deviation of the place to which the striker is brought back; default 20 um",
        ),
    ],
};

static PHOTOGATE: Fields = Fields {
    title: "[campaign.photogate]",
    keys: &[
        not_negative(
            "error",
            "m/s",
            "standard deviation of a measured speed; default 0.5 mm/s",
        ),
        positive(
            "way",
            "m",
            "way of the striker from the gate to bead 1; default 1 mm",
        ),
    ],
};

static AMPLIFIER: Fields = Fields {
    title: "[campaign.amplifier]",
    keys: &[
        positive(
            "sensitivity",
            "C/N",
            "charge of the sensor bead's disc; default 10 pC/N",
        ),
        positive(
            "wall_sensitivity",
            "C/N",
            "charge of the wall's disc; default: as sensitivity",
        ),
        positive("gain", "V/C", "voltage for a charge; default 1 mV/pC"),
        positive(
            "low_pass",
            "Hz",
            "frequency above which the response falls; default 180 kHz",
        ),
        choice("order", ORDERS, "order of the low-pass; default second"),
        choice("kind", KINDS, "kind of the low-pass; default butterworth"),
        positive(
            "high_pass",
            "Hz",
            "frequency below which the response falls; default 0.5 Hz",
        ),
        not_negative(
            "noise",
            "V",
            "standard deviation of each sample's noise; default 1.5 mV",
        ),
    ],
};

static RECORDER: Fields = Fields {
    title: "[campaign.recorder]",
    keys: &[
        Key::new(
            "bits",
            Kind::Count { least: 2, most: 16 },
            "bits of a sample; default 16",
        ),
        positive("sampling", "Hz", "samples a second; default 1 MHz"),
        positive("range", "V", "largest voltage either way; default 10 V"),
        quantity(
            "offset",
            "V",
            Limits::ANY,
            "voltage of no signal; default 0",
        ),
        positive("record", "s", "length of a record; default 0.1 s"),
        not_negative(
            "before",
            "s",
            "part of a record before the trigger; default 2 ms",
        ),
        choice(
            "trigger",
            TRIGGERS,
            "what starts a record; default photogate",
        ),
        quantity(
            "level",
            "V",
            Limits::ANY,
            "voltage that triggers, with trigger = \"level\"; default 20 mV",
        ),
        choice(
            "channels",
            CHANNELS,
            "both sensors summed in one channel or each in a separate one; default summed",
        ),
    ],
};

/// The whole table.
pub(super) static CAMPAIGN: Fields = Fields {
    title: "[campaign]",
    keys: &[
        Key::new(
            "seed",
            Kind::Count {
                least: 0,
                most: 1 << 52,
            },
            "seed of all that is random; default 1",
        ),
        Key::new(
            "speeds",
            Kind::Quantities("m/s"),
            "programmed speeds; default that of the striker",
        ),
        positive("slowest", "m/s", "slowest of speeds in equal ratios"),
        positive("fastest", "m/s", "fastest of them"),
        number_of("speed_count", 2, "how many there are"),
        number_of(
            "shots",
            1,
            "shots of a series, all at one speed; default 20",
        ),
        number_of("taps", 0, "taps before a shot; default 40"),
        quantity(
            "tap_speed",
            "m/s",
            ranges::SPEED,
            "speed of the striker in a tap; default 0.18 m/s",
        ),
        Key::new(
            "cases",
            Kind::Tables(&CASE),
            "chains to be measured; default this file's one",
        ),
        part("laying", &LAYING, "how a chain is laid before a series"),
        part("actuator", &ACTUATOR, "what launches the striker"),
        part("photogate", &PHOTOGATE, "what measures the striker's speed"),
        part("amplifier", &AMPLIFIER, "what turns forces into voltages"),
        part("recorder", &RECORDER, "what turns voltages into records"),
    ],
};

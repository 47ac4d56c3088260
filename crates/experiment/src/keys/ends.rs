//! Tables of what stands at the two ends of a chain.

use super::tables::{MATERIAL_NAME, either_way, not_negative, positive, text};
use super::{Fields, Key, Kind, Need, Variants};

pub(super) static STRIKER: Fields = Fields {
    title: "[striker]",
    keys: &[
        positive("speed", "m/s", "speed toward the chain at first touch").needed(Need::Always),
        positive("radius", "m", "radius; default: as bead 1"),
        positive(
            "mass",
            "kg",
            "mass; default: as bead 1, or from the material's density",
        ),
        MATERIAL_NAME,
    ],
};

const DRIVEN_RADIUS: Key = positive(
    "radius",
    "m",
    "radius of the driven body; default: as bead 1",
);
const AMPLITUDE: Key = either_way("amplitude", "largest displacement").needed(Need::Always);

pub(super) static DRIVEN: Variants = Variants {
    title: "[driven]",
    tag: "motion",
    options: &[
        (
            "sine",
            Fields {
                title: "[driven] with motion = \"sine\"",
                keys: &[
                    AMPLITUDE,
                    positive("frequency", "Hz", "frequency").needed(Need::Always),
                    DRIVEN_RADIUS,
                    MATERIAL_NAME,
                ],
            },
        ),
        (
            "pulse",
            Fields {
                title: "[driven] with motion = \"pulse\"",
                keys: &[
                    AMPLITUDE,
                    positive("duration", "s", "duration of the push").needed(Need::Always),
                    DRIVEN_RADIUS,
                    MATERIAL_NAME,
                ],
            },
        ),
        (
            "table",
            Fields {
                title: "[driven] with motion = \"table\"",
                keys: &[
                    Key::new("times", Kind::Quantities("s"), "times, increasing"),
                    Key::new("positions", Kind::Quantities("m"), "positions, one a time"),
                    text(
                        "file",
                        "CSV file with columns time_s,position_m, beside this file",
                    ),
                    DRIVEN_RADIUS,
                    MATERIAL_NAME,
                ],
            },
        ),
    ],
};

const HALF_BEAD_RADIUS: Key =
    positive("radius", "m", "radius of the half-bead; default: as bead N");
const STOP_MASS: Key = positive("mass", "kg", "mass of the stop").needed(Need::Always);

pub(super) static FAR_END: Variants = Variants {
    title: "[far_end]",
    tag: "kind",
    options: &[
        (
            "half-bead",
            Fields {
                title: "[far_end] with kind = \"half-bead\"",
                keys: &[HALF_BEAD_RADIUS, MATERIAL_NAME],
            },
        ),
        (
            "plane",
            Fields {
                title: "[far_end] with kind = \"plane\"",
                keys: &[MATERIAL_NAME],
            },
        ),
        (
            "stop",
            Fields {
                title: "[far_end] with kind = \"stop\"",
                keys: &[STOP_MASS, HALF_BEAD_RADIUS, MATERIAL_NAME],
            },
        ),
        (
            "plane-stop",
            Fields {
                title: "[far_end] with kind = \"plane-stop\"",
                keys: &[STOP_MASS, MATERIAL_NAME],
            },
        ),
        (
            "periodic",
            Fields {
                title: "[far_end] with kind = \"periodic\"",
                keys: &[not_negative(
                    "force",
                    "N",
                    "static force around the ring; default 0",
                )],
            },
        ),
        (
            "free",
            Fields {
                title: "[far_end] with kind = \"free\"",
                keys: &[],
            },
        ),
    ],
};

pub(super) static NEAR_END: Variants = Variants {
    title: "[near_end]",
    tag: "push",
    options: &[
        (
            "constant",
            Fields {
                title: "[near_end] with push = \"constant\"",
                keys: &[not_negative("force", "N", "force on bead 1").needed(Need::Always)],
            },
        ),
        (
            "spring",
            Fields {
                title: "[near_end] with push = \"spring\"",
                keys: &[
                    not_negative("force", "N", "force on bead 1 at rest").needed(Need::Always),
                    not_negative("stiffness", "N/m", "stiffness of the spring")
                        .needed(Need::Always),
                ],
            },
        ),
    ],
};

//! What people write in good faith and the file calls otherwise.

/// Words for a key, and the key.
const KEYS: &[(&[&str], &str)] = &[
    (&["velocity", "v", "v0", "impact_speed"], "speed"),
    (&["speed", "v", "v0"], "velocity"),
    (&["position", "offset", "x"], "displacement"),
    (&["n", "number", "length", "num", "beads"], "count"),
    (
        &[
            "e",
            "y",
            "young",
            "youngs_modulus",
            "modulus",
            "elastic_modulus",
        ],
        "young_modulus",
    ),
    (&["nu", "ν", "poisson", "poissons_ratio"], "poisson_ratio"),
    (&["viscosity", "eta", "η"], "shear_viscosity"),
    (&["rho", "ρ"], "density"),
    (&["r"], "radius"),
    (&["m"], "mass"),
    (&["angle", "inclination", "tilt", "slope"], "incline"),
    (&["g"], "gravity"),
    (&["tolerance", "tol", "rtol", "precision"], "accuracy"),
    (&["dt", "time_step", "timestep", "step_size"], "step"),
    (&["time", "t_end", "end_time", "t_max", "tmax"], "duration"),
    (&["solver", "integrator", "name", "kind"], "method"),
    (&["law", "forces", "model"], "laws"),
    (&["first", "start", "begin"], "from"),
    (&["last", "end", "until"], "to"),
    (&["size", "width", "distance"], "gap"),
    (&["wall", "end", "far", "stop", "boundary"], "far_end"),
    (&["impactor", "projectile", "hammer"], "striker"),
    (
        &["chain", "balls", "spheres", "particles", "grains"],
        "beads",
    ),
    (&["name", "description"], "title"),
    (&["path", "csv"], "file"),
];

/// The key meant by another word for it, among those that a table knows.
pub(crate) fn meant<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let word = word.to_lowercase();
    let says = |key: &&'a str| {
        let mut rows = KEYS.iter().filter(|(_, meant)| meant == key);
        rows.any(|(words, _)| words.contains(&word.as_str()))
    };
    known.iter().copied().find(says)
}

/// What to do about a key that no other word stands for.
pub(crate) fn about(table: &str, key: &str) -> Option<&'static str> {
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

/// What to write in place of an option that there is not.
pub(crate) fn option(key: &str, word: &str) -> Option<&'static str> {
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

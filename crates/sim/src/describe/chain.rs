//! Beads and ends as understood.

use super::Group;
use hertzchain_chain::{Bead, Chain, FarEnd, Material, Push, Start, Tension};
use hertzchain_experiment::{Experiment, Method};

pub(super) fn experiment(experiment: &Experiment, chain: &Chain) -> Group {
    let mut group = Group::new("Experiment");
    group.text("title", experiment.title());
    group.text("reading", experiment.reading().to_string());
    group.count("sensor bead", experiment.sensor_bead());
    let solver = experiment.solver();
    let method = match solver.method {
        Method::Adaptive => "adaptive",
        Method::Rk4 => "rk4, fixed step",
        Method::Verlet => "verlet, fixed step",
    };
    group.text("solver", method);
    group.number("accuracy asked of times of flight", solver.accuracy, "");
    solver.step_s.into_iter().for_each(|step| group.number("step", step, "s"));
    match solver.duration_s {
        Some(duration) => group.number("duration", duration, "s"),
        None => {
            group.text("duration", "until the reflected pulse has passed and the striker is away")
        }
    }
    if let Some(liquid) = experiment.liquid() {
        group.text("liquid", liquid.name.clone());
        let viscosity = liquid.dynamic_viscosity_pa_s();
        viscosity.into_iter().for_each(|eta| group.number("its dynamic viscosity", eta, "Pa s"));
    }
    if chain.tension == Tension::Clipped {
        group.text("tension", "clipped: contacts never pull");
    }
    group
}

/// Most runs of equal beads that are listed.
const MOST_RUNS: usize = 8;

pub(super) fn beads(chain: &Chain) -> Group {
    let mut group = Group::new("Beads");
    group.count("number of beads N", chain.beads.len());
    let mass: f64 = chain.beads.iter().map(|bead| bead.mass_kg).sum();
    group.number("mass of all beads", mass, "kg");
    match cell(&chain.beads) {
        Some(length) => {
            group.count("beads in a unit cell", length);
            group.count("unit cells", chain.beads.len() / length);
            list(&mut group, &chain.beads[..length]);
        }
        None => list(&mut group, &chain.beads),
    }
    group
}

/// Longest unit cell that is looked for.
const LONGEST_CELL: usize = 6;

/// Length of a unit cell of unlike beads that repeats at least twice.
fn cell(beads: &[Bead]) -> Option<usize> {
    let repeats = |length: &usize| {
        beads.len() >= 2 * length && beads.iter().zip(&beads[*length..]).all(|(a, b)| a == b)
    };
    (1..=LONGEST_CELL).find(repeats).filter(|length| *length > 1)
}

fn list(group: &mut Group, beads: &[Bead]) {
    let runs: Vec<(usize, &[Bead])> = runs(beads);
    for (first, run) in runs.iter().take(MOST_RUNS) {
        let last = first + run.len() - 1;
        let name = match run.len() {
            1 => format!("bead {first}"),
            _ => format!("beads {first} to {last}"),
        };
        group.parts(name, bead(&run[0]));
    }
    if runs.len() > MOST_RUNS {
        group.count("more runs of equal beads", runs.len() - MOST_RUNS);
    }
}

/// Runs of equal beads with the number of their first one.
fn runs(beads: &[Bead]) -> Vec<(usize, &[Bead])> {
    let mut first = 1;
    let chunks = beads.chunk_by(|a, b| a == b);
    chunks
        .map(|run| {
            let at = first;
            first += run.len();
            (at, run)
        })
        .collect()
}

/// Numbers of a bead; the group is never shown as such.
fn bead(bead: &Bead) -> Group {
    let mut parts = Group::new("");
    parts.number("radius", bead.radius_m, "m");
    parts.number("mass", bead.mass_kg, "kg");
    material(&mut parts, &bead.material);
    parts
}

fn material(parts: &mut Group, material: &Material) {
    if material.young_modulus_pa.is_infinite() {
        return parts.text("material", "rigid");
    }
    parts.number("Young modulus", material.young_modulus_pa, "Pa");
    parts.number("Poisson ratio", material.poisson_ratio, "");
    if let Some(strength_pa) = material.yield_strength_pa {
        parts.number("yield strength", strength_pa, "Pa");
    }
    let (shear, bulk) = (material.shear_viscosity_pa_s, material.bulk_viscosity_pa_s);
    if shear != 0.0 || bulk != 0.0 {
        parts.number("shear viscosity", shear, "Pa s");
        parts.number("bulk viscosity", bulk, "Pa s");
    }
}

pub(super) fn ends(chain: &Chain) -> Group {
    let mut group = Group::new("Ends");
    match &chain.start {
        Start::Striker { bead: ball, speed_m_s } => {
            group.parts("striker", bead(ball));
            group.number("its speed", *speed_m_s, "m/s");
        }
        Start::Driven { motion, .. } => {
            group.text("near end", "follows a prescribed motion");
            group.number("its largest speed", motion.largest_speed_m_s(), "m/s");
        }
        Start::Free => {
            group.text("near end", "free");
            group.count("beads that start displaced or moving", chain.initial.len());
        }
    }
    match chain.push {
        Push::None => {}
        Push::Constant { force_n } => {
            let driven = matches!(chain.start, Start::Driven { .. });
            let what =
                if driven { "force of the driven body at rest" } else { "constant push on bead 1" };
            group.number(what, force_n, "N");
        }
        Push::Spring { force_n, stiffness_n_m } => {
            group.number("spring push on bead 1", force_n, "N");
            group.number("stiffness of that spring", stiffness_n_m, "N/m");
        }
    }
    if chain.incline_rad != 0.0 {
        group.number("incline", chain.incline_rad.to_degrees(), "°");
    }
    chain.suspension_m.into_iter().for_each(|length| group.number("threads", length, "m"));
    group.parts("far end", far(&chain.far));
    group
}

fn far(far: &FarEnd) -> Group {
    let mut parts = Group::new("");
    let kind = match far {
        FarEnd::HalfBead { .. } => "fixed half-bead",
        FarEnd::Plane { .. } => "fixed plane",
        FarEnd::Stop { .. } => "half-bead on a stop",
        FarEnd::PlaneStop { .. } => "plane on a stop",
        FarEnd::Periodic { .. } => "bead 1 again (a ring)",
        FarEnd::Free => "free",
    };
    parts.text("kind", kind);
    if let FarEnd::Stop { mass_kg, .. } | FarEnd::PlaneStop { mass_kg, .. } = far {
        parts.number("mass of the stop", *mass_kg, "kg");
    }
    if let FarEnd::HalfBead { radius_m, .. } | FarEnd::Stop { radius_m, .. } = far {
        parts.number("radius", *radius_m, "m");
    }
    match far {
        FarEnd::HalfBead { material: of, .. }
        | FarEnd::Plane { material: of }
        | FarEnd::Stop { material: of, .. }
        | FarEnd::PlaneStop { material: of, .. } => material(&mut parts, of),
        FarEnd::Periodic { force_n } => parts.number("static force", *force_n, "N"),
        FarEnd::Free => {}
    }
    parts
}

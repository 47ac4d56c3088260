//! Beads and ends as understood.

use super::Group;
use hertzchain_chain::{Bead, Chain, FarEnd, Material, Push, Start, Tension};
use hertzchain_experiment::{Experiment, Method};

pub(super) fn experiment(experiment: &Experiment, chain: &Chain) -> Group {
    let mut group = Group::new("Experiment");
    group.text("title", experiment.title());
    group.text("reading", experiment.reading().to_string());
    group.text("sensor bead", experiment.sensor_bead().to_string());
    let solver = experiment.solver();
    let method = match solver.method {
        Method::Adaptive => "adaptive",
        Method::Rk4 => "rk4, fixed step",
        Method::Verlet => "verlet, fixed step",
    };
    group.text("solver", method);
    group.number("accuracy asked of times of flight", solver.accuracy, "");
    solver
        .step_s
        .into_iter()
        .for_each(|step| group.number("step", step, "s"));
    match solver.duration_s {
        Some(duration) => group.number("duration", duration, "s"),
        None => group.text("duration", "until the reflected pulse has passed"),
    }
    if let Some(liquid) = experiment.liquid() {
        group.text("liquid", liquid.name.clone());
        let viscosity = liquid.dynamic_viscosity_pa_s();
        viscosity
            .into_iter()
            .for_each(|eta| group.number("its dynamic viscosity", eta, "Pa s"));
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
    group.text("number of beads N", chain.beads.len().to_string());
    let mass: f64 = chain.beads.iter().map(|bead| bead.mass_kg).sum();
    group.number("mass of all beads", mass, "kg");
    match cell(&chain.beads) {
        Some(length) => {
            let cells = chain.beads.len() / length;
            group.text(
                "unit cell",
                format!("{length} beads, repeated {cells} times"),
            );
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
    (1..=LONGEST_CELL)
        .find(repeats)
        .filter(|length| *length > 1)
}

fn list(group: &mut Group, beads: &[Bead]) {
    let runs: Vec<(usize, &[Bead])> = runs(beads);
    for (first, run) in runs.iter().take(MOST_RUNS) {
        let last = first + run.len() - 1;
        let name = match run.len() {
            1 => format!("bead {first}"),
            _ => format!("beads {first} to {last}"),
        };
        group.text(name, bead(&run[0]));
    }
    if runs.len() > MOST_RUNS {
        let more = runs.len() - MOST_RUNS;
        group.text("", format!("and {more} more runs of equal beads"));
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

fn bead(bead: &Bead) -> String {
    format!(
        "radius {} m, mass {} kg, {}",
        short(bead.radius_m),
        short(bead.mass_kg),
        material(&bead.material)
    )
}

fn material(material: &Material) -> String {
    if material.young_modulus_pa.is_infinite() {
        return "rigid".to_owned();
    }
    let mut text = format!(
        "Y {} Pa, ν {}",
        short(material.young_modulus_pa),
        short(material.poisson_ratio)
    );
    let (shear, bulk) = (material.shear_viscosity_pa_s, material.bulk_viscosity_pa_s);
    if shear != 0.0 || bulk != 0.0 {
        text += &format!(", η1 {} Pa s, η2 {} Pa s", short(shear), short(bulk));
    }
    text
}

/// A number with at most seven digits.
pub(super) fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.6e}").parse().unwrap_or(value);
    if rounded != 0.0 && !(1e-3..1e6).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        format!("{rounded}")
    }
}

pub(super) fn ends(chain: &Chain) -> Group {
    let mut group = Group::new("Ends");
    match &chain.start {
        Start::Striker {
            bead: ball,
            speed_m_s,
        } => {
            group.text("striker", bead(ball));
            group.number("its speed", *speed_m_s, "m/s");
        }
        Start::Driven { motion, .. } => {
            group.text("near end", "follows a prescribed motion");
            group.number("its largest speed", motion.largest_speed_m_s(), "m/s");
        }
        Start::Free => {
            let moving = chain.initial.len();
            group.text(
                "near end",
                format!("free; {moving} beads start displaced or moving"),
            );
        }
    }
    match chain.push {
        Push::None => {}
        Push::Constant { force_n } => group.number("constant push on bead 1", force_n, "N"),
        Push::Spring {
            force_n,
            stiffness_n_m,
        } => {
            group.number("spring push on bead 1", force_n, "N");
            group.number("stiffness of that spring", stiffness_n_m, "N/m");
        }
    }
    if chain.incline_rad != 0.0 {
        group.number("incline", chain.incline_rad.to_degrees(), "°");
    }
    chain
        .suspension_m
        .into_iter()
        .for_each(|length| group.number("threads", length, "m"));
    group.text("far end", far(&chain.far));
    group
}

fn far(far: &FarEnd) -> String {
    match far {
        FarEnd::HalfBead {
            radius_m,
            material: of,
        } => {
            format!(
                "fixed half-bead, radius {} m, {}",
                short(*radius_m),
                material(of)
            )
        }
        FarEnd::Plane { material: of } => format!("fixed plane, {}", material(of)),
        FarEnd::Stop {
            radius_m,
            material: of,
            mass_kg,
        } => format!(
            "half-bead on a stop of {} kg, radius {} m, {}",
            short(*mass_kg),
            short(*radius_m),
            material(of)
        ),
        FarEnd::PlaneStop {
            material: of,
            mass_kg,
        } => {
            format!(
                "plane on a stop of {} kg, {}",
                short(*mass_kg),
                material(of)
            )
        }
        FarEnd::Periodic { force_n } => {
            format!("bead 1 again (a ring), static force {} N", short(*force_n))
        }
        FarEnd::Free => "free".to_owned(),
    }
}

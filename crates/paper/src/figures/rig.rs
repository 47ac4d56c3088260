//! The rig, drawn from an experiment: what the simulation uses, and around it
//! what the file's `[rig]` describes.

use crate::reproduce::{Cases, ReproduceError};
use hertzchain_chain::{Bead, Chain, FarEnd, Start};
use hertzchain_experiment::{Experiment, RigPart, RigPartKind, Units};
use hertzchain_figures::{Figure, RigDrawing, RigEnd};

/// The paper's Fig. 1: the wet rig with all that stands around the chain.
pub(super) fn figure(cases: &Cases) -> Result<Figure, ReproduceError> {
    let experiment = cases.get("motor")?;
    let drawing = RigDrawing {
        // The figures that follow have many speeds.
        striker_label: "$v_0$".to_owned(),
        ..rig(experiment)?
    };
    let caption = format!(
        "Drawn from the experiment file of the motor oil: what moves, what is wet, where forces \
         are measured.{} Not to scale{}.",
        not_modelled(experiment)?,
        part(experiment, RigPartKind::Bar).map_or("", |_| "; where the bar stands is not known"),
    );
    Ok(drawing.figure().title("The rig").caption(&caption))
}

/// A drawing of what an experiment file describes.
///
/// Where both the model and `[rig]` give a number, the model's is drawn.
pub(crate) fn rig(experiment: &Experiment) -> Result<RigDrawing, ReproduceError> {
    let (chain, _warnings) = experiment.chain(None)?;
    let beads = chain.beads.len();
    let liquid = experiment.liquid().map(|liquid| unbroken(&liquid.name));
    let named = |kind| part(experiment, kind).map_or(String::new(), |part| label(experiment, part));
    Ok(RigDrawing {
        beads,
        bead_label: bead_label(experiment, &chain.beads),
        striker_ratio: striker_ratio(&chain),
        striker_label: striker_label(experiment),
        sensor_bead: Some(experiment.sensor_bead()),
        sensor_label: named(RigPartKind::Sensor),
        wet_contacts: wet_contacts(experiment, beads),
        liquid: liquid.unwrap_or_default(),
        incline_deg: chain.incline_rad.to_degrees(),
        far_end: far_end(&chain.far),
        wall_sensor: experiment.has_wall(),
        actuator: named(RigPartKind::Actuator),
        repositioner: named(RigPartKind::Repositioner),
        photogate: named(RigPartKind::Photogate),
        springs: {
            let pushed = Some(chain.push.force_n()).filter(|newtons| *newtons > 0.0);
            modelled(experiment, RigPartKind::Springs, "push", pushed.map(force))
        },
        recorder: named(RigPartKind::Recorder),
        stop: named(RigPartKind::Stop),
        end_structure: {
            let mass = stop_mass(&chain.far).map(kilograms);
            modelled(experiment, RigPartKind::EndStructure, "stop", mass)
        },
        bar: named(RigPartKind::Bar),
    })
}

fn part(experiment: &Experiment, kind: RigPartKind) -> Option<&RigPart> {
    experiment.rig().and_then(|rig| rig.part(kind))
}

/// What of the rig the model leaves out, as a sentence of a caption.
fn not_modelled(experiment: &Experiment) -> Result<String, ReproduceError> {
    let (chain, _warnings) = experiment.chain(None)?;
    let name = |kind| part(experiment, kind).map(|part| part.name.clone());
    let pushed = chain.push.force_n() > 0.0;
    let absent = [
        name(RigPartKind::Springs).filter(|_| !pushed),
        name(RigPartKind::EndStructure).filter(|_| stop_mass(&chain.far).is_none()),
        name(RigPartKind::Bar),
    ];
    let absent: Vec<String> = absent.into_iter().flatten().collect();
    Ok(match absent.split_last() {
        None => String::new(),
        Some((only, [])) => format!(" The model computes without the {only}."),
        Some((last, others)) => {
            let others = others.join(", the ");
            format!(" The model computes without the {others} and the {last}.")
        }
    })
}

fn label(experiment: &Experiment, part: &RigPart) -> String {
    let recorded = match (part.bits, part.rate_hz) {
        (Some(bits), Some(rate)) => Some(format!("{bits}-bit ADC at {}", kilohertz(rate))),
        (Some(bits), None) => Some(format!("{bits}-bit ADC")),
        (None, Some(rate)) => Some(kilohertz(rate)),
        (None, None) => None,
    };
    let numbers = [
        part.mass_kg.map(kilograms),
        part.length_m.map(|length| format!("{}\u{a0}mm", digits(length * 1e3))),
        part.force_n.map(force),
        recorded.map(|words| unbroken(&words)),
    ];
    let numbers = match experiment.units() {
        Units::Si => numbers.into_iter().flatten().collect(),
        Units::Dimensionless => Vec::new(),
    };
    let words: Vec<String> = std::iter::once(part.name.clone()).chain(numbers).collect();
    words.join(", ")
}

fn kilohertz(hertz: f64) -> String {
    format!("{} kHz", digits(hertz * 1e-3))
}

fn unbroken(words: &str) -> String {
    words.replace(' ', "\u{a0}")
}

fn kilograms(mass: f64) -> String {
    format!("{}\u{a0}kg", digits(mass))
}

fn force(newtons: f64) -> String {
    format!("$F$\u{a0}=\u{a0}{}\u{a0}N", digits(newtons))
}

/// A number with at most five digits.
fn digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.4e}").parse().unwrap_or(value);
    rounded.to_string()
}

/// Radius and mass where all beads have the same.
fn bead_label(experiment: &Experiment, beads: &[Bead]) -> String {
    let words = experiment.rig().and_then(|rig| rig.beads.clone());
    let words = words.map(|words| unbroken(&words));
    let same = |of: fn(&Bead) -> f64| {
        let first = beads.first().map(of)?;
        beads.iter().all(|bead| of(bead) == first).then_some(first)
    };
    let si = experiment.units() == Units::Si;
    let radius = same(|bead| bead.radius_m).filter(|_| si);
    let mass = same(|bead| bead.mass_kg).filter(|_| si);
    let numbers = [
        radius.map(|m| format!("$R$\u{a0}=\u{a0}{}\u{a0}mm", digits(m * 1e3))),
        mass.map(|kg| format!("$m$\u{a0}=\u{a0}{}\u{a0}g", digits(kg * 1e3))),
    ];
    let all: Vec<String> = words.into_iter().chain(numbers.into_iter().flatten()).collect();
    all.join(", ")
}

fn striker_ratio(chain: &Chain) -> Option<f64> {
    let first = chain.beads.first()?;
    match &chain.start {
        Start::Striker { bead, .. } => Some(bead.radius_m / first.radius_m),
        Start::Driven { .. } | Start::Free => None,
    }
}

fn striker_label(experiment: &Experiment) -> String {
    let speed = experiment.speed_m_s().map(digits);
    match (speed, experiment.units()) {
        (Some(speed), Units::Si) => format!("$v_0$\u{a0}=\u{a0}{speed}\u{a0}m/s"),
        (Some(speed), Units::Dimensionless) => format!("$v_0$\u{a0}=\u{a0}{speed}"),
        (None, _) => String::new(),
    }
}

fn wet_contacts(experiment: &Experiment, beads: usize) -> Option<(usize, usize)> {
    let wet = experiment.sections().iter().filter(|section| section.wet);
    let spans = wet.map(|section| (section.from, section.last(beads)));
    spans.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// A part of the rig with the model's number in the place of the rig's, and by this name if the rig
/// has none.
fn modelled(
    experiment: &Experiment,
    kind: RigPartKind,
    name: &str,
    number: Option<String>,
) -> String {
    let described = part(experiment, kind);
    let name = described.map_or(name, |part| &part.name);
    match (number, described) {
        (Some(number), _) if experiment.units() == Units::Si => format!("{name}, {number}"),
        (Some(_), _) => name.to_owned(),
        (None, Some(part)) => label(experiment, part),
        (None, None) => String::new(),
    }
}

fn far_end(far: &FarEnd) -> RigEnd {
    match far {
        FarEnd::HalfBead { .. } | FarEnd::Stop { .. } => RigEnd::HalfBead,
        FarEnd::Plane { .. } | FarEnd::PlaneStop { .. } => RigEnd::Plane,
        FarEnd::Periodic { .. } | FarEnd::Free => RigEnd::Open,
    }
}

fn stop_mass(far: &FarEnd) -> Option<f64> {
    match far {
        FarEnd::Stop { mass_kg, .. } | FarEnd::PlaneStop { mass_kg, .. } => Some(*mass_kg),
        _ => None,
    }
}

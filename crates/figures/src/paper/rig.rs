//! The rig, drawn from an experiment.

use super::PaperError;
use crate::{FarEnd, Figure, RigDrawing};
use hertzchain_chain::{Chain, FarEnd as ChainEnd, Push, Start};
use hertzchain_experiment::Experiment;
use hertzchain_experiment::reading::{PRELOAD_N, STOP_MASS_KG};
use hertzchain_study::reproduce::{Cases, ReproduceError};

/// The paper's Fig. 1: the wet rig with all that stands around the chain.
pub(super) fn figure(cases: &Cases) -> Result<Figure, PaperError> {
    let missing = || ReproduceError::NoCase("motor".to_owned());
    let experiment = cases.get("motor").ok_or_else(missing)?;
    let drawing = rig(experiment)?;
    // What the rig has, whatever a reading of the model leaves out.
    let complete = RigDrawing {
        bead_material: "AISI 316".to_owned(),
        striker_label: "$v_0$".to_owned(),
        liquid: "oil".to_owned(),
        preload_n: Some(PRELOAD_N),
        stop_mass_kg: Some(STOP_MASS_KG),
        actuator: true,
        photogate: true,
        recorder: "charge amplifier, 16-bit ADC".to_owned(),
        ..drawing
    };
    Ok(complete.figure().title("The rig").caption(
        "The paper's rig, drawn from the experiment file of the motor oil: what moves, what is \
         wet, where forces are measured. Not to scale.",
    ))
}

/// A drawing of what an experiment file describes.
///
/// # Errors
/// A chain that can't be set up.
pub fn rig(experiment: &Experiment) -> Result<RigDrawing, PaperError> {
    let (chain, _warnings) = experiment.chain(None).map_err(ReproduceError::from)?;
    let beads = chain.beads.len();
    let liquid = experiment.liquid().map(|liquid| liquid.name.clone());
    Ok(RigDrawing {
        beads,
        bead_radius_m: chain.beads.first().map_or(0.0, |bead| bead.radius_m),
        striker_radius_m: striker(&chain),
        striker_label: experiment
            .speed_m_s()
            .map_or(String::new(), |v| format!("{v} m/s")),
        sensor_bead: Some(experiment.sensor_bead()),
        wet_contacts: wet_contacts(experiment, beads),
        liquid: liquid.unwrap_or_default(),
        preload_n: preload(&chain.push),
        incline_deg: chain.incline_rad.to_degrees(),
        far_end: far_end(&chain.far),
        wall_sensor: experiment.has_wall(),
        stop_mass_kg: stop_mass(&chain.far),
        ..RigDrawing::default()
    })
}

fn striker(chain: &Chain) -> Option<f64> {
    match &chain.start {
        Start::Striker { bead, .. } => Some(bead.radius_m),
        Start::Driven { .. } | Start::Free => None,
    }
}

fn wet_contacts(experiment: &Experiment, beads: usize) -> Option<(usize, usize)> {
    let wet = experiment.sections().iter().filter(|section| section.wet);
    let spans = wet.map(|section| (section.from, section.last(beads)));
    spans.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

fn preload(push: &Push) -> Option<f64> {
    (push.force_n() > 0.0).then(|| push.force_n())
}

fn far_end(far: &ChainEnd) -> FarEnd {
    match far {
        ChainEnd::HalfBead { .. } | ChainEnd::Stop { .. } => FarEnd::HalfBead,
        ChainEnd::Plane { .. } | ChainEnd::PlaneStop { .. } => FarEnd::Plane,
        ChainEnd::Periodic { .. } | ChainEnd::Free => FarEnd::Open,
    }
}

fn stop_mass(far: &ChainEnd) -> Option<f64> {
    match far {
        ChainEnd::Stop { mass_kg, .. } | ChainEnd::PlaneStop { mass_kg, .. } => Some(*mass_kg),
        _ => None,
    }
}

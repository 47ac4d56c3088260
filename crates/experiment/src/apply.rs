//! What each switch of a reading changes in an experiment.

use crate::reading::{
    BulkViscosityReading, Contact6Reading, CubicGateReading, DryCubicReading, HalfBeadReading,
    InclineReading, PRELOAD_N, PoissonReading, PreloadReading, Reading, SPRING_STIFFNESS_N_M,
    STOP_MASS_KG, SensorReading, StopReading, StrikerReading, TensionReading, WallLiquidReading,
    WallShapeReading, WetEverywhereReading,
};
use crate::spec::{Far, SectionSpec, Spec};
use hertzchain_chain::laws::find;
use hertzchain_chain::{Push, Tension};

/// The experiment as written, in a reading.
pub(crate) fn apply(written: &Spec, reading: &Reading) -> Spec {
    let mut spec = Spec {
        reading: *reading,
        ..written.clone()
    };
    materials(&mut spec, reading);
    counting(&mut spec, reading);
    surroundings(&mut spec, reading);
    wall(&mut spec, reading);
    sections(&mut spec, reading);
    laws(&mut spec, reading);
    spec
}

fn materials(spec: &mut Spec, reading: &Reading) {
    for material in &mut spec.materials.0 {
        if reading.poisson == PoissonReading::Bounded {
            material.largest_poisson_ratio = 0.5;
        }
        material.without_bulk_viscosity = reading.bulk_viscosity == BulkViscosityReading::Zero;
    }
}

/// Who is one of the 40.
fn counting(spec: &mut Spec, reading: &Reading) {
    spec.beads_less = usize::from(reading.striker == StrikerReading::Within)
        + usize::from(reading.half_bead == HalfBeadReading::Within);
    if reading.sensor_counted_from == SensorReading::Striker {
        spec.sensors.bead = spec.sensors.bead.saturating_sub(1);
    }
}

fn surroundings(spec: &mut Spec, reading: &Reading) {
    match reading.preload {
        PreloadReading::None => {}
        PreloadReading::Spring => {
            spec.push = Push::Spring {
                force_n: PRELOAD_N,
                stiffness_n_m: SPRING_STIFFNESS_N_M,
            };
        }
        PreloadReading::Constant => spec.push = Push::Constant { force_n: PRELOAD_N },
    }
    match reading.incline {
        InclineReading::Level => {}
        InclineReading::Half => spec.incline_rad = 0.5f64.to_radians(),
        InclineReading::One => spec.incline_rad = 1f64.to_radians(),
    }
    if reading.tension == TensionReading::Clipped {
        spec.tension = Tension::Clipped;
    }
}

fn wall(spec: &mut Spec, reading: &Reading) {
    if reading.wall_shape == WallShapeReading::Plane
        && let Far::HalfBead { shape, stop_kg } = &spec.far
    {
        spec.far = Far::Plane {
            shape: shape.clone(),
            stop_kg: *stop_kg,
        };
    }
    if reading.stop == StopReading::Heavy
        && let Far::HalfBead { stop_kg, .. } | Far::Plane { stop_kg, .. } = &mut spec.far
    {
        *stop_kg = Some(STOP_MASS_KG);
    }
}

fn sections(spec: &mut Spec, reading: &Reading) {
    let Some(wet) = spec.sections.iter().position(|section| section.wet) else {
        return;
    };
    let dry = spec.sections.iter().find(|section| !section.wet).cloned();
    let earlier = usize::from(reading.contact_6 == Contact6Reading::Wet)
        + usize::from(reading.sensor_counted_from == SensorReading::Striker);
    begin_earlier(&mut spec.sections, wet, earlier);
    if reading.wet_everywhere == WetEverywhereReading::Yes
        && let Some(section) = spec.sections.iter().find(|section| section.wet)
    {
        spec.sections = vec![SectionSpec {
            from: 0,
            to: None,
            ..section.clone()
        }];
    }
    if reading.wall_liquid == WallLiquidReading::Dry {
        dry_wall(spec, dry);
    }
}

/// Moves the beginning of a section toward the striker.
fn begin_earlier(sections: &mut Vec<SectionSpec>, at: usize, by: usize) {
    let Some(from) = sections.get(at).map(|section| section.from) else {
        return;
    };
    let begin = from.saturating_sub(by);
    for section in sections.iter_mut().take(at) {
        section.to = section.to.map(|to| to.min(begin.saturating_sub(1)));
    }
    if let Some(section) = sections.get_mut(at) {
        section.from = begin;
    }
    let mut index = 0;
    sections.retain(|section| {
        index += 1;
        index > at || section.from < begin
    });
}

/// The wall contact gets the laws of a dry section.
fn dry_wall(spec: &mut Spec, dry: Option<SectionSpec>) {
    let contact = spec.bead_count();
    let (Some(dry), Some(last)) = (dry, spec.sections.last_mut()) else {
        return;
    };
    if !last.wet {
        return;
    }
    if last.from >= contact {
        spec.sections.pop();
    } else {
        last.to = Some(contact - 1);
    }
    spec.sections.push(SectionSpec {
        from: contact,
        to: None,
        ..dry
    });
}

fn laws(spec: &mut Spec, reading: &Reading) {
    let some_wet = spec.sections.iter().any(|section| section.wet);
    let cubic = |name: &str| name == "damping_cubic" || name == "damping_cubic_ungated";
    for section in &mut spec.sections {
        if some_wet && !section.wet && reading.dry_cubic_beside_wet == DryCubicReading::Without {
            section.laws.retain(|law| !cubic(law.name()));
        }
        if reading.cubic_gate == CubicGateReading::Always {
            for law in section
                .laws
                .iter_mut()
                .filter(|law| law.name() == "damping_cubic")
            {
                law.row = find("damping_cubic_ungated").unwrap_or(law.row);
            }
        }
    }
}

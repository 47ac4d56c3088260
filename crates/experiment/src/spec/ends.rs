//! What stands at the two ends of the chain.

use super::Materials;
use crate::finding::Problem;
use crate::keys::ranges::SPEED;
use crate::motion_file;
use crate::value::brief;
use crate::view::View;
use hertzchain_chain::{Motion, Push};
use std::ops::Range;
use std::path::Path;

/// Shape and material of body 0 or of a half-bead, as far as given.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Shape {
    pub(crate) radius_m: Option<f64>,
    pub(crate) mass_kg: Option<f64>,
    pub(crate) material: Option<usize>,
    pub(crate) span: Range<usize>,
}

/// What sets the chain in motion.
#[derive(Clone, Debug)]
pub(crate) enum Near {
    Striker {
        shape: Shape,
        speed_m_s: f64,
        speed_span: Range<usize>,
    },
    Driven {
        shape: Shape,
        motion: Motion,
    },
    /// Beads that start displaced or moving, as the file says here.
    Free {
        span: Range<usize>,
    },
}

impl Near {
    /// Speed of the striker in m/s, if there is one.
    pub(crate) fn speed_m_s(&self) -> Option<f64> {
        match self {
            Self::Striker { speed_m_s, .. } => Some(*speed_m_s),
            Self::Driven { .. } | Self::Free { .. } => None,
        }
    }

    /// Index of the material that its body is given.
    pub(crate) fn material(&self) -> Option<usize> {
        match self {
            Self::Striker { shape, .. } | Self::Driven { shape, .. } => shape.material,
            Self::Free { .. } => None,
        }
    }
}

/// What bead N leans on.
#[derive(Clone, Debug)]
pub(crate) enum Far {
    /// Fixed, or on a stop of this mass.
    HalfBead {
        shape: Shape,
        stop_kg: Option<f64>,
    },
    /// Fixed, or on a stop of this mass.
    Plane {
        shape: Shape,
        stop_kg: Option<f64>,
    },
    Periodic {
        force_n: f64,
    },
    Free,
}

impl Far {
    /// Index of the material that it is given.
    pub(crate) fn material(&self) -> Option<usize> {
        match self {
            Self::HalfBead { shape, .. } | Self::Plane { shape, .. } => shape.material,
            Self::Periodic { .. } | Self::Free => None,
        }
    }
}

fn shape(table: &View<'_>, materials: &Materials, keys: [&str; 2]) -> Result<Shape, Problem> {
    let number = |key: &str| match table.fields.key(key) {
        Some(_) => table.quantity(key),
        None => Ok(None),
    };
    Ok(Shape {
        radius_m: number(keys[0])?,
        mass_kg: number(keys[1])?,
        material: materials.find(table)?,
        span: table.span(),
    })
}

/// What sets the chain in motion.
pub(crate) fn near(root: &View<'_>, materials: &Materials, folder: &Path) -> Result<Near, Problem> {
    match (root.table("striker"), root.variant("driven")) {
        (Some(striker), Some((_, driven))) => {
            let message = "there are a striker and a driven end";
            let problem = Problem::new(&driven.span(), message, "expected one of the two");
            Err(problem.beside(&striker.span(), "the striker is here"))
        }
        (Some(striker), None) => Ok(Near::Striker {
            shape: shape(&striker, materials, ["radius", "mass"])?,
            speed_m_s: striker.needed("speed")?,
            speed_span: striker.span_of("speed"),
        }),
        (None, Some((tag, table))) => Ok(Near::Driven {
            shape: shape(&table, materials, ["radius", ""])?,
            motion: bearable(motion(tag, &table, folder)?, &table)?,
        }),
        (None, None) if root.has("initial") => Ok(Near::Free {
            span: root.tables("initial").first().map_or(0..0, View::span),
        }),
        (None, None) => {
            let message = "nothing sets the chain in motion";
            let label = "expected [striker], [driven] or [[initial]]";
            Err(Problem::new(&root.span_of("beads"), message, label))
        }
    }
}

fn motion(tag: &str, table: &View<'_>, folder: &Path) -> Result<Motion, Problem> {
    match tag {
        "sine" => Ok(Motion::Sine {
            amplitude_m: amplitude_m(table)?,
            frequency_hz: table.needed("frequency")?,
        }),
        "pulse" => Ok(Motion::Pulse {
            amplitude_m: amplitude_m(table)?,
            duration_s: table.needed("duration")?,
        }),
        _ => motion_file::table(table, folder),
    }
}

/// A motion as fast as a striker may be.
fn bearable(motion: Motion, table: &View<'_>) -> Result<Motion, Problem> {
    let speed_m_s = motion.largest_speed_m_s();
    let limits = SPEED.within(table.units, "m/s");
    if limits.hold(speed_m_s) {
        return Ok(motion);
    }
    let speed = table.units.with_unit(&brief(speed_m_s), "m/s");
    let message = format!("this motion reaches a speed of {speed}");
    let keys = ["frequency", "duration", "times", "file"];
    let place = keys.into_iter().find(|key| table.has(key));
    let place = place.map_or(table.span(), |key| table.span_of(key));
    let label = format!("expected a largest speed {}", limits.words);
    Err(Problem::new(&place, message, label))
}

/// An amplitude, which must move the body at all.
fn amplitude_m(table: &View<'_>) -> Result<f64, Problem> {
    let amplitude_m = table.needed("amplitude")?;
    if amplitude_m == 0.0 {
        let message = "an amplitude of 0 sets nothing in motion";
        let label = "expected a length, such as \"1 um\"";
        return Err(Problem::new(&table.span_of("amplitude"), message, label));
    }
    Ok(amplitude_m)
}

/// What pushes bead 1.
pub(crate) fn push(root: &View<'_>) -> Result<Push, Problem> {
    let Some((tag, table)) = root.variant("near_end") else {
        return Ok(Push::None);
    };
    let force_n = table.needed("force")?;
    Ok(match tag {
        "spring" => Push::Spring {
            force_n,
            stiffness_n_m: table.needed("stiffness")?,
        },
        _ => Push::Constant { force_n },
    })
}

/// What bead N leans on; a half-bead like bead N when the file is silent.
pub(crate) fn far(root: &View<'_>, materials: &Materials) -> Result<Far, Problem> {
    let Some((tag, table)) = root.variant("far_end") else {
        return Ok(Far::HalfBead {
            shape: Shape::default(),
            stop_kg: None,
        });
    };
    let half_bead = |stop_kg| -> Result<Far, Problem> {
        let shape = shape(&table, materials, ["radius", ""])?;
        Ok(Far::HalfBead { shape, stop_kg })
    };
    let plane = |stop_kg| -> Result<Far, Problem> {
        let shape = shape(&table, materials, ["", ""])?;
        Ok(Far::Plane { shape, stop_kg })
    };
    match tag {
        "half-bead" => half_bead(None),
        "stop" => half_bead(Some(table.needed("mass")?)),
        "plane" => plane(None),
        "plane-stop" => plane(Some(table.needed("mass")?)),
        "periodic" => Ok(Far::Periodic {
            force_n: table.quantity("force")?.unwrap_or(0.0),
        }),
        _ => Ok(Far::Free),
    }
}

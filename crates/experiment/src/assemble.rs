//! From what a file says to a chain for one impact speed.

use crate::finding::Problem;
use crate::keys::ranges::SPEED;
use crate::reference;
use crate::spec::{Far, Near, Shape, Spec};
use crate::validity;
use crate::value::short;
use hertzchain_chain::{Bead, Chain, FarEnd, Gap, Initial, Material, Section, Start};

/// A chain and its warnings.
pub(crate) type Assembled = (Chain, Vec<Problem>);

/// The chain of an experiment, hit at this speed.
pub(crate) fn chain(spec: &Spec, speed_m_s: Option<f64>) -> Result<Assembled, Problem> {
    let speed_m_s = striker_speed(spec, speed_m_s)?;
    let (materials, mut warnings) = materials(spec, speed_m_s)?;
    let beads = beads(spec, &materials)?;
    let (Some(first), Some(last)) = (beads.first(), beads.last()) else {
        return Err(Problem::new(
            &(0..0),
            "the chain has no beads",
            "expected at least one",
        ));
    };
    let start = start(spec, speed_m_s, first, &materials)?;
    let far = far(&spec.far, last, &materials);
    warnings.extend(inelastic(spec));
    warnings.extend(closed_gaps(spec));
    let mut chain = Chain {
        start,
        far,
        initial: initial(spec),
        push: spec.push,
        sections: sections(spec, &materials, beads.len())?,
        gaps: gaps(spec),
        incline_rad: spec.incline_rad,
        gravity_m_s2: spec.gravity_m_s2,
        suspension_m: spec.suspension_m,
        tension: spec.tension,
        beads,
    };
    chain.sections = reference::parted(spec, &chain)?;
    warnings.extend(validity::warnings(spec, &chain));
    Ok((chain, warnings))
}

/// The speed of the shot: the one asked for, else the file's.
fn striker_speed(spec: &Spec, asked_m_s: Option<f64>) -> Result<Option<f64>, Problem> {
    let limits = SPEED.within(spec.units, "m/s");
    match (&spec.near, asked_m_s) {
        (Near::Striker { .. }, Some(speed)) if limits.hold(speed) => Ok(Some(speed)),
        (Near::Striker { .. }, Some(speed)) => {
            let message = format!(
                "a shot at {} was asked for",
                spec.units.with_unit(&short(speed), "m/s")
            );
            let label = format!("expected a positive, finite speed, {}", limits.words);
            Err(Problem::new(&spec.near_span(), message, label))
        }
        (Near::Striker { speed_m_s, .. }, None) => Ok(Some(*speed_m_s)),
        (_, Some(speed)) => {
            let asked = spec.units.with_unit(&short(speed), "m/s");
            let message = format!("a shot at {asked} was asked for, but there is no striker");
            Err(no_striker(spec, message))
        }
        (_, None) => Ok(None),
    }
}

/// What else sets the chain in motion, where a striker is needed.
pub(crate) fn no_striker(spec: &Spec, message: impl Into<String>) -> Problem {
    Problem::new(&spec.near_span(), message, "this sets the chain in motion")
        .help("put a [striker] with a `speed` in its place")
}

impl Spec {
    /// Where the file says what sets the chain in motion.
    fn near_span(&self) -> std::ops::Range<usize> {
        match &self.near {
            Near::Striker { shape, .. } | Near::Driven { shape, .. } => shape.span.clone(),
            Near::Free { span } => span.clone(),
        }
    }

    /// Where the file says how fast it is set in motion.
    pub(crate) fn speed_span(&self) -> std::ops::Range<usize> {
        match &self.near {
            Near::Striker { speed_span, .. } => speed_span.clone(),
            Near::Driven { .. } | Near::Free { .. } => self.near_span(),
        }
    }

    /// Whether a case of the campaign names a material.
    fn case_uses(&self, index: usize) -> bool {
        let sections = self.cases.iter().filter_map(|case| case.sections.as_ref());
        let mut materials = sections.flatten().map(|section| section.material);
        materials.any(|material| material == Some(index))
    }

    /// Indices of the materials that bodies or contacts of the chain have.
    pub(crate) fn used_materials(&self) -> Vec<usize> {
        let parts = self.groups.iter().flat_map(|group| &group.cell);
        let sections = self.sections.iter().map(|section| section.material);
        let used = parts.map(|part| part.material).chain(sections);
        let ends = [self.near.material(), self.far.material()];
        used.chain(ends).flatten().collect()
    }
}

/// Every material at this speed; those without use only cost a warning.
fn materials(spec: &Spec, speed: Option<f64>) -> Result<(Vec<Material>, Vec<Problem>), Problem> {
    let used = spec.used_materials();
    let mut materials = Vec::new();
    let mut warnings = Vec::new();
    for (index, material) in spec.materials.0.iter().enumerate() {
        if used.contains(&index) {
            let (values, warning) = material.at(speed)?;
            materials.push(values);
            warnings.extend(warning);
        } else {
            materials.push(Material::RIGID);
            if spec.case_uses(index) {
                continue;
            }
            let message = format!("nothing is made of `{}`", material.name);
            warnings.push(Problem::new(
                &material.span,
                message,
                "this material is not used",
            ));
        }
    }
    Ok((materials, warnings))
}

fn beads(spec: &Spec, materials: &[Material]) -> Result<Vec<Bead>, Problem> {
    let mut beads = Vec::new();
    for group in &spec.groups {
        group.append(materials, &mut beads);
    }
    beads.truncate(spec.bead_count());
    Ok(beads)
}

fn start(
    spec: &Spec,
    speed_m_s: Option<f64>,
    first: &Bead,
    materials: &[Material],
) -> Result<Start, Problem> {
    match (&spec.near, speed_m_s) {
        (Near::Striker { shape, .. }, Some(speed_m_s)) => Ok(Start::Striker {
            bead: body_0(spec, shape, first, materials)?,
            speed_m_s,
        }),
        (Near::Driven { shape, motion }, _) => Ok(Start::Driven {
            bead: Bead {
                radius_m: shape.radius_m.unwrap_or(first.radius_m),
                mass_kg: first.mass_kg,
                material: material_of(shape, materials).unwrap_or(first.material),
            },
            motion: motion.clone(),
        }),
        _ => Ok(Start::Free),
    }
}

fn material_of(shape: &Shape, materials: &[Material]) -> Option<Material> {
    materials.get(shape.material?).copied()
}

/// The striker: what the file leaves out is as in bead 1; another size or
/// material has another mass, which then needs a density.
fn body_0(
    spec: &Spec,
    shape: &Shape,
    first: &Bead,
    materials: &[Material],
) -> Result<Bead, Problem> {
    let radius_m = shape.radius_m.unwrap_or(first.radius_m);
    let like_bead_1 =
        shape.radius_m.is_none_or(|r| r == first.radius_m) && shape.material.is_none();
    let index = shape
        .material
        .or_else(|| spec.groups.first()?.cell.first()?.material);
    let density = index.and_then(|i| spec.materials.0.get(i)?.density_kg_m3);
    let mass_kg = match (shape.mass_kg, density) {
        (Some(mass), _) => mass,
        (None, _) if like_bead_1 => first.mass_kg,
        (None, Some(density)) => crate::spec::sphere_mass_kg(radius_m, density),
        (None, None) => {
            let message = "the striker has no mass";
            let label = "it differs from bead 1: expected `mass = \"8.54 g\"`, or a density in its \
                         material";
            return Err(Problem::new(&shape.span, message, label));
        }
    };
    Ok(Bead {
        radius_m,
        mass_kg,
        material: material_of(shape, materials).unwrap_or(first.material),
    })
}

fn far(far: &Far, last: &Bead, materials: &[Material]) -> FarEnd {
    let material = |shape: &Shape| material_of(shape, materials).unwrap_or(last.material);
    let radius_m = |shape: &Shape| shape.radius_m.unwrap_or(last.radius_m);
    match far {
        Far::HalfBead { shape, stop_kg } => match stop_kg {
            None => FarEnd::HalfBead {
                radius_m: radius_m(shape),
                material: material(shape),
            },
            Some(mass_kg) => FarEnd::Stop {
                radius_m: radius_m(shape),
                material: material(shape),
                mass_kg: *mass_kg,
            },
        },
        Far::Plane { shape, stop_kg } => match stop_kg {
            None => FarEnd::Plane {
                material: material(shape),
            },
            Some(mass_kg) => FarEnd::PlaneStop {
                material: material(shape),
                mass_kg: *mass_kg,
            },
        },
        Far::Periodic { force_n } => FarEnd::Periodic { force_n: *force_n },
        Far::Free => FarEnd::Free,
    }
}

fn sections(spec: &Spec, materials: &[Material], beads: usize) -> Result<Vec<Section>, Problem> {
    let section = |section: &crate::spec::SectionSpec| {
        let laws = section.laws.iter().map(|law| law.build());
        Ok(Section {
            contacts: section.from..=section.last(beads),
            laws: laws.collect::<Result<_, _>>()?,
            material: section.material.and_then(|m| materials.get(m).copied()),
        })
    };
    spec.sections.iter().map(section).collect()
}

/// A warning for sections that nothing pushes apart.
fn inelastic(spec: &Spec) -> impl Iterator<Item = Problem> {
    let inelastic = spec.sections.iter().filter(|section| !section.is_elastic());
    inelastic.map(|section| {
        let message = "no law of these contacts pushes the beads apart";
        Problem::new(&section.laws_span, message, "an elastic law is missing")
            .help("add \"elastic_hertz\" to `laws`")
    })
}

/// A warning for gaps in contacts that are pressed together at rest.
fn closed_gaps(spec: &Spec) -> impl Iterator<Item = Problem> {
    let ring = matches!(spec.far, Far::Periodic { force_n } if force_n > 0.0);
    let weighs = spec.incline_rad > 0.0 && spec.gravity_m_s2 > 0.0;
    let pressed = ring || weighs || spec.push.force_n() > 0.0;
    let closed = (spec.gaps.iter()).filter(move |(gap, _)| pressed && gap.contact > 0);
    closed
        .filter(|(gap, _)| gap.gap_m > 0.0)
        .map(|(gap, span)| {
            let message = format!("contact {} is pressed together at rest", gap.contact);
            Problem::new(span, message, "this gap closes and has no effect")
        })
}

fn gaps(spec: &Spec) -> Vec<Gap> {
    spec.gaps.iter().map(|(gap, _)| *gap).collect()
}

fn initial(spec: &Spec) -> Vec<Initial> {
    spec.initial.iter().map(|(initial, _)| *initial).collect()
}

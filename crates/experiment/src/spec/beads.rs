//! Groups of beads.

use super::Materials;
use crate::finding::Problem;
use crate::keys::ranges::{LENGTH, MASS};
use crate::keys::{Limits, MOST_BEADS};
use crate::value::Units;
use crate::view::View;
use hertzchain_chain::{Bead, Material};
use std::f64::consts::PI;
use std::ops::Range;

/// A unit cell and how often it stands in a row.
#[derive(Clone, Debug)]
pub(crate) struct Group {
    pub(crate) cell: Vec<Part>,
    pub(crate) repeat: usize,
    /// Radii of a repetition over those of the one before.
    pub(crate) radius_ratio: f64,
    pub(crate) span: Range<usize>,
}

/// Identical beads in a unit cell.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub(crate) count: usize,
    pub(crate) radius_m: f64,
    pub(crate) mass_kg: f64,
    /// Index of the material; none in a dimensionless chain.
    pub(crate) material: Option<usize>,
}

impl Group {
    pub(crate) fn count(&self) -> usize {
        let cell: usize = self.cell.iter().map(|part| part.count).sum();
        cell.saturating_mul(self.repeat)
    }

    pub(crate) fn append(&self, materials: &[Material], beads: &mut Vec<Bead>) {
        for repetition in 0..self.repeat {
            let scale = self.scale(repetition);
            for part in &self.cell {
                let bead = Bead {
                    radius_m: part.radius_m * scale,
                    mass_kg: part.mass_kg * scale * scale * scale,
                    material: material(part.material, materials),
                };
                beads.extend(std::iter::repeat_n(bead, part.count));
            }
        }
    }

    fn scale(&self, repetition: usize) -> f64 {
        let power = i32::try_from(repetition).unwrap_or(i32::MAX);
        self.radius_ratio.powi(power)
    }
}

/// A material by its index; a body of no material does not yield.
pub(crate) fn material(index: Option<usize>, materials: &[Material]) -> Material {
    index
        .and_then(|i| materials.get(i).copied())
        .unwrap_or(Material::RIGID)
}

/// Mass in kg of a full sphere.
pub(crate) fn sphere_mass_kg(radius_m: f64, density_kg_m3: f64) -> f64 {
    4.0 / 3.0 * PI * radius_m * radius_m * radius_m * density_kg_m3
}

/// All groups of a file.
pub(crate) fn read(root: &View<'_>, materials: &Materials) -> Result<Vec<Group>, Problem> {
    let tables = root.tables("beads");
    let groups: Vec<Group> = tables
        .iter()
        .map(|table| group(table, materials))
        .collect::<Result<_, _>>()?;
    all_or_none_have_materials(&groups)?;
    let mut total = 0usize;
    for group in &groups {
        total = total.saturating_add(group.count());
        if i64::try_from(total).map_or(true, |n| n > MOST_BEADS) {
            let message = format!("the chain has more than {MOST_BEADS} beads");
            return Err(Problem::new(&group.span, message, "expected fewer here"));
        }
    }
    Ok(groups)
}

/// A dimensionless chain may do without materials, but not in part.
fn all_or_none_have_materials(groups: &[Group]) -> Result<(), Problem> {
    let bare = |group: &&Group| group.cell.iter().any(|part| part.material.is_none());
    let some = (groups.iter().flat_map(|g| &g.cell)).any(|part| part.material.is_some());
    match groups.iter().find(bare) {
        Some(group) if some => {
            let message = "these beads have no material, but others do";
            Err(Problem::new(
                &group.span,
                message,
                "expected `material = \"name\"`",
            ))
        }
        _ => Ok(()),
    }
}

fn group(table: &View<'_>, materials: &Materials) -> Result<Group, Problem> {
    let (cell, repeat) = if table.has("cell") {
        forbid(
            table,
            &["count", "radius", "mass", "material"],
            "with a cell; use `repeat`",
        )?;
        let cells = table.tables("cell");
        let parts = cells.iter().map(|cell| {
            let count = cell.count("count")?.unwrap_or(1);
            part(cell, materials, count)
        });
        let parts = parts.collect::<Result<_, _>>()?;
        (parts, table.count("repeat")?.unwrap_or(1))
    } else {
        forbid(table, &["repeat"], "without a cell; use `count`")?;
        let count = table.count("count")?.unwrap_or(1);
        (vec![part(table, materials, 1)?], count)
    };
    let group = Group {
        cell,
        repeat,
        radius_ratio: table.quantity("radius_ratio")?.unwrap_or(1.0),
        span: table.span(),
    };
    smallest_and_largest(&group, table)?;
    Ok(group)
}

fn forbid(table: &View<'_>, keys: &[&str], why: &str) -> Result<(), Problem> {
    match keys.iter().find(|key| table.has(key)) {
        None => Ok(()),
        Some(key) => {
            let message = format!("`{key}` has no meaning {why}");
            Err(Problem::new(
                &table.span_of(key),
                message,
                "expected nothing here",
            ))
        }
    }
}

fn part(table: &View<'_>, materials: &Materials, count: usize) -> Result<Part, Problem> {
    let material = materials.find(table)?;
    let lacks = |key: &str, label: &str| {
        let message = format!("these beads have no `{key}`");
        Problem::new(&table.span(), message, label)
    };
    let dimensionless = table.units == Units::Dimensionless;
    if material.is_none() && !dimensionless {
        return Err(lacks("material", "expected `material = \"name\"`"));
    }
    let radius_m = match table.quantity("radius")? {
        Some(radius) => radius,
        None if dimensionless => 1.0,
        None => return Err(lacks("radius", "expected `radius = \"6.35 mm\"`, a length")),
    };
    let density = material.and_then(|m| materials.0.get(m)?.density_kg_m3);
    let mass_kg = match (table.quantity("mass")?, density) {
        (Some(mass), _) => mass,
        (None, Some(density)) => sphere_mass_kg(radius_m, density),
        (None, None) if dimensionless => 1.0,
        (None, None) => {
            let label = "expected `mass = \"8.54 g\"`, or a `density` in the material";
            return Err(lacks("mass", label));
        }
    };
    Ok(Part {
        count,
        radius_m,
        mass_kg,
        material,
    })
}

/// A tapered group must keep radii and masses that a number can hold.
fn smallest_and_largest(group: &Group, table: &View<'_>) -> Result<(), Problem> {
    let scale = group.scale(group.repeat.saturating_sub(1));
    let sound = |value: f64, of: Limits, unit| of.within(table.units, unit).hold(value);
    let fits = |part: &Part| {
        let (radius_m, mass_kg) = (part.radius_m * scale, part.mass_kg * scale * scale * scale);
        sound(radius_m, LENGTH, "m") && sound(mass_kg, MASS, "kg")
    };
    if group.cell.iter().all(fits) {
        return Ok(());
    }
    let message = "the last beads of this group have a size or mass that no solid body has";
    let label = "expected a ratio nearer to 1, or fewer beads";
    Err(Problem::new(&table.span_of("radius_ratio"), message, label))
}

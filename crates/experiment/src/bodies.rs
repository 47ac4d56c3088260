//! Materials, whose numbers may depend on the striker's speed, and groups of beads.

use crate::document::as_key;
use crate::keys::{LENGTH, MASS, MOST_BEADS};
use crate::report::{FileProblem, brief, nearest_word, short, to_digits};
use crate::values::{SpeedLaw, TableView, Units};
use hertzchain_chain::{Bead, Material};
use std::f64::consts::PI;
use std::ops::{Range, RangeInclusive};

/// One material as written.
#[derive(Clone, Debug)]
pub(crate) struct MaterialSpec {
    pub(crate) name: String,
    pub(crate) span: Range<usize>,
    pub(crate) density_kg_m3: Option<f64>,
    yield_strength_pa: Option<f64>,
    /// Largest Poisson ratio; a reading bounds it.
    pub(crate) largest_poisson_ratio: f64,
    /// Whether a reading takes the bulk viscosity away.
    pub(crate) without_bulk_viscosity: bool,
    pub(crate) young_modulus: SpeedLaw,
    poisson_ratio: SpeedLaw,
    shear_viscosity: Option<SpeedLaw>,
    bulk_viscosity: Option<SpeedLaw>,
}

/// All materials of a file.
#[derive(Clone, Debug)]
pub(crate) struct Materials(pub(crate) Vec<MaterialSpec>);

impl Materials {
    pub(crate) fn read(root: &TableView<'_>) -> Result<Self, FileProblem> {
        let named = root.named("materials").into_iter();
        let specs = named.map(|(name, span, table)| MaterialSpec::read(name, span, &table));
        Ok(Self(specs.collect::<Result<_, _>>()?))
    }

    /// The material that a table names.
    pub(crate) fn find(&self, table: &TableView<'_>) -> Result<Option<usize>, FileProblem> {
        let Some(name) = table.text("material") else {
            return Ok(None);
        };
        let at = self.0.iter().position(|material| material.name == name);
        at.map(Some).ok_or_else(|| self.unknown(table, name))
    }

    fn unknown(&self, table: &TableView<'_>, name: &str) -> FileProblem {
        let names: Vec<&str> = self.0.iter().map(|m| m.name.as_str()).collect();
        let message = format!("there is no material `{name}`");
        let problem = table.problem("material", message, expected_material(&names));
        let bare = name.trim().trim_start_matches("materials.");
        match nearest_word(bare, names) {
            Some(near) => problem.nearest(Some(near)),
            None if name.is_empty() => problem,
            None => problem.help(format!(
                "no material is built in; write a table [materials.{}] with young_modulus and \
                 poisson_ratio",
                as_key(name)
            )),
        }
    }

    /// Whether no number of any depends on the striker's speed.
    pub(crate) fn is_constant(&self) -> bool {
        self.0.iter().all(MaterialSpec::is_constant)
    }

    /// Density of a material in kg/m³, where it has one.
    pub(crate) fn density_kg_m3(&self, index: Option<usize>) -> Option<f64> {
        self.0.get(index?)?.density_kg_m3
    }
}

/// "one of: "steel", "brass"", or the table that is missing.
pub(crate) fn expected_material(names: &[&str]) -> String {
    match names {
        [] => "expected the name of a table [materials.NAME], in quotes".to_owned(),
        [only] => format!("expected \"{only}\", the file's only material"),
        _ => format!("expected one of the file's materials: \"{}\"", names.join("\", \"")),
    }
}

impl MaterialSpec {
    fn read(name: &str, span: Range<usize>, table: &TableView<'_>) -> Result<Self, FileProblem> {
        let needed = |key: &str| {
            let message = || format!("material `{name}` has no `{key}`");
            let missing = || FileProblem::new(&span, message(), "expected it in this table");
            table.speed_law(key)?.ok_or_else(missing)
        };
        Ok(Self {
            name: name.to_owned(),
            density_kg_m3: table.quantity("density")?,
            yield_strength_pa: table.quantity("yield_strength")?,
            largest_poisson_ratio: f64::INFINITY,
            without_bulk_viscosity: false,
            young_modulus: needed("young_modulus")?,
            poisson_ratio: needed("poisson_ratio")?,
            shear_viscosity: table.speed_law("shear_viscosity")?,
            bulk_viscosity: table.speed_law("bulk_viscosity")?,
            span,
        })
    }

    fn is_constant(&self) -> bool {
        let viscosities = [&self.shear_viscosity, &self.bulk_viscosity];
        let given = [&self.young_modulus, &self.poisson_ratio].into_iter();
        let mut given = given.chain(viscosities.into_iter().flatten());
        given.all(|law| law.exponent == 0.0)
    }

    /// Where the larger of the viscosities stands, if there is one.
    pub(crate) fn viscosity_span(&self) -> Option<&Range<usize>> {
        let given = [&self.shear_viscosity, &self.bulk_viscosity];
        let given = given.into_iter().flatten();
        let largest = given.max_by(|a, b| a.prefactor.total_cmp(&b.prefactor))?;
        Some(&largest.span)
    }

    /// The material at a striker speed, and a warning about it.
    pub(crate) fn at(
        &self,
        speed_m_s: Option<f64>,
    ) -> Result<(Material, Option<FileProblem>), FileProblem> {
        let any = f64::INFINITY;
        let viscosity = |given: &Option<SpeedLaw>| {
            let value = |law: &SpeedLaw| law.at(speed_m_s, "viscosity", any);
            given.as_ref().map(value).transpose()
        };
        let young_modulus_pa = self.young_modulus.at(speed_m_s, "Young modulus", any)?;
        let most = self.largest_poisson_ratio;
        let poisson_ratio = self.poisson_ratio.at(speed_m_s, "Poisson ratio", most)?;
        let shear_viscosity_pa_s = viscosity(&self.shear_viscosity)?.unwrap_or(0.0);
        let bulk = viscosity(&self.bulk_viscosity)?.unwrap_or(shear_viscosity_pa_s);
        let material = Material {
            young_modulus_pa,
            poisson_ratio,
            shear_viscosity_pa_s,
            bulk_viscosity_pa_s: if self.without_bulk_viscosity { 0.0 } else { bulk },
            yield_strength_pa: self.yield_strength_pa,
        };
        Ok((material, self.beyond_half(poisson_ratio, speed_m_s)))
    }

    /// A warning when ν exceeds 1/2.
    fn beyond_half(&self, poisson_ratio: f64, speed_m_s: Option<f64>) -> Option<FileProblem> {
        let speed_m_s = speed_m_s.filter(|_| self.poisson_ratio.exponent != 0.0);
        let (name, value, at) = (&self.name, to_digits(poisson_ratio, 6), at(speed_m_s));
        let message = format!("the Poisson ratio of `{name}` is {value}{at}");
        (poisson_ratio > 0.5).then(|| {
            FileProblem::new(&self.poisson_ratio.span, message, "no solid is above 1/2")
                .help("taken as an effective number; it must stay below 1")
        })
    }
}

/// " at 0.5 m/s".
fn at(speed_m_s: Option<f64>) -> String {
    speed_m_s.map_or(String::new(), |speed| format!(" at {} m/s", short(speed)))
}

impl SpeedLaw {
    /// The value at a speed, at most so much.
    fn at(&self, speed_m_s: Option<f64>, name: &str, most: f64) -> Result<f64, FileProblem> {
        let value = match (speed_m_s, self.exponent == 0.0) {
            (_, true) => self.prefactor,
            (Some(speed), false) => self.prefactor * speed.powf(self.exponent),
            (None, false) => {
                let label = "expected a number, or a [striker] with a speed";
                let message = format!("{name} depends on a striker's speed and there is none");
                return Err(FileProblem::new(&self.span, message, label));
            }
        };
        let bounded = value.min(most);
        let (words, at) = (self.limits.words, at(speed_m_s));
        let message = || format!("{name} is {}{at}", to_digits(value, 6));
        let problem =
            || FileProblem::new(&self.span, message(), format!("expected a value {words}"));
        self.limits.hold(bounded).then_some(bounded).ok_or_else(problem)
    }
}

/// A unit cell and how often it stands in a row.
#[derive(Clone, Debug)]
pub(crate) struct BeadGroup {
    pub(crate) cell: Vec<CellPart>,
    repeat: usize,
    /// Radii of a repetition over those of the one before.
    radius_ratio: f64,
    pub(crate) span: Range<usize>,
}

/// Identical beads in a unit cell.
#[derive(Clone, Debug)]
pub(crate) struct CellPart {
    count: usize,
    radius_m: f64,
    mass_kg: f64,
    /// Index of the material; none in a dimensionless chain.
    pub(crate) material: Option<usize>,
}

impl BeadGroup {
    pub(crate) fn count(&self) -> usize {
        let cell: usize = self.cell.iter().map(|part| part.count).sum();
        cell.saturating_mul(self.repeat)
    }

    pub(crate) fn append(&self, materials: &[Material], beads: &mut Vec<Bead>) {
        for repetition in 0..self.repeat {
            let scale = self.scale(repetition);
            for part in &self.cell {
                let material = part.material.and_then(|at| materials.get(at));
                let bead = Bead {
                    radius_m: part.radius_m * scale,
                    mass_kg: part.mass_kg * scale * scale * scale,
                    // A body of no material does not yield.
                    material: material.copied().unwrap_or(Material::RIGID),
                };
                beads.extend(std::iter::repeat_n(bead, part.count));
            }
        }
    }

    /// Warnings of beads that no laboratory has, as when a unit is wrong.
    pub(crate) fn improbable(&self, specs: &Materials, values: &[Material]) -> Vec<FileProblem> {
        /// Larger than any ball that rolls.
        const LARGEST_M: f64 = 0.5;
        /// From foams to above osmium, in kg/m³.
        const DENSITIES: RangeInclusive<f64> = 10.0..=25e3;
        /// Glasses, ceramics and metals are denser than plastics; the softest of them, lead, has 16 GPa.
        const DENSE_KG_M3: f64 = 2400.0;
        const SOFT_PA: f64 = 5e9;
        let mut warnings = Vec::new();
        let mut warn = |span: &Range<usize>, message: String, label: &str| {
            warnings.push(FileProblem::new(span, message, label));
        };
        for part in &self.cell {
            let density = part.mass_kg / sphere_mass_kg(part.radius_m, 1.0);
            let shown = format!("{} g/cm^3", to_digits(1e-3 * density, 3));
            if part.radius_m > LARGEST_M {
                let message = format!("these beads have a radius of {} m", short(part.radius_m));
                warn(&self.span, message, "larger than any ball that rolls: is the unit right?");
            }
            if !DENSITIES.contains(&density) {
                let label = "no solid has it: are radius, mass and their units right?";
                warn(&self.span, format!("these beads have a density of {shown}"), label);
            }
            let Some(at) = part.material.filter(|_| density > DENSE_KG_M3) else { continue };
            if let (Some(spec), Some(value)) = (specs.0.get(at), values.get(at))
                && value.young_modulus_pa < SOFT_PA
            {
                let modulus = brief(1e-6 * value.young_modulus_pa);
                let message = format!(
                    "`{}` has a Young modulus of {modulus} MPa, and its beads a density of {shown}",
                    spec.name
                );
                let label = "solids as dense have at least some GPa: is the unit right?";
                warn(&spec.young_modulus.span, message, label);
            }
        }
        warnings
    }

    fn scale(&self, repetition: usize) -> f64 {
        let power = i32::try_from(repetition).unwrap_or(i32::MAX);
        self.radius_ratio.powi(power)
    }
}

/// Mass in kg of a full sphere.
pub(crate) fn sphere_mass_kg(radius_m: f64, density_kg_m3: f64) -> f64 {
    4.0 / 3.0 * PI * radius_m * radius_m * radius_m * density_kg_m3
}

/// All groups of a file.
pub(crate) fn groups(
    root: &TableView<'_>,
    materials: &Materials,
) -> Result<Vec<BeadGroup>, FileProblem> {
    let tables = root.tables("beads");
    let groups = tables.iter().map(|table| group(table, materials));
    let groups: Vec<BeadGroup> = groups.collect::<Result<_, _>>()?;
    // A dimensionless chain may do without materials, but not in part.
    let bare = |group: &&BeadGroup| group.cell.iter().any(|part| part.material.is_none());
    let mut parts = groups.iter().flat_map(|group| &group.cell);
    if let Some(group) = groups.iter().find(bare)
        && parts.any(|part| part.material.is_some())
    {
        let message = "these beads have no material, but others do";
        return Err(FileProblem::new(&group.span, message, "expected `material = \"name\"`"));
    }
    let mut total = 0usize;
    for group in &groups {
        total = total.saturating_add(group.count());
        if total as u64 > MOST_BEADS as u64 {
            let message = format!("the chain has more than {MOST_BEADS} beads");
            return Err(FileProblem::new(&group.span, message, "expected fewer here"));
        }
    }
    Ok(groups)
}

fn group(table: &TableView<'_>, materials: &Materials) -> Result<BeadGroup, FileProblem> {
    let has_cell = table.has("cell");
    let (foreign, why): (&[&str], _) = match has_cell {
        true => (&["count", "radius", "mass", "material"], "with a cell; use `repeat`"),
        false => (&["repeat"], "without a cell; use `count`"),
    };
    if let Some(key) = foreign.iter().find(|key| table.has(key)) {
        let message = format!("`{key}` has no meaning {why}");
        return Err(table.problem(key, message, "expected nothing here"));
    }
    let count = table.count(if has_cell { "repeat" } else { "count" })?;
    let tables = table.tables("cell");
    let cells = tables.iter().map(|cell| part(cell, materials, cell.count("count")?));
    let group = BeadGroup {
        cell: match has_cell {
            true => cells.collect::<Result<_, _>>()?,
            false => vec![part(table, materials, None)?],
        },
        repeat: count.unwrap_or(1),
        radius_ratio: table.quantity("radius_ratio")?.unwrap_or(1.0),
        span: table.span(),
    };
    // A tapered group must keep radii and masses that a number can hold.
    let scale = group.scale(group.repeat.saturating_sub(1));
    let fits = |part: &CellPart| {
        let (radius_m, mass_kg) = (part.radius_m * scale, part.mass_kg * scale * scale * scale);
        LENGTH.within(table.units, "m").hold(radius_m)
            && MASS.within(table.units, "kg").hold(mass_kg)
    };
    if group.cell.iter().all(fits) {
        return Ok(group);
    }
    let message = "the last beads of this group have a size or mass that no solid body has";
    let label = "expected a ratio nearer to 1, or fewer beads";
    Err(table.problem("radius_ratio", message, label))
}

fn part(
    table: &TableView<'_>,
    materials: &Materials,
    count: Option<usize>,
) -> Result<CellPart, FileProblem> {
    let material = materials.find(table)?;
    let lacks = |key: &str, label: &str| {
        let message = format!("these beads have no `{key}`");
        FileProblem::new(&table.span(), message, label)
    };
    // K = m = R = 1 unless written.
    let one = (table.units == Units::Dimensionless).then_some(1.0);
    if material.is_none() && one.is_none() {
        return Err(lacks("material", "expected `material = \"name\"`"));
    }
    let radius_m = table.quantity("radius")?.or(one);
    let radius_m =
        radius_m.ok_or_else(|| lacks("radius", "expected `radius = \"6.35 mm\"`, a length"))?;
    let density = materials.density_kg_m3(material);
    let full = density.map(|density| sphere_mass_kg(radius_m, density));
    let label = "expected `mass = \"8.54 g\"`, or a `density` in the material";
    let mass_kg = table.quantity("mass")?.or(full).or(one);
    Ok(CellPart {
        count: count.unwrap_or(1),
        radius_m,
        mass_kg: mass_kg.ok_or_else(|| lacks("mass", label))?,
        material,
    })
}

//! Materials of a file; their numbers may depend on the striker's speed.

use crate::finding::Problem;
use crate::known::expected_material;
use crate::nearest;
use crate::value::{rounded, short};
use crate::view::{Scaled, View};
use hertzchain_chain::Material;
use std::ops::Range;

/// One material as written.
#[derive(Clone, Debug)]
pub(crate) struct MaterialSpec {
    pub(crate) name: String,
    pub(crate) span: Range<usize>,
    pub(crate) density_kg_m3: Option<f64>,
    /// Largest Poisson ratio; a reading bounds it.
    pub(crate) largest_poisson_ratio: f64,
    /// Whether a reading takes the bulk viscosity away.
    pub(crate) without_bulk_viscosity: bool,
    young_modulus: Scaled,
    poisson_ratio: Scaled,
    shear_viscosity: Option<Scaled>,
    bulk_viscosity: Option<Scaled>,
}

/// All materials of a file.
#[derive(Clone, Debug)]
pub(crate) struct Materials(pub(crate) Vec<MaterialSpec>);

impl Materials {
    pub(crate) fn read(root: &View<'_>) -> Result<Self, Problem> {
        let named = root.named("materials").into_iter();
        let specs = named.map(|(name, span, table)| MaterialSpec::read(name, span, &table));
        Ok(Self(specs.collect::<Result<_, _>>()?))
    }

    /// The material that a table names.
    pub(crate) fn find(&self, table: &View<'_>) -> Result<Option<usize>, Problem> {
        let Some(name) = table.text("material") else {
            return Ok(None);
        };
        let at = self.0.iter().position(|material| material.name == name);
        at.map(Some).ok_or_else(|| self.unknown(table, name))
    }

    fn unknown(&self, table: &View<'_>, name: &str) -> Problem {
        let known: Vec<&str> = self.0.iter().map(|m| m.name.as_str()).collect();
        let label = expected_material(known.iter().copied());
        let message = format!("there is no material `{name}`");
        let problem = Problem::new(&table.span_of("material"), message, label);
        let bare = name.trim().trim_start_matches("materials.");
        match nearest::of(bare, known) {
            Some(near) => problem.nearest(Some(near)),
            None if name.is_empty() => problem,
            None => problem.help(format!(
                "no material is built in; write a table [materials.{}] with young_modulus and \
                 poisson_ratio",
                as_key(name)
            )),
        }
    }
}

/// A name as a key of TOML: in quotes unless it is bare.
pub(crate) fn as_key(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    match !name.is_empty() && name.chars().all(bare) {
        true => name.to_owned(),
        false => format!("{name:?}"),
    }
}

impl MaterialSpec {
    fn read(name: &str, span: Range<usize>, table: &View<'_>) -> Result<Self, Problem> {
        let needed = |key: &str| {
            table.scaled(key)?.ok_or_else(|| {
                let message = format!("material `{name}` has no `{key}`");
                Problem::new(&span, message, "expected it in this table")
            })
        };
        Ok(Self {
            name: name.to_owned(),
            density_kg_m3: table.quantity("density")?,
            largest_poisson_ratio: f64::INFINITY,
            without_bulk_viscosity: false,
            young_modulus: needed("young_modulus")?,
            poisson_ratio: needed("poisson_ratio")?,
            shear_viscosity: table.scaled("shear_viscosity")?,
            bulk_viscosity: table.scaled("bulk_viscosity")?,
            span,
        })
    }

    /// Whether no number of it depends on the striker's speed.
    pub(crate) fn is_constant(&self) -> bool {
        let viscosities = [&self.shear_viscosity, &self.bulk_viscosity];
        let given = [&self.young_modulus, &self.poisson_ratio].into_iter();
        let mut given = given.chain(viscosities.into_iter().flatten());
        given.all(|number| number.exponent == 0.0)
    }

    /// Where the Young modulus stands.
    pub(crate) fn modulus_span(&self) -> &Range<usize> {
        &self.young_modulus.span
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
    ) -> Result<(Material, Option<Problem>), Problem> {
        let any = f64::INFINITY;
        let young_modulus_pa = self.young_modulus.at(speed_m_s, "Young modulus", any)?;
        let most = self.largest_poisson_ratio;
        let poisson_ratio = self.poisson_ratio.at(speed_m_s, "Poisson ratio", most)?;
        let viscosity = |given: &Option<Scaled>| {
            let value = |s: &Scaled| s.at(speed_m_s, "viscosity", any);
            given.as_ref().map(value).transpose()
        };
        let shear_viscosity_pa_s = viscosity(&self.shear_viscosity)?.unwrap_or(0.0);
        let bulk = viscosity(&self.bulk_viscosity)?.unwrap_or(shear_viscosity_pa_s);
        let material = Material {
            young_modulus_pa,
            poisson_ratio,
            shear_viscosity_pa_s,
            bulk_viscosity_pa_s: if self.without_bulk_viscosity {
                0.0
            } else {
                bulk
            },
        };
        Ok((material, self.beyond_half(poisson_ratio, speed_m_s)))
    }

    /// A warning when ν exceeds 1/2.
    fn beyond_half(&self, poisson_ratio: f64, speed_m_s: Option<f64>) -> Option<Problem> {
        let at = match speed_m_s {
            Some(speed) if self.poisson_ratio.exponent != 0.0 => {
                format!(" at {} m/s", short(speed))
            }
            _ => String::new(),
        };
        let message = format!(
            "the Poisson ratio of `{}` is {}{at}",
            self.name,
            rounded(poisson_ratio)
        );
        (poisson_ratio > 0.5).then(|| {
            Problem::new(&self.poisson_ratio.span, message, "no solid is above 1/2")
                .help("taken as an effective number; it must stay below 1")
        })
    }
}

impl Scaled {
    /// The value at a speed, at most so much; what is in the way is a problem.
    fn at(&self, speed_m_s: Option<f64>, name: &str, most: f64) -> Result<f64, Problem> {
        let value = match (speed_m_s, self.exponent == 0.0) {
            (_, true) => self.prefactor,
            (Some(speed), false) => self.prefactor * speed.powf(self.exponent),
            (None, false) => {
                let label = "expected a number, or a [striker] with a speed";
                let message = format!("{name} depends on a striker's speed and there is none");
                return Err(Problem::new(&self.span, message, label));
            }
        };
        let bounded = value.min(most);
        if self.limits.hold(bounded) {
            return Ok(bounded);
        }
        let at = speed_m_s.map_or(String::new(), |speed| format!(" at {} m/s", short(speed)));
        let message = format!("{name} is {}{at}", rounded(value));
        let label = format!("expected a value {}", self.limits.words);
        Err(Problem::new(&self.span, message, label))
    }
}

//! Known oils: what each makes of a contact.

use crate::InferError;
use crate::data::with_plain_ends;
use csv::{ReaderBuilder, StringRecord, Trim};
use hertzchain_chain::{BeadPair, Material};
use serde::Deserialize;

/// The table that comes with the program: the paper's three.
const KNOWN: &str = include_str!("../../data/oils.csv");

/// prefactor · v^exponent of the striker's speed v in m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OilLaw {
    /// Value at 1 m/s.
    pub prefactor: f64,
    /// Exponent.
    pub exponent: f64,
}

impl OilLaw {
    fn at(self, speed_m_s: f64) -> f64 {
        self.prefactor * speed_m_s.powf(self.exponent)
    }
}

/// How an oil's contact is described.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Description {
    /// By an effective material of both sides, as in the paper.
    Material {
        /// Young modulus in Pa.
        young_modulus_pa: f64,
        /// Poisson ratio.
        poisson_ratio: OilLaw,
        /// Viscosity in Pa s, shear and bulk alike.
        viscosity_pa_s: OilLaw,
    },
    /// By the contact's own numbers.
    Contact {
        /// Hertz stiffness K in N/m^{3/2}.
        stiffness: OilLaw,
        /// Relaxation time A in s.
        relaxation_s: OilLaw,
    },
}

/// An oil of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Oil {
    /// Name.
    pub name: String,
    /// What it makes of a contact.
    pub description: Description,
    /// Where the numbers come from.
    pub source: String,
}

impl Oil {
    /// K in N/m^{3/2} and A in s of a contact of spheres with this reduced radius
    /// R* in m, at a speed of the striker in m/s.
    pub fn contact(&self, reduced_radius_m: f64, speed_m_s: f64) -> (f64, f64) {
        match self.description {
            Description::Contact { stiffness, relaxation_s } => {
                (stiffness.at(speed_m_s), relaxation_s.at(speed_m_s))
            }
            Description::Material { young_modulus_pa, poisson_ratio, viscosity_pa_s } => {
                let viscosity = viscosity_pa_s.at(speed_m_s);
                let material = Material {
                    young_modulus_pa,
                    poisson_ratio: poisson_ratio.at(speed_m_s),
                    shear_viscosity_pa_s: viscosity,
                    bulk_viscosity_pa_s: viscosity,
                };
                let pair = BeadPair {
                    left: material,
                    right: material,
                    radius_m: reduced_radius_m,
                    mass_kg: f64::NAN,
                };
                (pair.hertz_stiffness(), material.relaxation_time_s())
            }
        }
    }
}

/// The oils that come with the program.
///
/// # Errors
/// None that a user could cause: the table is part of the program, and tested.
pub fn known_oils() -> Result<Vec<Oil>, InferError> {
    oils("the program's table of oils", KNOWN)
}

/// Oils of a table with the columns of the program's own.
///
/// # Errors
/// A line without a name, with a number that is none, or that gives neither all
/// of an effective material nor all of a contact.
pub fn oils(file: &str, text: &str) -> Result<Vec<Oil>, InferError> {
    let text = with_plain_ends(text);
    let mut reader =
        ReaderBuilder::new().comment(Some(b'#')).trim(Trim::All).from_reader(text.as_bytes());
    let wrong = |line: u64, what: String| InferError::Input(format!("{file}, line {line}: {what}"));
    let titles = reader.headers().map_err(|error| wrong(1, error.to_string()))?.clone();
    let mut all: Vec<Oil> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| wrong(0, error.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        let row = record.deserialize::<OilRow>(Some(&titles)).map_err(|error| {
            let at = match error.kind() {
                csv::ErrorKind::Deserialize { err, .. } => err.field(),
                _ => None,
            };
            let cell = |of: &StringRecord| of.get(at? as usize).map(str::to_owned);
            let (title, text) = (cell(&titles), cell(&record));
            let text = text.unwrap_or_default();
            wrong(line, format!("{}: `{text}` is no number", title.unwrap_or_default()))
        })?;
        let oil = row.oil().map_err(|what| wrong(line, what))?;
        if all.iter().any(|known| known.name == oil.name) {
            let what =
                format!("{} stands in the table twice: give each oil its own name", oil.name);
            return Err(wrong(line, what));
        }
        all.push(oil);
    }
    Ok(all)
}

/// Contact laws end below this Poisson ratio; the paper's effective materials go beyond 1/2.
const BELOW: f64 = 1.0;

/// A line of a table; columns that it does not have are empty.
#[derive(Deserialize, Default)]
#[serde(default)]
struct OilRow {
    name: String,
    young_modulus_pa: Option<f64>,
    poisson_prefactor: Option<f64>,
    poisson_exponent: Option<f64>,
    viscosity_prefactor_pa_s: Option<f64>,
    viscosity_exponent: Option<f64>,
    stiffness_prefactor: Option<f64>,
    stiffness_exponent: Option<f64>,
    relaxation_prefactor_s: Option<f64>,
    relaxation_exponent: Option<f64>,
    source: String,
}

/// A power law of two columns; its exponent is 0 where none stands.
fn law(
    name: &str,
    prefactor: Option<f64>,
    exponent: Option<f64>,
    below: f64,
) -> Result<Option<OilLaw>, String> {
    let exponent = exponent.unwrap_or(0.0);
    let positive = |value: f64| value > 0.0 && value < below && exponent.is_finite();
    match prefactor {
        Some(value) if !positive(value) => Err(format!(
            "{name} is {value}, with the exponent {exponent}; expected more than 0, less than {below}"
        )),
        value => Ok(value.map(|prefactor| OilLaw { prefactor, exponent })),
    }
}

impl OilRow {
    fn oil(self) -> Result<Oil, String> {
        if self.name.is_empty() {
            return Err("an oil without a name".to_owned());
        }
        let any = |name: &str, prefactor, exponent| law(name, prefactor, exponent, f64::INFINITY);
        let poisson = (self.poisson_prefactor, self.poisson_exponent);
        let material = (
            any("young_modulus_pa", self.young_modulus_pa, None)?,
            law("poisson_prefactor", poisson.0, poisson.1, BELOW)?,
            any(
                "viscosity_prefactor_pa_s",
                self.viscosity_prefactor_pa_s,
                self.viscosity_exponent,
            )?,
        );
        let contact = (
            any("stiffness_prefactor", self.stiffness_prefactor, self.stiffness_exponent)?,
            any("relaxation_prefactor_s", self.relaxation_prefactor_s, self.relaxation_exponent)?,
        );
        let description = match (material, contact) {
            ((Some(young), Some(poisson_ratio), Some(viscosity_pa_s)), (None, None)) => {
                Description::Material {
                    young_modulus_pa: young.prefactor,
                    poisson_ratio,
                    viscosity_pa_s,
                }
            }
            ((None, None, None), (Some(stiffness), Some(relaxation_s))) => {
                Description::Contact { stiffness, relaxation_s }
            }
            _ => {
                return Err(format!(
                    "{}: expected either young_modulus_pa, poisson_prefactor and \
                     viscosity_prefactor_pa_s, or stiffness_prefactor and relaxation_prefactor_s",
                    self.name
                ));
            }
        };
        Ok(Oil { name: self.name, description, source: self.source })
    }
}

//! Known oils: what each makes of a contact.

use crate::InferError;
use crate::data::with_plain_ends;
use csv::{ReaderBuilder, StringRecord, Trim};
use hertzchain_chain::{BeadPair, Material};

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
    let titles = reader.headers().map_err(|error| wrong(1, error.to_string()))?;
    let titles = titles.clone();
    let oil = |record: Result<StringRecord, csv::Error>| {
        let record = record.map_err(|error| wrong(0, error.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        let row = Row { titles: &titles, record: &record };
        row.oil().map_err(|what| wrong(line, what))
    };
    let mut all: Vec<Oil> = Vec::new();
    for (at, record) in reader.records().enumerate() {
        let line = record.as_ref().ok().and_then(StringRecord::position);
        let line = line.map_or(at as u64 + 2, csv::Position::line);
        let found = oil(record)?;
        if all.iter().any(|known| known.name == found.name) {
            let what =
                format!("{} stands in the table twice: give each oil its own name", found.name);
            return Err(wrong(line, what));
        }
        all.push(found);
    }
    Ok(all)
}

/// Contact laws end below this Poisson ratio; the paper's effective materials go beyond 1/2.
const BELOW: f64 = 1.0;

struct Row<'a> {
    titles: &'a StringRecord,
    record: &'a StringRecord,
}

impl Row<'_> {
    fn text(&self, column: &str) -> &str {
        let at = self.titles.iter().position(|title| title == column);
        at.and_then(|at| self.record.get(at)).unwrap_or_default()
    }

    fn number(&self, column: &str) -> Result<Option<f64>, String> {
        let text = self.text(column);
        if text.is_empty() {
            return Ok(None);
        }
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        let number = number.ok_or_else(|| format!("{column}: `{text}` is no number"))?;
        Ok(Some(number))
    }

    /// A power law of two columns; its exponent is 0 where none stands.
    fn law(&self, prefactor: &str, exponent: &str) -> Result<Option<OilLaw>, String> {
        let exponent = self.number(exponent)?.unwrap_or(0.0);
        match self.number(prefactor)? {
            None => Ok(None),
            Some(value) if prefactor == "poisson_prefactor" && value >= BELOW => Err(format!(
                "{prefactor} is {value}, the Poisson ratio at 1 m/s; expected less than {BELOW}"
            )),
            Some(value) if value > 0.0 => Ok(Some(OilLaw { prefactor: value, exponent })),
            Some(value) => Err(format!("{prefactor} is {value}; expected more than 0")),
        }
    }

    fn oil(&self) -> Result<Oil, String> {
        let name = self.text("name");
        if name.is_empty() {
            return Err("an oil without a name".to_owned());
        }
        let material = (
            self.law("young_modulus_pa", "")?,
            self.law("poisson_prefactor", "poisson_exponent")?,
            self.law("viscosity_prefactor_pa_s", "viscosity_exponent")?,
        );
        let contact = (
            self.law("stiffness_prefactor", "stiffness_exponent")?,
            self.law("relaxation_prefactor_s", "relaxation_exponent")?,
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
                    "{name}: expected either young_modulus_pa, poisson_prefactor and \
                     viscosity_prefactor_pa_s, or stiffness_prefactor and relaxation_prefactor_s"
                ));
            }
        };
        Ok(Oil { name: name.to_owned(), description, source: self.text("source").to_owned() })
    }
}

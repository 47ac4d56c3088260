//! Known oils: what each makes of a contact.

use crate::InferError;
use crate::data::with_plain_ends;
use csv::{ErrorKind, ReaderBuilder, Trim};
use hertzchain_chain::{BeadPair, Material};
use serde::Deserialize;

/// The table that comes with the program: the paper's three.
const KNOWN: &str = include_str!("../../data/oils.csv");

/// An oil of a table, a column each: either an effective material of both sides of a contact, as in
/// the paper, or the contact's own numbers. Those that depend on the striker's speed v in m/s are
/// prefactor · v^exponent, constant without an exponent.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct Oil {
    /// Name.
    pub name: String,
    /// Young modulus in Pa.
    pub young_modulus_pa: Option<f64>,
    /// Poisson ratio at 1 m/s.
    pub poisson_prefactor: Option<f64>,
    /// Its exponent.
    pub poisson_exponent: Option<f64>,
    /// Viscosity in Pa s at 1 m/s, shear and bulk alike.
    pub viscosity_prefactor_pa_s: Option<f64>,
    /// Its exponent.
    pub viscosity_exponent: Option<f64>,
    /// Hertz stiffness K in N/m^{3/2} at 1 m/s.
    pub stiffness_prefactor: Option<f64>,
    /// Its exponent.
    pub stiffness_exponent: Option<f64>,
    /// Relaxation time A in s at 1 m/s.
    pub relaxation_prefactor_s: Option<f64>,
    /// Its exponent.
    pub relaxation_exponent: Option<f64>,
    /// Where the numbers come from.
    pub source: String,
}

/// Contact laws end below this Poisson ratio; the paper's effective materials go beyond 1/2.
const BELOW: f64 = 1.0;

impl Oil {
    /// K in N/m^{3/2} and A in s of a contact of spheres with this reduced radius
    /// R* in m, at a speed of the striker in m/s.
    pub fn contact(&self, reduced_radius_m: f64, speed_m_s: f64) -> (f64, f64) {
        let law = |prefactor: Option<f64>, exponent: Option<f64>| {
            prefactor.unwrap_or(f64::NAN) * speed_m_s.powf(exponent.unwrap_or(0.0))
        };
        if self.stiffness_prefactor.is_some() {
            let stiffness = law(self.stiffness_prefactor, self.stiffness_exponent);
            return (stiffness, law(self.relaxation_prefactor_s, self.relaxation_exponent));
        }
        let viscosity_pa_s = law(self.viscosity_prefactor_pa_s, self.viscosity_exponent);
        let material = Material {
            young_modulus_pa: law(self.young_modulus_pa, None),
            poisson_ratio: law(self.poisson_prefactor, self.poisson_exponent),
            shear_viscosity_pa_s: viscosity_pa_s,
            bulk_viscosity_pa_s: viscosity_pa_s,
            yield_strength_pa: None,
        };
        let pair = BeadPair {
            left: material,
            right: material,
            radius_m: reduced_radius_m,
            mass_kg: f64::NAN,
        };
        (pair.hertz_stiffness(), material.relaxation_time_s())
    }

    /// Checks that it has a name and either all of a material or all of a contact, in range.
    fn check(&self) -> Result<(), String> {
        let material = [
            ("young_modulus_pa", self.young_modulus_pa, f64::INFINITY),
            ("poisson_prefactor", self.poisson_prefactor, BELOW),
            ("viscosity_prefactor_pa_s", self.viscosity_prefactor_pa_s, f64::INFINITY),
        ];
        let contact = [
            ("stiffness_prefactor", self.stiffness_prefactor, f64::INFINITY),
            ("relaxation_prefactor_s", self.relaxation_prefactor_s, f64::INFINITY),
        ];
        let mut all = material.iter().chain(&contact);
        let wrong = |value: f64, below: f64| !(value > 0.0 && value < below);
        let count = |of: &[(&str, Option<f64>, f64)]| of.iter().filter(|it| it.1.is_some()).count();
        match all.find(|(_, value, below)| value.is_some_and(|value| wrong(value, *below))) {
            _ if self.name.is_empty() => Err("an oil without a name".to_owned()),
            Some((title, value, below)) => Err(format!(
                "{title} is {}; expected more than 0, less than {below}",
                value.unwrap_or(f64::NAN)
            )),
            None if matches!((count(&material), count(&contact)), (3, 0) | (0, 2)) => Ok(()),
            None => Err(format!(
                "{}: expected either young_modulus_pa, poisson_prefactor and \
                 viscosity_prefactor_pa_s, or stiffness_prefactor and relaxation_prefactor_s",
                self.name
            )),
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
        let oil: Oil = record.deserialize(Some(&titles)).map_err(|error| {
            let at = match error.kind() {
                ErrorKind::Deserialize { err, .. } => err.field().map_or(0, |at| at as usize),
                _ => 0,
            };
            let (title, text) = (titles.get(at), record.get(at));
            let [title, text] = [title, text].map(Option::unwrap_or_default);
            wrong(line, format!("{title}: `{text}` is no number"))
        })?;
        oil.check().map_err(|what| wrong(line, what))?;
        if all.iter().any(|known| known.name == oil.name) {
            let name = oil.name;
            let what = format!("{name} stands in the table twice: give each oil its own name");
            return Err(wrong(line, what));
        }
        all.push(oil);
    }
    Ok(all)
}

//! Numbers of an experiment that a fit may change.
//!
//! `eta`, `wet.K`, `materials.steel.young_modulus`: a short name or a path of the experiment file.
//! After a colon stands how it depends on the speed v of the striker: `K:power` for K₀ (v/(1
//! m/s))^k, as the paper gives the numbers of its oils; `K:each` for one value at every speed of
//! the data; nothing for one value at all speeds.

mod name;
mod start;

use crate::{InferError, Parameter, Prior};
use hertzchain_experiment::{Experiment, Reference};
use name::Target;
use std::collections::HashSet;
use std::ops::Deref;

/// How a number depends on the speed of the striker.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// Not at all.
    #[default]
    Constant,
    /// As a power law: two parameters.
    PowerLaw,
    /// As the data determine: one parameter a speed.
    EachSpeed,
}

/// A number of an experiment that a fit may change.
#[derive(Clone, Debug)]
pub struct FreeNumber {
    name: String,
    target: Target,
    /// How it depends on speed.
    pub form: Form,
    unit: String,
    /// Value at the start, or prefactor and exponent.
    start: (f64, f64),
    bounds: (f64, f64),
    /// The contacts that a K or A holds for, and which of them has the value itself.
    pub reference: Option<Reference>,
    /// Standard deviation of a normal prior about the start.
    prior_sd: Option<f64>,
}

/// Most of a parameter's size that a prior's standard deviation may be, so that it is determined.
const PART_OF_SIZE: f64 = 0.5;

impl FreeNumber {
    /// The number of this name, as written on the command line.
    ///
    /// `start` is where a fit begins if the experiment gives no value.
    ///
    /// # Errors
    /// No such number, several of this name, one that cannot vary, or none to start from.
    pub fn find(
        experiment: &Experiment,
        asked: &str,
        start: Option<f64>,
    ) -> Result<Self, InferError> {
        let (name, form) = match asked.trim().split_once(':') {
            None => (asked.trim(), Form::Constant),
            Some((name, "power")) => (name, Form::PowerLaw),
            Some((name, "each")) => (name, Form::EachSpeed),
            Some((name, form)) => {
                return InferError::input(format!(
                    "{name}: `{form}` is no way to depend on speed; expected `power` or `each`"
                ));
            }
        };
        let found = name::find(experiment, name)?;
        let no_start = || {
            InferError::Input(format!(
                "{name} is not given in the experiment and has no usual value; give one there, or to `fit` and `design` by --start {name}=VALUE"
            ))
        };
        let start = start::of(experiment, &found, start).ok_or_else(no_start)?;
        // A law of speed in the file stays one, unless each speed is asked for.
        let law = matches!(found.target, Target::Scaled { .. }) && form == Form::Constant;
        Ok(Self {
            name: name.to_owned(),
            form: if law { Form::PowerLaw } else { form },
            bounds: start::bounds(&found),
            reference: found.target.path().and_then(|path| experiment.reference(path)),
            unit: found.unit,
            target: found.target,
            start,
            prior_sd: None,
        })
    }

    /// A nuisance parameter: a number that is known to this standard deviation, from elsewhere than
    /// the data.
    ///
    /// # Errors
    /// As [`find`](Self::find); a number that depends on speed.
    pub fn systematic(experiment: &Experiment, name: &str, sd: f64) -> Result<Self, InferError> {
        let found = Self::find(experiment, name, None)?;
        match found.form {
            Form::Constant => Ok(Self { prior_sd: Some(sd), ..found }),
            _ => InferError::input(format!(
                "{name} depends on speed: a systematic error is of one number; free {name} and say what is known \
                 of its parameters (--free, --prior)"
            )),
        }
    }

    /// The name as asked, without its form.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its parameters over data at these speeds in m/s, each called after it.
    pub fn parameters(&self, speeds_m_s: &[f64]) -> Vec<Parameter> {
        let (value, exponent) = self.start;
        let (lower, upper) = self.bounds;
        let one = |name: &str, start: f64| {
            let sd = self.prior_sd;
            let scale = start::scale(&self.target, start).max(sd.unwrap_or(0.0) / PART_OF_SIZE);
            let prior = sd.map_or(Prior::Flat, |sd| Prior::Normal { mean: start, sd });
            let parameter = Parameter::new(name, &self.unit, start).within(lower, upper);
            Parameter { scale, prior, ..parameter }
        };
        match self.form {
            Form::Constant => vec![one(&self.name, value)],
            Form::PowerLaw => {
                let exponent = Parameter::new(&format!("{}.exponent", self.name), "", exponent);
                let exponent = Parameter {
                    scale: start::EXPONENT_SCALE,
                    ..exponent.within(-start::MOST_EXPONENT, start::MOST_EXPONENT)
                };
                vec![one(&format!("{}.prefactor", self.name), value), exponent]
            }
            Form::EachSpeed => {
                let at = |(speed, digits): (&f64, String)| {
                    let name = format!("{}@{digits}", self.name);
                    one(&name, value * speed.powf(exponent))
                };
                speeds_m_s.iter().zip(apart(speeds_m_s)).map(at).collect()
            }
        }
    }

    /// Its path in the experiment file, or that of the law of speed whose prefactor it is;
    /// `None` of a number of the instruments.
    pub fn path(&self) -> Option<&str> {
        self.target.path()
    }

    /// The material and the key of a number of a material.
    pub(crate) fn material_number(&self) -> Option<(&str, &str)> {
        let path = self.target.path()?.strip_prefix("materials.")?;
        path.rsplit_once('.')
    }

    /// How many parameters it has over so many speeds.
    pub fn parameter_count(&self, speeds: usize) -> usize {
        match self.form {
            Form::Constant => 1,
            Form::PowerLaw => 2,
            Form::EachSpeed => speeds,
        }
    }

    /// Its value at a speed in m/s, the data's `row`th, from its parameters.
    fn value(&self, parameters: &[f64], row: usize, speed_m_s: f64) -> f64 {
        match (self.form, parameters) {
            (Form::PowerLaw, [prefactor, exponent]) => prefactor * speed_m_s.powf(*exponent),
            (Form::EachSpeed, each) => each.get(row).copied().unwrap_or(f64::NAN),
            (_, [value, ..]) => *value,
            _ => f64::NAN,
        }
    }
}

/// Whether two names, each of an experiment, mean numbers at the same place.
pub fn same_number(one: (&Experiment, &str), other: (&Experiment, &str)) -> bool {
    let target = |(experiment, name)| name::find(experiment, name).map(|found| found.target);
    matches!((target(one), target(other)), (Ok(one), Ok(other)) if one == other)
}

/// Speeds in m/s with as many digits as distinguish them, four at the least; one that comes again
/// has a number behind it.
pub(crate) fn apart(speeds_m_s: &[f64]) -> Vec<String> {
    let rounded = |digits: usize| -> Vec<String> {
        let short = |speed: &f64| {
            let text = format!("{speed:.*e}", digits - 1);
            text.parse().unwrap_or(*speed).to_string()
        };
        speeds_m_s.iter().map(short).collect()
    };
    let different = speeds_m_s.iter().map(|speed| speed.to_bits()).collect::<HashSet<_>>().len();
    let distinct = |texts: &Vec<String>| texts.iter().collect::<HashSet<_>>().len() == different;
    let mut all = (4..=MOST_DIGITS).map(rounded);
    let texts = all.find(distinct).unwrap_or_else(|| rounded(MOST_DIGITS));
    let named = |(at, text): (usize, &String)| match texts[..at]
        .iter()
        .filter(|before| *before == text)
        .count()
    {
        0 => text.clone(),
        before => format!("{text}({})", before + 1),
    };
    texts.iter().enumerate().map(named).collect()
}

/// Digits that distinguish any two numbers.
const MOST_DIGITS: usize = 17;

/// All free numbers of a fit.
#[derive(Clone, Debug)]
pub struct FreeNumbers(Vec<FreeNumber>);

impl Deref for FreeNumbers {
    type Target = [FreeNumber];

    /// The numbers, in the order in which their parameters stand.
    fn deref(&self) -> &[FreeNumber] {
        &self.0
    }
}

/// What the parameters make of an experiment at one speed.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct Settings {
    /// Numbers of the file, by path.
    pub(crate) numbers: Vec<(String, f64)>,
    /// Sensitivity of the wall's sensor over that of the bead's.
    pub(crate) wall_gain: f64,
    /// That of the bead's sensor with its amplifier in V/N, if it is not the experiment's.
    pub(crate) sensor_gain_v_n: Option<f64>,
    /// Added to incident and reflected times.
    pub(crate) delays_s: [f64; 2],
    /// True speed over the one stated.
    pub(crate) speed_scale: f64,
}

impl FreeNumbers {
    /// Free numbers, each once.
    ///
    /// # Errors
    /// A number that is free twice.
    pub fn new(numbers: Vec<FreeNumber>) -> Result<Self, InferError> {
        for (at, number) in numbers.iter().enumerate() {
            let same = |other: &&FreeNumber| other.target == number.target;
            if let Some(other) = numbers[..at].iter().find(same) {
                let (name, other) = (&number.name, &other.name);
                return InferError::input(format!("{name} and {other} are the same number"));
            }
        }
        Ok(Self(numbers))
    }

    /// Whether the number of this path is among them.
    pub(crate) fn is_free(&self, path: &str) -> bool {
        self.0.iter().any(|number| number.target.path() == Some(path))
    }

    /// Parameters of all numbers over data at these speeds in m/s.
    pub fn parameters(&self, speeds_m_s: &[f64]) -> Vec<Parameter> {
        let all = self.0.iter();
        all.flat_map(|number| number.parameters(speeds_m_s)).collect()
    }

    /// What a point sets at a speed in m/s, of `speeds` the `row`th.
    pub(crate) fn settings(
        &self,
        point: &[f64],
        speeds: usize,
        (row, speed_m_s): (usize, f64),
    ) -> Settings {
        let mut settings = Settings { wall_gain: 1.0, speed_scale: 1.0, ..Settings::default() };
        let mut rest = point;
        for number in &self.0 {
            let count = number.parameter_count(speeds).min(rest.len());
            let (own, others) = rest.split_at(count);
            rest = others;
            let value = number.value(own, row, speed_m_s);
            number.target.set(value, &mut settings);
        }
        settings
    }
}

//! What the command line says of parameters: starts, bounds, priors, scales.

use crate::failure::Failure;
use crate::options::{Assignment, ParameterOptions as Freed};
use hertzchain_experiment::Experiment;
use hertzchain_experiment::units::{Dimension, parse_quantity, parse_unit};
use hertzchain_infer::{FreeNumber, InferError, Parameter, Prior};

/// The number in a text, whatever its unit.
pub(super) fn any_number(text: &str) -> Option<f64> {
    parse_quantity(text).ok().map(|quantity| quantity.value)
}

/// Puts what the command line says into parameters.
pub(super) fn apply(freed: &Freed, parameters: &mut [Parameter]) -> Result<(), Failure> {
    each("--start", &freed.start, parameters, |parameter, text| {
        parameter.start = number(parameter, text)?;
        parameter.scale = match parameter.start {
            0.0 => parameter.scale,
            start => start.abs(),
        };
        Ok(())
    })?;
    each("--bounds", &freed.bounds, parameters, |parameter, text| {
        let parts = text.split_once(':').ok_or("expected FROM:TO")?;
        parameter.lower = bound(parameter, parts.0, parameter.lower)?;
        parameter.upper = bound(parameter, parts.1, parameter.upper)?;
        Ok(())
    })?;
    each("--prior", &freed.prior, parameters, |parameter, text| {
        parameter.prior = prior(parameter, text)?;
        Ok(())
    })?;
    each("--scale", &freed.scale, parameters, |parameter, text| {
        parameter.scale = number(parameter, text)?;
        Ok(())
    })
}

/// Does something with every parameter that an option names: by its own name, or
/// all of one number's by that.
fn each(
    option: &str,
    given: &[Assignment],
    parameters: &mut [Parameter],
    mut put: impl FnMut(&mut Parameter, &str) -> Result<(), String>,
) -> Result<(), Failure> {
    let known: Vec<String> = parameters.iter().map(|p| p.name.clone()).collect();
    for (at, Assignment { name, text }) in given.iter().enumerate() {
        if given[..at].iter().any(|other| other.name == *name) {
            return Err(Failure::User(format!("{option} {name} is given twice; leave one out")));
        }
        let meant = |p: &&mut Parameter| is_meant(name, &p.name);
        let mut found = parameters.iter_mut().filter(meant).peekable();
        if found.peek().is_none() {
            return Err(Failure::User(format!(
                "{option} {name}={text}: nothing of this name is free; free are {}",
                known.join(", ")
            )));
        }
        for parameter in found {
            put(parameter, text)
                .map_err(|error| Failure::User(format!("{option} {name}={text}: {error}")))?;
        }
    }
    Ok(())
}

/// Whether a name means a parameter: its own, or that of the number it is one of, of any table.
pub(crate) fn is_meant(name: &str, parameter: &str) -> bool {
    let rest = parameter.strip_prefix(name).map(|rest| match rest.strip_prefix('#') {
        Some(table) => table.trim_start_matches(|c: char| c.is_ascii_digit()),
        None => rest,
    });
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('@') || rest == ".prefactor")
}

/// A systematic error: its name and standard deviation in SI, or in percent of the number.
pub(crate) fn systematic(
    experiment: &Experiment,
    one: &Assignment,
) -> Result<(String, f64), InferError> {
    let Assignment { name, text } = one;
    let found = FreeNumber::find(experiment, name, None)?.parameters(&[]);
    let wrong = |why: String| InferError::Input(format!("--systematic {one}: {why}"));
    let parameter = found.first().ok_or_else(|| wrong("expected one number".to_owned()))?;
    let sd = deviation(parameter, text, parameter.start).map_err(wrong)?;
    match sd > 0.0 && sd.is_finite() {
        true => Ok((name.clone(), sd)),
        false => {
            Err(wrong("expected a standard deviation above 0, such as delay=0.2us".to_owned()))
        }
    }
}

/// A standard deviation in the parameter's unit, or in percent of its mean.
fn deviation(parameter: &Parameter, text: &str, mean: f64) -> Result<f64, String> {
    match text.trim().strip_suffix('%') {
        Some(percent) => any_number(percent)
            .map(|percent| 0.01 * percent * mean.abs())
            .ok_or_else(|| format!("`{text}` is no share such as 5%")),
        None => number(parameter, text),
    }
}

/// A number in the parameter's unit: plain in SI, or with a unit of its own.
fn number(parameter: &Parameter, text: &str) -> Result<f64, String> {
    let quantity = parse_quantity(text).map_err(|error| error.to_string())?;
    let own = parse_unit(&parameter.unit).map_or(Dimension::NONE, |unit| unit.dimension);
    let is_plain = quantity.dimension == Dimension::NONE && !text.trim_end().ends_with('%');
    match is_plain || quantity.dimension == own {
        true => Ok(quantity.value),
        false => Err(format!(
            "`{}` has another dimension; expected a number in {}",
            text.trim(),
            if parameter.unit.is_empty() { "no unit" } else { &parameter.unit }
        )),
    }
}

/// A bound; one that is left out, or infinite, stays what it is without the option.
fn bound(parameter: &Parameter, text: &str, own: f64) -> Result<f64, String> {
    match text.trim() {
        "" | "inf" | "-inf" => Ok(own),
        text => number(parameter, text),
    }
}

fn prior(parameter: &Parameter, text: &str) -> Result<Prior, String> {
    let normal = text.split_once("+-").or_else(|| text.split_once('±'));
    if let Some((mean, sd)) = normal {
        let mean = number(parameter, mean)?;
        return Ok(Prior::Normal { mean, sd: deviation(parameter, sd, mean)? });
    }
    let (median, factor) = text.split_once("*/").ok_or("expected MEAN+-SD, or MEDIAN*/FACTOR")?;
    let factor = factor.trim().parse::<f64>().ok().filter(|factor| *factor > 1.0);
    let factor = factor.ok_or("expected a factor above 1 after */")?;
    Ok(Prior::LogNormal { median: number(parameter, median)?, ln_sd: factor.ln() })
}

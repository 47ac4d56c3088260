//! From a channel's stored numbers to what they mean, by its properties.

use super::metadata::Property;
use std::collections::HashMap;

/// Properties of a channel by name.
pub(super) type Properties = HashMap<String, Property>;

/// Input of a scale that takes the stored numbers: no scale's number.
const STORED: f64 = u32::MAX as f64;

/// Most scales in a row that are followed: they may not go in circles.
const MOST: usize = 16;

/// Highest power of a scale.
const HIGHEST: usize = 16;

/// Coefficients, from that of power 0 on, of the polynomial that makes volts of
/// stored numbers; none if they are volts.
///
/// Scales stand in a row, each with another as its input; the last one gives volts.
/// One that the properties do not describe takes numbers as the card gave them.
///
/// # Errors
/// What a scale is that is no polynomial.
pub(super) fn polynomial(properties: &Properties) -> Result<Vec<f64>, String> {
    let mut whole = Vec::new();
    if properties.get("NI_Scaling_Status") == Some(&Property::Text("scaled".to_owned())) {
        return Ok(whole);
    }
    let mut at = last(properties);
    for _ in 0..MOST {
        let Some((own, input)) = scale(properties, at)? else {
            return Ok(whole);
        };
        whole = match whole.is_empty() {
            true => own,
            false => composed(&whole, &own),
        };
        at = input;
    }
    Err("scales that go in circles".to_owned())
}

/// Number of the last scale; beyond all scales if there is none.
fn last(properties: &Properties) -> f64 {
    let there = |at: &usize| properties.contains_key(&format!("NI_Scale[{at}]_Scale_Type"));
    let found = || (0..MOST).rev().find(there).map(|at| at as f64);
    let stated = number(properties, "NI_Number_Of_Scales").map(|count| count - 1.0);
    stated.or_else(found).unwrap_or(STORED)
}

/// Coefficients of a scale and the number of its input, if it is described.
fn scale(properties: &Properties, at: f64) -> Result<Option<(Vec<f64>, f64)>, String> {
    let prefix = format!("NI_Scale[{at}]");
    let kind = match properties.get(&format!("{prefix}_Scale_Type")) {
        None => return Ok(None),
        Some(Property::Text(kind)) => kind.as_str(),
        Some(_) => "",
    };
    let of = |what: &str| number(properties, &format!("{prefix}_{kind}_{what}"));
    let own = match kind {
        "Linear" => of("Y_Intercept").zip(of("Slope")).map(|(a, b)| vec![a, b]),
        "Polynomial" => powers(of),
        _ => None,
    };
    let own = own.ok_or_else(|| format!("a scale of the kind {kind:?}"))?;
    Ok(Some((own, of("Input_Source").unwrap_or(STORED))))
}

fn number(properties: &Properties, name: &str) -> Option<f64> {
    match properties.get(name) {
        Some(Property::Number(number)) => Some(*number),
        _ => None,
    }
}

/// Coefficients of a polynomial; four if it does not say how many.
fn powers(of: impl Fn(&str) -> Option<f64>) -> Option<Vec<f64>> {
    let count = of("Coefficients_Size").unwrap_or(4.0) as usize;
    let power = |at| of(&format!("Coefficients[{at}]"));
    let powers: Vec<f64> = (0..count.min(HIGHEST)).map(power).collect::<Option<_>>()?;
    (!powers.is_empty()).then_some(powers)
}

/// The polynomial `outer` of the polynomial `inner`, by Horner's rule.
fn composed(outer: &[f64], inner: &[f64]) -> Vec<f64> {
    let mut whole = Vec::new();
    for power in outer.iter().rev() {
        whole = product(&whole, inner);
        match whole.first_mut() {
            Some(constant) => *constant += power,
            None => whole.push(*power),
        }
    }
    whole
}

fn product(one: &[f64], other: &[f64]) -> Vec<f64> {
    if one.is_empty() || other.is_empty() {
        return Vec::new();
    }
    let mut whole = vec![0.0; one.len() + other.len() - 1];
    for (i, a) in one.iter().enumerate() {
        for (j, b) in other.iter().enumerate() {
            whole[i + j] += a * b;
        }
    }
    whole
}

/// The value of a polynomial.
pub(super) fn value(powers: &[f64], x: f64) -> f64 {
    let terms = powers.iter().rev();
    terms.fold(0.0, |sum, power| sum * x + power)
}

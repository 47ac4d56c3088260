//! The paper's figures and those of the claims about its rig.

mod energy;
mod ratios;
mod readings;
mod rig;
mod rig_claims;
mod signals;
mod space_time;
mod times;

pub use rig::rig;
pub use rig_claims::rig_figures;

use crate::reproduce::{ReproduceError, Reproduction};
use hertzchain_figures::Figure;

/// All figures of a reproduction with their names.
///
/// # Errors
/// A chain that can't be set up.
pub fn figures(of: &Reproduction) -> Result<Vec<(&'static str, Figure)>, ReproduceError> {
    let mut figures = vec![
        ("figure1", rig::figure(&of.cases)?),
        ("figure2", signals::figure(&of.signals)),
        ("figure3", times::figure(&of.evidence)),
        ("figure4", ratios::figure(&of.evidence)),
        ("space_time", space_time::figure(&of.films)),
        ("energy", energy::figure(&of.films)),
    ];
    if let Some(scan) = &of.scan {
        figures.push(("readings", readings::figure(scan)));
    }
    Ok(figures)
}

/// Titles and captions of figures as Markdown.
#[must_use]
pub fn captions(figures: &[(&str, Figure)]) -> String {
    figures
        .iter()
        .fold(String::from("# Captions\n"), |text, (name, figure)| {
            text + &format!("\n## {name}\n{}\n", figure.caption_text())
        })
}

/// How a case is named in legends.
fn label(case: &str) -> &str {
    match case {
        "pump" => "pump oil DS19",
        "gear" => "gear oil EP 80W-90",
        "motor" => "motor oil SAE 0W-30",
        "hertz" => "Hertz",
        "hertz-viscoelastic" => "Hertz + viscoelastic",
        other => other,
    }
}

/// Times or forces in another unit.
fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| value * factor).collect()
}

/// Microseconds in a second.
const US: f64 = 1e6;

//! The paper's figures, composed from a reproduction.
//!
//! The rest of this crate draws plain data; only this module knows what the
//! data are.

mod energy;
mod ratios;
mod readings;
mod rig;
mod signals;
mod space_time;
mod times;

pub use rig::rig;

use crate::{Colour, Figure, FigureError, Marker};
use hertzchain_paper::reproduce::{ReproduceError, Reproduction};

/// A picture that can't be made.
#[derive(Debug, thiserror::Error)]
pub enum PaperError {
    /// It can't be rendered.
    #[error("{name}: {error}")]
    Figure {
        /// Name of the figure.
        name: &'static str,
        /// Why.
        error: FigureError,
    },
    /// It can't be computed.
    #[error(transparent)]
    Reproduce(#[from] ReproduceError),
}

/// What journals ask of line drawings in PNG.
const DOTS_PER_INCH: f64 = 300.0;

/// All figures of a reproduction with their names.
///
/// # Errors
/// A chain that can't be set up.
pub fn figures(of: &Reproduction) -> Result<Vec<(&'static str, Figure)>, PaperError> {
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

/// All figures of a reproduction as files, each as SVG and PNG, and their captions: name and
/// content.
///
/// # Errors
/// The first picture that can't be made.
pub fn files(of: &Reproduction) -> Result<Vec<(String, Vec<u8>)>, PaperError> {
    let mut files = Vec::new();
    let mut captions = String::from("# Captions\n");
    for (name, figure) in figures(of)? {
        captions += &format!("\n## {name}\n{}\n", figure.caption_text());
        let png = figure.png(DOTS_PER_INCH);
        let png = png.map_err(|error| PaperError::Figure { name, error })?;
        files.push((format!("{name}.svg"), figure.svg().into_bytes()));
        files.push((format!("{name}.png"), png));
    }
    files.push(("captions.md".to_owned(), captions.into_bytes()));
    Ok(files)
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

/// The paper's symbols, and one colour a liquid in all figures.
fn look(case: &str) -> (Marker, Colour) {
    match case {
        "pump" => (Marker::Triangle, Colour::GREEN),
        "gear" => (Marker::Square, Colour::BLUE),
        "motor" => (Marker::Circle, Colour::VERMILION),
        _ => (Marker::OpenCircle, Colour::BLACK),
    }
}

/// Times or forces in another unit.
fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| value * factor).collect()
}

/// Microseconds in a second.
const US: f64 = 1e6;

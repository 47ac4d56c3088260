//! Diagrams with axes.

mod config;
mod decimate;
mod frame;
mod inset;
mod legend;
mod markers;
mod occupancy;
mod placement;
mod plot;
mod prepare;
mod references;
mod series;
mod strokes;
mod style;

pub use config::{Chart, Legend};
pub use series::{Dash, Marker, Series, case_look};

pub(crate) use placement::Spot;
pub(crate) use plot::Plot;
pub(crate) use prepare::{Prepared, x_scale, y_scale};
pub(crate) use style::Style;

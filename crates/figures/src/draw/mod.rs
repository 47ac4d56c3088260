//! Drawing surface: points, colours and the SVG writer. One user unit is one
//! typographic point (1/72 inch), so font sizes read as in a journal.

mod colour;
mod colour_map;
mod geometry;
mod path;
mod svg;

pub use colour::Colour;
pub use colour_map::ColourMap;
pub(crate) use geometry::{Point, Rect, Side, clip_segment};
pub(crate) use path::PathData;
pub(crate) use svg::{Paint, Svg, escape, fmt};

/// Points per millimetre.
pub(crate) const PT_PER_MM: f64 = 72.0 / 25.4;

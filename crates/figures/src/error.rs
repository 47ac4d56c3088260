//! What can go wrong when a picture is rendered.

use thiserror::Error;

/// A picture could not be rendered as PNG.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FigureError {
    /// The size in pixels is zero or beyond 30,000 along a side.
    #[error(
        "a picture of {width_mm} mm by {height_mm} mm at {dpi} dpi has an impossible size in pixels"
    )]
    Size {
        /// Width asked for, in millimetres.
        width_mm: f64,
        /// Height asked for, in millimetres.
        height_mm: f64,
        /// Dots per inch asked for.
        dpi: f64,
    },
    /// The renderer did not accept our SVG: a fault of this crate.
    #[error("the picture could not be rendered: {0}")]
    Render(String),
    /// The PNG could not be encoded.
    #[error("the picture could not be encoded as PNG")]
    Encode,
}

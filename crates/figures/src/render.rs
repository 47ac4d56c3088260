//! From SVG to PNG.

use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use crate::FigureError;
use crate::png_image::rgb_png;

/// Longest side of a picture in pixels.
const LARGEST: f64 = 30_000.0;

/// Renders an SVG of the given size on white paper.
pub(crate) fn png(
    svg: &str,
    width_mm: f64,
    height_mm: f64,
    dpi: f64,
) -> Result<Vec<u8>, FigureError> {
    let size = FigureError::Size {
        width_mm,
        height_mm,
        dpi,
    };
    let (Some(width), Some(height)) = (pixels(width_mm, dpi), pixels(height_mm, dpi)) else {
        return Err(size);
    };
    let tree =
        Tree::from_str(svg, &Options::default()).map_err(|e| FigureError::Render(e.to_string()))?;
    let mut page = Pixmap::new(width, height).ok_or(size)?;
    page.fill(Color::WHITE);
    let drawn = tree.size();
    let (sx, sy) = (width as f32 / drawn.width(), height as f32 / drawn.height());
    resvg::render(&tree, Transform::from_scale(sx, sy), &mut page.as_mut());
    // The page is opaque white below everything, so alpha can be dropped.
    let rgb: Vec<u8> = page
        .data()
        .chunks_exact(4)
        .flat_map(|p| [p[0], p[1], p[2]])
        .collect();
    rgb_png(width as usize, height as usize, &rgb, Some(dpi)).ok_or(FigureError::Encode)
}

fn pixels(mm: f64, dpi: f64) -> Option<u32> {
    let count = (mm / 25.4 * dpi).round();
    (1.0..=LARGEST).contains(&count).then_some(count as u32)
}

//! Writing PNG files.

/// An RGB picture; `dpi` is noted inside if given. Nothing if the data do not
/// fill the size.
pub(crate) fn rgb_png(
    width: usize,
    height: usize,
    data: &[u8],
    dpi: Option<f64>,
) -> Option<Vec<u8>> {
    let mut out = Vec::new();
    let mut encoder = encoder(&mut out, width, height)?;
    encoder.set_color(png::ColorType::Rgb);
    if let Some(dpi) = dpi {
        let per_metre = (dpi / 0.0254).round() as u32;
        encoder.set_pixel_dims(Some(png::PixelDimensions {
            xppu: per_metre,
            yppu: per_metre,
            unit: png::Unit::Meter,
        }));
    }
    encoder.write_header().ok()?.write_image_data(data).ok()?;
    Some(out)
}

/// A picture of up to 256 colours given as RGB triples.
pub(crate) fn indexed_png(
    width: usize,
    height: usize,
    palette: &[u8],
    data: &[u8],
) -> Option<Vec<u8>> {
    let mut out = Vec::new();
    let mut encoder = encoder(&mut out, width, height)?;
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_palette(palette);
    encoder.write_header().ok()?.write_image_data(data).ok()?;
    Some(out)
}

fn encoder(
    out: &mut Vec<u8>,
    width: usize,
    height: usize,
) -> Option<png::Encoder<'_, &mut Vec<u8>>> {
    let (width, height) = (u32::try_from(width).ok()?, u32::try_from(height).ok()?);
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_depth(png::BitDepth::Eight);
    Some(encoder)
}

//! Files of pictures: PNG, and PDF of one page with paths and images, whose text
//! must be outlines.
//!
//! svg2pdf needs an older resvg and codecs of images that take minutes to build; what this
//! crate draws is little enough to be written down directly.

use std::fmt::Write as _;

use resvg::tiny_skia::{self, PathSegment, Pixmap, Point, Transform};
use resvg::usvg::{Color, Group, Image, ImageKind, Node, Options, Paint, Path, Tree};
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

/// Longest side of a picture in pixels.
const LARGEST: f64 = 30_000.0;

/// Renders an SVG of the given size on white paper.
pub(crate) fn png(
    svg: &str,
    width_mm: f64,
    height_mm: f64,
    dpi: f64,
) -> Result<Vec<u8>, FigureError> {
    let size = FigureError::Size { width_mm, height_mm, dpi };
    let (Some(width), Some(height)) = (pixels(width_mm, dpi), pixels(height_mm, dpi)) else {
        return Err(size);
    };
    let tree =
        Tree::from_str(svg, &Options::default()).map_err(|e| FigureError::Render(e.to_string()))?;
    let mut page = Pixmap::new(width, height).ok_or(size)?;
    page.fill(tiny_skia::Color::WHITE);
    let drawn = tree.size();
    let (sx, sy) = (width as f32 / drawn.width(), height as f32 / drawn.height());
    resvg::render(&tree, Transform::from_scale(sx, sy), &mut page.as_mut());
    // The page is opaque white below everything, so alpha can be dropped.
    let rgb: Vec<u8> = page.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    rgb_png(width as usize, height as usize, &rgb, Some(dpi)).ok_or(FigureError::Encode)
}

fn pixels(mm: f64, dpi: f64) -> Option<u32> {
    let count = (mm / 25.4 * dpi).round();
    (1.0..=LARGEST).contains(&count).then_some(count as u32)
}

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

/// Renders an SVG of the given size in points.
pub(crate) fn pdf(svg: &str, (width, height): (f64, f64)) -> Result<Vec<u8>, FigureError> {
    let tree =
        Tree::from_str(svg, &Options::default()).map_err(|e| FigureError::Render(e.to_string()))?;
    let (across, down) =
        (width / f64::from(tree.size().width()), height / f64::from(tree.size().height()));
    let mut page = Page::default();
    // The y axis of a PDF points upward.
    page.write(&format!("{across} 0 0 {} 0 {height} cm\n", -down));
    page.group(tree.root(), 1.0);
    Ok(page.file((width, height)))
}

/// Content and resources of the page.
#[derive(Default)]
struct Page {
    content: String,
    opacities: Vec<f32>,
    images: Vec<Vec<u8>>,
}

impl Page {
    fn write(&mut self, text: &str) {
        self.content.push_str(text);
    }

    /// Opacity is handed down: no group of this crate with an opacity holds paths that overlap.
    fn group(&mut self, group: &Group, opacity: f32) {
        let opacity = opacity * group.opacity().get();
        for node in group.children() {
            match node {
                Node::Group(inner) => self.group(inner, opacity),
                Node::Path(path) => self.path(path, opacity),
                Node::Image(image) => self.image(image),
                Node::Text(_) => {}
            }
        }
    }

    /// Saves the state, and sets transform and opacity.
    fn open(&mut self, transform: Transform, opacity: f32) {
        let Transform { sx, kx, ky, sy, tx, ty } = transform;
        self.write(&format!("q {sx} {ky} {kx} {sy} {tx} {ty} cm "));
        if opacity < 1.0 {
            self.write(&format!("/A{} gs ", self.opacities.len()));
            self.opacities.push(opacity);
        }
    }

    fn path(&mut self, path: &Path, opacity: f32) {
        let outline = outline(path.data());
        self.open(path.abs_transform(), opacity);
        if let Some(Paint::Color(colour)) = path.fill().map(|fill| fill.paint()) {
            self.write(&format!("{} rg {outline}f ", rgb(*colour)));
        }
        if let Some(stroke) = path.stroke()
            && let Paint::Color(colour) = stroke.paint()
        {
            let dashes: Vec<String> = (stroke.dasharray().iter().flat_map(|dash| dash.iter()))
                .map(f32::to_string)
                .collect();
            self.write(&format!(
                "{} RG {} w 1 j [{}] 0 d {outline}S ",
                rgb(*colour),
                stroke.width().get(),
                dashes.join(" ")
            ));
        }
        self.write("Q\n");
    }

    fn image(&mut self, image: &Image) {
        let ImageKind::PNG(png) = image.kind() else {
            return;
        };
        if let Some(object) = image_object(png) {
            let (width, height) = (image.size().width(), image.size().height());
            self.open(image.abs_transform(), 1.0);
            let number = self.images.len();
            self.write(&format!("{width} 0 0 {} 0 {height} cm /I{number} Do Q\n", -height));
            self.images.push(object);
        }
    }

    /// The file: catalogue, list of pages, page, content, images and where each begins.
    fn file(self, (width, height): (f64, f64)) -> Vec<u8> {
        let images = (0..self.images.len()).map(|i| format!("/I{i} {} 0 R ", i + 5));
        let opacities = self.opacities.iter().enumerate();
        let opacities = opacities.map(|(i, share)| format!("/A{i} <</ca {share} /CA {share}>> "));
        let (images, opacities): (String, String) = (images.collect(), opacities.collect());
        let page = format!(
            "<</Type /Page /Parent 2 0 R /MediaBox [0 0 {width} {height}] /Contents 4 0 R \
             /Resources <</XObject <<{images}>> /ExtGState <<{opacities}>>>>>>"
        );
        let mut objects = vec![
            b"<</Type /Catalog /Pages 2 0 R>>".to_vec(),
            b"<</Type /Pages /Kids [3 0 R] /Count 1>>".to_vec(),
            page.into_bytes(),
            stream("", self.content.as_bytes()),
        ];
        objects.extend(self.images);
        let mut out = b"%PDF-1.5\n".to_vec();
        let mut table = format!("xref\n0 {}\n0000000000 65535 f \n", objects.len() + 1);
        for (i, object) in objects.iter().enumerate() {
            let _ = writeln!(table, "{:010} 00000 n ", out.len());
            out.extend(format!("{} 0 obj\n", i + 1).bytes());
            out.extend(object);
            out.extend(b"\nendobj\n");
        }
        let (start, size) = (out.len(), objects.len() + 1);
        let end = format!("trailer\n<</Size {size} /Root 1 0 R>>\nstartxref\n{start}\n%%EOF\n");
        out.extend(table.bytes().chain(end.bytes()));
        out
    }
}

fn rgb(colour: Color) -> String {
    let share = |part: u8| f32::from(part) / 255.0;
    let [r, g, b] = [colour.red, colour.green, colour.blue].map(share);
    format!("{r:.4} {g:.4} {b:.4}")
}

/// Operators that make a path the current one.
fn outline(path: &tiny_skia::Path) -> String {
    let (mut out, mut at) = (String::new(), Point::zero());
    for segment in path.segments() {
        let (control, end, operator) = match segment {
            PathSegment::MoveTo(p) => (None, p, 'm'),
            PathSegment::LineTo(p) => (None, p, 'l'),
            PathSegment::QuadTo(c, p) => {
                let third = |from: Point| {
                    Point::from_xy(from.x + (c.x - from.x) / 1.5, from.y + (c.y - from.y) / 1.5)
                };
                (Some((third(at), third(p))), p, 'c')
            }
            PathSegment::CubicTo(a, b, p) => (Some((a, b)), p, 'c'),
            PathSegment::Close => {
                out.push_str("h ");
                continue;
            }
        };
        if let Some((a, b)) = control {
            let _ = write!(out, "{} {} {} {} ", a.x, a.y, b.x, b.y);
        }
        let _ = write!(out, "{} {} {operator} ", end.x, end.y);
        at = end;
    }
    out
}

/// An image of eight bits a channel, RGB or with a palette; its compressed rows stay as they are.
fn image_object(png: &[u8]) -> Option<Vec<u8>> {
    let number = |from: usize| Some(u32::from_be_bytes(png.get(from..from + 4)?.try_into().ok()?));
    let (width, height) = (number(16)?, number(20)?);
    let (mut data, mut palette) = (Vec::new(), String::new());
    let mut at = 8;
    while let Some(length) = number(at) {
        let length = length as usize;
        let body = png.get(at + 8..at + 8 + length)?;
        match png.get(at + 4..at + 8)? {
            b"IDAT" => data.extend_from_slice(body),
            b"PLTE" => palette = body.iter().map(|byte| format!("{byte:02x}")).collect(),
            _ => {}
        }
        at += length + 12;
    }
    let (space, channels) = match palette.len() / 6 {
        0 => ("/DeviceRGB".to_owned(), 3),
        colours => (format!("[/Indexed /DeviceRGB {} <{palette}>]", colours - 1), 1),
    };
    let keys = format!(
        "/Type /XObject /Subtype /Image /Width {width} /Height {height} /BitsPerComponent 8 \
         /ColorSpace {space} /Filter /FlateDecode \
         /DecodeParms <</Predictor 15 /Colors {channels} /BitsPerComponent 8 /Columns {width}>> "
    );
    Some(stream(&keys, &data))
}

fn stream(keys: &str, data: &[u8]) -> Vec<u8> {
    let head = format!("<<{keys}/Length {}>>\nstream\n", data.len());
    [head.as_bytes(), data, b"\nendstream"].concat()
}

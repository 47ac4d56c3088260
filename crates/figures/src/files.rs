//! Files of pictures: SVG, and with text as outlines PNG and PDF of one page.
//!
//! In an SVG numbers are cut to a hundredth of a point, outlines of text to a thousandth, so that
//! equal input gives equal text.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use thiserror::Error;
use tiny_skia::{FillRule, FilterQuality, LineJoin, PathBuilder, Pixmap, PixmapPaint};
use tiny_skia::{Stroke, StrokeDash, Transform};

use crate::draw::{
    Canvas, Colour, Item, PT_PER_MM, Paint, PathData, PlacedText, Point, Raster, Rect, Segment,
};

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
    /// The PNG could not be encoded.
    #[error("the picture could not be encoded as PNG")]
    Encode,
}

const LARGEST: f64 = 30_000.0;

/// Renders a page of the given size on white paper.
pub(crate) fn png(
    canvas: &Canvas,
    (width_mm, height_mm): (f64, f64),
    dpi: f64,
) -> Result<Vec<u8>, FigureError> {
    let size = FigureError::Size { width_mm, height_mm, dpi };
    let (Some(width), Some(height)) = (pixels(width_mm, dpi), pixels(height_mm, dpi)) else {
        return Err(size);
    };
    let mut page = Pixmap::new(width, height).ok_or(size)?;
    page.fill(tiny_skia::Color::WHITE);
    let per_point = |pixels: u32, mm: f64| (f64::from(pixels) / (mm * PT_PER_MM)) as f32;
    let scale = Transform::from_scale(per_point(width, width_mm), per_point(height, height_mm));
    for item in &canvas.items {
        match item {
            Item::Path(data, paint) => render_path(&mut page, data, paint, scale),
            Item::Text(text) => {
                render_path(&mut page, &text.outlines(), &Paint::fill(text.colour), scale);
            }
            Item::Image(place, raster) => render_image(&mut page, place, raster, scale),
            Item::Legend(_) | Item::LegendEnd => {}
        }
    }
    // The page is opaque white below everything, so alpha can be dropped.
    let rgb: Vec<u8> = page.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    rgb_png((width, height), &rgb, dpi).ok_or(FigureError::Encode)
}

fn pixels(mm: f64, dpi: f64) -> Option<u32> {
    let count = (mm / 25.4 * dpi).round();
    (1.0..=LARGEST).contains(&count).then_some(count as u32)
}

fn render_path(page: &mut Pixmap, data: &PathData, paint: &Paint, scale: Transform) {
    let mut path = PathBuilder::new();
    for segment in &data.0 {
        let at = |p: Point| (p.x as f32, p.y as f32);
        match *segment {
            Segment::Move(p) => path.move_to(at(p).0, at(p).1),
            Segment::Line(p) => path.line_to(at(p).0, at(p).1),
            Segment::Quad(c, p) => path.quad_to(at(c).0, at(c).1, at(p).0, at(p).1),
            Segment::Cubic(a, b, p) => {
                let [a, b, p] = [a, b, p].map(at);
                path.cubic_to(a.0, a.1, b.0, b.1, p.0, p.1);
            }
            Segment::Close => path.close(),
        }
    }
    let Some(path) = path.finish() else {
        return;
    };
    let ink = |Colour(r, g, b): Colour| {
        let mut ink = tiny_skia::Paint::default();
        ink.set_color_rgba8(r, g, b, (255.0 * paint.opacity).round() as u8);
        ink
    };
    if let Some(fill) = paint.fill {
        page.fill_path(&path, &ink(fill), FillRule::Winding, scale, None);
    }
    if let Some(stroke) = paint.stroke {
        let dash = stroke.dash.iter().map(|length| *length as f32).collect();
        let look = Stroke {
            width: stroke.width as f32,
            line_join: LineJoin::Round,
            dash: StrokeDash::new(dash, 0.0),
            ..Stroke::default()
        };
        page.stroke_path(&path, &ink(stroke.colour), &look, scale, None);
    }
}

fn render_image(page: &mut Pixmap, place: &Rect, raster: &Raster, scale: Transform) {
    let Some(mut image) = Pixmap::new(raster.width as u32, raster.height as u32) else {
        return;
    };
    for (bytes, pixel) in image.data_mut().chunks_exact_mut(4).zip(&raster.pixels) {
        let Colour(r, g, b) =
            raster.palette.get(usize::from(*pixel)).copied().unwrap_or(Colour::WHITE);
        bytes.copy_from_slice(&[r, g, b, 255]);
    }
    let across = (place.width() / raster.width as f64) as f32;
    let down = (place.height() / raster.height as f64) as f32;
    let (x, y) = (place.x0 as f32, place.y0 as f32);
    let onto = Transform::from_row(across, 0.0, 0.0, down, x, y).post_concat(scale);
    let look = PixmapPaint { quality: FilterQuality::Nearest, ..PixmapPaint::default() };
    page.draw_pixmap(0, 0, image.as_ref(), &look, onto, None);
}

fn rgb_png((width, height): (u32, u32), data: &[u8], dpi: f64) -> Option<Vec<u8>> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(png::ColorType::Rgb);
    let per_metre = (dpi / 0.0254).round() as u32;
    let unit = png::Unit::Meter;
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: per_metre, yppu: per_metre, unit }));
    encoder.write_header().ok()?.write_image_data(data).ok()?;
    Some(out)
}

/// A picture with a palette; nothing if memory cannot hold it.
fn indexed_png(raster: &Raster) -> Option<Vec<u8>> {
    let mut out = Vec::new();
    let (width, height) = (u32::try_from(raster.width).ok()?, u32::try_from(raster.height).ok()?);
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(png::ColorType::Indexed);
    let palette: Vec<u8> = raster.palette.iter().flat_map(|c| [c.0, c.1, c.2]).collect();
    encoder.set_palette(palette);
    encoder.write_header().ok()?.write_image_data(&raster.pixels).ok()?;
    Some(out)
}

/// A PDF of a page of the given size in points.
pub(crate) fn pdf(canvas: &Canvas, (width, height): (f64, f64)) -> Vec<u8> {
    // The y axis of a PDF points upward.
    let mut page = Page { content: format!("1 0 0 -1 0 {height} cm\n"), ..Page::default() };
    for item in &canvas.items {
        match item {
            Item::Path(data, paint) => page.path(data, paint),
            Item::Text(text) => page.path(&text.outlines(), &Paint::fill(text.colour)),
            Item::Image(place, raster) => page.image(place, raster),
            Item::Legend(_) | Item::LegendEnd => {}
        }
    }
    page.file((width, height))
}

#[derive(Default)]
struct Page {
    content: String,
    opacities: Vec<f64>,
    images: Vec<Vec<u8>>,
}

impl Page {
    fn path(&mut self, data: &PathData, paint: &Paint) {
        let outline = outline(data);
        self.content += "q ";
        if paint.opacity < 1.0 {
            let _ = write!(self.content, "/A{} gs ", self.opacities.len());
            self.opacities.push(paint.opacity);
        }
        if let Some(fill) = paint.fill {
            let _ = write!(self.content, "{} rg ", rgb(fill));
        }
        if let Some(stroke) = paint.stroke {
            let dashes: Vec<String> = stroke.dash.iter().map(f64::to_string).collect();
            let (colour, width, dashes) = (rgb(stroke.colour), stroke.width, dashes.join(" "));
            let _ = write!(self.content, "{colour} RG {width} w 1 j [{dashes}] 0 d ");
        }
        let operator = match (paint.fill, paint.stroke) {
            (Some(_), Some(_)) => 'B',
            (Some(_), None) => 'f',
            (None, _) => 'S',
        };
        let _ = writeln!(self.content, "{outline}{operator} Q");
    }

    fn image(&mut self, place: &Rect, raster: &Raster) {
        if let Some(object) = indexed_png(raster).and_then(|png| image_object(&png, raster)) {
            let (width, height, bottom) = (place.width(), place.height(), place.y1);
            let _ = writeln!(
                self.content,
                "q {width} 0 0 {} {} {bottom} cm /I{} Do Q",
                -height,
                place.x0,
                self.images.len()
            );
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

fn rgb(Colour(r, g, b): Colour) -> String {
    let [r, g, b] = [r, g, b].map(|part| number(f64::from(part) / 255.0, 4));
    format!("{r} {g} {b}")
}

/// Operators that make a path the current one.
fn outline(path: &PathData) -> String {
    let (mut out, mut from) = (String::new(), Point::new(0.0, 0.0));
    for segment in &path.0 {
        let (points, operator) = match *segment {
            Segment::Move(p) => (vec![p], "m "),
            Segment::Line(p) => (vec![p], "l "),
            Segment::Quad(c, p) => {
                // The same curve by cubic control points.
                let near = |end: Point| {
                    Point::new(end.x + (c.x - end.x) / 1.5, end.y + (c.y - end.y) / 1.5)
                };
                (vec![near(from), near(p), p], "c ")
            }
            Segment::Cubic(a, b, p) => (vec![a, b, p], "c "),
            Segment::Close => (vec![], "h "),
        };
        for value in points.iter().flat_map(|p| [p.x, p.y]) {
            out += &number(value, 3);
            out.push(' ');
        }
        out += operator;
        from = points.last().copied().unwrap_or(from);
    }
    out
}

/// An image with a palette; its compressed rows stay as they are in a PNG.
fn image_object(png: &[u8], raster: &Raster) -> Option<Vec<u8>> {
    let number = |from: usize| Some(u32::from_be_bytes(png.get(from..from + 4)?.try_into().ok()?));
    let (mut data, mut at) = (Vec::new(), 8);
    while let Some(length) = number(at) {
        let length = length as usize;
        if png.get(at + 4..at + 8)? == b"IDAT" {
            data.extend_from_slice(png.get(at + 8..at + 8 + length)?);
        }
        at += length + 12;
    }
    let (width, height) = (raster.width, raster.height);
    let palette: String =
        raster.palette.iter().map(|colour| colour.to_string()[1..].to_owned()).collect();
    let keys = format!(
        "/Type /XObject /Subtype /Image /Width {width} /Height {height} /BitsPerComponent 8 \
         /ColorSpace [/Indexed /DeviceRGB {} <{palette}>] /Filter /FlateDecode \
         /DecodeParms <</Predictor 15 /Colors 1 /BitsPerComponent 8 /Columns {width}>> ",
        raster.palette.len().saturating_sub(1)
    );
    Some(stream(&keys, &data))
}

fn stream(keys: &str, data: &[u8]) -> Vec<u8> {
    let head = format!("<<{keys}/Length {}>>\nstream\n", data.len());
    [head.as_bytes(), data, b"\nendstream"].concat()
}

/// A number with at most so many decimals and no trailing zeros.
fn number(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", if value.is_nan() { 0.0 } else { value.clamp(-1e9, 1e9) });
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// The embedded font first, then common ones of its kind.
const FONT: &str = "font-family=\"'Noto Sans', 'Open Sans', 'DejaVu Sans', Arial, sans-serif\"";

/// The document of a page of the given size in millimetres, its texts as text or as outlines.
pub(crate) fn svg(
    canvas: &Canvas,
    (width_mm, height_mm): (f64, f64),
    (title, description): (&str, &str),
    outlines: bool,
) -> String {
    let [width, height] = [width_mm, height_mm].map(|mm| number(mm * PT_PER_MM, 2));
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
         width=\"{width_mm}mm\" height=\"{height_mm}mm\" viewBox=\"0 0 {width} {height}\" role=\"img\" {FONT}>\n\
         <title>{}</title>\n",
        escape(title)
    );
    if !description.is_empty() {
        let _ = writeln!(out, "<desc>{}</desc>", escape(description));
    }
    out.push_str("<path d=\"M0 0H10000V10000H0Z\" fill=\"#ffffff\"/>\n");
    let (mut texts, mut legends) = (0, 0);
    for item in &canvas.items {
        out += &match item {
            Item::Path(data, paint) => svg_path(data, paint, 2),
            Item::Text(text) => {
                texts += 1;
                svg_text(text, texts, outlines)
            }
            Item::Image(place, raster) => svg_image(place, raster).unwrap_or_default(),
            Item::Legend(Rect { x0, y0, x1, y1 }) => {
                legends += 1;
                format!("<g id=\"legend{legends}\" data-box=\"{x0:.2} {y0:.2} {x1:.2} {y1:.2}\">\n")
            }
            Item::LegendEnd => "</g>\n".to_owned(),
        };
    }
    out + "</svg>\n"
}

fn svg_path(data: &PathData, paint: &Paint, decimals: usize) -> String {
    let mut d = String::new();
    for segment in &data.0 {
        let (letter, points) = match segment {
            Segment::Move(p) => ('M', vec![p]),
            Segment::Line(p) => ('L', vec![p]),
            Segment::Quad(c, p) => ('Q', vec![c, p]),
            Segment::Cubic(a, b, p) => ('C', vec![a, b, p]),
            Segment::Close => ('Z', vec![]),
        };
        d.push(letter);
        let numbers = points.iter().flat_map(|p| [p.x, p.y]).map(|v| number(v, decimals));
        d += &numbers.collect::<Vec<_>>().join(" ");
    }
    let fill = paint.fill.map_or("none".to_owned(), |fill| fill.to_string());
    let mut out = format!("<path d=\"{d}\" fill=\"{fill}\"");
    if let Some(stroke) = paint.stroke {
        let (colour, width) = (stroke.colour, number(stroke.width, 2));
        out += &format!(" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"");
        if !stroke.dash.is_empty() {
            let dashes: Vec<String> = stroke.dash.iter().map(|dash| number(*dash, 2)).collect();
            out += &format!(" stroke-dasharray=\"{}\"", dashes.join(" "));
        }
    }
    if paint.opacity < 1.0 {
        out += &format!(" opacity=\"{}\"", number(paint.opacity, 2));
    }
    out + "/>\n"
}

/// A text as text, or as a group with its outlines.
fn svg_text(text: &PlacedText, count: usize, outlines: bool) -> String {
    let (label, colour) = (escape(&text.line.plain), text.colour);
    if outlines {
        let drawn = svg_path(&text.outlines(), &Paint::fill(colour), 3);
        return format!("<g id=\"t{count}\" aria-label=\"{label}\">{drawn}</g>\n");
    }
    let [x, y] = [text.at.x, text.at.y].map(|v| number(v, 2));
    let turn = match text.angle_deg {
        0.0 => String::new(),
        angle => format!(" rotate({})", number(-angle, 2)),
    };
    let down = number(text.down(), 2);
    format!(
        "<text id=\"t{count}\" aria-label=\"{label}\" fill=\"{colour}\" transform=\"translate({x} {y}){turn} \
         translate(0 {down})\" xml:space=\"preserve\"{}</text>\n",
        text.line.live(text.anchor)
    )
}

fn svg_image(place: &Rect, raster: &Raster) -> Option<String> {
    let data = STANDARD.encode(indexed_png(raster)?);
    let [x, y, w, h] =
        [place.x0, place.y0, place.width(), place.height()].map(|value| number(value, 2));
    Some(format!(
        "<image preserveAspectRatio=\"none\" image-rendering=\"optimizeSpeed\" x=\"{x}\" y=\"{y}\" width=\"{w}\" \
         height=\"{h}\" xlink:href=\"data:image/png;base64,{data}\"/>\n"
    ))
}

/// Text safe inside an attribute or element; characters XML forbids become spaces.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
#[path = "files/tests/svg.rs"]
mod tests;

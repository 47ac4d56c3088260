//! A page as SVG. Numbers are cut to a hundredth of a point, outlines of text to a thousandth, so
//! equal input gives equal text.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::{Canvas, Item, PT_PER_MM, Paint, PathData, PlacedText, Raster, Rect, Segment};
use crate::files::indexed_png;

/// A number with at most so many decimals and no trailing zeros.
pub(crate) fn number(value: f64, decimals: usize) -> String {
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
            Item::Path(data, paint) => path(data, paint, 2),
            Item::Text(text) => {
                texts += 1;
                element(text, texts, outlines)
            }
            Item::Image(place, raster) => image(place, raster).unwrap_or_default(),
            Item::Legend(Rect { x0, y0, x1, y1 }) => {
                legends += 1;
                format!("<g id=\"legend{legends}\" data-box=\"{x0:.2} {y0:.2} {x1:.2} {y1:.2}\">\n")
            }
            Item::LegendEnd => "</g>\n".to_owned(),
        };
    }
    out + "</svg>\n"
}

fn path(data: &PathData, paint: &Paint, decimals: usize) -> String {
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
fn element(text: &PlacedText, count: usize, outlines: bool) -> String {
    let (label, colour) = (escape(&text.line.plain), text.colour);
    if outlines {
        let drawn = path(&text.outlines(), &Paint::fill(colour), 3);
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

fn image(place: &Rect, raster: &Raster) -> Option<String> {
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
#[path = "tests/svg.rs"]
mod tests;

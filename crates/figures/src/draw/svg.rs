//! A small SVG writer. Numbers are cut to a hundredth of a point, so equal
//! input gives equal text.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::{Colour, PT_PER_MM, Point, Rect};
use crate::text::GlyphId;

/// Appends a number with at most two decimals and no trailing zeros.
pub(crate) fn fmt(out: &mut String, value: f64) {
    let hundredths = (value.clamp(-1e9, 1e9) * 100.0).round() as i64;
    let (whole, rest) = (hundredths.abs() / 100, hundredths.abs() % 100);
    let sign = if hundredths < 0 { "-" } else { "" };
    let written = match (rest, rest % 10) {
        (0, _) => write!(out, "{sign}{whole}"),
        (_, 0) => write!(out, "{sign}{whole}.{}", rest / 10),
        _ => write!(out, "{sign}{whole}.{rest:02}"),
    };
    written.expect("a String takes any text");
}

/// Builds the text of an SVG path.
#[derive(Debug, Clone, Default)]
pub(crate) struct PathData(String);

impl PathData {
    pub(crate) fn new() -> Self {
        Self::default()
    }

    fn push(&mut self, command: char, numbers: &[f64]) -> &mut Self {
        self.0.push(command);
        for (i, n) in numbers.iter().enumerate() {
            if i > 0 {
                self.0.push(' ');
            }
            fmt(&mut self.0, *n);
        }
        self
    }

    pub(crate) fn move_to(&mut self, p: Point) -> &mut Self {
        self.push('M', &[p.x, p.y])
    }

    pub(crate) fn line_to(&mut self, p: Point) -> &mut Self {
        self.push('L', &[p.x, p.y])
    }

    pub(crate) fn quad_to(&mut self, c: Point, p: Point) -> &mut Self {
        self.push('Q', &[c.x, c.y, p.x, p.y])
    }

    /// Circular arc to `p`; `large` and `sweep` as in SVG.
    pub(crate) fn arc_to(&mut self, radius: f64, large: bool, sweep: bool, p: Point) -> &mut Self {
        let flags = [f64::from(u8::from(large)), f64::from(u8::from(sweep))];
        self.push('A', &[radius, radius, 0.0, flags[0], flags[1], p.x, p.y])
    }

    pub(crate) fn close(&mut self) -> &mut Self {
        self.0.push('Z');
        self
    }

    pub(crate) fn segment(&mut self, a: Point, b: Point) -> &mut Self {
        self.move_to(a).line_to(b)
    }

    pub(crate) fn rect(&mut self, r: &Rect) -> &mut Self {
        let corners = [(r.x0, r.y0), (r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)];
        self.polygon(&corners.map(|(x, y)| Point::new(x, y)))
    }

    pub(crate) fn polygon(&mut self, corners: &[Point]) -> &mut Self {
        self.polyline(corners).close()
    }

    pub(crate) fn polyline(&mut self, points: &[Point]) -> &mut Self {
        for (i, p) in points.iter().enumerate() {
            if i == 0 {
                self.move_to(*p)
            } else {
                self.line_to(*p)
            };
        }
        self
    }

    pub(crate) fn circle(&mut self, c: Point, radius: f64) -> &mut Self {
        let (west, east) = (Point::new(c.x - radius, c.y), Point::new(c.x + radius, c.y));
        self.move_to(west)
            .arc_to(radius, false, true, east)
            .arc_to(radius, false, true, west)
            .close()
    }

    pub(crate) fn as_str(&self) -> &str {
        &self.0
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// A line's look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) colour: Colour,
    pub(crate) width: f64,
    pub(crate) dash: &'static [f64],
}

/// How a path is painted.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Paint {
    fill: Option<Colour>,
    stroke: Option<Stroke>,
    opacity: Option<f64>,
}

impl Paint {
    pub(crate) fn fill(colour: Colour) -> Self {
        Self { fill: Some(colour), ..Self::default() }
    }

    pub(crate) fn line(colour: Colour, width: f64) -> Self {
        Self::dashed(colour, width, &[])
    }

    pub(crate) fn dashed(colour: Colour, width: f64, dash: &'static [f64]) -> Self {
        let stroke = Some(Stroke { colour, width, dash });
        Self { stroke, ..Self::default() }
    }

    pub(crate) fn outlined(mut self, colour: Colour, width: f64) -> Self {
        let dash = &[];
        self.stroke = Some(Stroke { colour, width, dash });
        self
    }

    pub(crate) fn opacity(mut self, share: f64) -> Self {
        self.opacity = Some(share);
        self
    }

    fn attributes(&self) -> String {
        let fill = self.fill.map_or("none".to_owned(), |fill| fill.to_string());
        let mut out = format!(" fill=\"{fill}\"");
        if let Some(stroke) = self.stroke {
            let _ = write!(out, " stroke=\"{}\" stroke-width=\"", stroke.colour);
            fmt(&mut out, stroke.width);
            out.push_str("\" stroke-linejoin=\"round\"");
            push_dash(&mut out, &stroke);
        }
        if let Some(share) = self.opacity {
            out.push_str(" opacity=\"");
            fmt(&mut out, share);
            out.push('"');
        }
        out
    }
}

fn push_dash(out: &mut String, stroke: &Stroke) {
    if stroke.dash.is_empty() {
        return;
    }
    out.push_str(" stroke-dasharray=\"");
    for (i, d) in stroke.dash.iter().enumerate() {
        if i > 0 {
            out.push(' ');
        }
        fmt(out, *d);
    }
    out.push('"');
}

/// The embedded font first, then common ones of its kind.
const FONT: &str = "font-family=\"'Noto Sans', 'Open Sans', 'DejaVu Sans', Arial, sans-serif\"";

/// An SVG document being written.
#[derive(Debug, Default)]
pub(crate) struct Svg {
    body: String,
    glyphs: BTreeMap<GlyphId, String>,
    texts: usize,
    legends: usize,
    /// Text becomes outlines.
    pub(crate) outlines: bool,
}

impl Svg {
    pub(crate) fn new() -> Self {
        Self::default()
    }

    pub(crate) fn path(&mut self, data: &PathData, paint: &Paint) {
        if !data.is_empty() {
            let (d, look) = (data.as_str(), paint.attributes());
            let _ = writeln!(self.body, "<path d=\"{d}\"{look}/>");
        }
    }

    pub(crate) fn segment(&mut self, a: Point, b: Point, paint: &Paint) {
        self.path(PathData::new().segment(a, b), paint);
    }

    pub(crate) fn rect(&mut self, rect: &Rect, paint: &Paint) {
        self.path(PathData::new().rect(rect), paint);
    }

    pub(crate) fn circle(&mut self, centre: Point, radius: f64, paint: &Paint) {
        self.path(PathData::new().circle(centre, radius), paint);
    }

    /// Everything drawn until [`Svg::close`] is moved and scaled.
    pub(crate) fn open_scaled(&mut self, origin: Point, scale: f64) {
        self.body.push_str("<g transform=\"translate(");
        fmt(&mut self.body, origin.x);
        self.body.push(' ');
        fmt(&mut self.body, origin.y);
        let _ = writeln!(self.body, ") scale({scale:.6})\">");
    }

    /// Everything drawn until [`Svg::close`] is one legend.
    pub(crate) fn open_legend(&mut self, place: &Rect) {
        self.legends += 1;
        let Rect { x0, y0, x1, y1 } = place;
        let _ = writeln!(
            self.body,
            "<g id=\"legend{}\" data-box=\"{x0:.2} {y0:.2} {x1:.2} {y1:.2}\">",
            self.legends
        );
    }

    pub(crate) fn close(&mut self) {
        self.body.push_str("</g>\n");
    }

    /// A PNG stretched over `rect`, its pixels kept sharp.
    pub(crate) fn image(&mut self, rect: &Rect, png: &[u8]) {
        self.body.push_str("<image preserveAspectRatio=\"none\" image-rendering=\"optimizeSpeed\"");
        let (x, y, w, h) = (rect.x0, rect.y0, rect.width(), rect.height());
        for (name, value) in [("x", x), ("y", y), ("width", w), ("height", h)] {
            let _ = write!(self.body, " {name}=\"");
            fmt(&mut self.body, value);
            self.body.push('"');
        }
        let data = STANDARD.encode(png);
        let _ = writeln!(self.body, " xlink:href=\"data:image/png;base64,{data}\"/>");
    }

    /// A text element; `rest` ends its attributes and holds its runs.
    pub(crate) fn text(&mut self, transform: &str, colour: Colour, plain: &str, rest: &str) {
        self.texts += 1;
        let (n, label) = (self.texts, escape(plain));
        let _ = writeln!(
            self.body,
            "<text id=\"t{n}\" aria-label=\"{label}\" fill=\"{colour}\" transform=\"{transform}\" \
             xml:space=\"preserve\"{rest}</text>"
        );
    }

    /// Opens a text: glyphs follow in font units, placed by `transform`.
    pub(crate) fn open_text(&mut self, transform: &str, colour: Colour, plain: &str) {
        self.texts += 1;
        let (n, label) = (self.texts, escape(plain));
        let _ = write!(
            self.body,
            "<g id=\"t{n}\" aria-label=\"{label}\" fill=\"{colour}\" transform=\"{transform}\">"
        );
    }

    /// One glyph of an open text; its outline is stored once per document.
    pub(crate) fn glyph(&mut self, id: GlyphId, outline: impl FnOnce() -> String, transform: &str) {
        self.glyphs.entry(id).or_insert_with(outline);
        let _ = write!(self.body, "<use xlink:href=\"#{id}\" transform=\"{transform}\"/>");
    }

    /// The finished document of the given size.
    pub(crate) fn finish(
        self,
        (width_mm, height_mm): (f64, f64),
        title: &str,
        description: &str,
    ) -> String {
        let mut size = [String::new(), String::new()];
        fmt(&mut size[0], width_mm * PT_PER_MM);
        fmt(&mut size[1], height_mm * PT_PER_MM);
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
             width=\"{width_mm}mm\" height=\"{height_mm}mm\" viewBox=\"0 0 {} {}\" role=\"img\" {FONT}>\n",
            size[0], size[1]
        );
        let _ = writeln!(out, "<title>{}</title>", escape(title));
        if !description.is_empty() {
            let _ = writeln!(out, "<desc>{}</desc>", escape(description));
        }
        out.push_str("<defs>\n");
        for (id, d) in self.glyphs {
            let _ = writeln!(out, "<path id=\"{id}\" d=\"{d}\"/>");
        }
        out.push_str("</defs>\n<path d=\"M0 0H10000V10000H0Z\" fill=\"#ffffff\"/>\n");
        out.push_str(&self.body);
        out.push_str("</svg>\n");
        out
    }
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

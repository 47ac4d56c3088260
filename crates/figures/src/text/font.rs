//! The embedded faces (Noto Sans, Apache licence 2.0) and their outlines.

use std::fmt;
use std::fmt::Write as _;
use std::sync::LazyLock;

use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{FontRef, MetadataProvider};

/// Which of the embedded faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Face {
    Regular,
    Italic,
    Bold,
}

impl Face {
    /// How a `tspan` asks for it.
    pub(crate) fn attribute(self) -> &'static str {
        match self {
            Self::Regular => "",
            Self::Italic => " font-style=\"italic\"",
            Self::Bold => " font-weight=\"bold\"",
        }
    }
}

/// Width of characters in em.
pub(crate) fn width(style: Face, text: &str) -> f64 {
    text.chars().map(|c| GlyphId::of(style, c).advance()).sum()
}

/// One glyph of one face; also its name inside an SVG.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct GlyphId {
    style: Face,
    index: u32,
}

impl fmt::Display for GlyphId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let letter = match self.style {
            Face::Regular => 'r',
            Face::Italic => 'i',
            Face::Bold => 'h',
        };
        write!(f, "{letter}{}", self.index)
    }
}

static REGULAR: LazyLock<FontRef<'static>> = LazyLock::new(|| parse(ttf_noto_sans::REGULAR));
static ITALIC: LazyLock<FontRef<'static>> = LazyLock::new(|| parse(ttf_noto_sans::ITALIC));
static BOLD: LazyLock<FontRef<'static>> = LazyLock::new(|| parse(ttf_noto_sans::BOLD));

fn parse(bytes: &'static [u8]) -> FontRef<'static> {
    FontRef::new(bytes).expect("the embedded font is a valid TrueType file")
}

fn face(style: Face) -> &'static FontRef<'static> {
    match style {
        Face::Regular => &REGULAR,
        Face::Italic => &ITALIC,
        Face::Bold => &BOLD,
    }
}

/// Font units per em, the same for all embedded faces.
pub(crate) fn units_per_em() -> f64 {
    let metrics = REGULAR.metrics(Size::unscaled(), LocationRef::default());
    f64::from(metrics.units_per_em)
}

impl GlyphId {
    /// The glyph of a character; an empty box if the face has none.
    pub(crate) fn of(style: Face, c: char) -> Self {
        let found = face(style).charmap().map(c);
        Self { style, index: found.map_or(0, |g| g.to_u32()) }
    }

    /// Advance width in em.
    pub(crate) fn advance(self) -> f64 {
        let metrics = face(self.style).glyph_metrics(Size::unscaled(), LocationRef::default());
        let units = metrics.advance_width(self.index.into());
        f64::from(units.unwrap_or(0.0)) / units_per_em()
    }

    /// Outline in font units, y upward.
    pub(crate) fn outline(self) -> String {
        let mut path = Outline::default();
        let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
        if let Some(glyph) = face(self.style).outline_glyphs().get(self.index.into()) {
            let drawn = glyph.draw(settings, &mut path);
            drawn.expect("the embedded font's outlines are whole");
        }
        path.0
    }
}

#[derive(Default)]
struct Outline(String);

impl Outline {
    fn push(&mut self, command: char, numbers: &[f32]) {
        self.0.push(command);
        for (i, n) in numbers.iter().enumerate() {
            let gap = if i > 0 { " " } else { "" };
            write!(self.0, "{gap}{}", n.round()).expect("a String takes any text");
        }
    }
}

impl OutlinePen for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.push('M', &[x, y]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.push('L', &[x, y]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.push('Q', &[x1, y1, x, y]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.push('C', &[x1, y1, x2, y2, x, y]);
    }

    fn close(&mut self) {
        self.0.push('Z');
    }
}

#[cfg(test)]
#[path = "tests/font.rs"]
mod tests;

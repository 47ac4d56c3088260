//! The embedded faces (Noto Sans, Apache licence 2.0): widths and outlines of their characters.

use std::collections::HashMap;
use std::sync::LazyLock;

use crate::draw::{Point, Segment};

/// Font units per em, the same for all faces.
pub(crate) const UNITS_PER_EM: f64 = 2048.0;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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

    fn letter(self) -> char {
        match self {
            Self::Regular => 'r',
            Self::Italic => 'i',
            Self::Bold => 'b',
        }
    }
}

pub(crate) fn width(face: Face, text: &str) -> f64 {
    text.chars().map(|c| Glyph::new(face, c).advance).sum()
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Glyph {
    pub(crate) advance: f64,
    outline: &'static str,
}

/// All glyphs. The table is written by `data/make_glyphs.py`: a parser of fonts takes longer to
/// build than this whole crate.
static GLYPHS: LazyLock<HashMap<(char, u32), Glyph>> = LazyLock::new(|| {
    let glyph = |line: &'static str| {
        let mut parts = line.splitn(3, ' ');
        let (name, width, outline) = (parts.next()?, parts.next()?, parts.next()?);
        let id = (name.chars().next()?, name[1..].parse().ok()?);
        Some((id, Glyph { advance: width.parse::<f64>().ok()? / UNITS_PER_EM, outline }))
    };
    include_str!("../../data/glyphs.txt").lines().filter_map(glyph).collect()
});

impl Glyph {
    /// Steps of the outline in font units, y upward.
    pub(crate) fn segments(self) -> impl Iterator<Item = Segment> {
        let steps = self.outline.split_inclusive(|c: char| c.is_ascii_uppercase());
        steps.filter_map(|step| {
            let (numbers, operator) = step.split_at(step.len() - 1);
            let mut numbers = numbers.split(' ').filter_map(|number| number.parse().ok());
            let mut point = || Some(Point::new(numbers.next()?, numbers.next()?));
            Some(match operator {
                "M" => Segment::Move(point()?),
                "L" => Segment::Line(point()?),
                "Q" => Segment::Quad(point()?, point()?),
                _ => Segment::Close,
            })
        })
    }

    /// The glyph of a character; an empty box if the face has none.
    pub(crate) fn new(face: Face, c: char) -> Self {
        let found = GLYPHS.get(&(face.letter(), u32::from(c)));
        *found.unwrap_or_else(|| &GLYPHS[&(face.letter(), 0)])
    }
}

#[cfg(test)]
#[path = "tests/font.rs"]
mod tests;

//! A laid-out line of text.

use super::font::{GlyphId, Style, units_per_em};
use super::markup::{Run, Script, parse};
use crate::draw::{Colour, Point, Svg, fmt};

/// Smallest size of anything that is written, points: what journals ask for.
pub(crate) const LEAST_SIZE: f64 = 6.0;
/// Size of sub- and superscripts relative to the base, where that is legible.
const SCRIPT_SIZE: f64 = 0.7;
/// What stands for the rest of a line that is cut.
const ELLIPSIS: char = '…';
/// Height of a capital letter in em.
const CAP_HEIGHT: f64 = 0.714;
/// Depth of descenders in em.
const DESCENT: f64 = 0.24;

/// Where a line's reference point lies, as shares of its width and cap height:
/// (0, 0) is the left end of the baseline, (0.5, 1) the middle of the top.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Anchor {
    pub(crate) across: f64,
    pub(crate) up: f64,
}

impl Anchor {
    pub(crate) const LEFT: Self = Self {
        across: 0.0,
        up: 0.0,
    };
    pub(crate) const LEFT_MIDDLE: Self = Self {
        across: 0.0,
        up: 0.5,
    };
    pub(crate) const RIGHT: Self = Self {
        across: 1.0,
        up: 0.0,
    };
    pub(crate) const RIGHT_MIDDLE: Self = Self {
        across: 1.0,
        up: 0.5,
    };
    pub(crate) const CENTRE: Self = Self {
        across: 0.5,
        up: 0.0,
    };
    pub(crate) const MIDDLE: Self = Self {
        across: 0.5,
        up: 0.5,
    };
}

#[derive(Debug, Clone, Copy)]
struct Placed {
    glyph: GlyphId,
    x: f64,
    up: f64,
    scale: f64,
}

/// A line of text ready to be drawn at any place.
#[derive(Debug, Clone)]
pub(crate) struct TextLine {
    runs: Vec<Run>,
    glyphs: Vec<Placed>,
    plain: String,
    width_em: f64,
    top_em: f64,
    bottom_em: f64,
    size: f64,
}

impl TextLine {
    /// Lays out markup at a font size in points.
    pub(crate) fn new(markup: &str, size: f64) -> Self {
        Self::from_runs(&parse(markup), size)
    }

    /// Literal bold text, for panel letters.
    pub(crate) fn bold(text: &str, size: f64) -> Self {
        let run = Run {
            text: text.into(),
            style: Style::Bold,
            script: Script::Base,
        };
        Self::from_runs(&[run], size)
    }

    fn from_runs(runs: &[Run], size: f64) -> Self {
        let mut line = Self {
            runs: runs.to_vec(),
            glyphs: Vec::new(),
            plain: String::new(),
            width_em: 0.0,
            top_em: CAP_HEIGHT,
            bottom_em: DESCENT,
            size,
        };
        line.lay_out(runs);
        line
    }

    fn lay_out(&mut self, runs: &[Run]) {
        // A superscript right after a subscript (or the reverse) starts at the
        // same place: both belong to the same base.
        let (mut x, mut script_start, mut stacked_end) = (0.0, 0.0, 0.0_f64);
        let mut before = Script::Base;
        for run in runs {
            match (before, run.script) {
                (Script::Base, _) => (script_start, stacked_end) = (x, x),
                (_, Script::Base) => x = f64::max(x, stacked_end),
                (a, b) if a != b => (x, stacked_end) = (script_start, x.max(stacked_end)),
                _ => {}
            }
            x = self.place(run, x);
            before = run.script;
        }
        self.width_em = f64::max(x, stacked_end);
    }

    fn place(&mut self, run: &Run, start: f64) -> f64 {
        let (scale, up) = match run.script {
            Script::Base => (1.0, 0.0),
            // Large scripts sink deeper to be told from their base.
            Script::Sub => (self.script_scale(), 0.04 - 0.3 * self.script_scale()),
            Script::Super => (self.script_scale(), 0.36),
        };
        self.top_em = self.top_em.max(up + CAP_HEIGHT * scale);
        self.bottom_em = self.bottom_em.max(DESCENT * scale - up);
        let mut x = start;
        for c in run.text.chars() {
            let glyph = GlyphId::of(run.style, c);
            if !c.is_whitespace() {
                self.glyphs.push(Placed {
                    glyph,
                    x,
                    up,
                    scale,
                });
            }
            self.plain.push(c);
            x += glyph.advance() * scale;
        }
        x
    }

    /// Scripts of small lines are as large as legible.
    fn script_scale(&self) -> f64 {
        (LEAST_SIZE / self.size).clamp(SCRIPT_SIZE, 1.0)
    }

    pub(crate) fn width(&self) -> f64 {
        self.width_em * self.size
    }

    pub(crate) fn size(&self) -> f64 {
        self.size
    }

    /// From the highest superscript to the lowest descender.
    pub(crate) fn height(&self) -> f64 {
        (self.top_em + self.bottom_em) * self.size
    }

    /// Height above the baseline.
    pub(crate) fn ascent(&self) -> f64 {
        self.top_em * self.size
    }

    /// Depth below the baseline.
    pub(crate) fn descent(&self) -> f64 {
        self.bottom_em * self.size
    }

    /// Shrinks the font until the line is no wider than `width`, as far as it
    /// stays legible, and then cuts its end.
    pub(crate) fn fitted(mut self, width: f64) -> Self {
        let width = width.max(0.0);
        // Scripts shrink less than their base: a few rounds come close.
        for _ in 0..6 {
            if self.width() <= width || self.size <= LEAST_SIZE {
                break;
            }
            let size = (self.size * width / self.width()).max(LEAST_SIZE);
            self = Self::from_runs(&self.runs, size);
        }
        // What rounding leaves over is no reason to cut.
        if self.width() > width * (1.0 + 1e-3) {
            self.cut(width)
        } else {
            self
        }
    }

    /// As much of the line as fits, and an ellipsis.
    fn cut(mut self, width: f64) -> Self {
        let mark = GlyphId::of(Style::Regular, ELLIPSIS);
        let room = width / self.size - mark.advance();
        let end = |glyph: &Placed| glyph.x + glyph.glyph.advance() * glyph.scale;
        self.glyphs.retain(|glyph| end(glyph) <= room);
        let x = self.glyphs.iter().map(end).fold(0.0, f64::max);
        if room >= 0.0 {
            self.glyphs.push(Placed {
                glyph: mark,
                x,
                up: 0.0,
                scale: 1.0,
            });
        }
        self.width_em = if room >= 0.0 { x + mark.advance() } else { 0.0 };
        self
    }

    pub(crate) fn draw(&self, svg: &mut Svg, at: Point, anchor: Anchor, colour: Colour) {
        self.draw_turned(svg, at, anchor, colour, 0.0);
    }

    /// Draws turned by `angle_deg` counter-clockwise about `at`.
    pub(crate) fn draw_turned(
        &self,
        svg: &mut Svg,
        at: Point,
        anchor: Anchor,
        colour: Colour,
        angle_deg: f64,
    ) {
        if self.glyphs.is_empty() || self.size <= 0.0 {
            return;
        }
        let transform = self.transform(at, anchor, angle_deg);
        svg.open_text(&transform, colour, &self.plain);
        for placed in &self.glyphs {
            let id = placed.glyph;
            svg.glyph(id, || id.outline(), &glyph_transform(placed));
        }
        svg.close();
    }

    /// Font units, y upward, to the page.
    fn transform(&self, at: Point, anchor: Anchor, angle_deg: f64) -> String {
        let mut out = String::from("translate(");
        fmt(&mut out, at.x);
        out.push(' ');
        fmt(&mut out, at.y);
        out.push(')');
        if angle_deg != 0.0 {
            out.push_str(" rotate(");
            fmt(&mut out, -angle_deg);
            out.push(')');
        }
        out.push_str(" translate(");
        fmt(&mut out, -anchor.across * self.width());
        out.push(' ');
        fmt(&mut out, anchor.up * CAP_HEIGHT * self.size);
        let scale = self.size / units_per_em();
        out.push_str(&format!(") scale({scale:.6} {:.6})", -scale));
        out
    }
}

fn glyph_transform(placed: &Placed) -> String {
    let mut out = String::from("translate(");
    fmt(&mut out, placed.x * units_per_em());
    out.push(' ');
    fmt(&mut out, placed.up * units_per_em());
    out.push(')');
    if placed.scale != 1.0 {
        out.push_str(&format!(" scale({})", placed.scale));
    }
    out
}

#[cfg(test)]
#[path = "tests/line.rs"]
mod tests;

//! Text: a little TeX-like markup is laid out with the metrics of an embedded font and
//! drawn as text, or as outlines that need no font.
//!
//! Inside `$...$` Latin letters are italic, `_x`, `_{...}`, `^x` and `^{...}`
//! make subscripts and superscripts, `\mathrm{...}` is upright, `\alpha`,
//! `\Delta`, `\times`, `\cdot`, `\leq` ... are single characters and `-` is a
//! minus sign. Outside, everything is literal; `\$` is a dollar sign.

mod font;
mod markup;

use crate::draw::{Canvas, Colour, Item, PathData, PlacedText, Point};
use crate::files::escape;
use font::{Face, Glyph, UNITS_PER_EM, width};
use markup::{Script, TextRun, parse};

/// Smallest size of anything that is written, points: what journals ask for.
pub(crate) const LEAST_SIZE: f64 = 6.0;
/// Size of sub- and superscripts relative to the base, where that is legible.
const SCRIPT_SIZE: f64 = 0.7;
/// End of a line that is cut.
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
    pub(crate) const LEFT: Self = Self::new(0.0, 0.0);
    pub(crate) const LEFT_MIDDLE: Self = Self::new(0.0, 0.5);
    pub(crate) const RIGHT: Self = Self::new(1.0, 0.0);
    pub(crate) const RIGHT_MIDDLE: Self = Self::new(1.0, 0.5);
    pub(crate) const CENTRE: Self = Self::new(0.5, 0.0);
    pub(crate) const MIDDLE: Self = Self::new(0.5, 0.5);

    const fn new(across: f64, up: f64) -> Self {
        Self { across, up }
    }
}

/// Characters of one style that follow each other at one height, in em of the line.
#[derive(Debug, Clone)]
struct Span {
    text: String,
    style: Face,
    x: f64,
    up: f64,
    scale: f64,
}

impl Span {
    fn end(&self) -> f64 {
        self.x + self.scale * width(self.style, &self.text)
    }
}

/// A line of text ready to be drawn at any place.
#[derive(Debug, Clone)]
pub(crate) struct TextLine {
    runs: Vec<TextRun>,
    spans: Vec<Span>,
    pub(crate) plain: String,
    width_em: f64,
    top_em: f64,
    bottom_em: f64,
    pub(crate) size: f64,
}

impl TextLine {
    pub(crate) fn new(markup: &str, size: f64) -> Self {
        Self::from_runs(&parse(markup), size)
    }

    /// Literal bold text, for panel letters.
    pub(crate) fn bold(text: &str, size: f64) -> Self {
        let run = TextRun { text: text.into(), style: Face::Bold, script: Script::Base };
        Self::from_runs(&[run], size)
    }

    fn from_runs(runs: &[TextRun], size: f64) -> Self {
        let mut line = Self {
            runs: runs.to_vec(),
            spans: Vec::new(),
            plain: String::new(),
            width_em: 0.0,
            top_em: CAP_HEIGHT,
            bottom_em: DESCENT,
            size,
        };
        line.lay_out(runs);
        line
    }

    fn lay_out(&mut self, runs: &[TextRun]) {
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

    fn place(&mut self, run: &TextRun, start: f64) -> f64 {
        let (scale, up) = match run.script {
            Script::Base => (1.0, 0.0),
            // Large scripts sink deeper to differ from their base.
            Script::Sub => (self.script_scale(), 0.04 - 0.3 * self.script_scale()),
            Script::Super => (self.script_scale(), 0.36),
        };
        self.top_em = self.top_em.max(up + CAP_HEIGHT * scale);
        self.bottom_em = self.bottom_em.max(DESCENT * scale - up);
        let span = Span { text: run.text.clone(), style: run.style, x: start, up, scale };
        let end = span.end();
        self.plain.push_str(&run.text);
        self.spans.push(span);
        end
    }

    /// Scripts of small lines are as large as legible.
    fn script_scale(&self) -> f64 {
        (LEAST_SIZE / self.size).clamp(SCRIPT_SIZE, 1.0)
    }

    pub(crate) fn width(&self) -> f64 {
        self.width_em * self.size
    }

    /// The same in another size, its proportions kept.
    pub(crate) fn scaled(self, scale: f64) -> Self {
        Self { size: scale * self.size, ..self }
    }

    /// From the highest superscript to the lowest descender.
    pub(crate) fn height(&self) -> f64 {
        (self.top_em + self.bottom_em) * self.size
    }

    pub(crate) fn ascent(&self) -> f64 {
        self.top_em * self.size
    }

    pub(crate) fn descent(&self) -> f64 {
        self.bottom_em * self.size
    }

    /// Shrinks the font until the line is no wider than `width`, as far as it
    /// stays legible, and then cuts its end.
    pub(crate) fn shrunk_to(mut self, width: f64) -> Self {
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
        if self.width() > width * (1.0 + 1e-3) { self.cut(width) } else { self }
    }

    /// As much of the line as fits, and an ellipsis.
    fn cut(mut self, width: f64) -> Self {
        let mut mark =
            Span { text: ELLIPSIS.to_string(), style: Face::Regular, x: 0.0, up: 0.0, scale: 1.0 };
        let room = width / self.size - mark.end();
        for span in &mut self.spans {
            while !span.text.is_empty() && (span.end() > room || span.text.ends_with(' ')) {
                span.text.pop();
            }
        }
        self.spans.retain(|span| !span.text.is_empty());
        self.width_em = 0.0;
        if room >= 0.0 {
            mark.x = self.spans.iter().map(Span::end).fold(0.0, f64::max);
            self.width_em = mark.end();
            self.spans.push(mark);
        }
        self
    }

    pub(crate) fn draw(&self, canvas: &mut Canvas, at: Point, anchor: Anchor, colour: Colour) {
        self.draw_turned(canvas, at, anchor, colour, 0.0);
    }

    /// Draws turned by `angle_deg` counter-clockwise about `at`.
    pub(crate) fn draw_turned(
        &self,
        canvas: &mut Canvas,
        at: Point,
        anchor: Anchor,
        colour: Colour,
        angle_deg: f64,
    ) {
        if !(self.plain.trim().is_empty() || self.spans.is_empty() || self.size <= 0.0) {
            let line = self.clone();
            canvas.items.push(Item::Text(PlacedText { line, at, anchor, colour, angle_deg }));
        }
    }

    /// Attributes and content of a `text` element, runs following each other in one line.
    pub(crate) fn live(&self, anchor: Anchor) -> String {
        let side = match anchor.across {
            share if share < 0.25 => "start",
            share if share > 0.75 => "end",
            _ => "middle",
        };
        let mut out = format!(" text-anchor=\"{side}\" font-size=\"{:.4}\">", self.size);
        let (mut x, mut up) = (0.0, 0.0);
        for span in &self.spans {
            out.push_str("<tspan");
            let moved = [("dx", span.x - x), ("dy", up - span.up)];
            for (name, em) in moved.into_iter().filter(|(_, em)| em.abs() > 1e-9) {
                out.push_str(&format!(" {name}=\"{:.3}\"", em * self.size));
            }
            if span.scale != 1.0 {
                out.push_str(&format!(" font-size=\"{:.4}\"", span.scale * self.size));
            }
            out.push_str(span.style.attribute());
            out.push_str(&format!(">{}</tspan>", escape(&span.text)));
            (x, up) = (span.end(), span.up);
        }
        out
    }
}

impl PlacedText {
    /// From the anchor down to the baseline.
    pub(crate) fn down(&self) -> f64 {
        self.anchor.up * CAP_HEIGHT * self.line.size
    }

    pub(crate) fn outlines(&self) -> PathData {
        let (sin, cos) = self.angle_deg.to_radians().sin_cos();
        let (left, down) = (-self.anchor.across * self.line.width(), self.down());
        let mut path = PathData::default();
        for span in &self.line.spans {
            let mut start = span.x;
            for glyph in span.text.chars().map(|c| Glyph::new(span.style, c)) {
                let at = |p: Point| {
                    let x = left + self.line.size * (start + span.scale * p.x / UNITS_PER_EM);
                    let y = down - self.line.size * (span.up + span.scale * p.y / UNITS_PER_EM);
                    Point::new(self.at.x + x * cos + y * sin, self.at.y + y * cos - x * sin)
                };
                path.0.extend(glyph.segments().map(|segment| segment.map(&at)));
                start += glyph.advance * span.scale;
            }
        }
        path
    }
}

/// Breaks at spaces so that no line is wider than `width`; a single word that is too wide shrinks.
/// At most `max_lines` lines, the last one ending in an ellipsis if something was left out.
pub(crate) fn wrap(markup: &str, size: f64, width: f64, max_lines: usize) -> Vec<TextLine> {
    let mut lines: Vec<String> = Vec::new();
    for word in words(markup) {
        match lines.last_mut() {
            Some(line) if TextLine::new(&format!("{line} {word}"), size).width() <= width => {
                line.push(' ');
                line.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    if lines.len() > max_lines {
        lines.truncate(max_lines);
        if let Some(last) = lines.last_mut() {
            last.push('…');
        }
    }
    lines.iter().map(|l| TextLine::new(l, size).shrunk_to(width)).collect()
}

/// Words of markup; formulas between dollar signs and no-break spaces hold together.
fn words(markup: &str) -> Vec<String> {
    let (mut found, mut math) = (vec![String::new()], false);
    for c in markup.chars() {
        math ^= c == '$';
        if c.is_whitespace() && c != '\u{a0}' && !math {
            found.push(String::new());
        } else if let Some(word) = found.last_mut() {
            word.push(c);
        }
    }
    found.retain(|w| !w.is_empty());
    found
}

#[cfg(test)]
#[path = "tests/line.rs"]
mod tests;

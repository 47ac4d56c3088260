//! Verdicts on claims under several readings, as a table of symbols.

use crate::draw::{Canvas, Colour, PT_PER_MM, Paint, PathData, Point, Rect};
use crate::figure::{DOUBLE_COLUMN_MM, Figure, SINGLE_COLUMN_MM};
use crate::text::{Anchor, LEAST_SIZE, TextLine, wrap};

/// The answer to "does the model show what is claimed?".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ClaimVerdict {
    /// It does.
    Holds,
    /// It does in at least half of the comparisons that the claim covers, or meets the claim's
    /// weaker threshold.
    InPart,
    /// It does not, or in fewer.
    Fails,
    /// The numbers do not decide.
    NotDecidable,
}

impl ClaimVerdict {
    /// All verdicts.
    pub const ALL: [Self; 4] = [Self::Holds, Self::InPart, Self::Fails, Self::NotDecidable];

    /// As written in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::InPart => "holds in part",
            Self::Fails => "fails",
            Self::NotDecidable => "not decidable",
        }
    }

    /// Share of the claim that is met, for ranking: 1, 1/2 or 0.
    pub const fn score(self) -> f64 {
        match self {
            Self::Holds => 1.0,
            Self::InPart => 0.5,
            Self::Fails | Self::NotDecidable => 0.0,
        }
    }

    /// Colours differ in lightness too, for grey print.
    fn colour(self) -> Colour {
        match self {
            Self::Holds => Colour(56, 150, 122),
            Self::InPart => Colour(244, 218, 130),
            Self::Fails => Colour(186, 66, 10),
            Self::NotDecidable => Colour::grey(226),
        }
    }
}

impl std::fmt::Display for ClaimVerdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

const FONT: f64 = 7.0;
const LEADING: f64 = 8.8;
/// Widest and narrowest room for the names of claims.
const LABELS: f64 = 190.0;
const NARROWEST: f64 = 66.0;
const SMALLEST_CELL: f64 = 9.0;
const LARGEST_CELL: f64 = 40.0;
const TALLEST_HEADER: f64 = 130.0;
const PADDING: f64 = 4.0;
const KEY: f64 = 18.0;
/// Room that an entry of the key needs beside its name.
const KEY_ROOM: f64 = 26.0;
/// Room left of a line that holds throughout, for its symbol.
const INDENT: f64 = 16.0;
/// Margins of the page, left and right together.
const MARGINS: f64 = 6.0;

/// Rows are claims, columns readings, cells verdicts.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct VerdictMatrix {
    /// Names of the readings.
    pub columns: Vec<String>,
    /// Claims with their verdicts; cells beyond the columns are not drawn, missing ones stay empty.
    pub rows: Vec<(String, Vec<ClaimVerdict>)>,
    /// Claims that have one verdict in all columns, as lines of text below the rows.
    pub throughout: Vec<(ClaimVerdict, String)>,
    /// Remarks below everything.
    pub notes: Vec<String>,
}

impl VerdictMatrix {
    /// The table as a figure of its own, as high as it needs to be: one column
    /// wide if that holds its cells, else two, or wider if it has very many.
    pub fn figure(self) -> Figure {
        let narrow = MatrixLayout::new(&self, SINGLE_COLUMN_MM);
        let (page_mm, layout) = if narrow.fits(SINGLE_COLUMN_MM) {
            (SINGLE_COLUMN_MM, narrow)
        } else {
            (DOUBLE_COLUMN_MM, MatrixLayout::new(&self, DOUBLE_COLUMN_MM))
        };
        let (width, height) = layout.size();
        let mm = |points: f64| (points + MARGINS) / PT_PER_MM;
        Figure::new(mm(width).max(page_mm), mm(height)).panel(self)
    }

    /// Draws the table, shrunk to fit the frame.
    pub(crate) fn draw(&self, canvas: &mut Canvas, frame: &Rect) {
        let layout = MatrixLayout::new(self, (frame.width() + MARGINS) / PT_PER_MM);
        let (width, height) = layout.size();
        canvas.shrunk_to(frame, (width, 0.0, height), |canvas| {
            layout.draw_header(canvas, self);
            let y = layout.draw_rows(canvas, self);
            layout.draw_below(canvas, y);
            layout.draw_key(canvas);
        });
    }
}

struct MatrixLayout {
    claims: Vec<Vec<TextLine>>,
    headers: Vec<TextLine>,
    below: Vec<(Option<ClaimVerdict>, Vec<TextLine>)>,
    labels: f64,
    cell: f64,
    header: f64,
    upright: bool,
}

impl MatrixLayout {
    /// For a page of this width.
    fn new(matrix: &VerdictMatrix, page_mm: f64) -> Self {
        let page = page_mm * PT_PER_MM - MARGINS;
        let columns = matrix.columns.len().max(1) as f64;
        let room = page - columns * SMALLEST_CELL - 2.0 * PADDING;
        let claims: Vec<Vec<TextLine>> = matrix
            .rows
            .iter()
            .map(|(claim, _)| wrap(claim, FONT, room.clamp(NARROWEST, LABELS), 4))
            .collect();
        let lines = claims.iter().flatten();
        let widest = lines.map(TextLine::width).fold(40.0, f64::max);
        let labels = widest + 2.0 * PADDING;
        let cell = ((page - labels) / columns).clamp(SMALLEST_CELL, LARGEST_CELL);
        let headers: Vec<TextLine> = matrix
            .columns
            .iter()
            .map(|c| TextLine::new(c, FONT).shrunk_to(TALLEST_HEADER))
            .collect();
        let longest = headers.iter().map(TextLine::width).fold(0.0, f64::max);
        let upright = longest <= cell - 3.0;
        let header = if upright { 1.3 * FONT } else { longest } + PADDING;
        let mut layout = Self { claims, headers, below: Vec::new(), labels, cell, header, upright };
        layout.below = layout.lines_below(matrix, page);
        layout
    }

    /// What stands below the rows, as wide as the page.
    fn lines_below(
        &self,
        matrix: &VerdictMatrix,
        page: f64,
    ) -> Vec<(Option<ClaimVerdict>, Vec<TextLine>)> {
        let width = page.max(self.size().0);
        let same = matrix.throughout.iter().map(|(verdict, claims)| {
            let lines = wrap(claims, FONT, width - INDENT, 30);
            (Some(*verdict), lines)
        });
        let notes = matrix.notes.iter();
        let notes = notes.map(|note| (None, wrap(note, FONT, width, 30)));
        same.chain(notes).collect()
    }

    /// Whether everything is legible on a page of this width.
    fn fits(&self, page_mm: f64) -> bool {
        // Cells that fill the page may exceed it by rounding.
        self.size().0 <= page_mm * PT_PER_MM - MARGINS + 1e-6
    }

    fn size(&self) -> (f64, f64) {
        let rows: f64 = self.claims.iter().map(|lines| row_height(lines)).sum();
        let width = self.labels + self.cell * self.headers.len() as f64;
        let below: f64 = self.below.iter().map(|(_, lines)| below_height(lines)).sum();
        let height = self.header + rows + below + KEY;
        (width.max(self.key_width()), height)
    }

    fn cell_centre(&self, column: usize) -> f64 {
        self.labels + self.cell * (column as f64 + 0.5)
    }

    fn draw_header(&self, canvas: &mut Canvas, matrix: &VerdictMatrix) {
        for (i, header) in self.headers.iter().enumerate().take(matrix.columns.len()) {
            let at = Point::new(self.cell_centre(i), self.header - PADDING);
            if self.upright {
                header.draw(canvas, at, Anchor::CENTRE, Colour::BLACK);
            } else {
                header.draw_turned(canvas, at, Anchor::LEFT_MIDDLE, Colour::BLACK, 90.0);
            }
        }
    }

    /// Returns where the last row ends.
    fn draw_rows(&self, canvas: &mut Canvas, matrix: &VerdictMatrix) -> f64 {
        let (mut y, mut rules) = (self.header, PathData::default());
        let right = self.labels + self.cell * self.headers.len() as f64;
        for (row, (_, cells)) in matrix.rows.iter().enumerate() {
            let height = row_height(&self.claims[row]);
            let lines = &self.claims[row];
            let first = y + 0.5 * height - 0.5 * LEADING * (lines.len() as f64 - 1.0);
            canvas.lines(lines, Point::new(PADDING, first), LEADING, Anchor::LEFT_MIDDLE);
            for (column, verdict) in cells.iter().take(matrix.columns.len()).enumerate() {
                let x = self.cell_centre(column) - 0.5 * self.cell;
                draw_symbol(canvas, *verdict, &Rect::sized(x, y, self.cell, height).grown(-0.5));
            }
            rules.segment(Point::new(0.0, y), Point::new(right, y));
            y += height;
        }
        rules.segment(Point::new(0.0, y), Point::new(right, y));
        canvas.path(&rules, &Paint::line(Colour::grey(190), 0.4));
        y
    }

    /// Claims with one verdict, and remarks.
    fn draw_below(&self, canvas: &mut Canvas, mut y: f64) {
        for (verdict, lines) in &self.below {
            let middle = y + PADDING + 0.5 * LEADING;
            let x = if verdict.is_some() { INDENT } else { 0.0 };
            if let Some(verdict) = verdict {
                draw_symbol(canvas, *verdict, &Rect::sized(0.0, middle - 4.5, 11.0, 9.0));
            }
            canvas.lines(lines, Point::new(x, middle), LEADING, Anchor::LEFT_MIDDLE);
            y += below_height(lines);
        }
    }

    fn key_width(&self) -> f64 {
        let widths =
            ClaimVerdict::ALL.iter().map(|v| TextLine::new(v.name(), FONT).width() + KEY_ROOM);
        widths.sum()
    }

    fn draw_key(&self, canvas: &mut Canvas) {
        let middle = self.size().1 - 0.5 * KEY + 3.0;
        let mut x = (self.size().0 - self.key_width()).max(0.0);
        for verdict in ClaimVerdict::ALL {
            draw_symbol(canvas, verdict, &Rect::sized(x, middle - 5.0, 12.0, 10.0));
            let name = TextLine::new(verdict.name(), FONT);
            name.draw(canvas, Point::new(x + 16.0, middle), Anchor::LEFT_MIDDLE, Colour::BLACK);
            x += name.width() + KEY_ROOM;
        }
    }
}

fn row_height(claim: &[TextLine]) -> f64 {
    (claim.len().max(1) as f64 * LEADING + 3.0).max(SMALLEST_CELL + 2.0)
}

/// Height of a line of text below the rows, however often it breaks.
fn below_height(lines: &[TextLine]) -> f64 {
    PADDING + LEADING * lines.len().max(1) as f64
}

/// Fills `cell` and draws the symbol of a verdict, as a path that needs no font.
fn draw_symbol(canvas: &mut Canvas, verdict: ClaimVerdict, cell: &Rect) {
    canvas.rect(cell, &Paint::fill(verdict.colour()));
    let (c, r) = (cell.centre(), 0.3 * cell.width().min(cell.height()).min(11.0));
    let at = |dx: f64, dy: f64| Point::new(c.x + dx * r, c.y + dy * r);
    let white = Paint::line(Colour::WHITE, 0.42 * r);
    match verdict {
        ClaimVerdict::Holds => {
            let tick = [at(-0.9, 0.05), at(-0.25, 0.75), at(0.95, -0.8)];
            canvas.path(PathData::default().polyline(&tick), &white);
        }
        ClaimVerdict::Fails => {
            let mut cross = PathData::default();
            cross.segment(at(-0.75, -0.75), at(0.75, 0.75));
            cross.segment(at(-0.75, 0.75), at(0.75, -0.75));
            canvas.path(&cross, &white);
        }
        ClaimVerdict::InPart => draw_half_circle(canvas, c, 0.8 * r),
        ClaimVerdict::NotDecidable => {
            let mark = TextLine::bold("?", (2.6 * r).max(LEAST_SIZE));
            mark.draw(canvas, c, Anchor::MIDDLE, Colour::grey(90));
        }
    }
}

fn draw_half_circle(canvas: &mut Canvas, c: Point, r: f64) {
    let ink = Colour::grey(60);
    canvas.circle(c, r, &Paint::line(ink, 0.25 * r));
    canvas.path(PathData::default().left_half_circle(c, r), &Paint::fill(ink));
}

#[cfg(test)]
#[path = "matrix/tests/mod.rs"]
mod tests;

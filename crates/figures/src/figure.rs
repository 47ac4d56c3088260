//! A figure: panels in a grid, as SVG, PNG or PDF.

use crate::chart::{Chart, Prepared, SMALL, x_scale};
use crate::draw::{Canvas, Colour, Margins, PT_PER_MM, Point, Rect};
use crate::files::{self, FigureError};
use crate::matrix::VerdictMatrix;
use crate::rig::RigDrawing;
use crate::text::{Anchor, TextLine};

/// Width of a single journal column in millimetres.
pub(crate) const SINGLE_COLUMN_MM: f64 = 85.0;
/// Width of a journal page of two columns in millimetres.
pub(crate) const DOUBLE_COLUMN_MM: f64 = 175.0;

/// Part of a figure.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Panel {
    /// A diagram with axes, with or without a map.
    Chart(Box<Chart>),
    /// Verdicts on claims.
    Matrix(VerdictMatrix),
    /// A drawing of the apparatus.
    Rig(Box<RigDrawing>),
    /// A place left free.
    Empty,
}

impl From<Chart> for Panel {
    fn from(chart: Chart) -> Self {
        Self::Chart(Box::new(chart))
    }
}

impl From<VerdictMatrix> for Panel {
    fn from(matrix: VerdictMatrix) -> Self {
        Self::Matrix(matrix)
    }
}

impl From<RigDrawing> for Panel {
    fn from(rig: RigDrawing) -> Self {
        Self::Rig(Box::new(rig))
    }
}

impl Panel {
    fn title(&self) -> &str {
        match self {
            Self::Chart(chart) => &chart.title,
            Self::Matrix(_) | Self::Rig(_) | Self::Empty => "",
        }
    }
}

/// Panels in a grid, filled row by row.
///
/// ```
/// use hertzchain_figures::{Chart, Figure, Series};
/// let speed_m_s = [0.1, 0.2, 0.5, 1.0];
/// let tof_us = [1020.0, 890.0, 741.0, 645.0];
/// let chart = Chart::new("Impact speed $v_0$ (m/s)", "ToF (µs)")
///     .x_log()
///     .with(Series::points("dry", &speed_m_s, &tof_us));
/// let svg = Figure::single_column(60.0).panel(chart).svg();
/// assert!(svg.starts_with("<svg"));
/// ```
#[derive(Debug, Clone)]
pub struct Figure {
    width_mm: f64,
    pub(crate) height_mm: f64,
    columns: usize,
    panels: Vec<Panel>,
    letters: bool,
    share_x: bool,
    title: String,
    caption: String,
}

impl Figure {
    /// A figure of any size; sizes are held between 10 mm and 5 m.
    pub fn new(width_mm: f64, height_mm: f64) -> Self {
        let held = |mm: f64| match mm.is_finite() {
            true => mm.clamp(10.0, 5000.0),
            false => SINGLE_COLUMN_MM,
        };
        Self {
            width_mm: held(width_mm),
            height_mm: held(height_mm),
            columns: 1,
            panels: Vec::new(),
            letters: false,
            share_x: false,
            title: String::new(),
            caption: String::new(),
        }
    }

    /// As wide as one journal column.
    pub fn single_column(height_mm: f64) -> Self {
        Self::new(SINGLE_COLUMN_MM, height_mm)
    }

    /// As wide as a journal page of two columns.
    pub fn double_column(height_mm: f64) -> Self {
        Self::new(DOUBLE_COLUMN_MM, height_mm)
    }

    /// Puts the panels into this many columns.
    pub fn columns(mut self, columns: usize) -> Self {
        self.columns = columns.max(1);
        self
    }

    /// Adds a panel.
    pub fn panel(mut self, panel: impl Into<Panel>) -> Self {
        self.panels.push(panel.into());
        self
    }

    /// Letters (a), (b), ... above the panels.
    pub fn letters(mut self) -> Self {
        self.letters = true;
        self
    }

    /// Charts of a column share their x axis; only the lowest is labelled.
    pub fn share_x(mut self) -> Self {
        self.share_x = true;
        self
    }

    /// Title inside the file, for readers of the SVG; not drawn.
    pub fn title(mut self, title: &str) -> Self {
        self.title = title.into();
        self
    }

    /// What a journal prints below the figure: plain text, not drawn, kept in
    /// the SVG as its description.
    pub fn caption(mut self, caption: &str) -> Self {
        self.caption = caption.into();
        self
    }

    /// The caption and, in front of it, the title.
    pub fn caption_text(&self) -> String {
        let parts = [&self.title, &self.caption].into_iter();
        let parts: Vec<&str> = parts.map(|text| text.trim_end_matches('.')).collect();
        let written: Vec<&str> = parts.into_iter().filter(|text| !text.is_empty()).collect();
        written.join(". ") + if written.is_empty() { "" } else { "." }
    }

    /// The picture as SVG with text as text, measured with Noto Sans.
    pub fn svg(&self) -> String {
        self.written(false)
    }

    /// The picture as SVG with text as outlines, which look the same everywhere.
    pub fn svg_outlined(&self) -> String {
        self.written(true)
    }

    fn written(&self, outlines: bool) -> String {
        let size = (self.width_mm, self.height_mm);
        files::svg(&self.drawn(), size, (&self.title, &self.caption), outlines)
    }

    /// The picture as PNG at a resolution in dots per inch; journals ask for 300.
    ///
    /// # Errors
    /// [`FigureError::Size`] if the size in pixels is zero or too large.
    pub fn png(&self, dpi: f64) -> Result<Vec<u8>, FigureError> {
        files::png(&self.drawn(), (self.width_mm, self.height_mm), dpi)
    }

    /// The picture as PDF, text as outlines.
    pub fn pdf(&self) -> Vec<u8> {
        files::pdf(&self.drawn(), self.page())
    }

    fn page(&self) -> (f64, f64) {
        (self.width_mm * PT_PER_MM, self.height_mm * PT_PER_MM)
    }

    fn drawn(&self) -> Canvas {
        let mut canvas = Canvas::default();
        let panels = self.shared();
        let grid = PanelGrid::new(self.page(), self.columns, self.letters, &panels);
        for (i, panel) in panels.iter().enumerate() {
            let frame = grid.frame(i);
            self.heading(&mut canvas, panel, i, &frame, &grid);
            match panel {
                Panel::Chart(chart) => Prepared::new(chart, grid.frame).draw(&mut canvas, &frame),
                Panel::Matrix(matrix) => matrix.draw(&mut canvas, &frame),
                Panel::Rig(rig) => rig.draw(&mut canvas, &frame),
                Panel::Empty => {}
            }
        }
        canvas
    }

    /// The panels, shared axes given one range and one set of labels.
    fn shared(&self) -> Vec<Panel> {
        let mut panels = self.panels.clone();
        for column in (0..self.columns.min(panels.len())).filter(|_| self.share_x) {
            let members: Vec<usize> = (column..panels.len()).step_by(self.columns).collect();
            share_x(&mut panels, &members);
        }
        panels
    }

    fn heading(
        &self,
        canvas: &mut Canvas,
        panel: &Panel,
        index: usize,
        frame: &Rect,
        grid: &PanelGrid,
    ) {
        let mut x = frame.x0;
        let baseline = frame.y0 - grid.above(index) - 4.0;
        if self.letters {
            let letter = TextLine::bold(&panel_letter(index), 8.5);
            letter.draw(canvas, Point::new(x, baseline), Anchor::LEFT, Colour::BLACK);
            x += letter.width() + 4.0;
        }
        let title = TextLine::new(panel.title(), 8.0).shrunk_to(frame.x1 - x);
        title.draw(canvas, Point::new(x, baseline), Anchor::LEFT, Colour::BLACK);
    }
}

fn panel_letter(index: usize) -> String {
    match u8::try_from(index) {
        Ok(i) if i < 26 => format!("({})", char::from(b'a' + i)),
        _ => format!("({})", index + 1),
    }
}

/// Gives charts one x range and labels the last of them.
fn share_x(panels: &mut [Panel], members: &[usize]) {
    let ranges = members.iter().filter_map(|i| match &panels[*i] {
        Panel::Chart(chart) => Some(x_scale(chart)),
        _ => None,
    });
    let ranges = ranges.map(|scale| (scale.lo, scale.hi));
    let shared = ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    for i in members {
        if let Panel::Chart(chart) = &mut panels[*i] {
            chart.x.range = shared;
            chart.x.unlabelled = Some(i) != members.last();
        }
    }
}

/// Space around and between panels, in points.
const MARGIN: f64 = 3.0;
const GUTTER: f64 = 7.0;
/// Height of the line with panel letter and title, in points.
const HEADING: f64 = 11.5;

/// Places of the frames: equal in size, aligned along rows and columns.
struct PanelGrid {
    columns: usize,
    frame: (f64, f64),
    /// Margins of each column (left, right) and row (top, bottom).
    across: Vec<Margins>,
    down: Vec<Margins>,
}

impl PanelGrid {
    fn new(page: (f64, f64), columns: usize, letters: bool, panels: &[Panel]) -> Self {
        let columns = columns.min(panels.len()).max(1);
        let rows = panels.len().div_ceil(columns).max(1);
        let mut grid = Self {
            columns,
            frame: (0.75 * page.0 / columns as f64, 0.75 * page.1 / rows as f64),
            across: vec![Margins::default(); columns],
            down: vec![Margins::default(); rows],
        };
        // Ticks depend on the frame and the frame on the tick labels. The first
        // guess is dropped; after it margins only grow, so this settles.
        for round in 0..4 {
            if round == 1 {
                grid.across.fill(Margins::default());
                grid.down.fill(Margins::default());
            }
            grid.measure(panels, letters);
            grid.fit(page);
        }
        grid
    }

    fn measure(&mut self, panels: &[Panel], letters: bool) {
        for (i, panel) in panels.iter().enumerate() {
            let mut side = match panel {
                Panel::Chart(chart) => Prepared::new(chart, self.frame).margins(),
                _ => Margins::default(),
            };
            if letters || !panel.title().is_empty() {
                side.top += HEADING;
            }
            let (column, row) = (i % self.columns, i / self.columns);
            self.across[column] = self.across[column].union(side);
            self.down[row] = self.down[row].union(side);
        }
    }

    fn fit(&mut self, page: (f64, f64)) {
        let gaps = |count: usize| 2.0 * MARGIN + GUTTER * (count - 1) as f64;
        let across: f64 = self.across.iter().map(|s| s.left + s.right).sum();
        let down: f64 = self.down.iter().map(|s| s.top + s.bottom).sum();
        let (columns, rows) = (self.across.len(), self.down.len());
        self.frame = (
            ((page.0 - across - gaps(columns)) / columns as f64).max(4.0),
            ((page.1 - down - gaps(rows)) / rows as f64).max(4.0),
        );
    }

    fn frame(&self, index: usize) -> Rect {
        let (column, row) = (index % self.columns, index / self.columns);
        let before = self.across.iter().take(column);
        let left: f64 = before.map(|s| s.left + s.right + self.frame.0 + GUTTER).sum();
        let before = self.down.iter().take(row);
        let top: f64 = before.map(|s| s.top + s.bottom + self.frame.1 + GUTTER).sum();
        let x = MARGIN + left + self.across[column].left;
        let y = MARGIN + top + self.down[row].top;
        Rect::sized(x, y, self.frame.0, self.frame.1)
    }

    /// Room between the heading and the frame.
    fn above(&self, index: usize) -> f64 {
        let top = self.down[index / self.columns].top;
        (top - HEADING - 0.55 * SMALL).max(0.0)
    }
}

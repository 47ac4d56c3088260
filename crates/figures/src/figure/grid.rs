//! Where the panels' frames stand on the page.

use super::Panel;
use crate::chart::{Chart, Prepared, Spot, Style};
use crate::draw::{Rect, Side};

/// Space around and between panels, in points.
const MARGIN: f64 = 3.0;
const GUTTER: f64 = 7.0;
/// Height of the line with panel letter and title, in points.
const HEADING: f64 = 11.5;

/// Places of the frames: equal in size, aligned along rows and columns.
pub(super) struct Grid {
    columns: usize,
    frame: (f64, f64),
    /// Margins of each column (left, right) and row (top, bottom).
    across: Vec<Side>,
    down: Vec<Side>,
    /// Where each panel's legend stands.
    spots: Vec<Spot>,
}

impl Grid {
    pub(super) fn new(page: (f64, f64), columns: usize, letters: bool, panels: &[Panel]) -> Self {
        let columns = columns.min(panels.len()).max(1);
        let rows = panels.len().div_ceil(columns).max(1);
        let mut grid = Self {
            columns,
            frame: (0.75 * page.0 / columns as f64, 0.75 * page.1 / rows as f64),
            across: vec![Side::default(); columns],
            down: vec![Side::default(); rows],
            spots: vec![Spot::Inside; panels.len()],
        };
        // Ticks depend on the frame and the frame on the tick labels. The first
        // guess is forgotten; after it margins only grow, so this settles.
        for round in 0..4 {
            if round == 1 {
                grid.across.fill(Side::default());
                grid.down.fill(Side::default());
                grid.spots.fill(Spot::Inside);
            }
            grid.measure(panels, letters);
            grid.fit(page);
        }
        grid
    }

    fn measure(&mut self, panels: &[Panel], letters: bool) {
        for (i, panel) in panels.iter().enumerate() {
            let mut side = self.margins(i, panel);
            if letters || !panel.title().is_empty() {
                side.top += HEADING;
            }
            if let Some(column) = self.across.get_mut(i % self.columns) {
                *column = column.union(side);
            }
            if let Some(row) = self.down.get_mut(i / self.columns) {
                *row = row.union(side);
            }
        }
    }

    fn margins(&mut self, index: usize, panel: &Panel) -> Side {
        let Panel::Chart(chart) = panel else {
            return Side::default();
        };
        // A legend that went above stays there: its room makes the frame lower.
        let above = self.spot(index).filter(|spot| *spot == Spot::Above);
        let prepared = Prepared::new(chart, Style::JOURNAL, self.frame, above);
        if let Some(spot) = self.spots.get_mut(index) {
            *spot = prepared.spot;
        }
        prepared.margins(chart, self.frame)
    }

    fn spot(&self, index: usize) -> Option<Spot> {
        self.spots.get(index).copied()
    }

    /// A panel's chart for its frame, its legend where there is room for it.
    pub(super) fn prepared(&self, index: usize, chart: &Chart) -> Prepared {
        Prepared::new(chart, Style::JOURNAL, self.frame, self.spot(index))
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

    pub(super) fn frame(&self, index: usize) -> Rect {
        let (column, row) = (index % self.columns, index / self.columns);
        let left: f64 = self
            .across
            .iter()
            .take(column)
            .map(|s| s.left + s.right + self.frame.0 + GUTTER)
            .sum();
        let top: f64 = self
            .down
            .iter()
            .take(row)
            .map(|s| s.top + s.bottom + self.frame.1 + GUTTER)
            .sum();
        let own = (self.across.get(column), self.down.get(row));
        let x = MARGIN + left + own.0.map_or(0.0, |s| s.left);
        let y = MARGIN + top + own.1.map_or(0.0, |s| s.top);
        Rect::sized(x, y, self.frame.0, self.frame.1)
    }

    /// Room between the heading and the frame.
    pub(super) fn above(&self, index: usize) -> f64 {
        let top = self.down.get(index / self.columns).map_or(0.0, |s| s.top);
        (top - HEADING - 0.55 * Style::JOURNAL.small).max(0.0)
    }
}

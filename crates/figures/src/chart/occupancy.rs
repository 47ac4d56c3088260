//! Which parts of a frame are taken, so that legends, insets and labels find
//! a free place.

use crate::draw::{Point, Rect};

/// Edge of a cell in points, on posters a share of the frame.
const CELL: f64 = 2.0;
const MOST_CELLS: f64 = 600.0;
/// What lies this near, in points, counts as covered: half a line's width and more.
const STROKE: f64 = 1.2;
/// Places tried along either side of a frame.
const FINE: u32 = 32;

/// A coarse grid over a frame that counts what lies where.
#[derive(Debug, Clone)]
pub(crate) struct Occupancy {
    frame: Rect,
    cell: f64,
    columns: usize,
    rows: usize,
    cells: Vec<u32>,
}

impl Occupancy {
    pub(crate) fn new(frame: Rect) -> Self {
        let cell = CELL.max(frame.width().max(frame.height()) / MOST_CELLS);
        let columns = (frame.width() / cell).ceil() as usize + 1;
        let rows = (frame.height() / cell).ceil() as usize + 1;
        Self {
            frame,
            cell,
            columns,
            rows,
            cells: vec![0; columns * rows],
        }
    }

    fn index(&self, p: Point) -> Option<usize> {
        if !self.frame.contains(p) {
            return None;
        }
        let column = ((p.x - self.frame.x0) / self.cell) as usize;
        let row = ((p.y - self.frame.y0) / self.cell) as usize;
        Some(row * self.columns + column)
    }

    /// Marks one place as taken, `weight` saying how bad it is to cover it.
    pub(crate) fn mark(&mut self, p: Point, weight: u32) {
        if let Some(cell) = self.index(p).and_then(|i| self.cells.get_mut(i)) {
            *cell = (*cell).max(weight);
        }
    }

    /// Marks everything along a polyline.
    pub(crate) fn mark_line(&mut self, points: &[Point], weight: u32) {
        for pair in points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            // Half a cell a step: no more than a corner of a cell is missed.
            let steps = (2.0 * (b.x - a.x).hypot(b.y - a.y) / self.cell)
                .ceil()
                .clamp(1.0, 4096.0);
            for i in 0..=steps as u32 {
                let t = f64::from(i) / steps;
                self.mark(
                    Point::new(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)),
                    weight,
                );
            }
        }
    }

    /// Marks an area.
    pub(crate) fn mark_rect(&mut self, rect: &Rect, weight: u32) {
        for (column, row) in self.covered(rect) {
            if let Some(cell) = self.cells.get_mut(row * self.columns + column) {
                *cell = (*cell).max(weight);
            }
        }
    }

    /// What covering `rect` would hide; zero if it is free, strokes and corners of
    /// cells included.
    pub(crate) fn cost(&self, rect: &Rect) -> u64 {
        let cells = self.covered(&rect.grown(STROKE));
        cells
            .filter_map(|(c, r)| self.cells.get(r * self.columns + c))
            .map(|w| u64::from(*w))
            .sum()
    }

    fn covered(&self, rect: &Rect) -> impl Iterator<Item = (usize, usize)> + use<> {
        let cell = self.cell;
        let range = |from: f64, to: f64, start: f64, count: usize| {
            let first = ((from - start) / cell).floor().max(0.0) as usize;
            let last = ((to - start) / cell).floor().max(-1.0) + 1.0;
            first..(last as usize).min(count)
        };
        let columns = range(rect.x0, rect.x1, self.frame.x0, self.columns);
        let rows = range(rect.y0, rect.y1, self.frame.y0, self.rows);
        rows.flat_map(move |r| columns.clone().map(move |c| (c, r)))
    }

    /// Of several places the cheapest, the first among equals.
    pub(crate) fn freest(&self, places: &[Rect]) -> Option<(Rect, u64)> {
        let costs = places.iter().map(|r| (*r, self.cost(r)));
        costs.min_by_key(|(_, cost)| *cost)
    }
}

/// Places for a box of the given size in `frame`: the corners first, then along
/// the edges, then inside.
pub(crate) fn places(frame: &Rect, width: f64, height: f64) -> Vec<Rect> {
    // The right and upper end first: there legends are looked for.
    let steps: Vec<f64> = (0..=FINE)
        .rev()
        .map(|i| f64::from(i) / f64::from(FINE))
        .collect();
    let mut shares = vec![(1.0, 0.0), (0.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    shares.extend(steps.iter().flat_map(|s| [(*s, 0.0), (*s, 1.0)]));
    shares.extend(steps.iter().flat_map(|s| [(1.0, 1.0 - s), (0.0, 1.0 - s)]));
    for across in &steps {
        shares.extend(steps.iter().map(|d| (*across, 1.0 - d)));
    }
    let at = |(across, down): (f64, f64)| {
        let x = frame.x0 + across * (frame.width() - width).max(0.0);
        let y = frame.y0 + down * (frame.height() - height).max(0.0);
        Rect::sized(x, y, width, height)
    };
    shares.into_iter().map(at).collect()
}

#[cfg(test)]
#[path = "tests/occupancy.rs"]
mod tests;

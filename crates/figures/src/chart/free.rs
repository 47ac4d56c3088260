//! Free paper inside a frame, where insets, notes and labels of reference lines go.

use super::{Chart, ChartStyle, Plot, ReferenceLine, SeriesKind, strokes};
use crate::draw::{Point, Rect};
use crate::text::TextLine;

/// Edge of a cell in points, on posters a share of the frame.
const CELL: f64 = 2.0;
const MOST_CELLS: f64 = 600.0;
/// What lies this near, in points, counts as covered: half a line's width and more.
const STROKE: f64 = 1.2;
/// Places tried along either side of a frame.
const FINE: u32 = 32;

/// A coarse grid over a frame that counts what lies where.
pub(super) struct Occupancy {
    frame: Rect,
    cell: f64,
    columns: usize,
    rows: usize,
    cells: Vec<u32>,
}

impl Occupancy {
    fn new(frame: Rect) -> Self {
        let cell = CELL.max(frame.width().max(frame.height()) / MOST_CELLS);
        let columns = (frame.width() / cell).ceil() as usize + 1;
        let rows = (frame.height() / cell).ceil() as usize + 1;
        let cells = vec![0; columns * rows];
        Self { frame, cell, columns, rows, cells }
    }

    /// The data and reference lines of a chart.
    pub(super) fn of(chart: &Chart, style: &ChartStyle, plot: &Plot) -> Self {
        let mut taken = Self::new(plot.frame);
        for series in &chart.series {
            if series.has_line() {
                strokes::pieces(plot, series).iter().for_each(|piece| taken.mark_line(piece, 3));
            }
            if let SeriesKind::Band(upper) = &series.kind {
                let edges = series.xy().zip(upper);
                for edge in edges.map(|((x, low), high)| plot.at(x, low).zip(plot.at(x, *high))) {
                    edge.into_iter().for_each(|(a, b)| taken.mark_line(&[a, b], 1));
                }
            }
            if matches!(series.kind, SeriesKind::Points(_) | SeriesKind::LinePoints(_)) {
                let r = style.marker + 1.0;
                for p in strokes::centres(plot, series) {
                    taken.mark_rect(&Rect::sized(p.x - r, p.y - r, 2.0 * r, 2.0 * r), 4);
                }
                for (centre, ends, _) in strokes::error_bars(plot, series) {
                    let ends = ends.into_iter().flatten();
                    ends.for_each(|end| taken.mark_line(&[centre, end], 3));
                }
            }
        }
        for (a, b) in chart.references.iter().filter_map(|line| line.ends(plot)) {
            taken.mark_line(&[a, b], 1);
        }
        taken
    }

    /// Marks everything along a polyline, `weight` saying how bad it is to cover it.
    fn mark_line(&mut self, points: &[Point], weight: u32) {
        for pair in points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            // Half a cell a step: no more than a corner of a cell is missed.
            let steps = (2.0 * (b.x - a.x).hypot(b.y - a.y) / self.cell).ceil();
            let steps = steps.clamp(1.0, 4096.0);
            for i in 0..=steps as u32 {
                let t = f64::from(i) / steps;
                let at = Point::new(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y));
                if self.frame.contains(at) {
                    self.mark_rect(&Rect::sized(at.x, at.y, 0.0, 0.0), weight);
                }
            }
        }
    }

    pub(super) fn mark_rect(&mut self, rect: &Rect, weight: u32) {
        for cell in self.covered(rect) {
            self.cells[cell] = self.cells[cell].max(weight);
        }
    }

    /// Weight of all that covering `rect` would hide, strokes and corners of cells included.
    fn cost(&self, rect: &Rect) -> u64 {
        let cells = self.covered(&rect.grown(STROKE));
        cells.map(|cell| u64::from(self.cells[cell])).sum()
    }

    fn covered(&self, rect: &Rect) -> impl Iterator<Item = usize> + use<> {
        let (cell, pitch) = (self.cell, self.columns);
        let range = |from: f64, to: f64, start: f64, count: usize| {
            let first = ((from - start) / cell).floor().max(0.0) as usize;
            let last = ((to - start) / cell).floor().max(-1.0) + 1.0;
            first..(last as usize).min(count)
        };
        let columns = range(rect.x0, rect.x1, self.frame.x0, self.columns);
        let rows = range(rect.y0, rect.y1, self.frame.y0, self.rows);
        rows.flat_map(move |row| columns.clone().map(move |column| row * pitch + column))
    }

    /// Of several places the cheapest, the first among equals; it is then taken.
    pub(super) fn take(&mut self, places: &[Rect]) -> Option<Rect> {
        let place = *places.iter().min_by_key(|place| self.cost(place))?;
        self.mark_rect(&place, 9);
        Some(place)
    }
}

/// Places for a box of the given size in `frame`: the corners first, then all over.
pub(super) fn places(frame: &Rect, width: f64, height: f64) -> Vec<Rect> {
    let steps = || (0..=FINE).map(|i| f64::from(i) / f64::from(FINE));
    let corners = [(1.0, 0.0), (0.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    // From the right and upper end.
    let inner = steps().flat_map(|left| steps().map(move |down| (1.0 - left, down)));
    let at = |(across, down): (f64, f64)| {
        let x = frame.x0 + across * (frame.width() - width).max(0.0);
        let y = frame.y0 + down * (frame.height() - height).max(0.0);
        Rect::sized(x, y, width, height)
    };
    corners.into_iter().chain(inner).map(at).collect()
}

impl ReferenceLine {
    /// Ends of the line on the page.
    pub(super) fn ends(&self, plot: &Plot) -> Option<(Point, Point)> {
        let (frame, value) = (plot.frame, self.value);
        if self.vertical {
            let x = plot.x_at(value).filter(|_| plot.x.holds(value))?;
            Some((Point::new(x, frame.y0), Point::new(x, frame.y1)))
        } else {
            let y = plot.y_at(value).filter(|_| plot.y.holds(value))?;
            Some((Point::new(frame.x0, y), Point::new(frame.x1, y)))
        }
    }

    /// Places for the label on both sides of the line, at its ends and along it; at a vertical
    /// line the text is turned, or level where that is freer.
    pub(super) fn label_places(&self, plot: &Plot, line: &TextLine, start: Point) -> Vec<Rect> {
        let (frame, gap) = (plot.frame, 6.0);
        let (long, thick) = (line.width(), line.size());
        let along = |share: f64, length: f64| gap + share * (length - 2.0 * gap).max(0.0);
        let (mut turned, mut level) = (Vec::new(), Vec::new());
        for share in [1.0, 0.0, 0.5, 0.75, 0.25, 0.875, 0.125, 0.625, 0.375] {
            for side in [-1.0, 1.0] {
                let offset = side * 0.8 * thick - 0.5 * thick;
                let y = |own: f64| frame.y0 + along(1.0 - share, frame.height() - own);
                if self.vertical {
                    turned.push(Rect::sized(start.x + offset, y(long), thick, long));
                    let left = start.x + if side < 0.0 { -long - 3.0 } else { 3.0 };
                    level.push(Rect::sized(left, y(thick), long, thick));
                } else {
                    let x = frame.x0 + along(share, frame.width() - long);
                    level.push(Rect::sized(x, start.y + offset, long, thick));
                }
            }
        }
        turned.append(&mut level);
        turned.retain(|r| frame.holds(r));
        turned
    }
}

#[cfg(test)]
#[path = "tests/free.rs"]
mod tests;

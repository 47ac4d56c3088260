//! Path data for the `d` attribute.

use super::{Point, Rect, fmt};

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

//! From data to the page.

use crate::axis::Scale;
use crate::draw::{Point, Rect};

/// Two scales laid over a frame on the page.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plot {
    pub(crate) frame: Rect,
    pub(crate) x: Scale,
    pub(crate) y: Scale,
}

impl Plot {
    /// Where a data point lies; nothing if the axes cannot show it.
    pub(crate) fn at(&self, x: f64, y: f64) -> Option<Point> {
        Some(Point::new(self.x_at(x)?, self.y_at(y)?))
    }

    pub(crate) fn x_at(&self, x: f64) -> Option<f64> {
        Some(self.frame.x0 + self.x.share(x)? * self.frame.width())
    }

    pub(crate) fn y_at(&self, y: f64) -> Option<f64> {
        Some(self.frame.y1 - self.y.share(y)? * self.frame.height())
    }
}

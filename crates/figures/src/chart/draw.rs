//! Drawing a prepared chart into its frame.

use super::{FRAME, LABEL, Plot, Prepared, SMALL, TICK, reference, strokes};
use crate::axis::{Scale, Ticks};
use crate::draw::{Canvas, Colour, Paint, PathData, Point, Rect};
use crate::text::{Anchor, TextLine};

impl Prepared<'_> {
    /// Draws everything: the data inside `frame`, the labels around it.
    pub(crate) fn draw(&self, canvas: &mut Canvas, frame: &Rect) {
        let chart = self.chart;
        let plot = Plot { frame: *frame, x: self.x, y: self.y };
        if let Some(map) = &chart.heat {
            map.draw(canvas, &plot);
            map.draw_bar(canvas, frame);
        }
        for (a, b) in chart.references.iter().filter_map(|line| line.ends(&plot)) {
            canvas.segment(a, b, &Paint::dashed(Colour::GREY, 0.6, &[2.2, 1.8]));
        }
        strokes::draw(canvas, chart, &plot);
        self.draw_frame(canvas, frame);
        if !chart.x.unlabelled {
            self.draw_x_labels(canvas, frame);
        }
        if !chart.y.unlabelled {
            self.draw_y_labels(canvas, frame);
        }
        let bottom = frame.y0 - self.factor_room() - 0.3 * SMALL;
        self.legend.draw(canvas, chart, frame.centre().x, bottom);
        reference::draw_labels(canvas, chart, &plot);
    }

    /// The frame with inward ticks on all four sides.
    fn draw_frame(&self, canvas: &mut Canvas, frame: &Rect) {
        let mut path = PathData::new();
        path.rect(frame);
        for (share, length) in self.tick_shares(&self.x, &self.x_ticks) {
            let x = frame.x0 + share * frame.width();
            path.segment(Point::new(x, frame.y1), Point::new(x, frame.y1 - length));
            path.segment(Point::new(x, frame.y0), Point::new(x, frame.y0 + length));
        }
        for (share, length) in self.tick_shares(&self.y, &self.y_ticks) {
            let y = frame.y1 - share * frame.height();
            path.segment(Point::new(frame.x0, y), Point::new(frame.x0 + length, y));
            path.segment(Point::new(frame.x1, y), Point::new(frame.x1 - length, y));
        }
        if self.chart.heat.is_some() {
            // A light rim keeps ticks visible over dark colours.
            let rim = Paint::line(Colour::WHITE, 2.2 * FRAME);
            canvas.path(&path, &rim.opacity(0.7));
        }
        canvas.path(&path, &Paint::line(Colour::BLACK, FRAME));
    }

    /// Places of ticks along the axis, as shares, with their lengths.
    fn tick_shares(&self, scale: &Scale, ticks: &Ticks) -> Vec<(f64, f64)> {
        let (long, short) = (TICK, 0.55 * TICK);
        let major = ticks.major.iter().map(|tick| (tick.value, long));
        let all = major.chain(ticks.minor.iter().map(|value| (*value, short)));
        let placed = all.filter_map(|(value, length)| Some((scale.share(value)?, length)));
        placed.filter(|(share, _)| (0.0..=1.0).contains(share)).collect()
    }

    fn draw_x_labels(&self, canvas: &mut Canvas, frame: &Rect) {
        let (small, ink) = (SMALL, Colour::BLACK);
        for tick in &self.x_ticks.major {
            let x = frame.x0 + self.x.share(tick.value).unwrap_or(0.0) * frame.width();
            let at = Point::new(x, frame.y1 + 3.0 + 0.85 * small);
            TextLine::new(&tick.label, small).draw(canvas, at, Anchor::CENTRE, ink);
        }
        let mut room = frame.width();
        let label = TextLine::new(&self.chart.x.label, LABEL);
        let y = frame.y1 + 3.0 + 1.35 * small + label.ascent();
        if let Some(factor) = self.x_ticks.factor(small) {
            factor.draw(canvas, Point::new(frame.x1, y), Anchor::RIGHT, ink);
            room -= 2.0 * factor.width() + small;
        }
        let at = Point::new(frame.centre().x, y);
        label.shrunk_to(room).draw(canvas, at, Anchor::CENTRE, ink);
    }

    fn draw_y_labels(&self, canvas: &mut Canvas, frame: &Rect) {
        let (small, ink) = (SMALL, Colour::BLACK);
        for tick in &self.y_ticks.major {
            let y = frame.y1 - self.y.share(tick.value).unwrap_or(0.0) * frame.height();
            let at = Point::new(frame.x0 - 2.5, y);
            TextLine::new(&tick.label, small).draw(canvas, at, Anchor::RIGHT_MIDDLE, ink);
        }
        if let Some(factor) = self.y_ticks.factor(small) {
            let at = Point::new(frame.x0, frame.y0 - 0.6 * small);
            factor.draw(canvas, at, Anchor::LEFT, ink);
        }
        let label = TextLine::new(&self.chart.y.label, LABEL);
        let label = label.shrunk_to(1.08 * frame.height());
        let x = frame.x0 - 4.5 - self.y_ticks.widest(small) - label.descent();
        label.draw_turned(canvas, Point::new(x, frame.centre().y), Anchor::CENTRE, ink, 90.0);
    }
}

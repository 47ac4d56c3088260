//! Drawing a prepared chart into its frame: axes, series, and reference lines whose labels stand
//! where they hide least.

use super::{Chart, FRAME, LABEL, MARKER, Plot, Prepared, ReferenceLine, SMALL, TICK, strokes};
use crate::axis::{Scale, Ticks};
use crate::draw::{Canvas, Colour, Paint, PathData, Point, Rect, clip_segment};
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
        draw_labels(canvas, chart, &plot);
    }

    /// The frame with inward ticks on all four sides.
    fn draw_frame(&self, canvas: &mut Canvas, frame: &Rect) {
        let mut path = PathData::default();
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

fn draw_labels(canvas: &mut Canvas, chart: &Chart, plot: &Plot) {
    let mut drawn: Vec<Vec<Point>> = Vec::new();
    for series in chart.series.iter().filter(|_| !chart.references.is_empty()) {
        if series.has_line() {
            drawn.extend(strokes::pieces(plot, series));
        }
        let edge = MARKER + 1.0;
        let across = |p: Point| vec![Point::new(p.x - edge, p.y), Point::new(p.x + edge, p.y)];
        drawn.extend(strokes::centres(plot, series).into_iter().map(across));
    }
    drawn.extend(
        chart.references.iter().filter_map(|line| line.ends(plot)).map(|(a, b)| vec![a, b]),
    );
    for line in chart.references.iter().filter(|line| !line.label.is_empty()) {
        let Some((a, b)) = line.ends(plot) else {
            continue;
        };
        let text = TextLine::new(&line.label, SMALL);
        let text = text.shrunk_to(0.9 * (b.y - a.y).max(b.x - a.x));
        let places = line.label_places(plot, &text, a);
        let Some(place) = places.iter().min_by_key(|place| hidden(place, &drawn)) else {
            continue;
        };
        let angle = if place.height() > place.width() { 90.0 } else { 0.0 };
        text.draw_turned(canvas, place.centre(), Anchor::MIDDLE, Colour::grey(70), angle);
        // A text is as bad to cover as many strokes.
        for y in 0..40 {
            let y = place.y0 + place.height() * f64::from(y) / 39.0;
            drawn.push(vec![Point::new(place.x0, y), Point::new(place.x1, y)]);
        }
    }
}

/// Strokes that a text would lie on.
fn hidden(place: &Rect, drawn: &[Vec<Point>]) -> usize {
    let place = place.grown(0.8);
    let pairs = drawn.iter().flat_map(|piece| piece.windows(2));
    pairs.filter(|pair| clip_segment(&place, pair[0], pair[1]).is_some()).count()
}

impl ReferenceLine {
    fn ends(&self, plot: &Plot) -> Option<(Point, Point)> {
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
    fn label_places(&self, plot: &Plot, line: &TextLine, start: Point) -> Vec<Rect> {
        let (frame, gap) = (plot.frame, 6.0);
        let (long, thick) = (line.width(), line.size);
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

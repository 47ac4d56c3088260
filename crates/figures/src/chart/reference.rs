//! Reference lines and their labels, each where it hides least.

use super::{Chart, MARKER, Plot, ReferenceLine, SMALL, strokes};
use crate::draw::{Canvas, Colour, Point, Rect, clip_segment};
use crate::text::{Anchor, TextLine};

/// Draws the labels of all reference lines.
pub(super) fn draw_labels(canvas: &mut Canvas, chart: &Chart, plot: &Plot) {
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

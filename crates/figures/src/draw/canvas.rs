//! What is drawn on a page, in its order, before it is written as SVG, PDF or PNG.

use super::{Colour, Point, Rect};
use crate::text::{Anchor, TextLine};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Segment {
    Move(Point),
    Line(Point),
    Quad(Point, Point),
    Cubic(Point, Point, Point),
    Close,
}

impl Segment {
    pub(crate) fn map(self, at: &impl Fn(Point) -> Point) -> Self {
        match self {
            Self::Move(p) => Self::Move(at(p)),
            Self::Line(p) => Self::Line(at(p)),
            Self::Quad(c, p) => Self::Quad(at(c), at(p)),
            Self::Cubic(a, b, p) => Self::Cubic(at(a), at(b), at(p)),
            Self::Close => Self::Close,
        }
    }
}

#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct PathData(pub(crate) Vec<Segment>);

impl PathData {
    pub(crate) fn segment(&mut self, a: Point, b: Point) -> &mut Self {
        self.polyline(&[a, b])
    }

    pub(crate) fn rect(&mut self, r: &Rect) -> &mut Self {
        let corners = [(r.x0, r.y0), (r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)];
        self.polygon(&corners.map(|(x, y)| Point::new(x, y)))
    }

    pub(crate) fn polygon(&mut self, corners: &[Point]) -> &mut Self {
        self.polyline(corners).0.push(Segment::Close);
        self
    }

    pub(crate) fn polyline(&mut self, points: &[Point]) -> &mut Self {
        let steps = points.iter().enumerate();
        self.0
            .extend(steps.map(|(i, p)| if i == 0 { Segment::Move(*p) } else { Segment::Line(*p) }));
        self
    }

    pub(crate) fn circle(&mut self, centre: Point, radius: f64) -> &mut Self {
        self.quarters(centre, radius, 4)
    }

    pub(crate) fn left_half_circle(&mut self, centre: Point, radius: f64) -> &mut Self {
        self.quarters(centre, radius, 2)
    }

    /// Quarters of a circle from its lowest point over its left one.
    fn quarters(&mut self, centre: Point, radius: f64, count: usize) -> &mut Self {
        // Of a circle such curves miss 0.03 % of the radius at most.
        const REACH: f64 = 0.552_284_75;
        let at = |x: f64, y: f64| Point::new(centre.x + radius * x, centre.y + radius * y);
        let ends = [(0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (1.0, 0.0), (0.0, 1.0)];
        self.0.push(Segment::Move(at(0.0, 1.0)));
        for pair in ends.windows(2).take(count) {
            let ((a, b), (x, y)) = (pair[0], pair[1]);
            let controls = [at(a + REACH * x, b + REACH * y), at(x + REACH * a, y + REACH * b)];
            self.0.push(Segment::Cubic(controls[0], controls[1], at(x, y)));
        }
        self.0.push(Segment::Close);
        self
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) colour: Colour,
    pub(crate) width: f64,
    pub(crate) dash: &'static [f64],
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Paint {
    pub(crate) fill: Option<Colour>,
    pub(crate) stroke: Option<Stroke>,
    pub(crate) opacity: f64,
}

impl Paint {
    pub(crate) fn fill(colour: Colour) -> Self {
        Self { fill: Some(colour), stroke: None, opacity: 1.0 }
    }

    pub(crate) fn line(colour: Colour, width: f64) -> Self {
        Self::dashed(colour, width, &[])
    }

    pub(crate) fn dashed(colour: Colour, width: f64, dash: &'static [f64]) -> Self {
        Self { fill: None, stroke: Some(Stroke { colour, width, dash }), opacity: 1.0 }
    }

    pub(crate) fn outlined(self, colour: Colour, width: f64) -> Self {
        Self { stroke: Some(Stroke { colour, width, dash: &[] }), ..self }
    }

    pub(crate) fn opacity(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}

/// Pixels as places in a palette of up to 256 colours, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Raster {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) palette: Vec<Colour>,
    pub(crate) pixels: Vec<u8>,
}

/// A line of text at its place, turned counter-clockwise.
#[derive(Debug, Clone)]
pub(crate) struct PlacedText {
    pub(crate) line: TextLine,
    pub(crate) at: Point,
    pub(crate) anchor: Anchor,
    pub(crate) colour: Colour,
    pub(crate) angle_deg: f64,
}

#[derive(Debug, Clone)]
pub(crate) enum Item {
    Path(PathData, Paint),
    Text(PlacedText),
    /// Stretched over a rectangle, its pixels kept sharp.
    Image(Rect, Raster),
    /// What follows until the end is a legend.
    Legend(Rect),
    LegendEnd,
}

impl Item {
    /// The same at another place and scale.
    fn placed(self, at: &impl Fn(Point) -> Point, scale: f64) -> Self {
        let rect = |r: Rect| {
            let (a, b) = (at(Point::new(r.x0, r.y0)), at(Point::new(r.x1, r.y1)));
            Rect { x0: a.x, y0: a.y, x1: b.x, y1: b.y }
        };
        match self {
            Self::Path(data, paint) => {
                let stroke = paint.stroke.map(|s| Stroke { width: scale * s.width, ..s });
                let moved = data.0.into_iter().map(|segment| segment.map(at)).collect();
                Self::Path(PathData(moved), Paint { stroke, ..paint })
            }
            Self::Text(text) => {
                Self::Text(PlacedText { at: at(text.at), line: text.line.scaled(scale), ..text })
            }
            Self::Image(place, raster) => Self::Image(rect(place), raster),
            Self::Legend(place) => Self::Legend(rect(place)),
            Self::LegendEnd => Self::LegendEnd,
        }
    }
}

/// Items in the order in which they cover each other.
#[derive(Debug, Default)]
pub(crate) struct Canvas {
    pub(crate) items: Vec<Item>,
}

impl Canvas {
    pub(crate) fn path(&mut self, data: &PathData, paint: &Paint) {
        if !data.0.is_empty() {
            self.items.push(Item::Path(data.clone(), *paint));
        }
    }

    pub(crate) fn segment(&mut self, a: Point, b: Point, paint: &Paint) {
        self.path(PathData::default().segment(a, b), paint);
    }

    pub(crate) fn rect(&mut self, rect: &Rect, paint: &Paint) {
        self.path(PathData::default().rect(rect), paint);
    }

    pub(crate) fn circle(&mut self, centre: Point, radius: f64, paint: &Paint) {
        self.path(PathData::default().circle(centre, radius), paint);
    }

    /// Shrinks to a frame what is so wide, and so high above and below its origin.
    pub(crate) fn shrunk_to(
        &mut self,
        frame: &Rect,
        (width, above, below): (f64, f64, f64),
        draw: impl FnOnce(&mut Self),
    ) {
        let fit = (frame.width() / width).min(frame.height() / (above + below));
        // The page was made for it up to rounding.
        let scale = if fit > 0.999 { 1.0 } else { fit };
        let mut inner = Self::default();
        draw(&mut inner);
        let (left, top) = (frame.x0, frame.y0 + scale * above);
        let at = |p: Point| Point::new(left + scale * p.x, top + scale * p.y);
        self.items.extend(inner.items.into_iter().map(|item| item.placed(&at, scale)));
    }

    /// Lines of text below each other, the first at a place.
    pub(crate) fn lines(&mut self, lines: &[TextLine], at: Point, leading: f64, anchor: Anchor) {
        for (i, line) in lines.iter().enumerate() {
            let at = Point::new(at.x, at.y + leading * i as f64);
            line.draw(self, at, anchor, Colour::BLACK);
        }
    }
}

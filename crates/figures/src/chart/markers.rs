//! Shapes of data points.

use super::series::Marker;
use crate::draw::{Colour, Paint, PathData, Point, Svg};

/// Draws the same marker at many places.
pub(crate) fn draw(svg: &mut Svg, marker: Marker, at: &[Point], size: f64, colour: Colour) {
    let mut path = PathData::new();
    for centre in at {
        outline(&mut path, marker, *centre, size);
    }
    let open = matches!(
        marker,
        Marker::OpenCircle | Marker::OpenSquare | Marker::OpenTriangle
    );
    let paint = if marker == Marker::Cross {
        Paint::line(colour, 0.8)
    } else if open {
        Paint::fill(Colour::WHITE).outlined(colour, 0.8)
    } else {
        Paint::fill(colour)
    };
    svg.path(&path, &paint);
}

fn outline(path: &mut PathData, marker: Marker, c: Point, r: f64) {
    let at = |dx: f64, dy: f64| Point::new(c.x + dx * r, c.y + dy * r);
    match marker {
        Marker::Circle | Marker::OpenCircle => path.circle(c, r),
        Marker::Square | Marker::OpenSquare => {
            path.polygon(&[at(-0.9, -0.9), at(0.9, -0.9), at(0.9, 0.9), at(-0.9, 0.9)])
        }
        // Centred on the centroid, where the datum is.
        Marker::Triangle | Marker::OpenTriangle => {
            path.polygon(&[at(0.0, -1.35), at(1.17, 0.675), at(-1.17, 0.675)])
        }
        Marker::Diamond => {
            path.polygon(&[at(0.0, -1.3), at(1.1, 0.0), at(0.0, 1.3), at(-1.1, 0.0)])
        }
        Marker::Cross => path
            .segment(at(-0.9, -0.9), at(0.9, 0.9))
            .segment(at(-0.9, 0.9), at(0.9, -0.9)),
    };
}

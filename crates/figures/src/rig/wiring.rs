//! Wires from the sensors to the recorder above the row.

use super::layout::Layout;
use super::row::PIEZO;
use super::{FONT, FarEnd, OVER_RECORDER, RigDrawing, WIDTH};
use crate::draw::{Colour, Paint, PathData, Point, Rect, Svg};
use crate::text::{Anchor, TextLine, wrap};

/// Upper edge of the box, below the labels.
const TOP: f64 = OVER_RECORDER + 5.0;
const LEADING: f64 = 8.4;
const PADDING: f64 = 4.0;
/// Widest line: the box stays between the leaders beside it.
const WIDEST: f64 = 84.0;

/// Draws the box and a wire to every sensor.
pub(super) fn draw(svg: &mut Svg, rig: &RigDrawing, layout: &Layout) {
    let ends = sensors(rig, layout);
    let (Some(first), Some(last)) = (ends.first(), ends.last()) else {
        return;
    };
    if rig.recorder.is_empty() {
        return;
    }
    let lines = wrap(&rig.recorder, FONT, WIDEST, 3);
    let widest = lines.iter().map(TextLine::width).fold(0.0, f64::max);
    let width = widest + 2.0 * PADDING;
    // Leaders of what stands behind the row pass on its right.
    let left = (0.5 * (first + last - width)).min(last + PADDING - width);
    let left = left.clamp(0.0, (WIDTH - width).max(0.0));
    let height = LEADING * lines.len() as f64 + PADDING;
    let case = Rect::sized(left, TOP, width, height);
    let mut wires = PathData::new();
    for x in &ends {
        wires.polyline(&wire(*x, -0.97 * layout.radius(), &case));
    }
    svg.path(&wires, &Paint::line(PIEZO, 0.8));
    svg.rect(&case, &Paint::fill(Colour::WHITE).outlined(PIEZO, 0.8));
    for (i, line) in lines.iter().enumerate() {
        let middle = TOP + 0.5 * PADDING + LEADING * (i as f64 + 0.5);
        let at = Point::new(case.centre().x, middle);
        line.draw(svg, at, Anchor::MIDDLE, Colour::BLACK);
    }
}

/// Upper ends of the sensors, from left to right.
fn sensors(rig: &RigDrawing, layout: &Layout) -> Vec<f64> {
    let inside = rig.sensor().and_then(|n| layout.bead(n));
    let wall = rig.wall_sensor && rig.far_end != FarEnd::Open;
    let face = wall.then_some(layout.face - 1.8);
    inside.into_iter().chain(face).collect()
}

/// Straight up into the box, or up and across into its side.
fn wire(x: f64, from: f64, case: &Rect) -> [Point; 3] {
    let below = x > case.x0 + 1.0 && x < case.x1 - 1.0;
    let middle = case.centre().y;
    let (height, across) = match below {
        true => (case.y1, x),
        false => (middle, x.clamp(case.x0, case.x1)),
    };
    [
        Point::new(x, from),
        Point::new(x, height),
        Point::new(across, height),
    ]
}

//! The track below the row and what stands behind it.

use super::labels::Labels;
use super::layout::{APART, BAR, Layout, STOP};
use super::row::{PIEZO, STEEL};
use super::{FarEnd, INK, RigDrawing};
use crate::draw::{Colour, Paint, PathData, Point, Rect, Svg};

pub(super) const BODY: Colour = Colour(214, 217, 222);
pub(super) const DARK: Colour = Colour(150, 156, 164);

/// The air track below everything.
pub(super) fn draw_track(svg: &mut Svg, rig: &RigDrawing, layout: &Layout) {
    let top = layout.radius() + 0.3;
    let open = rig.far_end == FarEnd::Open;
    let end = layout.face + if open { 8.0 } else { 0.0 };
    let length = end - layout.left;
    let rail = Rect::sized(layout.left, top, length, 4.5);
    svg.rect(&rail, &Paint::fill(BODY).outlined(INK, 0.5));
    let mut holes = PathData::new();
    let count = (length / 7.0) as u32;
    for i in 0..count {
        let x = layout.left + 4.0 + 7.0 * f64::from(i);
        holes.segment(Point::new(x, top + 1.2), Point::new(x, top + 3.3));
    }
    svg.path(&holes, &Paint::line(DARK, 0.5));
}

/// Half-bead, sensor, stop, end structure and the bar apart from them.
pub(super) fn draw_far_end(svg: &mut Svg, rig: &RigDrawing, layout: &Layout, labels: &mut Labels) {
    if rig.far_end != FarEnd::Open {
        draw_end(svg, rig, layout, labels);
    }
    if !rig.bar.is_empty() {
        let x = layout.back + APART;
        let bar = Rect::sized(x, -16.0, BAR, 16.0 + layout.radius() + 4.8);
        svg.rect(&bar, &Paint::fill(DARK).outlined(INK, 0.5));
        labels.above(Point::new(x + 0.5 * BAR, -13.5), &rig.bar);
    }
}

fn draw_end(svg: &mut Svg, rig: &RigDrawing, layout: &Layout, labels: &mut Labels) {
    let r = layout.radius();
    if rig.far_end == FarEnd::HalfBead {
        draw_half_bead(svg, layout.end, r);
        let at = Point::new(layout.end + 0.45 * r, 0.5 * r);
        labels.below(at, "half-bead");
    }
    if rig.wall_sensor {
        let disc = Rect::sized(layout.face - 3.3, -0.97 * r, 2.8, 1.94 * r);
        svg.rect(&disc, &Paint::fill(PIEZO));
        let at = Point::new(layout.face - 1.8, 0.8 * r);
        labels.below(at, sensor_name(rig));
    }
    draw_stop(svg, rig, layout, labels);
}

/// What a sensor at the wall is called.
fn sensor_name(rig: &RigDrawing) -> &str {
    match rig.sensor_label.as_str() {
        "" => "wall sensor",
        label => label,
    }
}

fn draw_half_bead(svg: &mut Svg, x: f64, r: f64) {
    let shade = svg.ball_gradient(STEEL);
    let mut half = PathData::new();
    half.move_to(Point::new(x + r, r - 0.25));
    half.arc_to(r - 0.25, false, true, Point::new(x + r, -r + 0.25))
        .close();
    svg.path(&half, &Paint::gradient(&shade).outlined(INK, 0.5));
}

/// Stop and structure; a rigid wall where the structure is not named.
fn draw_stop(svg: &mut Svg, rig: &RigDrawing, layout: &Layout, labels: &mut Labels) {
    let (r, mut x) = (layout.radius(), layout.face);
    if !rig.stop.is_empty() {
        let stop = Rect::sized(x, -r, STOP, 2.0 * r + 4.8);
        svg.rect(&stop, &Paint::fill(DARK).outlined(INK, 0.5));
        labels.below(Point::new(x + 0.6 * STOP, 0.6 * r), &rig.stop);
        x += STOP;
    }
    let block = Rect::sized(x, -18.0, layout.back - x, 18.0 + r + 4.8);
    let at = Point::new(0.5 * (x + layout.back), -15.0);
    svg.rect(&block, &Paint::fill(BODY).outlined(INK, 0.5));
    if rig.end_structure.is_empty() {
        draw_hatching(svg, &block);
        labels.above(at, "rigid wall");
    } else {
        labels.above(at, &rig.end_structure);
    }
}

fn draw_hatching(svg: &mut Svg, block: &Rect) {
    let mut lines = PathData::new();
    let count = (block.height() / 4.0) as u32;
    for i in 1..count {
        let y = block.y0 + 4.0 * f64::from(i);
        let reach = block.width().min(block.y1 - y);
        lines.segment(
            Point::new(block.x0, y),
            Point::new(block.x0 + reach, y + reach),
        );
    }
    svg.path(&lines, &Paint::line(DARK, 0.5));
}

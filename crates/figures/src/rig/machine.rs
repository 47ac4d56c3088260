//! Everything around the row: track, launcher, far end, wiring.

use super::labels::Labels;
use super::layout::Layout;
use super::row::{PIEZO, STEEL, draw_bead};
use super::{AXIS, FONT, FarEnd, INK, RigDrawing, millimetres};
use crate::draw::{Colour, Paint, PathData, Point, Rect, Svg};
use crate::text::{Anchor, TextLine};

const BODY: Colour = Colour(214, 217, 222);
const DARK: Colour = Colour(150, 156, 164);
/// Upper edge of the wiring.
const WIRE: f64 = 44.0;

/// The air track below everything.
pub(super) fn draw_track(svg: &mut Svg, rig: &RigDrawing, layout: &Layout) {
    let top = AXIS + layout.radius() + 0.3;
    let open = rig.far_end == FarEnd::Open;
    let end = if open {
        layout.end + 8.0
    } else {
        far_face(rig, layout)
    };
    let length = end - layout.left;
    let rail = Rect::sized(layout.left, top, length, 5.0);
    svg.rect(&rail, &Paint::fill(BODY).outlined(INK, 0.5));
    let mut holes = PathData::new();
    let count = (length / 9.0) as u32;
    for i in 0..count {
        let x = layout.left + 5.0 + 9.0 * f64::from(i);
        holes.segment(Point::new(x, top + 1.2), Point::new(x, top + 3.8));
    }
    svg.path(&holes, &Paint::line(DARK, 0.5));
}

/// Left face of the stop.
fn far_face(rig: &RigDrawing, layout: &Layout) -> f64 {
    let half = if rig.far_end == FarEnd::HalfBead {
        layout.radius()
    } else {
        0.0
    };
    layout.end + half + if rig.wall_sensor { 4.0 } else { 0.0 }
}

/// Actuator, striker, photogate and springs, from left to right.
pub(super) fn draw_launcher(svg: &mut Svg, rig: &RigDrawing, layout: &Layout, labels: &mut Labels) {
    let mut x = layout.left + 2.0;
    if rig.actuator {
        draw_actuator(svg, x, labels);
        x += 62.0;
    }
    if let Some(radius_m) = rig.striker_radius_m {
        draw_striker(svg, rig, layout, x, radius_m, labels);
    }
    if rig.photogate {
        draw_photogate(svg, layout.start - 28.0, layout, labels);
    }
    if let Some(force_n) = rig.preload_n {
        draw_springs(svg, layout, force_n, labels);
    }
}

fn draw_actuator(svg: &mut Svg, x: f64, labels: &mut Labels) {
    let body = Rect::sized(x, AXIS - 14.0, 36.0, 28.0);
    svg.rect(&body, &Paint::fill(DARK).outlined(INK, 0.6));
    svg.rect(
        &Rect::sized(x + 8.0, AXIS - 9.0, 28.0, 18.0),
        &Paint::fill(Colour::WHITE).outlined(INK, 0.4),
    );
    svg.rect(
        &Rect::sized(x + 8.0, AXIS - 4.0, 20.0, 8.0),
        &Paint::fill(DARK),
    );
    let mut coil = PathData::new();
    for i in 0..6 {
        let at = x + 16.0 + 3.4 * f64::from(i);
        coil.segment(Point::new(at, AXIS - 7.5), Point::new(at, AXIS - 4.8));
        coil.segment(Point::new(at, AXIS + 4.8), Point::new(at, AXIS + 7.5));
    }
    svg.path(&coil, &Paint::line(Colour::OCHRE, 1.6));
    let rod = Rect::sized(x + 33.0, AXIS - 1.8, 21.0, 3.6);
    svg.rect(&rod, &Paint::fill(BODY).outlined(INK, 0.5));
    svg.rect(
        &Rect::sized(x + 54.0, AXIS - 5.0, 2.5, 10.0),
        &Paint::fill(INK),
    );
    labels.above(Point::new(x + 18.0, AXIS - 12.0), "voice-coil actuator");
}

fn draw_striker(
    svg: &mut Svg,
    rig: &RigDrawing,
    layout: &Layout,
    x: f64,
    radius_m: f64,
    labels: &mut Labels,
) {
    let ratio = radius_m / rig.bead_radius_m;
    let ratio = if ratio.is_finite() && ratio > 0.0 {
        ratio.clamp(0.6, 1.3)
    } else {
        1.0
    };
    let r = (layout.radius() * ratio).min(15.0);
    let floor = AXIS + layout.radius();
    let centre = Point::new(x + r, floor - r);
    draw_bead(svg, centre, r);
    draw_arrow(svg, Point::new(centre.x + r + 1.5, centre.y), 13.0);
    let mut text = String::from("striker");
    if radius_m > 0.0 && radius_m.is_finite() {
        text.push_str(&format!(", $R$ = {}", millimetres(radius_m)));
    }
    if !rig.striker_label.is_empty() {
        text.push_str(&format!(", {}", rig.striker_label));
    }
    labels.below(Point::new(centre.x, centre.y + 0.8 * r), &text);
}

fn draw_arrow(svg: &mut Svg, from: Point, length: f64) {
    let tip = Point::new(from.x + length, from.y);
    svg.segment(
        from,
        Point::new(tip.x - 3.0, tip.y),
        &Paint::line(Colour::VERMILION, 1.3),
    );
    let mut head = PathData::new();
    head.polygon(&[
        tip,
        Point::new(tip.x - 5.0, tip.y - 2.6),
        Point::new(tip.x - 5.0, tip.y + 2.6),
    ]);
    svg.path(&head, &Paint::fill(Colour::VERMILION));
}

fn draw_photogate(svg: &mut Svg, x: f64, layout: &Layout, labels: &mut Labels) {
    let reach = layout.radius() + 4.0;
    let beam = (
        Point::new(x, AXIS - reach),
        Point::new(x, AXIS + reach - 4.0),
    );
    svg.segment(
        beam.0,
        beam.1,
        &Paint::dashed(Colour::VERMILION, 0.8, &[2.0, 1.4]),
    );
    let head = Rect::sized(x - 4.0, AXIS - reach - 6.0, 8.0, 6.0);
    svg.rect(&head, &Paint::fill(INK));
    labels.above(Point::new(x, AXIS - reach - 4.0), "photogate");
}

/// Two springs from posts on the track press bead 1 towards the far end.
fn draw_springs(svg: &mut Svg, layout: &Layout, force_n: f64, labels: &mut Labels) {
    let (post, r) = (layout.start - 15.0, layout.radius());
    let (offset, end) = (0.72 * r, layout.start + 0.32 * r);
    for side in [-1.0, 1.0] {
        let y = AXIS + side * offset;
        svg.rect(
            &Rect::sized(post - 2.0, y - 2.2, 2.0, 4.4),
            &Paint::fill(INK),
        );
        draw_spring(svg, Point::new(post, y), end - post);
    }
    let text = format!("springs, $F$ = {} N", (force_n * 1e4).round() / 1e4);
    labels.above(Point::new(post + 8.0, AXIS - offset - 1.8), &text);
}

fn draw_spring(svg: &mut Svg, from: Point, length: f64) {
    const TURNS: u32 = 6;
    let pitch = length / f64::from(TURNS);
    let mut points = vec![from];
    for i in 0..TURNS {
        let x = from.x + pitch * f64::from(i);
        points.push(Point::new(x + 0.25 * pitch, from.y - 1.9));
        points.push(Point::new(x + 0.75 * pitch, from.y + 1.9));
    }
    points.push(Point::new(from.x + length, from.y));
    let mut path = PathData::new();
    path.polyline(&points);
    svg.path(&path, &Paint::line(Colour::BLUE, 0.8));
}

/// Half-bead, sensor disc, stop and end structure.
pub(super) fn draw_far_end(svg: &mut Svg, rig: &RigDrawing, layout: &Layout, labels: &mut Labels) {
    if rig.far_end == FarEnd::Open {
        return;
    }
    let (r, mut x) = (layout.radius(), layout.end);
    if rig.far_end == FarEnd::HalfBead {
        draw_half_bead(svg, x, r);
        labels.below(Point::new(x + 0.65 * r, AXIS + 0.5 * r), "half-bead");
        x += r;
    }
    if rig.wall_sensor {
        svg.rect(
            &Rect::sized(x + 0.5, AXIS - 0.97 * r, 3.0, 1.94 * r),
            &Paint::fill(PIEZO),
        );
        labels.below(Point::new(x + 2.0, AXIS + 0.85 * r), "piezo disc");
        x += 4.0;
    }
    draw_stop(svg, rig, x, r, labels);
}

fn draw_half_bead(svg: &mut Svg, x: f64, r: f64) {
    let shade = svg.ball_gradient(STEEL);
    let mut half = PathData::new();
    half.move_to(Point::new(x + r, AXIS + r - 0.25));
    half.arc_to(r - 0.25, false, true, Point::new(x + r, AXIS - r + 0.25))
        .close();
    svg.path(&half, &Paint::gradient(&shade).outlined(INK, 0.5));
}

fn draw_stop(svg: &mut Svg, rig: &RigDrawing, x: f64, r: f64, labels: &mut Labels) {
    let stop = Rect::sized(x, AXIS - r, 14.0, 2.0 * r);
    svg.rect(&stop, &Paint::fill(DARK).outlined(INK, 0.6));
    let block = Rect::sized(x + 14.0, AXIS - r - 12.0, 26.0, 2.0 * r + 18.0);
    svg.rect(&block, &Paint::fill(BODY).outlined(INK, 0.6));
    labels.below(Point::new(x + 9.0, AXIS + 0.7 * r), "steel stop");
    match rig.stop_mass_kg.filter(|m| m.is_finite()) {
        Some(mass_kg) => {
            let text = format!("end structure, {mass_kg} kg");
            labels.above(Point::new(x + 30.0, AXIS - r - 8.0), &text);
        }
        None => {
            draw_hatching(svg, &block);
            labels.above(Point::new(x + 30.0, AXIS - r - 8.0), "rigid wall");
        }
    }
}

fn draw_hatching(svg: &mut Svg, block: &Rect) {
    let mut lines = PathData::new();
    let count = (block.height() / 5.0) as u32;
    for i in 1..count {
        let y = block.y0 + 5.0 * f64::from(i);
        let reach = block.width().min(block.y1 - y);
        lines.segment(
            Point::new(block.x0, y),
            Point::new(block.x0 + reach, y + reach),
        );
    }
    svg.path(&lines, &Paint::line(DARK, 0.5));
}

/// Wires from both sensors to the recorder above the row.
pub(super) fn draw_wiring(svg: &mut Svg, rig: &RigDrawing, layout: &Layout) {
    if rig.recorder.is_empty() {
        return;
    }
    let sensor = rig.sensor().and_then(|n| layout.bead(n));
    let wall = rig.wall_sensor && rig.far_end != FarEnd::Open;
    let face = far_face(rig, layout) - 2.0;
    let ends: Vec<f64> = sensor.into_iter().chain(wall.then_some(face)).collect();
    let (Some(first), Some(last)) = (ends.first(), ends.last()) else {
        return;
    };
    let text = TextLine::new(&rig.recorder, FONT).fitted(150.0);
    let middle = 0.5 * (first + last);
    let top = AXIS - 0.97 * layout.radius();
    let mut wires = PathData::new();
    for x in &ends {
        wires.polyline(&[
            Point::new(*x, top),
            Point::new(*x, WIRE),
            Point::new(middle, WIRE),
        ]);
    }
    svg.path(&wires, &Paint::line(PIEZO, 0.7));
    let case = Rect::sized(
        middle - 0.5 * text.width() - 5.0,
        WIRE - 8.0,
        text.width() + 10.0,
        16.0,
    );
    svg.rect(&case, &Paint::fill(Colour::WHITE).outlined(PIEZO, 0.7));
    text.draw(svg, case.centre(), Anchor::MIDDLE, Colour::BLACK);
}

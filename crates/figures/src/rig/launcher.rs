//! What stands before the row: actuator, repositioner, striker, gate, springs.

use super::labels::Labels;
use super::layout::{ACTUATOR, Layout};
use super::machine::{BODY, DARK};
use super::row::draw_bead;
use super::{INK, RigDrawing};
use crate::draw::{Colour, Paint, PathData, Point, Rect, Svg};

/// Largest radius of the striker, with its arrow beside it.
const LARGEST: f64 = 6.8;
/// Height of the rail on which the repositioner runs.
const RAIL: f64 = -22.0;

/// Draws them from left to right.
pub(super) fn draw(svg: &mut Svg, rig: &RigDrawing, layout: &Layout, labels: &mut Labels) {
    let mut x = layout.left + 1.0;
    if !rig.actuator.is_empty() {
        draw_actuator(svg, x, layout.radius());
        labels.above(Point::new(x + 10.0, -10.0), &rig.actuator);
        x += ACTUATOR;
    }
    let ratio = rig.striker_ratio.filter(|ratio| ratio.is_finite());
    let radius = layout.radius() * ratio.unwrap_or(1.0).clamp(0.6, 1.4);
    let radius = radius.min(LARGEST);
    let centre = Point::new(x + radius, layout.radius() - radius);
    if rig.striker_ratio.is_some() {
        draw_bead(svg, centre, radius);
        draw_arrow(svg, Point::new(centre.x + radius + 1.2, centre.y), 9.0);
        let at = Point::new(centre.x, centre.y + 0.8 * radius);
        labels.below(at, &format!("striker{}", after_comma(&rig.striker_label)));
    }
    if !rig.repositioner.is_empty() {
        draw_repositioner(svg, centre, radius);
        labels.above(Point::new(centre.x, RAIL), &rig.repositioner);
    }
    if !rig.photogate.is_empty() {
        draw_photogate(svg, layout.gate, layout.radius());
        let at = Point::new(layout.gate, -layout.radius() - 6.0);
        labels.above(at, &rig.photogate);
    }
    if !rig.springs.is_empty() {
        draw_springs(svg, layout);
        let at = Point::new(layout.start - 4.0, -0.72 * layout.radius());
        labels.above(at, &rig.springs);
    }
}

/// A text that goes on after a comma, or nothing.
pub(super) fn after_comma(text: &str) -> String {
    match text {
        "" => String::new(),
        text => format!(", {text}"),
    }
}

/// A magnet with a coil around its core, and the rod that pushes the striker.
fn draw_actuator(svg: &mut Svg, x: f64, radius: f64) {
    let body = Rect::sized(x, -11.0, 22.0, 22.0);
    svg.rect(&body, &Paint::fill(DARK).outlined(INK, 0.5));
    let room = Rect::sized(x + 5.0, -7.0, 17.0, 14.0);
    svg.rect(&room, &Paint::fill(Colour::WHITE).outlined(INK, 0.4));
    let core = Rect::sized(x + 5.0, -2.8, 12.0, 5.6);
    svg.rect(&core, &Paint::fill(DARK));
    let mut coil = PathData::new();
    for i in 0..4 {
        let at = x + 9.5 + 3.0 * f64::from(i);
        coil.segment(Point::new(at, -5.8), Point::new(at, -3.4));
        coil.segment(Point::new(at, 3.4), Point::new(at, 5.8));
    }
    svg.path(&coil, &Paint::line(Colour::OCHRE, 1.4));
    let rod = Rect::sized(x + 19.0, -1.4, ACTUATOR - 22.5, 2.8);
    svg.rect(&rod, &Paint::fill(BODY).outlined(INK, 0.4));
    let plate = 0.7 * radius;
    let plate = Rect::sized(x + ACTUATOR - 3.5, -plate, 1.8, 2.0 * plate);
    svg.rect(&plate, &Paint::fill(INK));
}

/// A fork over the striker that runs along a rail.
fn draw_repositioner(svg: &mut Svg, centre: Point, radius: f64) {
    let reach = radius + 1.3;
    let shoulder = centre.y - radius - 2.2;
    let mut fork = PathData::new();
    fork.polyline(&[
        Point::new(centre.x - reach, centre.y - 0.35 * radius),
        Point::new(centre.x - reach, shoulder),
        Point::new(centre.x + reach, shoulder),
        Point::new(centre.x + reach, centre.y - 0.35 * radius),
    ]);
    fork.segment(Point::new(centre.x, shoulder), Point::new(centre.x, RAIL));
    svg.path(&fork, &Paint::line(Colour::GREEN, 1.2));
    let mut rail = PathData::new();
    rail.segment(
        Point::new(centre.x - 12.0, RAIL),
        Point::new(centre.x + 12.0, RAIL),
    );
    svg.path(&rail, &Paint::line(INK, 1.0));
    let carriage = Rect::sized(centre.x - 3.5, RAIL - 1.8, 7.0, 3.6);
    svg.rect(&carriage, &Paint::fill(Colour::GREEN).outlined(INK, 0.4));
}

fn draw_arrow(svg: &mut Svg, from: Point, length: f64) {
    let tip = Point::new(from.x + length, from.y);
    svg.segment(
        from,
        Point::new(tip.x - 2.5, tip.y),
        &Paint::line(Colour::VERMILION, 1.1),
    );
    let mut head = PathData::new();
    head.polygon(&[
        tip,
        Point::new(tip.x - 4.2, tip.y - 2.2),
        Point::new(tip.x - 4.2, tip.y + 2.2),
    ]);
    svg.path(&head, &Paint::fill(Colour::VERMILION));
}

fn draw_photogate(svg: &mut Svg, x: f64, radius: f64) {
    let beam = (Point::new(x, -radius - 3.0), Point::new(x, radius));
    let dashes = Paint::dashed(Colour::VERMILION, 0.8, &[1.8, 1.3]);
    svg.segment(beam.0, beam.1, &dashes);
    let head = Rect::sized(x - 2.6, -radius - 7.5, 5.2, 4.5);
    svg.rect(&head, &Paint::fill(INK));
}

/// Two springs from posts on the track press bead 1 towards the far end.
fn draw_springs(svg: &mut Svg, layout: &Layout) {
    let (post, r) = (layout.start - 10.0, layout.radius());
    let end = layout.start + 0.32 * r;
    for y in [-0.72 * r, 0.72 * r] {
        let foot = Rect::sized(post - 1.6, y - 1.8, 1.6, 3.6);
        svg.rect(&foot, &Paint::fill(INK));
        draw_spring(svg, Point::new(post, y), end);
    }
}

fn draw_spring(svg: &mut Svg, from: Point, end: f64) {
    let (turns, swing) = (6, 1.5);
    let step = (end - from.x) / f64::from(turns);
    let mut points = vec![from];
    for i in 0..turns {
        let side = if i % 2 == 0 { -swing } else { swing };
        let x = from.x + step * (f64::from(i) + 0.5);
        points.push(Point::new(x, from.y + side));
    }
    points.push(Point::new(end, from.y));
    let mut path = PathData::new();
    path.polyline(&points);
    svg.path(&path, &Paint::line(Colour::BLUE, 0.7));
}

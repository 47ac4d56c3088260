//! The row of beads with its contacts and the sensor bead.

use super::labels::Labels;
use super::launcher::after_comma;
use super::layout::{Layout, NUMBER};
use super::{INK, RigDrawing};
use crate::draw::{Colour, Paint, PathData, Point, Rect, Svg};
use crate::text::{Anchor, LEAST_SIZE, TextLine};

/// Polished steel.
pub(super) const STEEL: Colour = Colour(176, 184, 194);
/// Oil in a contact.
const OIL: Colour = Colour(224, 160, 30);
/// A piezoelectric disc.
pub(super) const PIEZO: Colour = Colour(150, 40, 110);

/// Draws oil, beads and elisions, and labels them.
pub(super) fn draw(svg: &mut Svg, rig: &RigDrawing, layout: &Layout, labels: &mut Labels) {
    for contact in 0..=layout.beads.len() {
        draw_oil_after(svg, rig, layout, contact);
    }
    for (number, x) in &layout.beads {
        draw_bead(svg, Point::new(*x, 0.0), layout.radius());
        if rig.sensor() == Some(*number) {
            draw_sensor(svg, rig, layout, (*number, *x), labels);
        } else {
            draw_number(svg, Point::new(*x, 0.0), layout, *number);
        }
    }
    for x in &layout.elisions {
        draw_dots(svg, *x, layout.radius());
    }
    label_beads(rig, layout, labels);
}

/// Oil right of the bead at `index` in the drawing, and left of the first.
fn draw_oil_after(svg: &mut Svg, rig: &RigDrawing, layout: &Layout, index: usize) {
    let before = index.checked_sub(1).and_then(|i| layout.beads.get(i));
    let contact = before.map_or(0, |(n, _)| *n);
    let x = before.map_or(layout.start, |(_, x)| x + layout.radius());
    let next = layout.beads.get(index).map(|(n, _)| *n);
    let neighbours = next.is_none_or(|n| n == contact + 1);
    let touched = contact > 0 && neighbours;
    if touched && rig.is_wet(contact) {
        draw_oil(svg, Point::new(x, 0.0), layout.radius());
    }
}

/// A meniscus around the contact of two balls: waisted, widest where it wets them.
fn draw_oil(svg: &mut Svg, contact: Point, radius: f64) {
    let half_height = 0.62 * radius;
    let wetted = radius - (radius * radius - half_height * half_height).sqrt();
    let at = |dx: f64, dy: f64| Point::new(contact.x + dx, contact.y + dy);
    let waist = 0.55 * half_height;
    let mut path = PathData::new();
    path.move_to(at(-wetted, -half_height));
    path.quad_to(at(0.0, -waist), at(wetted, -half_height));
    path.line_to(at(wetted, half_height));
    path.quad_to(at(0.0, waist), at(-wetted, half_height));
    path.close();
    svg.path(&path, &Paint::fill(OIL));
}

/// A shaded ball.
pub(super) fn draw_bead(svg: &mut Svg, centre: Point, radius: f64) {
    let shade = svg.ball_gradient(STEEL);
    svg.circle(
        centre,
        radius - 0.25,
        &Paint::gradient(&shade).outlined(INK, 0.5),
    );
}

/// The bead's number, where it is legible inside.
fn draw_number(svg: &mut Svg, centre: Point, layout: &Layout, number: usize) {
    let line = TextLine::new(&number.to_string(), LEAST_SIZE);
    // What rounding of the layout leaves over still fits.
    if line.width() <= NUMBER * layout.diameter * 1.001 {
        line.draw(svg, centre, Anchor::MIDDLE, Colour::BLACK);
    }
}

/// A bead cut in two with a sensor disc between the halves.
fn draw_sensor(
    svg: &mut Svg,
    rig: &RigDrawing,
    layout: &Layout,
    (number, x): (usize, f64),
    labels: &mut Labels,
) {
    let r = layout.radius();
    let disc = Rect::sized(x - 1.3, -0.97 * r, 2.6, 1.94 * r);
    svg.rect(&disc.grown(0.6), &Paint::fill(Colour::WHITE));
    svg.rect(&disc, &Paint::fill(PIEZO));
    let with = match rig.sensor_label.as_str() {
        "" => String::new(),
        label => format!(" with {label}"),
    };
    let text = format!("split bead $n$ = {number}{with}");
    labels.below(Point::new(x, 0.9 * r), &text);
}

fn draw_dots(svg: &mut Svg, x: f64, radius: f64) {
    for offset in [-0.55, 0.0, 0.55] {
        let at = Point::new(x + offset * radius, 0.0);
        svg.circle(at, 0.75, &Paint::fill(INK));
    }
}

fn label_beads(rig: &RigDrawing, layout: &Layout, labels: &mut Labels) {
    let mut others = layout
        .beads
        .iter()
        .filter(|(n, _)| Some(*n) != rig.sensor());
    let Some((_, x)) = others.find(|(n, _)| *n > 1) else {
        return;
    };
    let noun = if rig.beads == 1 { "bead" } else { "beads" };
    let text = format!("{} {noun}{}", rig.beads, after_comma(&rig.bead_label));
    labels.above(Point::new(*x, -0.8 * layout.radius()), &text);
}

/// Lines under the row that say which contacts are dry and which wet.
pub(super) fn draw_braces(svg: &mut Svg, rig: &RigDrawing, layout: &Layout, labels: &mut Labels) {
    for (first, last, wet) in groups(rig) {
        let from = layout.contact(first) - 0.22 * layout.diameter;
        let to = layout.contact(last) + 0.22 * layout.diameter;
        let colour = if wet {
            OIL.mixed(Colour::BLACK, 0.35)
        } else {
            INK
        };
        draw_brace(svg, layout.brace(), (from, to), colour);
        let leader = rig.sensor().and_then(|n| layout.bead(n));
        let at = Point::new(brace_label(from, to, leader), layout.brace());
        labels.coloured(at, &brace_text(rig, (first, last, wet)), colour);
    }
}

fn brace_text(rig: &RigDrawing, (first, last, wet): (usize, usize, bool)) -> String {
    let contacts = if first == last {
        format!("contact {first}")
    } else {
        format!("contacts {first}–{last}")
    };
    match (wet, rig.liquid.is_empty()) {
        (false, _) => format!("{contacts} dry"),
        (true, true) => format!("{contacts} wet"),
        (true, false) => format!("{contacts} wet: {}", rig.liquid),
    }
}

fn draw_brace(svg: &mut Svg, y: f64, (from, to): (f64, f64), colour: Colour) {
    let corners = [(from, y - 3.0), (from, y), (to, y), (to, y - 3.0)];
    let mut path = PathData::new();
    path.polyline(&corners.map(|(x, y)| Point::new(x, y)));
    svg.path(&path, &Paint::line(colour, 0.9));
}

/// Where the leader of a brace's label begins: its middle, or beside the
/// sensor's leader if that runs through there.
fn brace_label(from: f64, to: f64, sensor: Option<f64>) -> f64 {
    let middle = 0.5 * (from + to);
    match sensor.filter(|x| (x - middle).abs() < 8.0) {
        Some(x) => (x + 8.0).min(0.5 * (middle + to)),
        None => middle,
    }
}

/// Neighbouring contacts of one kind: first, last, wet.
fn groups(rig: &RigDrawing) -> Vec<(usize, usize, bool)> {
    let begin = usize::from(rig.striker_ratio.is_none());
    let end = if rig.far_end == super::FarEnd::Open {
        rig.beads.saturating_sub(1)
    } else {
        rig.beads
    };
    if begin > end {
        return Vec::new();
    }
    let (first, last) = match rig.wet_contacts {
        Some((a, b)) if a <= b && a <= end && b >= begin => (a.max(begin), b.min(end)),
        _ => return vec![(begin, end, false)],
    };
    let mut found = Vec::new();
    if first > begin {
        found.push((begin, first - 1, false));
    }
    found.push((first, last, true));
    if last < end {
        found.push((last + 1, end, false));
    }
    found
}

#[cfg(test)]
#[path = "tests/row.rs"]
mod tests;

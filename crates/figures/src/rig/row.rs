//! The row of beads with its contacts and the sensor bead.

use super::labels::{Labels, spread};
use super::layout::Layout;
use super::{AXIS, FONT, INK, RigDrawing, millimetres};
use crate::draw::{Colour, Paint, PathData, Point, Svg};
use crate::text::{Anchor, TextLine};

/// Polished steel.
pub(super) const STEEL: Colour = Colour(176, 184, 194);
/// Oil in a contact.
const OIL: Colour = Colour(224, 160, 30);
/// A piezoelectric disc.
pub(super) const PIEZO: Colour = Colour(150, 40, 110);
/// Height of the line that groups dry and wet contacts.
const BRACE: f64 = 111.0;
/// Widest text of one such group.
const WIDEST: f64 = 150.0;

/// Draws oil, beads and elisions, and labels them.
pub(super) fn draw(svg: &mut Svg, rig: &RigDrawing, layout: &Layout, labels: &mut Labels) {
    for contact in 0..=layout.beads.len() {
        draw_oil_beside(svg, rig, layout, contact);
    }
    for (number, x) in &layout.beads {
        draw_bead(svg, Point::new(*x, AXIS), layout.radius());
        if rig.sensor() == Some(*number) {
            draw_sensor(svg, layout, *x, *number, labels);
        } else {
            draw_number(svg, Point::new(*x, AXIS), layout, *number);
        }
    }
    for x in &layout.elisions {
        draw_dots(svg, *x, layout.radius());
    }
    label_beads(rig, layout, labels);
}

/// Oil right of the bead at `index` in the drawing, and left of the first.
fn draw_oil_beside(svg: &mut Svg, rig: &RigDrawing, layout: &Layout, index: usize) {
    let before = index.checked_sub(1).and_then(|i| layout.beads.get(i));
    let contact = before.map_or(0, |(n, _)| *n);
    let x = before.map_or(layout.start, |(_, x)| x + layout.radius());
    let next = layout.beads.get(index).map(|(n, _)| *n);
    let neighbours = next.is_none_or(|n| n == contact + 1);
    let touched = contact > 0 && neighbours;
    if touched && rig.is_wet(contact) {
        draw_oil(svg, Point::new(x, AXIS), layout.radius());
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

fn draw_number(svg: &mut Svg, centre: Point, layout: &Layout, number: usize) {
    let line = TextLine::new(&number.to_string(), 6.4).fitted(1.4 * layout.radius());
    line.draw(svg, centre, Anchor::MIDDLE, Colour::BLACK);
}

/// A bead cut in two with a sensor disc between the halves.
fn draw_sensor(svg: &mut Svg, layout: &Layout, x: f64, number: usize, labels: &mut Labels) {
    let r = layout.radius();
    let disc = crate::draw::Rect::sized(x - 1.5, AXIS - 0.97 * r, 3.0, 1.94 * r);
    svg.rect(&disc.grown(0.7), &Paint::fill(Colour::WHITE));
    svg.rect(&disc, &Paint::fill(PIEZO));
    let text = format!("sensor bead $n$ = {number}, split, with piezo disc");
    labels.below(Point::new(x, AXIS + 0.9 * r), &text);
}

fn draw_dots(svg: &mut Svg, x: f64, radius: f64) {
    for offset in [-0.5, 0.0, 0.5] {
        svg.circle(
            Point::new(x + offset * radius, AXIS),
            0.9,
            &Paint::fill(INK),
        );
    }
}

fn label_beads(rig: &RigDrawing, layout: &Layout, labels: &mut Labels) {
    let Some((_, x)) = layout
        .beads
        .iter()
        .find(|(n, _)| Some(*n) != rig.sensor() && *n > 1)
    else {
        return;
    };
    let mut text = format!("{} beads", rig.beads);
    if !rig.bead_material.is_empty() {
        let material = rig.bead_material.replace(' ', "\u{a0}");
        text.push_str(&format!(" of {material}"));
    }
    if rig.bead_radius_m > 0.0 && rig.bead_radius_m.is_finite() {
        text.push_str(&format!(", $R$ = {}", millimetres(rig.bead_radius_m)));
    }
    labels.above(Point::new(*x, AXIS - 0.8 * layout.radius()), &text);
}

/// A line under a group of contacts with its text.
struct Brace {
    from: f64,
    to: f64,
    text: TextLine,
    colour: Colour,
}

/// Lines under the row that say which contacts are dry and which wet.
pub(super) fn draw_braces(svg: &mut Svg, rig: &RigDrawing, layout: &Layout) {
    let leader = rig.sensor().and_then(|n| layout.bead(n));
    let braces: Vec<Brace> = groups(rig)
        .into_iter()
        .map(|g| brace(rig, layout, g))
        .collect();
    let widths: Vec<f64> = braces.iter().map(|b| b.text.width()).collect();
    let mut centres: Vec<f64> = braces
        .iter()
        .map(|b| brace_text(b.from, b.to, 0.5 * b.text.width(), leader))
        .collect();
    spread(&mut centres, &widths);
    for (brace, centre) in braces.iter().zip(centres) {
        draw_brace(svg, brace, centre);
    }
}

fn brace(rig: &RigDrawing, layout: &Layout, (first, last, wet): (usize, usize, bool)) -> Brace {
    let contacts = if first == last {
        format!("contact {first}")
    } else {
        format!("contacts {first}–{last}")
    };
    let text = match (wet, rig.liquid.is_empty()) {
        (false, _) => format!("{contacts} dry"),
        (true, true) => format!("{contacts} wet"),
        (true, false) => format!("{contacts} wet: {}", rig.liquid),
    };
    Brace {
        from: layout.contact(first) - 0.22 * layout.diameter,
        to: layout.contact(last) + 0.22 * layout.diameter,
        text: TextLine::new(&text, FONT).fitted(WIDEST),
        colour: if wet {
            OIL.mixed(Colour::BLACK, 0.3)
        } else {
            INK
        },
    }
}

fn draw_brace(svg: &mut Svg, brace: &Brace, centre: f64) {
    let Brace {
        from,
        to,
        text,
        colour,
    } = brace;
    let corners = [
        (*from, BRACE - 4.0),
        (*from, BRACE),
        (*to, BRACE),
        (*to, BRACE - 4.0),
    ];
    let mut path = PathData::new();
    path.polyline(&corners.map(|(x, y)| Point::new(x, y)));
    svg.path(&path, &Paint::line(*colour, 0.9));
    text.draw(
        svg,
        Point::new(centre, BRACE + 8.5),
        Anchor::CENTRE,
        *colour,
    );
}

/// Middle of a brace's text: the middle, or off the leader that runs through it.
fn brace_text(from: f64, to: f64, half: f64, leader: Option<f64>) -> f64 {
    let middle = 0.5 * (from + to);
    match leader.filter(|x| (x - middle).abs() < half + 4.0) {
        Some(x) if x - from > to - x => x - half - 4.0,
        Some(x) => x + half + 4.0,
        None => middle,
    }
}

/// Neighbouring contacts of one kind: first, last, wet.
fn groups(rig: &RigDrawing) -> Vec<(usize, usize, bool)> {
    let begin = usize::from(rig.striker_radius_m.is_none());
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
mod tests {
    use super::*;

    #[test]
    fn every_contact_belongs_to_one_group() {
        for wet_contacts in [
            None,
            Some((0, 40)),
            Some((7, 40)),
            Some((3, 5)),
            Some((50, 60)),
        ] {
            let rig = RigDrawing {
                beads: 40,
                striker_radius_m: Some(1.0),
                wet_contacts,
                ..RigDrawing::default()
            };
            let found = groups(&rig);
            assert_eq!(found.first().map(|g| g.0), Some(0));
            assert_eq!(found.last().map(|g| g.1), Some(40));
            assert!(found.windows(2).all(|w| w[1].0 == w[0].1 + 1), "{found:?}");
        }
    }
}

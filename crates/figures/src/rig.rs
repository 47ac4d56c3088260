//! A drawing of the apparatus, as wide as one column: parts have numbers, and a key below names
//! them.

use crate::draw::{Canvas, Colour, PT_PER_MM, Paint, PathData, Point, Rect, Segment};
use crate::figure::{Figure, SINGLE_COLUMN_MM};
use crate::text::{Anchor, LEAST_SIZE, TextLine, wrap};

/// The end that closes the row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RigEnd {
    /// A half-bead fixed to the stop.
    #[default]
    HalfBead,
    /// The plane face of the stop itself.
    Plane,
    /// Nothing: the last bead is free.
    Open,
}

/// The parts of an apparatus. Parts that are `None`, `false` or without a label are left out.
///
/// The default is an empty track.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RigDrawing {
    /// Beads in the row, the striker not counted.
    pub beads: usize,
    /// Material and size of the beads, such as "AISI 316, $R$ = 6.35 mm".
    pub bead_label: String,
    /// Radius of the striker over that of a bead; no striker if `None`.
    pub striker_ratio: Option<f64>,
    /// Label of the striker.
    pub striker_label: String,
    /// Bead with a sensor in its middle, counted from 1.
    pub sensor_bead: Option<usize>,
    /// Kind of the sensors, such as "piezo disc".
    pub sensor_label: String,
    /// First and last wet contact; contact c lies between bead c and c + 1, bead 0 being the striker.
    pub wet_contacts: Option<(usize, usize)>,
    /// Name of the liquid.
    pub liquid: String,
    /// Angle of the track above the horizontal in degrees, rising away from the wall.
    pub incline_deg: f64,
    /// The far end.
    pub far_end: RigEnd,
    /// A sensor between the far end and the stop.
    pub wall_sensor: bool,
    /// Launches the striker.
    pub actuator: String,
    /// Brings the striker back.
    pub repositioner: String,
    /// Measures the striker's speed.
    pub photogate: String,
    /// Springs that hold bead 1.
    pub springs: String,
    /// The box that the sensors are wired to.
    pub recorder: String,
    /// Body to which the far end is fixed; a rigid wall if there is neither it nor
    /// an end structure.
    pub stop: String,
    /// Carries the stop.
    pub end_structure: String,
    /// A mass that stands apart.
    pub bar: String,
}

/// Width of the drawing in points; the beads' centres are at height 0.
const WIDTH: f64 = SINGLE_COLUMN_MM * PT_PER_MM - 6.0;
const FONT: f64 = 7.0;
/// Distance of lines of the key.
const LEADING: f64 = 8.8;
const INK: Colour = Colour::grey(60);
const BODY: Colour = Colour(214, 217, 222);
const DARK: Colour = Colour(150, 156, 164);
const STEEL: Colour = Colour(190, 197, 206);
const OIL: Colour = Colour(224, 160, 30);
/// A piezoelectric disc.
const PIEZO: Colour = Colour(150, 40, 110);

/// The lowest row of numbers above begins here, and the recorder stands here.
const ROOF: f64 = -44.0;
const RECORDER: f64 = -36.0;
/// Beads are drawn between these diameters, points.
const SMALLEST: f64 = 11.0;
const LARGEST: f64 = 24.0;
/// Width of an elision in bead diameters.
const ELISION: f64 = 1.1;
/// Widest number in a bead, in diameters.
const NUMBER: f64 = 0.86;

/// Widths of the parts at either end of the row.
const ACTUATOR: f64 = 34.0;
const STRIKER: f64 = 25.0;
const GATE: f64 = 8.0;
const SPRINGS: f64 = 13.0;
const SENSOR: f64 = 3.8;
const STOP: f64 = 8.0;
const STRUCTURE: f64 = 17.0;
const APART: f64 = 5.0;
const BAR: f64 = 9.0;

impl RigDrawing {
    /// The drawing as a figure of its own, one column wide.
    pub fn figure(self) -> Figure {
        let (above, below) = self.drawn(&mut Canvas::default());
        Figure::single_column((above + below + 6.0) / PT_PER_MM).panel(self)
    }

    /// Draws the rig, shrunk to fit the frame.
    pub(crate) fn draw(&self, canvas: &mut Canvas, frame: &Rect) {
        let (above, below) = self.drawn(&mut Canvas::default());
        canvas.shrunk_to(frame, (WIDTH, above, below), |canvas| {
            self.drawn(canvas);
        });
    }

    /// Draws everything and returns the room above and below the beads' centres.
    fn drawn(&self, canvas: &mut Canvas) -> (f64, f64) {
        let drawing = Drawing::new(self);
        let mut labels = Vec::new();
        drawing.draw_track(canvas);
        drawing.draw_launcher(canvas, &mut labels);
        drawing.draw_row(canvas, &mut labels);
        drawing.draw_far_end(canvas, &mut labels);
        drawing.draw_recorder(canvas, &mut labels);
        drawing.draw_contacts(canvas, &mut labels);
        // Numbered from left to right.
        labels.sort_by(|a, b| a.at.x.total_cmp(&b.at.x));
        let floor = drawing.radius() + 16.0;
        draw_numbers(canvas, &labels, true, ROOF);
        draw_numbers(canvas, &labels, false, floor);
        let mut key = String::new();
        for (i, label) in labels.iter().enumerate() {
            key += &format!("{}:\u{a0}{}; ", i + 1, label.text);
        }
        key += "not to scale";
        if self.incline_deg != 0.0 && self.incline_deg.is_finite() {
            let angle = self.incline_deg;
            key += &format!("; the track, drawn level, is inclined by $\\alpha$ = {angle}°");
        }
        let lines = wrap(&(key + "."), FONT, WIDTH, 40);
        canvas.lines(&lines, Point::new(0.0, floor + LEADING * 2.0), LEADING, Anchor::LEFT);
        (LEADING - ROOF, floor + LEADING * (lines.len() + 1) as f64 + 3.0)
    }

    fn sensor(&self) -> Option<usize> {
        self.sensor_bead.filter(|n| (1..=self.beads).contains(n))
    }

    fn is_wet(&self, contact: usize) -> bool {
        let holds = |(first, last): (usize, usize)| (first..=last).contains(&contact);
        self.wet_contacts.is_some_and(holds)
    }

    fn half_bead(&self) -> f64 {
        if self.far_end == RigEnd::HalfBead { 0.5 } else { 0.0 }
    }

    /// Width of the wall's sensor, and of stop and structure.
    fn end_widths(&self) -> (f64, f64) {
        let closed = self.far_end != RigEnd::Open;
        let stop = closed && !self.stop.is_empty();
        (sum(&[(self.wall_sensor && closed, SENSOR)]), sum(&[(stop, STOP), (closed, STRUCTURE)]))
    }
}

/// A part of the drawing with its name, and whether its number stands above.
struct PartLabel {
    at: Point,
    is_above: bool,
    text: String,
}

fn label(labels: &mut Vec<PartLabel>, (x, y): (f64, f64), is_above: bool, text: &str) {
    labels.push(PartLabel { at: Point::new(x, y), is_above, text: text.to_owned() });
}

/// Draws the numbers of the parts on one side of the row in a line beyond `edge`, each as close to
/// its part as its neighbours allow. Parts come from left to right.
fn draw_numbers(canvas: &mut Canvas, labels: &[PartLabel], above: bool, edge: f64) {
    let numbers = labels.iter().enumerate().filter(|(_, label)| label.is_above == above);
    let numbers: Vec<(TextLine, Point)> =
        numbers.map(|(i, label)| (TextLine::new(&(i + 1).to_string(), FONT), label.at)).collect();
    // Pushed to the right by those before, then back from the right edge.
    let (mut places, mut end) = (Vec::new(), 0.0);
    for (line, at) in &numbers {
        let x = f64::max(at.x, end + 0.5 * line.width());
        end = x + 0.5 * line.width() + APART;
        places.push(x);
    }
    let mut limit = WIDTH;
    for ((line, _), x) in numbers.iter().zip(&mut places).rev() {
        *x = x.min(limit - 0.5 * line.width());
        limit = *x - 0.5 * line.width() - APART;
    }
    let out = if above { -0.5 } else { 0.5 } * LEADING;
    for ((line, at), x) in numbers.iter().zip(places) {
        canvas.segment(*at, Point::new(x, edge), &Paint::line(INK, 0.45));
        canvas.circle(*at, 0.9, &Paint::fill(INK));
        line.draw(canvas, Point::new(x, edge + out), Anchor::MIDDLE, Colour::BLACK);
    }
}

/// Sum of the widths of what there is.
fn sum(parts: &[(bool, f64)]) -> f64 {
    parts.iter().map(|(there, width)| if *there { *width } else { 0.0 }).sum()
}

/// A drawing with the positions of its parts in points.
struct Drawing<'a> {
    rig: &'a RigDrawing,
    diameter: f64,
    /// Left end of everything, the photogate, and the left edge of bead 1.
    left: f64,
    gate: f64,
    start: f64,
    /// Right edge of the last bead, left face of the stop, right face of the structure.
    end: f64,
    face: f64,
    back: f64,
    /// Number and centre of every bead that is drawn.
    beads: Vec<(usize, f64)>,
    /// Middle of every place where beads are left out.
    elisions: Vec<f64>,
}

impl<'a> Drawing<'a> {
    fn new(rig: &'a RigDrawing) -> Self {
        let striker = rig.striker_ratio.is_some() || !rig.repositioner.is_empty();
        let springs = sum(&[(!rig.springs.is_empty(), SPRINGS)]);
        let before = sum(&[
            (true, 2.0 + springs),
            (!rig.actuator.is_empty(), ACTUATOR),
            (striker, STRIKER),
            (!rig.photogate.is_empty(), GATE),
        ]);
        let (sensor, support) = rig.end_widths();
        let bar = sum(&[(!rig.bar.is_empty(), APART + BAR)]);
        let open = sum(&[(rig.far_end == RigEnd::Open, 8.0), (true, 1.0)]);
        let room = WIDTH - before - (sensor + support + bar + open);
        // Least diameter at which the longest number is legible inside a bead.
        let number = TextLine::new(&rig.beads.to_string(), LEAST_SIZE).width();
        let smallest = (number / NUMBER).clamp(SMALLEST, LARGEST);
        let runs = runs(rig, (room / smallest) as usize);
        let shown: usize = runs.iter().map(|(first, last)| last - first + 1).sum();
        let gaps = runs.len().saturating_sub(1);
        let units = shown as f64 + gaps as f64 * ELISION + rig.half_bead();
        let diameter = (room / units.max(1.0)).min(LARGEST);
        // Short rows stand in the middle.
        let left = 0.5 * (room - diameter * units).max(0.0);
        let start = left + before;
        let mut end = start;
        let (mut beads, mut elisions) = (Vec::new(), Vec::new());
        for (i, (first, last)) in runs.into_iter().enumerate() {
            if i > 0 {
                elisions.push(end + 0.5 * ELISION * diameter);
                end += ELISION * diameter;
            }
            for bead in first..=last {
                beads.push((bead, end + 0.5 * diameter));
                end += diameter;
            }
        }
        let face = end + rig.half_bead() * diameter + sensor;
        Self {
            rig,
            diameter,
            left,
            gate: start - springs - 0.5 * GATE,
            start,
            end,
            face,
            back: face + support,
            beads,
            elisions,
        }
    }

    fn radius(&self) -> f64 {
        0.5 * self.diameter
    }

    fn bead(&self, number: usize) -> Option<f64> {
        let found = self.beads.iter().find(|(n, _)| *n == number);
        found.map(|(_, x)| *x)
    }

    /// Place of a contact, or of the elision that hides it.
    fn contact(&self, contact: usize) -> f64 {
        let before = self.bead(contact).map(|x| x + self.radius());
        let after = || self.bead(contact + 1).map(|x| x - self.radius());
        let hidden = || self.beads.iter().rev().find(|(n, _)| *n <= contact);
        let elision = || hidden().map(|(_, x)| x + self.radius() * (1.0 + ELISION));
        before.or_else(after).or_else(elision).unwrap_or(self.start)
    }

    /// The air track below everything, with its holes.
    fn draw_track(&self, canvas: &mut Canvas) {
        let top = self.radius() + 0.3;
        let open = sum(&[(self.rig.far_end == RigEnd::Open, 8.0)]);
        let length = self.face + open - self.left;
        block(canvas, (self.left, top), (length, 4.5), BODY);
        let mut holes = PathData::default();
        for i in 0..(length / 7.0) as u32 {
            let x = self.left + 4.0 + 7.0 * f64::from(i);
            holes.segment(Point::new(x, top + 1.2), Point::new(x, top + 3.3));
        }
        canvas.path(&holes, &Paint::line(DARK, 0.5));
    }

    /// Actuator, striker, repositioner, photogate and springs, from left to right.
    fn draw_launcher(&self, canvas: &mut Canvas, labels: &mut Vec<PartLabel>) {
        let (rig, r) = (self.rig, self.radius());
        let mut x = self.left + 1.0;
        if !rig.actuator.is_empty() {
            block(canvas, (x, -8.0), (22.0, 16.0), DARK);
            block(canvas, (x + 22.0, -1.4), (ACTUATOR - 25.0, 2.8), BODY);
            block(canvas, (x + ACTUATOR - 3.5, -0.7 * r), (1.8, 1.4 * r), INK);
            label(labels, (x + 10.0, -6.0), true, &rig.actuator);
            x += ACTUATOR;
        }
        let ratio = rig.striker_ratio.filter(|ratio| ratio.is_finite());
        // The striker leaves room for its arrow.
        let radius = (r * ratio.unwrap_or(1.0).clamp(0.6, 1.4)).min(6.8);
        let centre = Point::new(x + radius, r - radius);
        if rig.striker_ratio.is_some() {
            draw_bead(canvas, centre, radius);
            draw_arrow(canvas, Point::new(centre.x + radius + 1.2, centre.y), 9.0);
            let at = (centre.x, centre.y + 0.8 * radius);
            label(labels, at, false, &with_comma("striker", &rig.striker_label));
        }
        if !rig.repositioner.is_empty() {
            let rail = -22.0;
            let arm = [(centre.x, centre.y - radius), (centre.x, rail)];
            polyline(canvas, &arm, &Paint::line(Colour::GREEN, 1.2));
            let ends = [(centre.x - 12.0, rail), (centre.x + 12.0, rail)];
            polyline(canvas, &ends, &Paint::line(INK, 1.0));
            label(labels, (centre.x, rail), true, &rig.repositioner);
        }
        if !rig.photogate.is_empty() {
            let beam = [(self.gate, -r - 3.0), (self.gate, r)];
            polyline(canvas, &beam, &Paint::dashed(Colour::VERMILION, 0.8, &[1.8, 1.3]));
            block(canvas, (self.gate - 2.6, -r - 7.5), (5.2, 4.5), INK);
            label(labels, (self.gate, -r - 6.0), true, &rig.photogate);
        }
        if !rig.springs.is_empty() {
            let (post, end) = (self.start - 10.0, self.start + 0.32 * r);
            for y in [-0.72 * r, 0.72 * r] {
                let turn = |i: u8| {
                    let side = [0.0, 1.5, 0.0, -1.5][usize::from(i % 4)];
                    (post + (end - post) / 12.0 * f64::from(i), y + side)
                };
                let spring: Vec<(f64, f64)> = (0..=12).map(turn).collect();
                polyline(canvas, &spring, &Paint::line(Colour::BLUE, 0.7));
            }
            label(labels, (self.start - 4.0, -0.72 * r), true, &rig.springs);
        }
    }

    /// Oil, beads, sensor bead and elisions.
    fn draw_row(&self, canvas: &mut Canvas, labels: &mut Vec<PartLabel>) {
        let (rig, r) = (self.rig, self.radius());
        for (i, (number, x)) in self.beads.iter().enumerate() {
            let next = self.beads.get(i + 1).map(|(n, _)| *n);
            if rig.is_wet(*number) && next.is_none_or(|n| n == number + 1) {
                draw_oil(canvas, x + r, r);
            }
        }
        for (number, x) in &self.beads {
            let centre = Point::new(*x, 0.0);
            draw_bead(canvas, centre, r);
            if rig.sensor() == Some(*number) {
                // Cut in two with a sensor disc between the halves.
                let disc = Rect::sized(x - 1.3, -0.97 * r, 2.6, 1.94 * r);
                canvas.rect(&disc.grown(0.6), &Paint::fill(Colour::WHITE));
                canvas.rect(&disc, &Paint::fill(PIEZO));
                let mut text = format!("split bead $n$ = {number}");
                if !rig.sensor_label.is_empty() {
                    text += &format!(" with {}", rig.sensor_label);
                }
                label(labels, (*x, 0.9 * r), false, &text);
                continue;
            }
            let line = TextLine::new(&number.to_string(), LEAST_SIZE);
            // What rounding of the layout leaves over still fits.
            if line.width() <= NUMBER * self.diameter * 1.001 {
                line.draw(canvas, centre, Anchor::MIDDLE, Colour::BLACK);
            }
        }
        for x in &self.elisions {
            for offset in [-0.55, 0.0, 0.55] {
                canvas.circle(Point::new(x + offset * r, 0.0), 0.75, &Paint::fill(INK));
            }
        }
        let mut others = self.beads.iter().filter(|(n, _)| Some(*n) != rig.sensor());
        if let Some((_, x)) = others.find(|(n, _)| *n > 1) {
            let noun = if rig.beads == 1 { "bead" } else { "beads" };
            let text = with_comma(&format!("{} {noun}", rig.beads), &rig.bead_label);
            label(labels, (*x, -0.8 * r), true, &text);
        }
    }

    /// Half-bead, sensor, stop, end structure and the bar apart from them.
    fn draw_far_end(&self, canvas: &mut Canvas, labels: &mut Vec<PartLabel>) {
        let (rig, r) = (self.rig, self.radius());
        if rig.far_end == RigEnd::HalfBead {
            let (x, radius) = (self.end + r, r - 0.25);
            let mut half = PathData::default();
            half.left_half_circle(Point::new(x, 0.0), radius);
            canvas.path(&half, &Paint::fill(STEEL).outlined(INK, 0.5));
            label(labels, (self.end + 0.45 * r, 0.5 * r), false, "half-bead");
        }
        if rig.far_end != RigEnd::Open {
            if rig.wall_sensor {
                let disc = Rect::sized(self.face - 3.3, -0.97 * r, 2.8, 1.94 * r);
                canvas.rect(&disc, &Paint::fill(PIEZO));
                let name = [rig.sensor_label.as_str(), "wall sensor"];
                let name = name.into_iter().find(|name| !name.is_empty());
                label(labels, (self.face - 1.8, 0.8 * r), false, name.unwrap_or_default());
            }
            let mut x = self.face;
            if !rig.stop.is_empty() {
                block(canvas, (x, -r), (STOP, 2.0 * r + 4.8), DARK);
                label(labels, (x + 0.6 * STOP, 0.6 * r), false, &rig.stop);
                x += STOP;
            }
            block(canvas, (x, -18.0), (self.back - x, 22.8 + r), BODY);
            let name = match rig.end_structure.as_str() {
                "" => "rigid wall",
                name => name,
            };
            label(labels, (0.5 * (x + self.back), -15.0), true, name);
        }
        if !rig.bar.is_empty() {
            let x = self.back + APART;
            block(canvas, (x, -16.0), (BAR, 20.8 + r), DARK);
            label(labels, (x + 0.5 * BAR, -13.5), true, &rig.bar);
        }
    }

    /// Lines under the row that say which contacts are dry and which wet.
    fn draw_contacts(&self, canvas: &mut Canvas, labels: &mut Vec<PartLabel>) {
        let y = self.radius() + 11.0;
        for (first, last, wet) in groups(self.rig) {
            let from = self.contact(first) - 0.22 * self.diameter;
            let to = self.contact(last) + 0.22 * self.diameter;
            let colour = if wet { OIL.mixed(Colour::BLACK, 0.35) } else { INK };
            let corners = [(from, y - 3.0), (from, y), (to, y), (to, y - 3.0)];
            polyline(canvas, &corners, &Paint::line(colour, 0.9));
            let contacts = match first == last {
                true => format!("contact {first}"),
                false => format!("contacts {first}–{last}"),
            };
            let text = match (wet, self.rig.liquid.as_str()) {
                (false, _) => format!("{contacts} dry"),
                (true, "") => format!("{contacts} wet"),
                (true, liquid) => format!("{contacts} wet: {liquid}"),
            };
            label(labels, (0.5 * (from + to), y), false, &text);
        }
    }

    /// The recorder above the row and a wire to every sensor.
    fn draw_recorder(&self, canvas: &mut Canvas, labels: &mut Vec<PartLabel>) {
        let rig = self.rig;
        let inside = rig.sensor().and_then(|n| self.bead(n));
        let wall = rig.wall_sensor && rig.far_end != RigEnd::Open;
        let ends: Vec<f64> = inside.into_iter().chain(wall.then_some(self.face - 1.8)).collect();
        let (Some(first), Some(last), false) = (ends.first(), ends.last(), rig.recorder.is_empty())
        else {
            return;
        };
        let (middle, y) = (0.5 * (first + last), RECORDER + 5.0);
        for x in &ends {
            let wire = [(*x, -0.97 * self.radius()), (*x, y), (middle, y)];
            polyline(canvas, &wire, &Paint::line(PIEZO, 0.8));
        }
        let case = Rect::sized(middle - 9.0, RECORDER, 18.0, 10.0);
        canvas.rect(&case, &Paint::fill(Colour::WHITE).outlined(PIEZO, 0.8));
        label(labels, (middle, RECORDER + 3.0), true, &rig.recorder);
    }
}

/// A text and another after a comma, if there is one.
fn with_comma(text: &str, other: &str) -> String {
    if other.is_empty() { text.to_owned() } else { format!("{text}, {other}") }
}

fn block(canvas: &mut Canvas, (x, y): (f64, f64), (width, height): (f64, f64), colour: Colour) {
    canvas.rect(&Rect::sized(x, y, width, height), &Paint::fill(colour).outlined(INK, 0.5));
}

fn polyline(canvas: &mut Canvas, points: &[(f64, f64)], paint: &Paint) {
    let points: Vec<Point> = points.iter().map(|(x, y)| Point::new(*x, *y)).collect();
    canvas.path(PathData::default().polyline(&points), paint);
}

fn draw_bead(canvas: &mut Canvas, centre: Point, radius: f64) {
    canvas.circle(centre, radius - 0.25, &Paint::fill(STEEL).outlined(INK, 0.5));
}

/// A meniscus around the contact of two balls at `x`: waisted, widest where it wets them.
fn draw_oil(canvas: &mut Canvas, x: f64, radius: f64) {
    let half_height = 0.62 * radius;
    let wetted = radius - (radius * radius - half_height * half_height).sqrt();
    let (at, waist) = (|dx, y| Point::new(x + dx, y), 0.55 * half_height);
    let path = PathData(vec![
        Segment::Move(at(-wetted, -half_height)),
        Segment::Quad(at(0.0, -waist), at(wetted, -half_height)),
        Segment::Line(at(wetted, half_height)),
        Segment::Quad(at(0.0, waist), at(-wetted, half_height)),
        Segment::Close,
    ]);
    canvas.path(&path, &Paint::fill(OIL));
}

fn draw_arrow(canvas: &mut Canvas, from: Point, length: f64) {
    let tip = from.x + length;
    polyline(
        canvas,
        &[(from.x, from.y), (tip - 2.5, from.y)],
        &Paint::line(Colour::VERMILION, 1.1),
    );
    let corners = [(tip, 0.0), (tip - 4.2, -2.2), (tip - 4.2, 2.2)];
    let corners = corners.map(|(x, dy)| Point::new(x, from.y + dy));
    canvas.path(PathData::default().polygon(&corners), &Paint::fill(Colour::VERMILION));
}

/// Runs of neighbouring beads to draw if there is room for `capacity` beads: all of them, or
/// those at the ends and around the sensor.
fn runs(rig: &RigDrawing, capacity: usize) -> Vec<(usize, usize)> {
    let last = rig.beads;
    if last <= capacity {
        return if last == 0 { Vec::new() } else { vec![(1, last)] };
    }
    // Beads kept at either end; a narrow drawing has room for one.
    let kept = if capacity < 9 { 1 } else { 2 };
    let sensor = rig.sensor().map(|n| ((n - 1).max(1), n.saturating_add(1).min(last)));
    let end = (last.saturating_sub(kept) + 1, last);
    let mut out: Vec<(usize, usize)> = Vec::new();
    for (first, last) in [Some((1, kept)), sensor, Some(end)].into_iter().flatten() {
        match out.last_mut() {
            // Runs that touch, or that hide a single bead between them, are joined.
            Some(before) if first <= before.1 + 2 => before.1 = before.1.max(last),
            _ => out.push((first, last)),
        }
    }
    out
}

/// Neighbouring contacts of one kind: first, last, wet.
fn groups(rig: &RigDrawing) -> Vec<(usize, usize, bool)> {
    let begin = usize::from(rig.striker_ratio.is_none());
    let end = rig.beads.saturating_sub(usize::from(rig.far_end == RigEnd::Open));
    let wet = match rig.wet_contacts {
        Some((a, b)) if a <= b && a <= end && b >= begin => (a.max(begin), b.min(end) + 1),
        _ => (end + 1, end + 1),
    };
    let all = [(begin, wet.0, false), (wet.0, wet.1, true), (wet.1, end + 1, false)];
    let some = all.into_iter().filter(|(from, to, _)| from < to);
    some.map(|(from, to, wet)| (from, to - 1, wet)).collect()
}

#[cfg(test)]
#[path = "rig/tests/drawing.rs"]
mod tests;

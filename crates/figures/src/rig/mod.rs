//! A labelled drawing of the apparatus.

mod labels;
mod layout;
mod machine;
mod row;

use labels::Labels;
use layout::Layout;

use crate::draw::{Colour, PT_PER_MM, Point, Rect, Svg};
use crate::figure::{DOUBLE_COLUMN_MM, Figure};
use crate::text::{Anchor, TextLine};

/// What closes the far end of the row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FarEnd {
    /// A half-bead fixed to the stop.
    #[default]
    HalfBead,
    /// The plane face of the stop itself.
    Plane,
    /// Nothing: the last bead is free.
    Open,
}

/// What there is to draw. Parts that are `None` or `false` are left out.
///
/// The default is a bare row of ten beads.
#[derive(Debug, Clone, PartialEq)]
pub struct RigDrawing {
    /// Beads in the row, the striker not counted.
    pub beads: usize,
    /// Radius of the beads in metres, for the label.
    pub bead_radius_m: f64,
    /// What the beads are made of, for the label.
    pub bead_material: String,
    /// Radius of the striker in metres; no striker if `None`.
    pub striker_radius_m: Option<f64>,
    /// Text at the striker's arrow, such as its speed.
    pub striker_label: String,
    /// Bead with a sensor disc in its middle, counted from 1.
    pub sensor_bead: Option<usize>,
    /// First and last wet contact; contact c lies between bead c and c + 1, bead 0 being the striker.
    pub wet_contacts: Option<(usize, usize)>,
    /// Name of the liquid, for the label.
    pub liquid: String,
    /// Preload of the springs on bead 1 in newtons; no springs if `None`.
    pub preload_n: Option<f64>,
    /// Angle of the track above the horizontal in degrees, rising away from the wall.
    pub incline_deg: f64,
    /// The far end.
    pub far_end: FarEnd,
    /// A sensor disc between the far end and the stop.
    pub wall_sensor: bool,
    /// Mass of the stop's end structure in kilograms; drawn as a rigid wall if `None`.
    pub stop_mass_kg: Option<f64>,
    /// A voice-coil actuator that launches the striker.
    pub actuator: bool,
    /// A photogate that measures the striker's speed.
    pub photogate: bool,
    /// The box that both sensors are wired to, such as "16-bit ADC"; none if empty.
    pub recorder: String,
}

impl Default for RigDrawing {
    fn default() -> Self {
        Self {
            beads: 10,
            bead_radius_m: 0.0,
            bead_material: String::new(),
            striker_radius_m: None,
            striker_label: String::new(),
            sensor_bead: None,
            wet_contacts: None,
            liquid: String::new(),
            preload_n: None,
            incline_deg: 0.0,
            far_end: FarEnd::default(),
            wall_sensor: false,
            stop_mass_kg: None,
            actuator: false,
            photogate: false,
            recorder: String::new(),
        }
    }
}

/// Natural size of the drawing in points.
const WIDTH: f64 = DOUBLE_COLUMN_MM * PT_PER_MM - 6.0;
const HEIGHT: f64 = 178.0;
/// Height of the beads' centres.
const AXIS: f64 = 84.0;
const FONT: f64 = 7.0;
const INK: Colour = Colour::grey(60);

impl RigDrawing {
    /// The drawing as a figure of its own, a double column wide.
    #[must_use]
    pub fn figure(self) -> Figure {
        Figure::double_column((HEIGHT + 6.0) / PT_PER_MM).panel(self)
    }

    /// Draws the rig, shrunk to fit the frame.
    pub(crate) fn draw(&self, svg: &mut Svg, frame: &Rect) {
        let scale = (frame.width() / WIDTH).min(frame.height() / HEIGHT);
        svg.open_scaled(Point::new(frame.x0, frame.y0), scale);
        let layout = Layout::new(self);
        let mut labels = Labels::default();
        machine::draw_track(svg, self, &layout);
        machine::draw_launcher(svg, self, &layout, &mut labels);
        row::draw(svg, self, &layout, &mut labels);
        machine::draw_far_end(svg, self, &layout, &mut labels);
        machine::draw_wiring(svg, self, &layout);
        row::draw_braces(svg, self, &layout);
        labels.draw(svg);
        self.draw_remarks(svg);
        svg.close();
    }

    fn draw_remarks(&self, svg: &mut Svg) {
        let mut text = String::from("Not to scale");
        if self.incline_deg != 0.0 && self.incline_deg.is_finite() {
            text.push_str(&format!(
                "; the track, drawn level, is inclined by $\\alpha$ = {}°",
                self.incline_deg
            ));
        }
        let line = TextLine::new(&format!("{text}."), 6.2).fitted(WIDTH);
        line.draw(
            svg,
            Point::new(0.0, HEIGHT - 3.0),
            Anchor::LEFT,
            Colour::grey(100),
        );
    }

    /// Beads that are drawn and the sensor bead among them.
    pub(crate) fn sensor(&self) -> Option<usize> {
        self.sensor_bead.filter(|n| (1..=self.beads).contains(n))
    }

    /// Whether a contact is wet.
    pub(crate) fn is_wet(&self, contact: usize) -> bool {
        self.wet_contacts
            .is_some_and(|(first, last)| (first..=last).contains(&contact))
    }
}

/// A length for a label: millimetres, three digits.
pub(crate) fn millimetres(length_m: f64) -> String {
    let mm = length_m * 1e3;
    let digits = (2 - mm.abs().log10().floor() as i32).clamp(0, 6);
    let text = format!("{mm:.*}", usize::try_from(digits).unwrap_or(0));
    let trimmed = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        &text
    };
    format!("{trimmed} mm")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_written_in_millimetres() {
        assert_eq!(millimetres(6.35e-3), "6.35 mm");
        assert_eq!(millimetres(0.0127), "12.7 mm");
        assert_eq!(millimetres(0.1), "100 mm");
    }
}

//! A labelled drawing of the apparatus, as wide as one column.

mod labels;
mod launcher;
mod layout;
mod machine;
mod row;
mod stack;
mod wiring;

use labels::{Arranged, Labels};
use layout::Layout;

use crate::draw::{Colour, PT_PER_MM, Point, Rect, Svg};
use crate::figure::{Figure, SINGLE_COLUMN_MM};
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

/// What there is to draw. Parts that are `None`, `false` or without a label
/// are left out.
///
/// The default is a bare row of ten beads.
#[derive(Debug, Clone, PartialEq)]
pub struct RigDrawing {
    /// Beads in the row, the striker not counted.
    pub beads: usize,
    /// What the beads are, such as "AISI 316, $R$ = 6.35 mm".
    pub bead_label: String,
    /// Radius of the striker over that of a bead; no striker if `None`.
    pub striker_ratio: Option<f64>,
    /// Label of the striker.
    pub striker_label: String,
    /// Bead with a sensor in its middle, counted from 1.
    pub sensor_bead: Option<usize>,
    /// What the sensors are, such as "piezo disc".
    pub sensor_label: String,
    /// First and last wet contact; contact c lies between bead c and c + 1, bead 0 being the striker.
    pub wet_contacts: Option<(usize, usize)>,
    /// Name of the liquid.
    pub liquid: String,
    /// Angle of the track above the horizontal in degrees, rising away from the wall.
    pub incline_deg: f64,
    /// The far end.
    pub far_end: FarEnd,
    /// A sensor between the far end and the stop.
    pub wall_sensor: bool,
    /// An actuator that launches the striker.
    pub actuator: String,
    /// What brings the striker back.
    pub repositioner: String,
    /// A gate that measures the striker's speed.
    pub photogate: String,
    /// Springs that hold bead 1.
    pub springs: String,
    /// The box that the sensors are wired to.
    pub recorder: String,
    /// What the far end is fixed to; a rigid wall if there is neither it nor
    /// an end structure.
    pub stop: String,
    /// What carries the stop.
    pub end_structure: String,
    /// A mass that stands apart.
    pub bar: String,
}

impl Default for RigDrawing {
    fn default() -> Self {
        Self {
            beads: 10,
            bead_label: String::new(),
            striker_ratio: None,
            striker_label: String::new(),
            sensor_bead: None,
            sensor_label: String::new(),
            wet_contacts: None,
            liquid: String::new(),
            incline_deg: 0.0,
            far_end: FarEnd::default(),
            wall_sensor: false,
            actuator: String::new(),
            repositioner: String::new(),
            photogate: String::new(),
            springs: String::new(),
            recorder: String::new(),
            stop: String::new(),
            end_structure: String::new(),
            bar: String::new(),
        }
    }
}

/// Width of the drawing in points; the beads' centres are at height 0.
const WIDTH: f64 = SINGLE_COLUMN_MM * PT_PER_MM - 6.0;
const FONT: f64 = 7.0;
const INK: Colour = Colour::grey(60);
/// Labels above begin here: over the row, or over the recorder.
const ROOF: f64 = -30.0;
const OVER_RECORDER: f64 = -58.0;
/// Room for the remark at the bottom.
const REMARK: f64 = 17.0;

impl RigDrawing {
    /// The drawing as a figure of its own, one column wide.
    #[must_use]
    pub fn figure(self) -> Figure {
        let (above, below) = self.extent(&self.arranged());
        Figure::single_column((above + below + 6.0) / PT_PER_MM).panel(self)
    }

    /// Draws the rig, shrunk to fit the frame.
    pub(crate) fn draw(&self, svg: &mut Svg, frame: &Rect) {
        let labels = self.arranged();
        let (above, below) = self.extent(&labels);
        let fit = (frame.width() / WIDTH).min(frame.height() / (above + below));
        // The page was made for it up to rounding.
        let scale = if fit > 0.999 { 1.0 } else { fit };
        let origin = Point::new(frame.x0, frame.y0 + scale * above);
        svg.open_scaled(origin, scale);
        self.draw_parts(svg);
        let layout = Layout::new(self);
        labels.draw(svg, self.roof(), layout.floor());
        wiring::draw(svg, self, &layout);
        self.draw_remarks(svg, below);
        svg.close();
    }

    /// Everything but the labels, which are returned.
    fn draw_parts(&self, svg: &mut Svg) -> Labels {
        let layout = Layout::new(self);
        let mut labels = Labels::default();
        machine::draw_track(svg, self, &layout);
        launcher::draw(svg, self, &layout, &mut labels);
        row::draw(svg, self, &layout, &mut labels);
        machine::draw_far_end(svg, self, &layout, &mut labels);
        row::draw_braces(svg, self, &layout, &mut labels);
        labels
    }

    fn arranged(&self) -> Arranged {
        self.draw_parts(&mut Svg::new()).arranged()
    }

    /// Room above and below the beads' centres.
    fn extent(&self, labels: &Arranged) -> (f64, f64) {
        let (above, below) = labels.heights();
        let floor = Layout::new(self).floor();
        (above - self.roof(), floor + below + REMARK)
    }

    fn roof(&self) -> f64 {
        if self.recorder.is_empty() {
            ROOF
        } else {
            OVER_RECORDER
        }
    }

    fn draw_remarks(&self, svg: &mut Svg, below: f64) {
        let mut text = String::from("Not to scale");
        if self.incline_deg != 0.0 && self.incline_deg.is_finite() {
            text.push_str(&format!(
                "; the track, drawn level, is inclined by $\\alpha$ = {}°",
                self.incline_deg
            ));
        }
        let line = TextLine::new(&format!("{text}."), 6.4).shrunk_to(WIDTH);
        let at = Point::new(0.0, below - 3.0);
        line.draw(svg, at, Anchor::LEFT, Colour::grey(100));
    }

    /// The sensor bead if it is in the row.
    pub(crate) fn sensor(&self) -> Option<usize> {
        self.sensor_bead.filter(|n| (1..=self.beads).contains(n))
    }

    /// Whether a contact is wet.
    pub(crate) fn is_wet(&self, contact: usize) -> bool {
        self.wet_contacts
            .is_some_and(|(first, last)| (first..=last).contains(&contact))
    }
}

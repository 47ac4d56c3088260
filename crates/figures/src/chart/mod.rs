//! Diagrams with axes: what they show.

mod draw;
mod layout;
mod strokes;

pub(crate) use layout::{Plot, Prepared, x_scale};

use crate::draw::Colour;
use crate::heat::HeatMap;

#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Axis {
    pub(crate) label: String,
    pub(crate) log: bool,
    /// Counts something: ticks at whole numbers alone.
    pub(crate) whole: bool,
    pub(crate) range: Option<(f64, f64)>,
    /// Shared with a neighbour that carries the labels.
    pub(crate) unlabelled: bool,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ReferenceLine {
    pub(crate) value: f64,
    pub(crate) label: String,
    pub(crate) vertical: bool,
}

/// A diagram with two axes.
///
/// Labels are in the markup of this crate: `$v_0$ (m/s)`, `$10^{-5}$`, `$\Delta$`.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    pub(crate) title: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) series: Vec<Series>,
    pub(crate) references: Vec<ReferenceLine>,
    pub(crate) notes: Vec<String>,
    /// Whether names of series stand above the frame.
    pub(crate) legend: bool,
    pub(crate) heat: Option<HeatMap>,
}

impl Chart {
    /// An empty chart with linear axes.
    pub fn new(x_label: &str, y_label: &str) -> Self {
        let axis = |label: &str| Axis { label: label.into(), ..Axis::default() };
        Self {
            title: String::new(),
            x: axis(x_label),
            y: axis(y_label),
            series: Vec::new(),
            references: Vec::new(),
            notes: Vec::new(),
            legend: true,
            heat: None,
        }
    }

    /// A short title above the frame, next to the panel letter.
    pub fn title(mut self, title: &str) -> Self {
        self.title = title.into();
        self
    }

    /// Makes the x axis logarithmic.
    pub fn x_log(mut self) -> Self {
        self.x.log = true;
        self
    }

    /// Makes the x axis count: ticks at whole numbers alone.
    pub(crate) fn x_whole(mut self) -> Self {
        self.x.whole = true;
        self
    }

    /// Makes the y axis logarithmic.
    pub fn y_log(mut self) -> Self {
        self.y.log = true;
        self
    }

    /// Fixes the x range; ignored if it makes no axis.
    pub fn x_range(mut self, from: f64, to: f64) -> Self {
        self.x.range = Some((from, to));
        self
    }

    /// Fixes the y range; ignored if it makes no axis.
    pub fn y_range(mut self, from: f64, to: f64) -> Self {
        self.y.range = Some((from, to));
        self
    }

    /// Adds a series; later ones lie on top.
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Adds a horizontal reference line.
    pub fn h_line(self, y: f64, label: &str) -> Self {
        self.reference(y, label, false)
    }

    /// Adds a vertical reference line.
    pub fn v_line(self, x: f64, label: &str) -> Self {
        self.reference(x, label, true)
    }

    fn reference(mut self, value: f64, label: &str, vertical: bool) -> Self {
        let label = label.into();
        self.references.push(ReferenceLine { value, label, vertical });
        self
    }

    /// Adds a line of text above the frame, below the legend.
    pub fn note(mut self, text: &str) -> Self {
        self.notes.push(text.into());
        self
    }

    /// Whether names of series stand above the frame; they do by default.
    pub fn legend(mut self, legend: bool) -> Self {
        self.legend = legend;
        self
    }

    /// Lays a map under the series of this chart.
    pub fn heat(mut self, map: HeatMap) -> Self {
        self.heat = Some(map);
        self
    }

    /// The colour series `index` is drawn in.
    pub(crate) fn colour_of(&self, index: usize) -> Colour {
        let chosen = self.series.get(index).and_then(|s| s.colour);
        chosen.unwrap_or_else(|| Colour::PALETTE[index % Colour::PALETTE.len()])
    }
}

/// Line pattern.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dash {
    /// Unbroken.
    Solid,
    /// Long strokes.
    Dashed,
    /// Dots.
    Dotted,
    /// Strokes and dots in turn.
    DashDotted,
}

impl Dash {
    const CYCLE: [Self; 4] = [Self::Solid, Self::Dashed, Self::DashDotted, Self::Dotted];

    pub(crate) fn pattern(self) -> &'static [f64] {
        match self {
            Self::Solid => &[],
            Self::Dashed => &[4.5, 2.2],
            Self::Dotted => &[1.1, 1.6],
            Self::DashDotted => &[5.0, 1.6, 1.1, 1.6],
        }
    }

    pub(crate) fn of_index(i: usize) -> Self {
        Self::CYCLE[i % Self::CYCLE.len()]
    }
}

/// Shape of a data point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    /// Filled circle.
    Circle,
    /// Open circle.
    OpenCircle,
    /// Filled square.
    Square,
    /// Open square.
    OpenSquare,
    /// Filled triangle, point up.
    Triangle,
    /// Open triangle, point up.
    OpenTriangle,
    /// Filled diamond.
    Diamond,
    /// Diagonal cross.
    Cross,
}

impl Marker {
    const CYCLE: [Self; 7] = [
        Self::Circle,
        Self::Square,
        Self::Triangle,
        Self::OpenCircle,
        Self::Diamond,
        Self::OpenSquare,
        Self::OpenTriangle,
    ];

    pub(crate) fn of_index(i: usize) -> Self {
        Self::CYCLE[i % Self::CYCLE.len()]
    }
}

type Look = (Colour, Marker);

/// Looks of the paper's liquids, known by the first word of a name.
const OF_PAPER: [(&str, Look); 4] = [
    ("dry", (Colour::BLACK, Marker::OpenCircle)),
    ("pump", (Colour::GREEN, Marker::Triangle)),
    ("gear", (Colour::BLUE, Marker::Square)),
    ("motor", (Colour::VERMILION, Marker::Circle)),
];

/// Returns the colour and marker of a case among those of a figure: the paper's for the first that is
/// called as one of its liquids, another for each further one.
pub fn case_look(case: &str, among: &[&str]) -> Look {
    let own = |name: &str| {
        let first = name.split(|c: char| !c.is_alphanumeric()).next();
        OF_PAPER.iter().find(|of| first == Some(of.0))
    };
    let is_first = |at: usize| {
        let mut before = among[..at].iter();
        own(among[at]).is_some_and(|of| before.all(|name| own(name) != Some(of)))
    };
    let at = among.iter().position(|name| *name == case);
    if let Some((_, look)) = own(case)
        && at.is_none_or(is_first)
    {
        return *look;
    }
    let before = (0..at.unwrap_or(among.len())).filter(|at| !is_first(*at)).count();
    // The palette has the four of above first.
    let count = Colour::PALETTE.len();
    let looks = (0..count * count)
        .map(|i| (Colour::PALETTE[(i + 4) % count], Marker::of_index(i + 4 + i / count)));
    let is_free = |look: &Look| OF_PAPER.iter().all(|of| of.1 != *look);
    looks.filter(is_free).cycle().nth(before).unwrap_or(OF_PAPER[0].1)
}

/// One data set of a chart: a line, points or a band.
///
/// Points that are not finite, or not positive on a logarithmic axis, are left
/// out and break the line.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    pub(crate) name: String,
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    pub(crate) kind: SeriesKind,
    pub(crate) colour: Option<Colour>,
    pub(crate) dash: Option<Dash>,
    pub(crate) width: f64,
    pub(crate) x_error: Vec<f64>,
    /// Lengths of the bars below and above each point.
    pub(crate) y_error: (Vec<f64>, Vec<f64>),
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum SeriesKind {
    Line,
    Points(Option<Marker>),
    LinePoints(Marker),
    /// Between `y` (lower) and these upper values.
    Band(Vec<f64>),
}

impl Series {
    fn new(name: &str, x: &[f64], y: &[f64], kind: SeriesKind) -> Self {
        Self {
            name: name.into(),
            x: x.to_vec(),
            y: y.to_vec(),
            kind,
            colour: None,
            dash: None,
            width: 1.0,
            x_error: Vec::new(),
            y_error: (Vec::new(), Vec::new()),
        }
    }

    /// A line through the points. An empty name keeps it out of the legend.
    pub fn line(name: &str, x: &[f64], y: &[f64]) -> Self {
        Self::new(name, x, y, SeriesKind::Line)
    }

    /// Separate points.
    pub fn points(name: &str, x: &[f64], y: &[f64]) -> Self {
        Self::new(name, x, y, SeriesKind::Points(None))
    }

    /// A shaded area between two curves.
    pub fn band(name: &str, x: &[f64], lower: &[f64], upper: &[f64]) -> Self {
        Self::new(name, x, lower, SeriesKind::Band(upper.to_vec()))
    }

    /// Sets the colour; without it the palette is walked through.
    pub fn colour(mut self, colour: Colour) -> Self {
        self.colour = Some(colour);
        self
    }

    /// Sets the line pattern; without it, lines of automatic colour differ by pattern too.
    pub fn dash(mut self, dash: Dash) -> Self {
        self.dash = Some(dash);
        self
    }

    /// Sets the marker; a line keeps its stroke and gains points.
    pub fn marker(mut self, marker: Marker) -> Self {
        self.kind = match self.kind {
            SeriesKind::Points(_) => SeriesKind::Points(Some(marker)),
            SeriesKind::Line | SeriesKind::LinePoints(_) => SeriesKind::LinePoints(marker),
            band @ SeriesKind::Band(_) => band,
        };
        self
    }

    /// Line width in points (1/72 inch); 1 by default.
    pub fn width(mut self, points: f64) -> Self {
        self.width = points.clamp(0.1, 10.0);
        self
    }

    /// Symmetric vertical error bars.
    pub fn y_error(self, error: &[f64]) -> Self {
        self.y_errors(error, error)
    }

    /// Vertical error bars of different lengths below and above.
    pub fn y_errors(mut self, below: &[f64], above: &[f64]) -> Self {
        self.y_error = (below.to_vec(), above.to_vec());
        self
    }

    /// Symmetric horizontal error bars.
    pub fn x_error(mut self, error: &[f64]) -> Self {
        self.x_error = error.to_vec();
        self
    }

    pub(crate) fn has_line(&self) -> bool {
        matches!(self.kind, SeriesKind::Line | SeriesKind::LinePoints(_))
    }

    pub(crate) fn is_band(&self) -> bool {
        matches!(self.kind, SeriesKind::Band(_))
    }

    /// All points, as far as both coordinates reach.
    pub(crate) fn xy(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.x.iter().copied().zip(self.y.iter().copied())
    }
}

// The look of a chart, in points: legible at the column width of a journal.

/// Font size of tick labels and legends.
pub(crate) const SMALL: f64 = 7.0;
/// Font size of axis labels.
pub(crate) const LABEL: f64 = 8.0;
/// Length of a labelled tick.
const TICK: f64 = 4.0;
/// Width of frame and ticks.
pub(crate) const FRAME: f64 = 0.6;
/// Half the size of a marker.
const MARKER: f64 = 2.1;
/// Free share at the ends of an axis.
const PAD: f64 = 0.04;

//! Data series and their look.

use crate::draw::Colour;

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

/// Returns the colour and marker of a case in every figure: the paper's for its liquids, known by
/// the first word of the name, else the next by `number`.
#[must_use]
pub fn case_look(case: &str, number: usize) -> (Colour, Marker) {
    match case.split(|c: char| !c.is_alphanumeric()).next() {
        Some("dry") => (Colour::BLACK, Marker::OpenCircle),
        Some("pump") => (Colour::GREEN, Marker::Triangle),
        Some("gear") => (Colour::BLUE, Marker::Square),
        Some("motor") => (Colour::VERMILION, Marker::Circle),
        // The palette has the four of above first.
        _ => (
            Colour::PALETTE[(number + 4) % Colour::PALETTE.len()],
            Marker::of_index(number + 4),
        ),
    }
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
    pub(crate) kind: Kind,
    pub(crate) colour: Option<Colour>,
    pub(crate) dash: Option<Dash>,
    pub(crate) width: f64,
    pub(crate) x_error: Vec<f64>,
    /// Lengths of the bars below and above each point.
    pub(crate) y_error: (Vec<f64>, Vec<f64>),
}

/// What a series is drawn as.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Kind {
    Line,
    Points(Option<Marker>),
    LinePoints(Marker),
    /// Between `y` (lower) and these upper values.
    Band(Vec<f64>),
}

impl Series {
    fn new(name: &str, x: &[f64], y: &[f64], kind: Kind) -> Self {
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
    #[must_use]
    pub fn line(name: &str, x: &[f64], y: &[f64]) -> Self {
        Self::new(name, x, y, Kind::Line)
    }

    /// Separate points.
    #[must_use]
    pub fn points(name: &str, x: &[f64], y: &[f64]) -> Self {
        Self::new(name, x, y, Kind::Points(None))
    }

    /// A shaded area between two curves.
    #[must_use]
    pub fn band(name: &str, x: &[f64], lower: &[f64], upper: &[f64]) -> Self {
        Self::new(name, x, lower, Kind::Band(upper.to_vec()))
    }

    /// Sets the colour; without it the palette is walked through.
    #[must_use]
    pub fn colour(mut self, colour: Colour) -> Self {
        self.colour = Some(colour);
        self
    }

    /// Sets the line pattern; without it, lines of automatic colour differ by pattern too.
    #[must_use]
    pub fn dash(mut self, dash: Dash) -> Self {
        self.dash = Some(dash);
        self
    }

    /// Sets the marker; a line keeps its stroke and gains points.
    #[must_use]
    pub fn marker(mut self, marker: Marker) -> Self {
        self.kind = match self.kind {
            Kind::Points(_) => Kind::Points(Some(marker)),
            Kind::Line | Kind::LinePoints(_) => Kind::LinePoints(marker),
            band @ Kind::Band(_) => band,
        };
        self
    }

    /// Line width in points (1/72 inch); 1 by default.
    #[must_use]
    pub fn width(mut self, points: f64) -> Self {
        self.width = points.clamp(0.1, 10.0);
        self
    }

    /// Symmetric vertical error bars.
    #[must_use]
    pub fn y_error(self, error: &[f64]) -> Self {
        self.y_errors(error, error)
    }

    /// Vertical error bars of different lengths below and above.
    #[must_use]
    pub fn y_errors(mut self, below: &[f64], above: &[f64]) -> Self {
        self.y_error = (below.to_vec(), above.to_vec());
        self
    }

    /// Symmetric horizontal error bars.
    #[must_use]
    pub fn x_error(mut self, error: &[f64]) -> Self {
        self.x_error = error.to_vec();
        self
    }

    pub(crate) fn has_line(&self) -> bool {
        matches!(self.kind, Kind::Line | Kind::LinePoints(_))
    }

    pub(crate) fn is_band(&self) -> bool {
        matches!(self.kind, Kind::Band(_))
    }

    /// All points, as far as both coordinates reach.
    pub(crate) fn xy(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.x.iter().copied().zip(self.y.iter().copied())
    }
}

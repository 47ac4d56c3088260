//! What a chart shows: axes, series, reference lines, inset.

use super::Series;
use crate::draw::Colour;
use crate::heat::HeatLayer;

/// One axis as asked for.
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

/// A horizontal or vertical line at a value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Reference {
    pub(crate) value: f64,
    pub(crate) label: String,
    pub(crate) vertical: bool,
}

/// Where the legend goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Legend {
    /// On free paper inside the frame, or above the frame if there is none.
    #[default]
    Auto,
    /// No legend.
    Off,
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
    pub(crate) references: Vec<Reference>,
    pub(crate) notes: Vec<String>,
    pub(crate) inset: Option<Box<Chart>>,
    pub(crate) legend: Legend,
    pub(crate) heat: Option<HeatLayer>,
}

impl Chart {
    /// An empty chart with linear axes.
    #[must_use]
    pub fn new(x_label: &str, y_label: &str) -> Self {
        let axis = |label: &str| Axis {
            label: label.into(),
            ..Axis::default()
        };
        Self {
            title: String::new(),
            x: axis(x_label),
            y: axis(y_label),
            series: Vec::new(),
            references: Vec::new(),
            notes: Vec::new(),
            inset: None,
            legend: Legend::default(),
            heat: None,
        }
    }

    /// A short title above the frame, beside the panel letter.
    #[must_use]
    pub fn title(mut self, title: &str) -> Self {
        self.title = title.into();
        self
    }

    /// Makes the x axis logarithmic.
    #[must_use]
    pub fn x_log(mut self) -> Self {
        self.x.log = true;
        self
    }

    /// Makes the x axis count: ticks at whole numbers alone.
    #[must_use]
    pub fn x_whole(mut self) -> Self {
        self.x.whole = true;
        self
    }

    /// Makes the y axis logarithmic.
    #[must_use]
    pub fn y_log(mut self) -> Self {
        self.y.log = true;
        self
    }

    /// Fixes the x range; ignored if it makes no axis.
    #[must_use]
    pub fn x_range(mut self, from: f64, to: f64) -> Self {
        self.x.range = Some((from, to));
        self
    }

    /// Fixes the y range; ignored if it makes no axis.
    #[must_use]
    pub fn y_range(mut self, from: f64, to: f64) -> Self {
        self.y.range = Some((from, to));
        self
    }

    /// Adds a series; later ones lie on top.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Adds a horizontal reference line.
    #[must_use]
    pub fn h_line(self, y: f64, label: &str) -> Self {
        self.reference(y, label, false)
    }

    /// Adds a vertical reference line.
    #[must_use]
    pub fn v_line(self, x: f64, label: &str) -> Self {
        self.reference(x, label, true)
    }

    fn reference(mut self, value: f64, label: &str, vertical: bool) -> Self {
        self.references.push(Reference {
            value,
            label: label.into(),
            vertical,
        });
        self
    }

    /// Adds a line of text in a free corner.
    #[must_use]
    pub fn note(mut self, text: &str) -> Self {
        self.notes.push(text.into());
        self
    }

    /// Adds a small chart in the freest corner. It has no legend or inset of its own.
    #[must_use]
    pub fn inset(mut self, mut chart: Chart) -> Self {
        chart.legend = Legend::Off;
        chart.inset = None;
        self.inset = Some(Box::new(chart));
        self
    }

    /// Says where the legend goes.
    #[must_use]
    pub fn legend(mut self, legend: Legend) -> Self {
        self.legend = legend;
        self
    }

    /// The colour series `index` is drawn in.
    pub(crate) fn colour_of(&self, index: usize) -> Colour {
        let chosen = self.series.get(index).and_then(|s| s.colour);
        chosen.unwrap_or_else(|| Colour::PALETTE[index % Colour::PALETTE.len()])
    }
}

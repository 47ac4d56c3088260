//! Sizes in points.

/// The look of a chart's frame and text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Style {
    /// Font size of tick labels and legends.
    pub(crate) small: f64,
    /// Font size of axis labels.
    pub(crate) label: f64,
    /// Length of a labelled tick.
    pub(crate) tick: f64,
    /// Width of frame and ticks.
    pub(crate) frame: f64,
    /// Half the size of a marker.
    pub(crate) marker: f64,
    /// Factor on line widths.
    pub(crate) line: f64,
    /// Free share at the ends of an axis.
    pub(crate) pad: f64,
}

impl Style {
    /// Legible at the column width of a journal.
    pub(crate) const JOURNAL: Self = Self {
        small: 7.0,
        label: 8.0,
        tick: 4.0,
        frame: 0.6,
        marker: 2.1,
        line: 1.0,
        pad: 0.04,
    };

    /// For a chart inside a chart.
    pub(crate) const INSET: Self = Self {
        small: 6.4,
        label: 7.0,
        tick: 2.6,
        frame: 0.5,
        marker: 1.4,
        line: 0.8,
        pad: 0.06,
    };
}

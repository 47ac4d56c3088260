//! Maps of a quantity over two axes, as in a space-time diagram.

mod bar;
mod raster;

pub(crate) use bar::{draw_bar, room as bar_room};
pub(crate) use raster::draw;

use crate::chart::Chart;
use crate::draw::ColourMap;

/// Values on a regular grid, to be shown as colours.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatMap {
    columns: usize,
    rows: usize,
    values: Vec<f64>,
    pub(crate) x: (f64, f64),
    pub(crate) y: (f64, f64),
    map: ColourMap,
    limits: Option<(f64, f64)>,
    label: String,
}

pub(crate) use HeatMap as HeatLayer;

impl HeatMap {
    /// `values` row by row: `rows` rows of `columns` values each. The first row
    /// lies at the lower end of the y axis. Missing values count as not a number.
    #[must_use]
    pub fn new(columns: usize, rows: usize, values: &[f64]) -> Self {
        let number = |n: usize| n as f64;
        Self {
            columns,
            rows,
            values: values.to_vec(),
            x: (0.0, number(columns.max(1))),
            y: (0.0, number(rows.max(1))),
            map: ColourMap::Sequential,
            limits: None,
            label: String::new(),
        }
    }

    /// Outer edges of the first and last column on the x axis.
    #[must_use]
    pub fn x_edges(mut self, from: f64, to: f64) -> Self {
        self.x = (from, to);
        self
    }

    /// Outer edges of the first and last row on the y axis.
    #[must_use]
    pub fn y_edges(mut self, from: f64, to: f64) -> Self {
        self.y = (from, to);
        self
    }

    /// Chooses the colour map; sequential by default.
    #[must_use]
    pub fn colours(mut self, map: ColourMap) -> Self {
        self.map = map;
        self
    }

    /// Values at the ends of the colour bar; by default those of the data,
    /// symmetric about zero for a diverging map.
    #[must_use]
    pub fn limits(mut self, from: f64, to: f64) -> Self {
        self.limits = Some((from, to));
        self
    }

    /// Label of the colour bar.
    #[must_use]
    pub fn label(mut self, label: &str) -> Self {
        self.label = label.into();
        self
    }

    /// Lowest and highest value of the colour bar.
    fn range(&self) -> (f64, f64) {
        let asked = self
            .limits
            .filter(|(a, b)| a.is_finite() && b.is_finite() && a < b);
        asked.unwrap_or_else(|| self.data_range())
    }

    fn data_range(&self) -> (f64, f64) {
        let finite = self.values.iter().copied().filter(|v| v.abs() <= 1e300);
        let (lo, hi) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), v| {
            (lo.min(v), hi.max(v))
        });
        let largest = lo.abs().max(hi.abs());
        if lo > hi || largest < 1e-290 {
            (0.0, 1.0)
        } else if self.map == ColourMap::Diverging {
            (-largest, largest)
        } else if hi - lo <= 1e-8 * largest {
            (lo - 0.5 * largest, hi + 0.5 * largest)
        } else {
            (lo, hi)
        }
    }
}

impl Chart {
    /// Lays a map under the series of this chart.
    #[must_use]
    pub fn heat(mut self, map: HeatMap) -> Self {
        self.heat = Some(map);
        self
    }
}

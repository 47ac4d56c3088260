//! Scales, ticks and the room they need, before anything is drawn.

use super::config::{Axis, Chart};
use super::legend::LegendBox;
use super::placement::{self, Spot};
use super::plot::Plot;
use super::series::{Kind, Series};
use super::style::Style;
use crate::axis::{Extent, Room, Scale, Ticks, ticks};
use crate::draw::{Rect, Side};
use crate::heat;
use crate::text::TextLine;

/// A chart with its scales and ticks chosen for a frame size.
#[derive(Debug, Clone)]
pub(crate) struct Prepared {
    pub(crate) x: Scale,
    pub(crate) y: Scale,
    pub(crate) x_ticks: Ticks,
    pub(crate) y_ticks: Ticks,
    pub(crate) style: Style,
    pub(crate) spot: Spot,
}

impl Prepared {
    /// Chooses scales, ticks and the legend's side of the frame, for a frame of
    /// about the given size. `spot` is where the legend was found to stand before.
    pub(crate) fn new(
        chart: &Chart,
        style: Style,
        (width, height): (f64, f64),
        spot: Option<Spot>,
    ) -> Self {
        let plot = Plot {
            frame: Rect::sized(0.0, 0.0, width, height),
            x: x_scale(chart, &style),
            y: y_scale(chart, &style),
        };
        let (y, spot) = placement::choose(chart, &style, &plot, spot);
        let x = plot.x;
        let font = style.small;
        let x_room = Room {
            length: width,
            font,
            side_by_side: true,
        };
        let y_room = Room {
            length: height,
            font,
            side_by_side: false,
        };
        Self {
            x,
            y,
            x_ticks: match chart.x.whole {
                true => ticks(&x, &x_room).whole(),
                false => ticks(&x, &x_room),
            },
            y_ticks: ticks(&y, &y_room),
            style,
            spot,
        }
    }

    /// Room for tick labels, axis labels and colour bar around the frame.
    pub(crate) fn margins(&self, chart: &Chart, frame: (f64, f64)) -> Side {
        let style = &self.style;
        let line = |text: &str| TextLine::new(text, style.label);
        let mut side = Side {
            left: 2.0,
            right: 2.0,
            top: 0.55 * style.small,
            bottom: 2.0,
        };
        if !chart.y.unlabelled {
            side.left = self.y_label_width() + 3.5;
            if !chart.y.label.is_empty() {
                side.left += line(&chart.y.label).height() + 2.0;
            }
        }
        if !chart.x.unlabelled {
            side.bottom = 1.35 * style.small + 3.0;
            if !chart.x.label.is_empty() || self.x_ticks.exponent.is_some() {
                side.bottom += line(&chart.x.label).height() + 1.5;
            }
            let (left, right) = self.overhang(frame.0);
            side.left = side.left.max(left);
            side.right = side.right.max(right);
        }
        let (bar, above) = match &chart.heat {
            Some(map) => heat::bar_room(map, style, frame.1),
            None => (0.0, 0.0),
        };
        side.right += bar;
        side.top += self.factor_room().max(above);
        if self.spot == Spot::Above {
            side.top += LegendBox::flat(chart, style, frame.0).height();
        }
        side
    }

    /// Room above the frame for a power of ten.
    pub(crate) fn factor_room(&self) -> f64 {
        match self.y_ticks.exponent {
            Some(_) => 1.5 * self.style.small,
            None => 0.0,
        }
    }

    fn y_label_width(&self) -> f64 {
        let widths = self
            .y_ticks
            .major
            .iter()
            .map(|t| TextLine::new(&t.label, self.style.small).width());
        widths.fold(0.0, f64::max)
    }

    /// How far the outermost x tick labels reach beyond the frame.
    fn overhang(&self, frame_width: f64) -> (f64, f64) {
        let (mut left, mut right) = (0.0_f64, 0.0_f64);
        for tick in &self.x_ticks.major {
            let half = 0.5 * TextLine::new(&tick.label, self.style.small).width();
            if let Some(share) = self.x.share(tick.value) {
                left = left.max(half - share * frame_width);
                right = right.max(half - (1.0 - share) * frame_width);
            }
        }
        (left + 1.5, right + 1.5)
    }
}

/// The x scale of a chart: as asked for, or around the data.
pub(crate) fn x_scale(chart: &Chart, style: &Style) -> Scale {
    let mut extent = Extent::new(chart.x.log);
    chart.series.iter().for_each(|s| add_x(&mut extent, s));
    if let Some(layer) = &chart.heat {
        extent.add(layer.x.0);
        extent.add(layer.x.1);
    }
    chosen(&chart.x).unwrap_or_else(|| with_air(chart, extent, style.pad))
}

/// Lines and maps fill the frame from edge to edge; points near an edge need air there.
fn with_air(chart: &Chart, extent: Extent, pad: f64) -> Scale {
    let (tight, airy) = (extent.scale(0.0), extent.scale(pad));
    let mut points = Extent::new(chart.x.log);
    let dotted = chart
        .series
        .iter()
        .filter(|s| matches!(s.kind, Kind::Points(_) | Kind::LinePoints(_)));
    dotted.for_each(|s| add_x(&mut points, s));
    let Some((first, last)) = points.ends().filter(|_| chart.heat.is_none()) else {
        return tight;
    };
    let near = |value: f64, edge: f64| tight.share(value).is_some_and(|s| (s - edge).abs() < pad);
    let lo = if near(first, 0.0) { airy.lo } else { tight.lo };
    let hi = if near(last, 1.0) { airy.hi } else { tight.hi };
    Scale { lo, hi, ..tight }
}

fn add_x(extent: &mut Extent, series: &Series) {
    for (i, (x, _)) in series.xy().enumerate() {
        let error = series.x_error.get(i).copied().unwrap_or(0.0);
        [x, x - error, x + error]
            .into_iter()
            .for_each(|v| extent.add(v));
    }
}

/// The y scale of a chart: as asked for, or around the data.
pub(crate) fn y_scale(chart: &Chart, style: &Style) -> Scale {
    let mut extent = Extent::new(chart.y.log);
    let x = x_scale(chart, style);
    for series in &chart.series {
        add_y(&mut extent, series, &x);
    }
    if let Some(layer) = &chart.heat {
        extent.add(layer.y.0);
        extent.add(layer.y.1);
    }
    let pad = if chart.heat.is_some() || areas_only(chart) {
        0.0
    } else {
        1.5 * style.pad
    };
    chosen(&chart.y).unwrap_or_else(|| extent.scale(pad))
}

fn add_y(extent: &mut Extent, series: &Series, x: &Scale) {
    for (i, (_, y)) in series.xy().enumerate().filter(|(_, (at, _))| x.holds(*at)) {
        extent.add(y);
        let error = |e: &[f64]| e.get(i).copied().unwrap_or(0.0);
        extent.add(y - error(&series.y_error.0));
        extent.add(y + error(&series.y_error.1));
        if let Kind::Band(upper) = &series.kind {
            upper.get(i).into_iter().for_each(|v| extent.add(*v));
        }
    }
}

/// Stacked areas fill their frame.
pub(crate) fn areas_only(chart: &Chart) -> bool {
    !chart.series.is_empty() && chart.series.iter().all(Series::is_band)
}

fn chosen(axis: &Axis) -> Option<Scale> {
    axis.range
        .and_then(|(from, to)| Scale::fixed(from, to, axis.log))
}

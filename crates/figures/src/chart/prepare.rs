//! Scales, ticks and the room they need, before anything is drawn.

use super::config::{Axis, Chart, Legend};
use super::legend::LegendBox;
use super::occupancy::{Occupancy, places};
use super::plot::Plot;
use super::series::{Kind, Series};
use super::strokes;
use super::style::Style;
use crate::axis::{Extent, Room, Scale, Ticks, ticks};
use crate::draw::{Point, Rect, Side};
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
}

impl Prepared {
    /// Chooses scales and ticks for a frame of about the given size.
    pub(crate) fn new(chart: &Chart, style: Style, width: f64, height: f64) -> Self {
        let (x, mut y) = (x_scale(chart, &style), y_scale(chart, &style));
        if chart.y.range.is_none() && chart.heat.is_none() {
            y = with_headroom(
                chart,
                &style,
                Plot {
                    frame: Rect::sized(0.0, 0.0, width, height),
                    x,
                    y,
                },
            );
        }
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
            x_ticks: ticks(&x, &x_room),
            y_ticks: ticks(&y, &y_room),
            style,
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
        let factor = if self.y_ticks.exponent.is_some() {
            1.5 * style.small
        } else {
            0.0
        };
        side.right += bar;
        side.top += factor.max(above);
        side
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
fn areas_only(chart: &Chart) -> bool {
    !chart.series.is_empty() && chart.series.iter().all(Series::is_band)
}

fn chosen(axis: &Axis) -> Option<Scale> {
    axis.range
        .and_then(|(from, to)| Scale::fixed(from, to, axis.log))
}

/// Raises the upper end of the y axis if the legend would else hide data.
fn with_headroom(chart: &Chart, style: &Style, plot: Plot) -> Scale {
    let legend = LegendBox::new(chart, style, 0.9 * plot.frame.width());
    let needed = legend.height() + 4.0;
    let height = plot.frame.height();
    if chart.legend == Legend::Off
        || legend.is_empty()
        || needed > 0.4 * height
        || areas_only(chart)
    {
        return plot.y;
    }
    let mut taken = occupancy(chart, style, &plot);
    if chart.inset.is_some() {
        super::inset::place(chart, &plot.frame, &mut taken);
    }
    let inner = plot.frame.grown(-style.tick - 1.0);
    let free = taken.freest(&places(&inner, legend.width(), legend.height()));
    if free.is_none_or(|(_, cost)| cost == 0) {
        return plot.y;
    }
    let raised = plot.y.value(height / (height - needed));
    Scale::fixed(plot.y.lo, raised, plot.y.log).unwrap_or(plot.y)
}

/// Where the data of a chart lie.
pub(crate) fn occupancy(chart: &Chart, style: &Style, plot: &Plot) -> Occupancy {
    let mut taken = Occupancy::new(plot.frame);
    for series in &chart.series {
        for piece in strokes::pieces(plot, series)
            .iter()
            .filter(|_| series.has_line())
        {
            taken.mark_line(piece, 3);
        }
        mark_points(&mut taken, style, plot, series);
    }
    for reference in &chart.references {
        super::references::mark(&mut taken, plot, reference);
    }
    taken
}

fn mark_points(taken: &mut Occupancy, style: &Style, plot: &Plot, series: &Series) {
    for outline in strokes::band(plot, series) {
        taken.mark_line(&outline, 1);
    }
    if matches!(series.kind, Kind::Points(_) | Kind::LinePoints(_)) {
        let r = style.marker + 1.0;
        for p in strokes::centres(plot, series) {
            taken.mark_rect(&Rect::sized(p.x - r, p.y - r, 2.0 * r, 2.0 * r), 4);
        }
        mark_errors(taken, plot, series);
    }
}

fn mark_errors(taken: &mut Occupancy, plot: &Plot, series: &Series) {
    for (i, (x, y)) in series.xy().enumerate().take(series.y_error.0.len()) {
        let end = |dy: f64| plot.at(x, y + dy).map(|p| Point::new(p.x, p.y));
        let below = series.y_error.0.get(i).and_then(|e| end(-e));
        let above = series.y_error.1.get(i).and_then(|e| end(*e));
        if let (Some(a), Some(b)) = (below, above) {
            taken.mark_line(&[a, b], 3);
        }
    }
}

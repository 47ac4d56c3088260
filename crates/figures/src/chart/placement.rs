//! Where a legend stands: on free paper inside the frame if there is some or if
//! a higher y axis makes some, above the frame otherwise. It never covers data
//! unless the page is too small for anything else.

use super::config::{Chart, Legend};
use super::legend::LegendBox;
use super::occupancy::{Occupancy, places};
use super::plot::Plot;
use super::prepare::areas_only;
use super::series::{Kind, Series};
use super::strokes;
use super::style::Style;
use crate::axis::Scale;
use crate::draw::Rect;

/// Largest share of the frame's height given to a legend inside, on top of the data.
const MOST_INSIDE: f64 = 0.4;
/// Largest share of the frame's height given to a legend above.
const MOST_ABOVE: f64 = 0.5;

/// Side of the frame on which a legend stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Spot {
    /// Within the frame.
    Inside,
    /// Between the frame and the heading.
    Above,
}

/// Chooses the spot, unless it is given, and the y scale that goes with it.
pub(crate) fn choose(
    chart: &Chart,
    style: &Style,
    plot: &Plot,
    given: Option<Spot>,
) -> (Scale, Spot) {
    let legend = LegendBox::stacked(chart, style, 0.9 * plot.frame.width());
    if chart.legend == Legend::Off || legend.is_empty() || given == Some(Spot::Above) {
        return (plot.y, given.unwrap_or(Spot::Inside));
    }
    let covered = chart.heat.is_some() || areas_only(chart);
    if !covered && hidden(chart, style, plot, &legend) == 0 {
        return (plot.y, Spot::Inside);
    }
    let raised = raised(chart, plot, legend.height() + 4.0).filter(|_| !covered);
    if let Some(y) = raised
        && hidden(chart, style, &Plot { y, ..*plot }, &legend) == 0
    {
        return (y, Spot::Inside);
    }
    let flat = LegendBox::flat(chart, style, plot.frame.width());
    let fits = flat.height() <= MOST_ABOVE * plot.frame.height();
    let spot = if fits { Spot::Above } else { Spot::Inside };
    (plot.y, given.unwrap_or(spot))
}

/// The y scale with free paper of the given height above the data.
fn raised(chart: &Chart, plot: &Plot, needed: f64) -> Option<Scale> {
    let height = plot.frame.height();
    if chart.y.range.is_some() || needed > MOST_INSIDE * height {
        return None;
    }
    let top = plot.y.value(height / (height - needed));
    Scale::fixed(plot.y.lo, top, plot.y.log)
}

/// What the legend hides at its best place inside.
fn hidden(chart: &Chart, style: &Style, plot: &Plot, legend: &LegendBox) -> u64 {
    let mut taken = occupancy(chart, style, plot);
    if chart.inset.is_some() {
        super::inset::place(chart, &plot.frame, &mut taken);
    }
    let best = inside(style, plot, legend, &taken);
    best.map_or(0, |(_, cost)| cost)
}

/// The freest place for a legend inside the frame and what it hides there.
pub(crate) fn inside(
    style: &Style,
    plot: &Plot,
    legend: &LegendBox,
    taken: &Occupancy,
) -> Option<(Rect, u64)> {
    let inner = plot.frame.grown(-style.tick - 1.0);
    taken.freest(&places(&inner, legend.width(), legend.height()))
}

/// Where the data of a chart lie.
pub(crate) fn occupancy(chart: &Chart, style: &Style, plot: &Plot) -> Occupancy {
    let mut taken = Occupancy::new(plot.frame);
    for series in &chart.series {
        if series.has_line() {
            for piece in strokes::pieces(plot, series) {
                taken.mark_line(&piece, 3);
            }
        }
        mark_band(&mut taken, plot, series);
        mark_points(&mut taken, style, plot, series);
    }
    for reference in &chart.references {
        super::references::mark(&mut taken, plot, reference);
    }
    taken
}

/// A band hides what lies on all of its area.
fn mark_band(taken: &mut Occupancy, plot: &Plot, series: &Series) {
    let Kind::Band(upper) = &series.kind else {
        return;
    };
    let edges = series.xy().zip(upper);
    let edges = edges.map(|((x, low), high)| plot.at(x, low).zip(plot.at(x, *high)));
    let edges: Vec<_> = edges.collect();
    for pair in edges.windows(2) {
        if let [Some((a, b)), Some((c, d))] = pair {
            let (low, high) = (a.y.max(c.y), b.y.min(d.y));
            let (left, right) = (a.x.min(c.x), a.x.max(c.x));
            let area = Rect::sized(left, low.min(high), right - left, (low - high).abs());
            taken.mark_rect(&area, 1);
        }
    }
}

fn mark_points(taken: &mut Occupancy, style: &Style, plot: &Plot, series: &Series) {
    if matches!(series.kind, Kind::Points(_) | Kind::LinePoints(_)) {
        let r = style.marker + 1.0;
        for p in strokes::centres(plot, series) {
            taken.mark_rect(&Rect::sized(p.x - r, p.y - r, 2.0 * r, 2.0 * r), 4);
        }
        mark_errors(taken, plot, series);
    }
}

fn mark_errors(taken: &mut Occupancy, plot: &Plot, series: &Series) {
    for (i, (x, y)) in series.xy().enumerate() {
        let end = |dx: f64, dy: f64| plot.at(x + dx, y + dy);
        let error = |of: &[f64]| of.get(i).copied();
        let (below, above) = (&series.y_error.0, &series.y_error.1);
        let upright = error(below).zip(error(above));
        let level = error(&series.x_error);
        let bars = [
            upright.and_then(|(b, a)| end(0.0, -b).zip(end(0.0, a))),
            level.and_then(|e| end(-e, 0.0).zip(end(e, 0.0))),
        ];
        for (a, b) in bars.into_iter().flatten() {
            taken.mark_line(&[a, b], 3);
        }
    }
}

//! Scales, ticks and legend of a chart and the room they need, before anything is drawn.

use super::{Axis, Chart, LABEL, PAD, SMALL, Series, SeriesKind, strokes};
use crate::axis::{Extent, Room, Scale, Ticks, ticks};
use crate::draw::{Canvas, Colour, Item, Margins, Point, Rect};
use crate::text::{Anchor, TextLine};

/// Two scales laid over a frame on the page.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plot {
    pub(crate) frame: Rect,
    pub(crate) x: Scale,
    pub(crate) y: Scale,
}

impl Plot {
    /// Where a data point lies; nothing if the axes cannot show it.
    pub(crate) fn at(&self, x: f64, y: f64) -> Option<Point> {
        Some(Point::new(self.x_at(x)?, self.y_at(y)?))
    }

    pub(crate) fn x_at(&self, x: f64) -> Option<f64> {
        Some(self.frame.x0 + self.x.share(x)? * self.frame.width())
    }

    pub(crate) fn y_at(&self, y: f64) -> Option<f64> {
        Some(self.frame.y1 - self.y.share(y)? * self.frame.height())
    }
}

/// A chart with its scales, ticks and legend chosen for a frame size.
pub(crate) struct Prepared<'a> {
    pub(super) chart: &'a Chart,
    pub(super) x: Scale,
    pub(super) y: Scale,
    pub(super) x_ticks: Ticks,
    pub(super) y_ticks: Ticks,
    pub(super) legend: LegendBox,
    size: (f64, f64),
}

impl<'a> Prepared<'a> {
    /// For a frame of about the given size.
    pub(crate) fn new(chart: &'a Chart, size: (f64, f64)) -> Self {
        let (x, y) = (x_scale(chart), y_scale(chart));
        let room = |length, side_by_side| Room { length, font: SMALL, side_by_side };
        let x_ticks = ticks(&x, &room(size.0, true));
        Self {
            x_ticks: if chart.x.whole { x_ticks.whole() } else { x_ticks },
            y_ticks: ticks(&y, &room(size.1, false)),
            legend: LegendBox::new(chart, size.0),
            chart,
            x,
            y,
            size,
        }
    }

    /// Room for tick labels, axis labels, legend and colour bar around the frame.
    pub(crate) fn margins(&self) -> Margins {
        let chart = self.chart;
        let height = |text: &str| TextLine::new(text, LABEL).height();
        let mut side = Margins { left: 2.0, right: 2.0, top: 0.55 * SMALL, bottom: 2.0 };
        if !chart.y.unlabelled {
            side.left = self.y_ticks.widest(SMALL) + 3.5;
            if !chart.y.label.is_empty() {
                side.left += height(&chart.y.label) + 2.0;
            }
        }
        if !chart.x.unlabelled {
            side.bottom = 1.35 * SMALL + 3.0;
            if !chart.x.label.is_empty() || self.x_ticks.exponent.is_some() {
                side.bottom += height(&chart.x.label) + 1.5;
            }
            let (left, right) = self.overhang();
            side.left = side.left.max(left);
            side.right = side.right.max(right);
        }
        let bar = chart.heat.as_ref().map(|map| map.bar_room(self.size.1));
        let (bar, above) = bar.unwrap_or_default();
        side.right += bar;
        side.top += self.factor_room().max(above) + self.legend.height();
        side
    }

    /// Room above the frame for a power of ten.
    pub(super) fn factor_room(&self) -> f64 {
        self.y_ticks.exponent.map_or(0.0, |_| 1.5 * SMALL)
    }

    /// How far the outermost x tick labels reach beyond the frame.
    fn overhang(&self) -> (f64, f64) {
        let (mut left, mut right) = (0.0_f64, 0.0_f64);
        for tick in &self.x_ticks.major {
            let half = 0.5 * TextLine::new(&tick.label, SMALL).width();
            if let Some(share) = self.x.share(tick.value) {
                left = left.max(half - share * self.size.0);
                right = right.max(half - (1.0 - share) * self.size.0);
            }
        }
        (left + 1.5, right + 1.5)
    }
}

/// The x scale of a chart: as asked for, or around the data. Lines and maps fill the frame from
/// edge to edge; points near an edge need air there.
pub(crate) fn x_scale(chart: &Chart) -> Scale {
    if let Some(scale) = chosen(&chart.x) {
        return scale;
    }
    let (mut all, mut points) = (Extent::new(chart.x.log), Extent::new(chart.x.log));
    for series in &chart.series {
        add_x(&mut all, series);
        if matches!(series.kind, SeriesKind::Points(_) | SeriesKind::LinePoints(_)) {
            add_x(&mut points, series);
        }
    }
    if let Some(map) = &chart.heat {
        all.extend([map.x_edges.0, map.x_edges.1]);
    }
    let (tight, airy) = (all.scale(0.0), all.scale(PAD));
    let Some((first, last)) = points.ends().filter(|_| chart.heat.is_none()) else {
        return tight;
    };
    let near =
        |value: f64, edge: f64| tight.share(value).is_some_and(|share| (share - edge).abs() < PAD);
    let lo = if near(first, 0.0) { airy.lo } else { tight.lo };
    let hi = if near(last, 1.0) { airy.hi } else { tight.hi };
    Scale { lo, hi, ..tight }
}

fn add_x(extent: &mut Extent, series: &Series) {
    for (i, (x, _)) in series.xy().enumerate() {
        let error = series.x_error.get(i).copied().unwrap_or(0.0);
        extent.extend([x, x - error, x + error]);
    }
}

/// The y scale of a chart: as asked for, or around the data.
fn y_scale(chart: &Chart) -> Scale {
    let mut extent = Extent::new(chart.y.log);
    let x = x_scale(chart);
    for series in &chart.series {
        for (i, (_, y)) in series.xy().enumerate().filter(|(_, (at, _))| x.holds(*at)) {
            let error = |e: &[f64]| e.get(i).copied().unwrap_or(0.0);
            let (below, above) = &series.y_error;
            extent.extend([y, y - error(below), y + error(above)]);
            if let SeriesKind::Band(upper) = &series.kind {
                extent.extend(upper.get(i).copied());
            }
        }
    }
    if let Some(map) = &chart.heat {
        extent.extend([map.y_edges.0, map.y_edges.1]);
    }
    // Maps and stacked areas fill their frame.
    let areas = !chart.series.is_empty() && chart.series.iter().all(Series::is_band);
    let pad = if chart.heat.is_some() || areas { 0.0 } else { 1.5 * PAD };
    chosen(&chart.y).unwrap_or_else(|| extent.scale(pad))
}

fn chosen(axis: &Axis) -> Option<Scale> {
    let (from, to) = axis.range?;
    Scale::fixed(from, to, axis.log)
}

/// The names of a chart's series beside samples of their look, and its notes, in rows above the
/// frame: there they hide nothing.
pub(super) struct LegendBox {
    entries: Vec<(usize, TextLine)>,
    notes: Vec<TextLine>,
    columns: usize,
    /// Length of the sample left of a name: that of a marker, or of a line.
    sample: f64,
}

/// Distances of lines and of columns.
const LEADING: f64 = 1.4 * SMALL;
const GAP: f64 = 1.2 * SMALL;

impl LegendBox {
    /// As few rows as `widest` allows, their columns aligned.
    fn new(chart: &Chart, widest: f64) -> Self {
        let named = chart.series.iter().enumerate();
        let named = named.filter(|(_, s)| chart.legend && !s.name.is_empty());
        let mut lines = named.clone().filter(|(_, s)| s.has_line() || s.is_band());
        let sample = if lines.next().is_some() { 2.6 * SMALL } else { SMALL };
        let room = widest - sample - 1.2 * SMALL;
        let entries = named.map(|(i, s)| (i, TextLine::new(&s.name, SMALL).shrunk_to(room)));
        let notes = chart.notes.iter().map(|note| TextLine::new(note, SMALL).shrunk_to(widest));
        let (entries, notes) = (entries.collect(), notes.collect());
        let mut legend = Self { entries, notes, columns: 1, sample };
        let most = ((widest + GAP) / (legend.cell() + GAP)).floor().max(1.0) as usize;
        let rows = legend.entries.len().div_ceil(most).max(1);
        legend.columns = legend.entries.len().div_ceil(rows).max(1);
        legend
    }

    fn cell(&self) -> f64 {
        let widths = self.entries.iter().map(|(_, name)| name.width());
        widths.fold(0.0, f64::max) + self.sample + SMALL
    }

    pub(super) fn height(&self) -> f64 {
        match self.entries.len().div_ceil(self.columns) + self.notes.len() {
            0 => 0.0,
            rows => rows as f64 * LEADING + 0.5 * SMALL,
        }
    }

    /// Draws the rows above `bottom`, in the middle of the frame.
    pub(super) fn draw(&self, canvas: &mut Canvas, chart: &Chart, middle: f64, bottom: f64) {
        let width = self.columns as f64 * (self.cell() + GAP) - GAP;
        let (left, top) = (middle - 0.5 * width, bottom - self.height());
        let row_at = |row: usize| top + 0.25 * SMALL + (row as f64 + 0.5) * LEADING;
        for (i, note) in self.notes.iter().enumerate() {
            let y = row_at(self.entries.len().div_ceil(self.columns) + i);
            note.draw(canvas, Point::new(middle, y), Anchor::MIDDLE, Colour::BLACK);
        }
        if self.entries.is_empty() {
            return;
        }
        let height = self.height() - self.notes.len() as f64 * LEADING;
        let place = Rect::sized(left, top, width, height).grown(-0.2 * SMALL);
        canvas.items.push(Item::Legend(place));
        for (number, (index, name)) in self.entries.iter().enumerate() {
            let (column, row) = (number % self.columns, number / self.columns);
            let left = left + 0.2 * SMALL + column as f64 * (self.cell() + GAP);
            let y = row_at(row);
            let sample = Rect::sized(left, y - 0.4 * SMALL, self.sample, 0.8 * SMALL);
            strokes::draw_sample(canvas, chart, *index, &sample);
            let at = Point::new(left + self.sample + 0.5 * SMALL, y);
            name.draw(canvas, at, Anchor::LEFT_MIDDLE, Colour::BLACK);
        }
        canvas.items.push(Item::LegendEnd);
    }
}

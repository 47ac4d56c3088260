//! Drawing a prepared chart into its frame.

use super::config::{Chart, Legend};
use super::legend::{LegendBox, band_paint, line_paint, marker_of};
use super::occupancy::{Occupancy, places};
use super::placement::{self, Spot, occupancy};
use super::plot::Plot;
use super::prepare::Prepared;
use super::{inset, markers, references, strokes};
use crate::axis::{Scale, Ticks};
use crate::draw::{Colour, Paint, PathData, Point, Rect, Svg};
use crate::heat;
use crate::text::{Anchor, TextLine};

impl Prepared {
    /// Draws everything: the data inside `frame`, the labels around it.
    pub(crate) fn draw(&self, svg: &mut Svg, chart: &Chart, frame: &Rect) {
        let plot = Plot {
            frame: *frame,
            x: self.x,
            y: self.y,
        };
        if let Some(layer) = &chart.heat {
            heat::draw(svg, layer, &plot);
            heat::draw_bar(svg, layer, frame, &self.style);
        }
        chart
            .references
            .iter()
            .for_each(|r| references::draw_line(svg, &plot, r));
        self.draw_series(svg, chart, &plot);
        self.draw_frame(svg, frame, chart.heat.is_some());
        self.draw_labels(svg, chart, frame);
        self.draw_extras(svg, chart, &plot);
    }

    fn draw_series(&self, svg: &mut Svg, chart: &Chart, plot: &Plot) {
        for (i, series) in chart.series.iter().enumerate().filter(|(_, s)| s.is_band()) {
            let mut path = PathData::new();
            for outline in strokes::band(plot, series) {
                path.polygon(&outline);
            }
            svg.path(&path, &band_paint(chart.colour_of(i)));
        }
        for i in 0..chart.series.len() {
            self.draw_strokes(svg, chart, plot, i);
        }
    }

    fn draw_strokes(&self, svg: &mut Svg, chart: &Chart, plot: &Plot, index: usize) {
        let Some(series) = chart.series.get(index) else {
            return;
        };
        let colour = chart.colour_of(index);
        if series.has_line() {
            let mut path = PathData::new();
            for piece in strokes::pieces(plot, series) {
                path.polyline(&piece);
            }
            svg.path(&path, &line_paint(chart, &self.style, index));
        }
        if let Some(marker) = marker_of(chart, index) {
            let bars = strokes::error_bars(plot, series, 0.7 * self.style.marker);
            svg.path(&bars, &Paint::line(colour, 0.6));
            let centres = strokes::centres(plot, series);
            markers::draw(svg, marker, &centres, self.style.marker, colour);
        }
    }

    /// The frame with inward ticks on all four sides.
    fn draw_frame(&self, svg: &mut Svg, frame: &Rect, over_map: bool) {
        let mut path = PathData::new();
        path.rect(frame);
        let (long, short) = (self.style.tick, 0.55 * self.style.tick);
        for (share, length) in tick_shares(&self.x, &self.x_ticks, long, short) {
            let x = frame.x0 + share * frame.width();
            path.segment(Point::new(x, frame.y1), Point::new(x, frame.y1 - length));
            path.segment(Point::new(x, frame.y0), Point::new(x, frame.y0 + length));
        }
        for (share, length) in tick_shares(&self.y, &self.y_ticks, long, short) {
            let y = frame.y1 - share * frame.height();
            path.segment(Point::new(frame.x0, y), Point::new(frame.x0 + length, y));
            path.segment(Point::new(frame.x1, y), Point::new(frame.x1 - length, y));
        }
        if over_map {
            // A light rim keeps ticks visible over dark colours.
            svg.path(
                &path,
                &Paint::line(Colour::WHITE, 2.2 * self.style.frame).opacity(0.7),
            );
        }
        svg.path(&path, &Paint::line(Colour::BLACK, self.style.frame));
    }

    fn draw_labels(&self, svg: &mut Svg, chart: &Chart, frame: &Rect) {
        if !chart.x.unlabelled {
            self.draw_x_labels(svg, chart, frame);
        }
        if !chart.y.unlabelled {
            self.draw_y_labels(svg, chart, frame);
        }
    }

    fn draw_x_labels(&self, svg: &mut Svg, chart: &Chart, frame: &Rect) {
        let (small, ink) = (self.style.small, Colour::BLACK);
        let baseline = frame.y1 + 3.0 + 0.85 * small;
        for tick in &self.x_ticks.major {
            let x = frame.x0 + self.x.share(tick.value).unwrap_or(0.0) * frame.width();
            TextLine::new(&tick.label, small).draw(
                svg,
                Point::new(x, baseline),
                Anchor::CENTRE,
                ink,
            );
        }
        let mut room = frame.width();
        let label = TextLine::new(&chart.x.label, self.style.label);
        let y = frame.y1 + 3.0 + 1.35 * small + label.ascent();
        if let Some(factor) = power(self.x_ticks.exponent, small) {
            factor.draw(svg, Point::new(frame.x1, y), Anchor::RIGHT, ink);
            room -= 2.0 * factor.width() + small;
        }
        label
            .shrunk_to(room)
            .draw(svg, Point::new(frame.centre().x, y), Anchor::CENTRE, ink);
    }

    fn draw_y_labels(&self, svg: &mut Svg, chart: &Chart, frame: &Rect) {
        let (small, ink) = (self.style.small, Colour::BLACK);
        let mut widest = 0.0_f64;
        for tick in &self.y_ticks.major {
            let y = frame.y1 - self.y.share(tick.value).unwrap_or(0.0) * frame.height();
            let line = TextLine::new(&tick.label, small);
            widest = widest.max(line.width());
            line.draw(
                svg,
                Point::new(frame.x0 - 2.5, y),
                Anchor::RIGHT_MIDDLE,
                ink,
            );
        }
        if let Some(factor) = power(self.y_ticks.exponent, small) {
            let at = Point::new(frame.x0, frame.y0 - 0.6 * small);
            factor.draw(svg, at, Anchor::LEFT, ink);
        }
        let label =
            TextLine::new(&chart.y.label, self.style.label).shrunk_to(1.08 * frame.height());
        let x = frame.x0 - 2.5 - widest - 2.0 - label.descent();
        label.draw_turned(
            svg,
            Point::new(x, frame.centre().y),
            Anchor::CENTRE,
            ink,
            90.0,
        );
    }

    /// Inset, legend, notes and labels of reference lines, each where it hides least.
    fn draw_extras(&self, svg: &mut Svg, chart: &Chart, plot: &Plot) {
        let mut taken = occupancy(chart, &self.style, plot);
        if let (Some(area), Some(inner)) =
            (inset::place(chart, &plot.frame, &mut taken), &chart.inset)
        {
            inset::draw(svg, inner, &area);
        }
        for reference in &chart.references {
            references::draw_label(svg, plot, &self.style, reference, &mut taken);
        }
        self.draw_legend(svg, chart, plot, &mut taken);
        self.draw_notes(svg, chart, plot, &mut taken);
    }

    fn draw_legend(&self, svg: &mut Svg, chart: &Chart, plot: &Plot, taken: &mut Occupancy) {
        if chart.legend == Legend::Off {
            return;
        }
        if self.spot == Spot::Above {
            return self.draw_legend_above(svg, chart, &plot.frame);
        }
        let legend = LegendBox::stacked(chart, &self.style, 0.9 * plot.frame.width());
        if legend.is_empty() {
            return;
        }
        if let Some((place, cost)) = placement::inside(&self.style, plot, &legend, taken) {
            let veil = cost > 0 || chart.heat.is_some();
            legend.draw(svg, chart, &self.style, &place, veil);
            taken.mark_rect(&place, 9);
        }
    }

    fn draw_legend_above(&self, svg: &mut Svg, chart: &Chart, frame: &Rect) {
        let legend = LegendBox::flat(chart, &self.style, frame.width());
        let bottom = frame.y0 - self.factor_room() - 0.3 * self.style.small;
        let left = frame.centre().x - 0.5 * legend.width();
        let top = bottom - legend.height();
        let place = Rect::sized(left, top, legend.width(), legend.height());
        legend.draw(svg, chart, &self.style, &place, false);
    }

    fn draw_notes(&self, svg: &mut Svg, chart: &Chart, plot: &Plot, taken: &mut Occupancy) {
        let inner = plot.frame.grown(-self.style.tick - 2.0);
        for note in &chart.notes {
            let line = TextLine::new(note, self.style.small).shrunk_to(inner.width());
            let places = places(&inner, line.width(), 1.3 * self.style.small);
            if let Some((place, _)) = taken.freest(&places) {
                taken.mark_rect(&place, 9);
                line.draw(svg, place.centre(), Anchor::MIDDLE, Colour::BLACK);
            }
        }
    }
}

/// Places of ticks along the axis, as shares, with their lengths.
fn tick_shares(scale: &Scale, ticks: &Ticks, long: f64, short: f64) -> Vec<(f64, f64)> {
    let major = ticks.major.iter().map(|t| (t.value, long));
    let minor = ticks.minor.iter().map(|v| (*v, short));
    let placed = major
        .chain(minor)
        .filter_map(|(v, length)| Some((scale.share(v)?, length)));
    placed
        .filter(|(share, _)| (0.0..=1.0).contains(share))
        .collect()
}

/// `×10^n` beside an axis whose labels leave a power of ten out.
fn power(exponent: Option<i32>, size: f64) -> Option<TextLine> {
    exponent.map(|n| TextLine::new(&format!(r"$\times10^{{{n}}}$"), size))
}

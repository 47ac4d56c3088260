//! Series as strokes on the page: broken at gaps, cut at the frame, thinned to what a printed
//! pixel can show.

use super::{Chart, Dash, MARKER, Marker, Plot, Series, SeriesKind};
use crate::axis::Scale;
use crate::draw::{Canvas, Colour, Paint, PathData, Point, Rect, clip_segment};
use std::collections::BTreeSet;

/// Width of a column in points: a pixel at 300 dpi.
const COLUMN: f64 = 0.24;
/// Shorter lines are drawn as they are.
const FEW: usize = 2000;

/// Thins one unbroken line: the points of a pixel column are replaced by their ends and extremes.
fn thinned(points: Vec<Point>) -> Vec<Point> {
    if points.len() <= FEW {
        return points;
    }
    let column = |p: &Point| (p.x / COLUMN).floor();
    let runs = points.chunk_by(|a, b| column(a) == column(b));
    let by_y = |a: &(usize, &Point), b: &(usize, &Point)| a.1.y.total_cmp(&b.1.y);
    let kept = |run: &[Point]| {
        let extremes = [run.iter().enumerate().min_by(by_y), run.iter().enumerate().max_by(by_y)];
        let extremes = extremes.into_iter().flatten().map(|(i, _)| i);
        let keep: BTreeSet<usize> = extremes.chain([0, run.len() - 1]).collect();
        keep.into_iter().map(|i| run[i]).collect::<Vec<_>>()
    };
    runs.flat_map(kept).collect()
}

/// Drops points that a printed pixel cannot distinguish from an earlier one.
fn distinct(points: Vec<Point>) -> Vec<Point> {
    let mut seen = BTreeSet::new();
    let pixel = |v: f64| (v / COLUMN).round() as i64;
    let many = points.len() > FEW;
    let new = |p: &Point| !many || seen.insert((pixel(p.x), pixel(p.y)));
    points.into_iter().filter(new).collect()
}

/// Unbroken pieces of a line inside the frame.
pub(super) fn pieces(plot: &Plot, series: &Series) -> Vec<Vec<Point>> {
    let mut out: Vec<Vec<Point>> = Vec::new();
    for run in unbroken(series.xy().map(|(x, y)| plot.at(x, y))) {
        let mut piece: Vec<Point> = Vec::new();
        for pair in thinned(run).windows(2) {
            let inside = clip_segment(&plot.frame, pair[0], pair[1]);
            if inside.is_none_or(|(a, _)| piece.last() != Some(&a)) {
                out.push(std::mem::take(&mut piece));
                piece.extend(inside.map(|(a, _)| a));
            }
            piece.extend(inside.map(|(_, b)| b));
        }
        out.push(piece);
    }
    out.retain(|piece| !piece.is_empty());
    out
}

/// Splits where a point is missing.
fn unbroken(points: impl Iterator<Item = Option<Point>>) -> Vec<Vec<Point>> {
    let points: Vec<Option<Point>> = points.collect();
    let runs = points.split(Option::is_none).filter(|run| !run.is_empty());
    runs.map(|run| run.iter().copied().flatten().collect()).collect()
}

pub(super) fn centres(plot: &Plot, series: &Series) -> Vec<Point> {
    let inside = plot.frame.grown(0.01);
    let points = series.xy().filter_map(|(x, y)| plot.at(x, y));
    distinct(points.filter(|p| inside.contains(*p)).collect())
}

/// Outlines of a band, held to the frame.
fn band(plot: &Plot, series: &Series, upper: &[f64]) -> Vec<Vec<Point>> {
    let frame = plot.frame;
    let hold = |p: Point| Point::new(p.x.clamp(frame.x0, frame.x1), p.y.clamp(frame.y0, frame.y1));
    let held = |run: Vec<Point>| thinned(run).into_iter().map(hold).collect::<Vec<_>>();
    let edges = series.xy().zip(upper);
    let edges: Vec<Option<(Point, Point)>> =
        edges.map(|((x, low), high)| plot.at(x, low).zip(plot.at(x, *high))).collect();
    let runs = edges.split(Option::is_none).filter(|run| !run.is_empty());
    let outline = |run: &[Option<(Point, Point)>]| {
        let (low, high): (Vec<Point>, Vec<Point>) = run.iter().copied().flatten().unzip();
        let mut outline = held(low);
        outline.extend(held(high).into_iter().rev());
        outline
    };
    runs.map(outline).collect()
}

/// Both ends of each error bar, with the centre and the direction of its caps. On a logarithmic
/// axis a bar may reach below zero: it then runs out of the frame.
pub(super) fn error_bars(plot: &Plot, series: &Series) -> Vec<(Point, [Option<Point>; 2], Point)> {
    let lowest = |v: f64, scale: &Scale| match scale.log && v <= 0.0 {
        true => scale.lo * 1e-3,
        false => v,
    };
    let end = |x: f64, y: f64| plot.at(lowest(x, &plot.x), lowest(y, &plot.y));
    let mut bars = Vec::new();
    for (i, (x, y)) in series.xy().enumerate() {
        let Some(centre) = plot.at(x, y).filter(|p| plot.frame.contains(*p)) else {
            continue;
        };
        if let (Some(below), Some(above)) = (series.y_error.0.get(i), series.y_error.1.get(i)) {
            bars.push((centre, [end(x, y - below), end(x, y + above)], Point::new(1.0, 0.0)));
        }
        if let Some(error) = series.x_error.get(i) {
            bars.push((centre, [end(x - error, y), end(x + error, y)], Point::new(0.0, 1.0)));
        }
    }
    bars
}

fn draw_error_bars(canvas: &mut Canvas, plot: &Plot, series: &Series, size: f64, colour: Colour) {
    let mut path = PathData::default();
    for (centre, ends, cap) in error_bars(plot, series) {
        for end in ends.into_iter().flatten() {
            let Some((_, reached)) = clip_segment(&plot.frame, centre, end) else {
                continue;
            };
            path.segment(centre, reached);
            if reached == end {
                let (dx, dy) = (size * cap.x, size * cap.y);
                path.segment(
                    Point::new(end.x - dx, end.y - dy),
                    Point::new(end.x + dx, end.y + dy),
                );
            }
        }
    }
    canvas.path(&path, &Paint::line(colour, 0.6));
}

/// Draws all series: bands below, then lines and points in their order.
pub(super) fn draw(canvas: &mut Canvas, chart: &Chart, plot: &Plot) {
    for (i, series) in chart.series.iter().enumerate() {
        if let SeriesKind::Band(upper) = &series.kind {
            let mut path = PathData::default();
            for outline in band(plot, series, upper) {
                path.polygon(&outline);
            }
            canvas.path(&path, &band_paint(chart.colour_of(i)));
        }
    }
    for (i, series) in chart.series.iter().enumerate() {
        let colour = chart.colour_of(i);
        if series.has_line() {
            let mut path = PathData::default();
            for piece in pieces(plot, series) {
                path.polyline(&piece);
            }
            canvas.path(&path, &line_paint(chart, i));
        }
        if let Some(marker) = marker_of(series, i) {
            draw_error_bars(canvas, plot, series, 0.7 * MARKER, colour);
            draw_markers(canvas, marker, &centres(plot, series), MARKER, colour);
        }
    }
}

/// Draws a sample of a series into a box of a legend.
pub(super) fn draw_sample(canvas: &mut Canvas, chart: &Chart, index: usize, place: &Rect) {
    let (series, colour) = (&chart.series[index], chart.colour_of(index));
    let middle = place.centre();
    if series.is_band() {
        canvas.rect(place, &band_paint(colour));
    }
    if series.has_line() {
        let ends = [place.x0, place.x1].map(|x| Point::new(x, middle.y));
        canvas.segment(ends[0], ends[1], &line_paint(chart, index));
    }
    if let Some(marker) = marker_of(series, index) {
        draw_markers(canvas, marker, &[middle], MARKER, colour);
    }
}

/// Shading of an area, with an edge for grey print.
fn band_paint(colour: Colour) -> Paint {
    let edge = colour.mixed(Colour::WHITE, 0.25);
    Paint::fill(colour.mixed(Colour::WHITE, 0.72)).outlined(edge, 0.4)
}

/// Stroke of a line series: those of automatic colour differ by pattern too.
fn line_paint(chart: &Chart, index: usize) -> Paint {
    let series = &chart.series[index];
    let before = chart.series[..index].iter().filter(|s| s.has_line()).count();
    let automatic = match series.colour {
        None => Dash::of_index(before),
        Some(_) => Dash::Solid,
    };
    let dash = series.dash.unwrap_or(automatic).pattern();
    Paint::dashed(chart.colour_of(index), series.width, dash)
}

fn marker_of(series: &Series, index: usize) -> Option<Marker> {
    match series.kind {
        SeriesKind::Points(chosen) => Some(chosen.unwrap_or_else(|| Marker::of_index(index))),
        SeriesKind::LinePoints(marker) => Some(marker),
        SeriesKind::Line | SeriesKind::Band(_) => None,
    }
}

fn draw_markers(canvas: &mut Canvas, marker: Marker, at: &[Point], size: f64, colour: Colour) {
    let mut path = PathData::default();
    for centre in at {
        outline(&mut path, marker, *centre, size);
    }
    let paint = match marker {
        Marker::Cross => Paint::line(colour, 0.8),
        Marker::OpenCircle | Marker::OpenSquare | Marker::OpenTriangle => {
            Paint::fill(Colour::WHITE).outlined(colour, 0.8)
        }
        _ => Paint::fill(colour),
    };
    canvas.path(&path, &paint);
}

fn outline(path: &mut PathData, marker: Marker, c: Point, r: f64) {
    let at = |dx: f64, dy: f64| Point::new(c.x + dx * r, c.y + dy * r);
    match marker {
        Marker::Circle | Marker::OpenCircle => path.circle(c, r),
        Marker::Square | Marker::OpenSquare => {
            path.polygon(&[at(-0.9, -0.9), at(0.9, -0.9), at(0.9, 0.9), at(-0.9, 0.9)])
        }
        // Centred on the centroid, where the datum is.
        Marker::Triangle | Marker::OpenTriangle => {
            path.polygon(&[at(0.0, -1.35), at(1.17, 0.675), at(-1.17, 0.675)])
        }
        Marker::Diamond => {
            path.polygon(&[at(0.0, -1.3), at(1.1, 0.0), at(0.0, 1.3), at(-1.1, 0.0)])
        }
        Marker::Cross => {
            path.segment(at(-0.9, -0.9), at(0.9, 0.9)).segment(at(-0.9, 0.9), at(0.9, -0.9))
        }
    };
}

#[cfg(test)]
#[path = "tests/strokes.rs"]
mod tests;

//! Series as strokes on the page: broken at gaps, cut at the frame, thinned.

use super::decimate;
use super::plot::Plot;
use super::series::{Kind, Series};
use crate::draw::{PathData, Point, Rect, clip_segment};

/// Unbroken pieces of a line inside the frame.
pub(crate) fn pieces(plot: &Plot, series: &Series) -> Vec<Vec<Point>> {
    let mut out = Vec::new();
    for run in unbroken(series.xy().map(|(x, y)| plot.at(x, y))) {
        cut(&plot.frame, &decimate::line(run), &mut out);
    }
    out
}

/// Splits where a point is missing.
fn unbroken(points: impl Iterator<Item = Option<Point>>) -> Vec<Vec<Point>> {
    let mut runs = vec![Vec::new()];
    for point in points {
        match (point, runs.last_mut()) {
            (Some(p), Some(run)) => run.push(p),
            (None, Some(run)) if !run.is_empty() => runs.push(Vec::new()),
            _ => {}
        }
    }
    runs
}

fn cut(frame: &Rect, run: &[Point], out: &mut Vec<Vec<Point>>) {
    let mut piece: Vec<Point> = Vec::new();
    for pair in run.windows(2) {
        match clip_segment(frame, pair[0], pair[1]) {
            Some((a, b)) => {
                if piece.last() != Some(&a) {
                    out.push(std::mem::take(&mut piece));
                    piece.push(a);
                }
                piece.push(b);
            }
            None => out.push(std::mem::take(&mut piece)),
        }
    }
    out.push(piece);
    out.retain(|p| !p.is_empty());
}

/// Marker centres inside the frame.
pub(crate) fn centres(plot: &Plot, series: &Series) -> Vec<Point> {
    let inside = plot.frame.grown(0.01);
    let points = series.xy().filter_map(|(x, y)| plot.at(x, y));
    decimate::scatter(points.filter(|p| inside.contains(*p)).collect())
}

/// Outlines of a band, held to the frame's height.
pub(crate) fn band(plot: &Plot, series: &Series) -> Vec<Vec<Point>> {
    let Kind::Band(upper) = &series.kind else {
        return Vec::new();
    };
    let edges = |y: &[f64]| -> Vec<Option<Point>> {
        series
            .x
            .iter()
            .zip(y)
            .map(|(x, y)| plot.at(*x, *y))
            .collect()
    };
    let (low, high) = (edges(&series.y), edges(upper));
    let both = low.iter().zip(&high).map(|(l, h)| l.and(*h).and(*l));
    let other = low.iter().zip(&high).map(|(l, h)| l.and(*h));
    let lows = unbroken(both).into_iter().map(|run| held(plot, run));
    let highs = unbroken(other).into_iter().map(|run| held(plot, run));
    lows.zip(highs)
        .map(|(l, h)| l.into_iter().chain(h.into_iter().rev()).collect())
        .collect()
}

/// Keeps an edge on the page; a band is clipped at the frame when drawn.
fn held(plot: &Plot, run: Vec<Point>) -> Vec<Point> {
    let frame = plot.frame;
    let hold = |p: Point| Point::new(p.x.clamp(frame.x0, frame.x1), p.y.clamp(frame.y0, frame.y1));
    decimate::line(run).into_iter().map(hold).collect()
}

/// Error bars of a series, caps included.
pub(crate) fn error_bars(plot: &Plot, series: &Series, cap: f64) -> PathData {
    let mut path = PathData::new();
    for (i, (x, y)) in series.xy().enumerate() {
        let Some(centre) = plot.at(x, y).filter(|p| plot.frame.contains(*p)) else {
            continue;
        };
        if let (Some(below), Some(above)) = (series.y_error.0.get(i), series.y_error.1.get(i)) {
            let ends = (bar_end(plot, x, y - below), bar_end(plot, x, y + above));
            push_bar(&mut path, plot, centre, ends, Point::new(cap, 0.0));
        }
        if let Some(error) = series.x_error.get(i) {
            let ends = (bar_end(plot, x - error, y), bar_end(plot, x + error, y));
            push_bar(&mut path, plot, centre, ends, Point::new(0.0, cap));
        }
    }
    path
}

/// End of an error bar. On a logarithmic axis a bar may reach below zero: it
/// then runs out of the frame.
fn bar_end(plot: &Plot, x: f64, y: f64) -> Option<Point> {
    let lowest = |v: f64, scale: &crate::axis::Scale| {
        if scale.log && v <= 0.0 {
            scale.lo * 1e-3
        } else {
            v
        }
    };
    plot.at(lowest(x, &plot.x), lowest(y, &plot.y))
}

fn push_bar(
    path: &mut PathData,
    plot: &Plot,
    centre: Point,
    ends: (Option<Point>, Option<Point>),
    cap: Point,
) {
    for end in [ends.0, ends.1].into_iter().flatten() {
        let Some((_, reached)) = clip_segment(&plot.frame, centre, end) else {
            continue;
        };
        path.segment(centre, reached);
        if reached == end {
            let (a, b) = (
                Point::new(end.x - cap.x, end.y - cap.y),
                Point::new(end.x + cap.x, end.y + cap.y),
            );
            path.segment(a, b);
        }
    }
}

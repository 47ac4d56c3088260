//! Accuracy against time, one line a tool.

use crate::scan::Point;
use anyhow::Context;
use hertzchain_figures::{Chart, Figure, Marker, Series};
use std::path::Path;

const MARKERS: [Marker; 8] = [
    Marker::Circle,
    Marker::Square,
    Marker::Triangle,
    Marker::OpenCircle,
    Marker::Diamond,
    Marker::OpenSquare,
    Marker::OpenTriangle,
    Marker::Cross,
];

/// A tool's points with those that another of its points beats left out.
fn front(points: &[Point]) -> (Vec<f64>, Vec<f64>) {
    let mut sorted: Vec<&Point> = points.iter().filter(|p| p.error < 0.3).collect();
    sorted.sort_by(|a, b| b.shots_per_s.total_cmp(&a.shots_per_s));
    let mut best = f64::INFINITY;
    sorted.retain(|p| {
        let better = p.error < best;
        best = best.min(p.error);
        better
    });
    sorted
        .iter()
        .map(|p| (1e3 / p.shots_per_s, p.error))
        .unzip()
}

/// Writes the picture as SVG and PNG.
pub fn write(lines: &[(String, Vec<Point>)], folder: &Path) -> anyhow::Result<()> {
    let mut chart = Chart::new(
        "Time per shot and core (ms)",
        "Largest relative error of both ToFs",
    )
    .x_log()
    .y_log()
    .h_line(1e-5, "");
    for ((name, points), marker) in lines.iter().zip(MARKERS.into_iter().cycle()) {
        let (x, y) = front(points);
        chart = chart.with(Series::line(name, &x, &y).marker(marker));
    }
    let figure = Figure::double_column(110.0)
        .title("Work and precision, dry law")
        .caption("The paper's dry chain at 0.4 to 0.6 m/s, whole shot with both times of flight.")
        .panel(chart);
    std::fs::write(folder.join("work_precision.svg"), figure.svg())?;
    std::fs::write(
        folder.join("work_precision.png"),
        figure.png(200.0).context("png")?,
    )?;
    Ok(())
}

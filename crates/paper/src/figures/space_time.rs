//! Bead velocities over time and place.

use super::{US, label};
use crate::reproduce::Film;
use hertzchain_figures::{Chart, ColourMap, Figure, HeatMap};

/// One map a shot, the wave running from below to the wall above and back.
pub(super) fn figure(films: &[Film]) -> Figure {
    let empty = Figure::single_column(124.0).letters();
    // The striker is faster than any bead and would pale the wave.
    let largest = films
        .iter()
        .flat_map(|film| film.velocity_m_s.iter().skip(1).flatten());
    let largest = largest.fold(0.0_f64, |most, v| most.max(v.abs()));
    films
        .iter()
        .fold(empty, |figure, film| figure.panel(panel(film, largest)))
        .title("Bead velocity over time and place")
        .caption(
            "Velocity of every bead against time, positive towards the wall above bead 40. The \
             striker (row 0) is faster than any bead until it has hit; its colour is that of the \
             end of the scale.",
        )
}

fn panel(film: &Film, largest: f64) -> Chart {
    let (columns, rows) = (film.time_s.len(), film.velocity_m_s.len());
    let values: Vec<f64> = film.velocity_m_s.iter().flatten().copied().collect();
    let end = film.time_s.last().copied().unwrap_or(1.0) * US;
    let map = HeatMap::new(columns, rows, &values)
        .x_edges(0.0, end)
        .y_edges(-0.5, rows as f64 - 0.5)
        .limits(-largest, largest)
        .colours(ColourMap::Diverging)
        .label("Velocity (m/s)");
    let title = format!("{}, $v_0$ = {:.4} m/s", label(&film.case), film.speed_m_s);
    Chart::new("Time (µs)", "Bead (0: striker)")
        .title(&title)
        .heat(map)
}

//! The signals of the paper's Fig. 2.

use super::{US, label, scaled};
use crate::{Chart, Colour, Figure, Legend, Marker, Series};
use hertzchain_study::reproduce::SignalShot;

/// Names and symbols of the three pulses.
const PULSES: [(&str, Marker, Colour); 3] = [
    ("bead 7, incoming", Marker::Circle, Colour::BLUE),
    ("wall", Marker::Square, Colour::VERMILION),
    ("bead 7, returning", Marker::Triangle, Colour::GREEN),
];

/// Shown beyond the returning peak, as a share of the time between the peaks.
const AFTER: f64 = 0.55;

/// Shown before the first peak.
const BEFORE: f64 = 0.25;

/// Four panels of force in the common channel against time.
pub(super) fn figure(signals: &[SignalShot]) -> Figure {
    let empty = Figure::double_column(105.0).columns(2).letters();
    let panels = signals.iter().enumerate();
    let full = panels.fold(empty, |figure, (i, signal)| {
        figure.panel(panel(signal, i == 0))
    });
    full.title("Signals of bead 7 and wall in one channel")
}

fn panel(signal: &SignalShot, legend: bool) -> Chart {
    let time = scaled(&signal.time_s, US);
    let title = format!(
        "{}, $v_0$ = {:.4} m/s",
        label(&signal.case),
        signal.speed_m_s
    );
    let mut chart = Chart::new("Time (µs)", "Force (N)").title(&title).with(
        Series::line("", &time, &signal.channel_n)
            .colour(Colour::BLACK)
            .width(0.8),
    );
    for ((time, force), (name, marker, colour)) in signal.peaks.iter().zip(PULSES) {
        let peak = Series::points(name, &[time * US], &[*force]);
        chart = chart.with(peak.marker(marker).colour(colour));
    }
    if let [(first, _), .., (last, _)] = signal.peaks[..] {
        let between = last - first;
        chart = chart.x_range(
            (first - BEFORE * between) * US,
            (last + AFTER * between) * US,
        );
    }
    chart.legend(if legend { Legend::Auto } else { Legend::Off })
}

//! The signals of the paper's Fig. 2.

use super::{US, label, scaled};
use crate::reproduce::SignalShot;
use hertzchain_figures::{Chart, Colour, Figure, Legend, Marker, Series};

/// Names and symbols of the three pulses.
const PULSES: [(&str, Marker, Colour); 3] = [
    ("bead 7, incoming", Marker::Circle, Colour::BLUE),
    ("wall", Marker::Square, Colour::VERMILION),
    ("bead 7, returning", Marker::Triangle, Colour::GREEN),
];

/// Shown beyond the returning peak, as a share of the time between the peaks.
const AFTER: f64 = 0.55;

/// Paper above the highest and below the lowest force, as shares of the highest.
const HEADROOM: f64 = 0.1;
const FOOTROOM: f64 = 0.04;

/// A panel a shot: force in the common channel against time.
pub(super) fn figure(signals: &[SignalShot]) -> Figure {
    let empty = Figure::single_column(172.0).letters();
    let panels = signals.iter().enumerate();
    let full = panels.fold(empty, |figure, (i, signal)| {
        figure.panel(panel(signal, i == 0))
    });
    full.title("Signals of bead 7 and wall in one channel")
        .caption(
            "Dynamic force of bead 7 and of the wall, added into one channel, against the time \
             since the striker's impact: the computed shots that the paper's Fig. 2 shows. Symbols \
             mark the peaks between which times of flight are taken.",
        )
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
        // From the impact on: before it, nothing moves.
        chart = chart.x_range(0.0, (last + AFTER * (last - first)) * US);
    }
    let highest = signal.channel_n.iter().copied().fold(0.0, f64::max);
    let lowest = signal.channel_n.iter().copied().fold(0.0, f64::min);
    chart = chart.y_range(lowest - FOOTROOM * highest, (1.0 + HEADROOM) * highest);
    chart.legend(if legend { Legend::Auto } else { Legend::Off })
}

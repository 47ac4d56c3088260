//! Dry times of flight against speed, the paper's Fig. 3.

use super::{US, scaled};
use crate::claims::{Branch, Curve, Evidence, SHOTS_PER_POINT, SPEED_SCATTER_M_S};
use hertzchain_figures::{Chart, Colour, Dash, Figure, Marker, Series};

/// Incident and reflected ToF with the log–log inset.
pub(super) fn figure(evidence: &Evidence) -> Figure {
    let speed = "Striker speed $v_0$ (m/s)";
    let inset = curves(
        evidence,
        Chart::new("$v_0$ (m/s)", "ToF (µs)").x_log().y_log(),
    );
    let chart = curves(evidence, Chart::new(speed, "Time of flight (µs)"));
    let chart = chart
        .with(line(DASHED, &[], &[], Colour::BLACK))
        .note(&format!("error bars: $v_0$ ± {SPEED_SCATTER_M_S} m/s"))
        .inset(inset);
    Figure::single_column(78.0)
        .panel(chart)
        .title("Time of flight in the dry chain against the striker's speed")
        .caption(&caption())
}

fn caption() -> String {
    format!(
        "Times of flight of the dry chain between bead 7 and the wall (incident, filled circles) \
         and back (reflected, open squares) against the striker's speed, computed with the full \
         dry law (symbols, full lines) and without its cubic term ({DASHED}, dashed lines in the \
         same colours). Error bars: what the paper's scatter of ±{SPEED_SCATTER_M_S} m/s in the \
         striker's speed (standard deviation over {SHOTS_PER_POINT} shots) does to the time of \
         flight of one shot, |dT/dv| times the scatter; where none is seen it is smaller than \
         the symbol. Inset: the same with logarithmic axes."
    )
}

/// What the dashed curves of both colours are computed with.
const DASHED: &str = "Hertz + viscoelastic";

fn curves(evidence: &Evidence, chart: Chart) -> Chart {
    let looks = [
        (Branch::Reflected, Marker::OpenSquare, Colour::VERMILION),
        (Branch::Incident, Marker::Circle, Colour::BLUE),
    ];
    let dashed = evidence.curve("hertz-viscoelastic");
    let full = evidence.curve("dry");
    looks
        .into_iter()
        .fold(chart, |chart, (branch, marker, colour)| {
            let chart = with(chart, dashed, |curve| viscoelastic(curve, branch, colour));
            with(chart, full, |curve| dry(curve, branch, marker, colour))
        })
}

fn with(chart: Chart, curve: Option<&Curve>, series: impl Fn(&Curve) -> Series) -> Chart {
    match curve {
        Some(curve) => chart.with(series(curve)),
        None => chart,
    }
}

/// Without a name: a sample in black stands for both colours in the legend.
fn viscoelastic(curve: &Curve, branch: Branch, colour: Colour) -> Series {
    let times = scaled(&curve.tofs_s(branch), US);
    line("", &curve.speeds_m_s(), &times, colour)
}

fn line(name: &str, speeds_m_s: &[f64], times_us: &[f64], colour: Colour) -> Series {
    Series::line(name, speeds_m_s, times_us)
        .colour(colour)
        .dash(Dash::Dashed)
        .width(0.8)
}

/// Error bars: the scatter of the speed from shot to shot, carried through dT/dv.
fn dry(curve: &Curve, branch: Branch, marker: Marker, colour: Colour) -> Series {
    let errors: Vec<f64> = curve
        .slopes_s2_m(branch)
        .iter()
        .map(|slope| slope.abs() * SPEED_SCATTER_M_S * US)
        .collect();
    let name = format!("{}, dry law", branch.name());
    Series::line(
        &name,
        &curve.speeds_m_s(),
        &scaled(&curve.tofs_s(branch), US),
    )
    .marker(marker)
    .colour(colour)
    .dash(Dash::Solid)
    .width(0.8)
    .y_error(&errors)
}

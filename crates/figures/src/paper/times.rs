//! Dry times of flight against speed, the paper's Fig. 3.

use super::{US, scaled};
use crate::{Chart, Colour, Dash, Figure, Marker, Series};
use hertzchain_study::claims::{Branch, Curve, Evidence, SPEED_SCATTER_M_S};

/// Incident and reflected ToF with the log–log inset.
pub(super) fn figure(evidence: &Evidence) -> Figure {
    let speed = "Striker speed $v_0$ (m/s)";
    let inset = curves(
        evidence,
        Chart::new("$v_0$ (m/s)", "ToF (µs)").x_log().y_log(),
    );
    let chart = curves(evidence, Chart::new(speed, "Time of flight (µs)")).inset(inset);
    Figure::single_column(78.0)
        .panel(chart)
        .title("Time of flight in the dry chain against the striker's speed")
}

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

fn viscoelastic(curve: &Curve, branch: Branch, colour: Colour) -> Series {
    // One entry of the legend stands for both dashed curves.
    let name = match branch {
        Branch::Reflected => "Hertz + viscoelastic",
        Branch::Incident => "",
    };
    Series::line(
        name,
        &curve.speeds_m_s(),
        &scaled(&curve.tofs_s(branch), US),
    )
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
    Series::line(
        branch.name(),
        &curve.speeds_m_s(),
        &scaled(&curve.tofs_s(branch), US),
    )
    .marker(marker)
    .colour(colour)
    .dash(Dash::Solid)
    .width(0.8)
    .y_error(&errors)
}

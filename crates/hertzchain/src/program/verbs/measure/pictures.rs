//! Figures of what was measured.

use hertzchain_figures::{Chart, Colour, Dash, Figure, Marker, Series, case_look};
use hertzchain_measure::signal::{Estimate, Flight, Ratio};
use hertzchain_measure::{Case, Curves, Example, Shot, SpeedRow, WetOverDry};

const MOST: usize = 4;

/// How much of a record is shown before the first pulse and after the last, in
/// incident times of flight.
const MARGIN: f64 = 0.5;

/// Free shares of a record's range below and above it; above stand the picks' names.
const BELOW: f64 = 0.06;
const ABOVE: f64 = 0.2;

/// One shot of every case with its picks; `None` without any.
pub(super) fn signals(examples: &[Example]) -> Option<Figure> {
    let good = examples.iter().filter(|example| example.shot.flight.is_ok());
    let charts: Vec<Chart> = good.take(MOST).map(signal).collect();
    let empty = Figure::double_column(55.0 * charts.len() as f64 + 8.0).letters();
    (!charts.is_empty()).then(|| charts.into_iter().fold(empty, Figure::panel))
}

/// A shot with its picks, if it has any: about its pulses, else whole.
pub(super) fn signal(example: &Example) -> Chart {
    let shot = &example.shot;
    let flight = shot.flight.as_ref().ok();
    let pulses = flight.map(|flight| {
        let picks = &flight.picks;
        let last = picks.reflected.map_or(picks.wall.time_s, |back| back.time_s);
        let margin_s = MARGIN * flight.incident_s.value;
        (picks.incident.time_s - margin_s, last + margin_s)
    });
    let (from, to) = pulses.unwrap_or((0.0, f64::INFINITY));
    let at = |time_s: f64| (time_s / shot.interval_s).max(0.0) as usize;
    let time_us = |index: usize| 1e6 * index as f64 * shot.interval_s;
    let mut chart = Chart::new("Time (µs)", "Signal (V)").title(&title(example));
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (name, volts) in example.names.iter().zip(&example.volts) {
        let end = at(to).min(volts.len());
        let first = at(from).min(end);
        let times: Vec<f64> = (first..end).map(time_us).collect();
        low = volts[first..end].iter().copied().fold(low, f64::min);
        high = volts[first..end].iter().copied().fold(high, f64::max);
        let name = if example.volts.len() > 1 { name } else { "" };
        chart = chart.with(Series::line(name, &times, &volts[first..end]).dash(Dash::Solid));
    }
    if high > low {
        chart = chart.y_range(low - BELOW * (high - low), high + ABOVE * (high - low));
    }
    let Some(Flight { picks, .. }) = flight else { return chart };
    let back = picks.reflected.map(|back| (back, "reflected"));
    let all = [(picks.incident, "incident"), (picks.wall, "wall")].into_iter().chain(back);
    all.fold(chart, |chart, (pick, name)| chart.v_line(1e6 * pick.time_s, name))
}

fn title(example: &Example) -> String {
    let Shot { case, speed_m_s, flight, .. } = &example.shot;
    let case = Some(case.clone()).filter(|case| !case.is_empty());
    let speed = speed_m_s.map(|speed| format!("{:.4} m/s", speed.value));
    let incident = flight.as_ref().ok();
    let incident =
        incident.map(|flight| format!("incident {:.2} µs", 1e6 * flight.incident_s.value));
    let doubt = example.shot.is_dubious().then(|| "not counted".to_owned());
    [case, speed, incident, doubt].into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// Times of flight at the mean speeds with all their errors, and their power laws, dashed where
/// the errors do not allow any, dotted where no speed tests them.
pub(super) fn times(curves: &Curves) -> Figure {
    let chart = Chart::new("Speed of the striker (m/s)", "Time of flight (µs)").x_log().y_log();
    let chart = chart.legend(curves.cases.len() != 1);
    let names = names(curves);
    both(&chart, |chart, time| {
        curves
            .cases
            .iter()
            .fold(chart, |chart, case| with_curve(chart, case, case_look(&case.name, &names), time))
    })
}

fn names(curves: &Curves) -> Vec<&str> {
    curves.cases.iter().map(|case| case.name.as_str()).collect()
}

/// A panel of incident and one of reflected times, 0 and 1.
fn both(empty: &Chart, filled: impl Fn(Chart, usize) -> Chart) -> Figure {
    let figure = Figure::double_column(75.0).columns(2).letters();
    let panel = |(time, title)| filled(empty.clone().title(title), time);
    ["incident", "reflected"].into_iter().enumerate().map(panel).fold(figure, Figure::panel)
}

/// Width of a fit's line in points: the data lie on top.
const FIT_WIDTH: f64 = 0.7;

/// Points of a case and their power law.
fn with_curve(chart: Chart, case: &Case, (colour, marker): (Colour, Marker), time: usize) -> Chart {
    let law = [&case.laws.incident, &case.laws.reflected][time];
    let known: Vec<(&SpeedRow, Estimate)> =
        case.rows.iter().filter_map(|row| Some((row, row.at_mean_speed_s[time]?))).collect();
    let column = |value: &dyn Fn(&(&SpeedRow, Estimate)) -> f64| -> Vec<f64> {
        known.iter().map(value).collect()
    };
    // A single shot may have no error: then there is no bar.
    let bar = |error: f64| if error.is_finite() { error } else { 0.0 };
    let speeds = column(&|point| point.0.speed_m_s.value);
    let times = column(&|point| 1e6 * point.1.value);
    let points = Series::points(&case.name, &speeds, &times)
        .marker(marker)
        .y_error(&column(&|point| 1e6 * bar(point.1.sigma)))
        .x_error(&column(&|point| bar(point.0.speed_m_s.sigma)));
    let fitted = column(&|point| match law {
        Ok(law) => 1e6 * law.at(point.0.speed_m_s.value),
        Err(_) => f64::NAN,
    });
    let dash = match law.as_ref().map(|law| case.supports(law)) {
        Ok(Ok(Some(false))) => Dash::Dashed,
        Ok(Ok(None)) => Dash::Dotted,
        _ => Dash::Solid,
    };
    let line = Series::line("", &speeds, &fitted).dash(dash);
    chart.with(points.colour(colour)).with(line.colour(colour).width(FIT_WIDTH))
}

/// Ratios of times to the reference's, with error bars.
pub(super) fn ratios(curves: &Curves, reference: &str) -> Figure {
    let label = format!("Time of flight over {reference}");
    let chart = Chart::new("Speed of the striker (m/s)", &label).x_log().h_line(1.0, "");
    let series = |wet: &WetOverDry, time: usize| {
        // The look that the case has beside its reference.
        let (colour, marker) = case_look(&wet.case, &names(curves));
        let column = |of: fn(&Ratio) -> f64| {
            [&wet.incident, &wet.reflected][time].iter().map(of).collect::<Vec<f64>>()
        };
        Series::points(&wet.case, &column(|of| of.speed), &column(|of| of.ratio.value))
            .marker(marker)
            .colour(colour)
            .y_error(&column(|of| of.ratio.sigma))
    };
    both(&chart, |chart, time| {
        curves.ratios.iter().fold(chart, |chart, wet| chart.with(series(wet, time)))
    })
}

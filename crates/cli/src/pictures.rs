//! Figures of a shot and of a sweep.

use hertzchain_chain::Sensor;
use hertzchain_chain::observe::Trace;
use hertzchain_chain::wave::Budget;
use hertzchain_figures::{Chart, Colour, Dash, Figure, Marker, Series};
use hertzchain_signal::{FitError, PowerLaw};
use hertzchain_study::Sweep;

/// What a sensor is called in figures and its unit.
pub fn name(sensor: Sensor) -> (String, &'static str) {
    match sensor {
        Sensor::Bead(bead) => (format!("sensor bead {bead}"), "N"),
        Sensor::Contact(contact) => (format!("contact {contact}"), "N"),
        Sensor::Position(body) => (format!("position {body}"), "m"),
        Sensor::Velocity(body) => (format!("velocity {body}"), "m/s"),
        Sensor::BeadPlusWall(bead) => (format!("bead {bead} plus wall"), "N"),
    }
}

/// Times in a unit that suits them.
struct Clock {
    scale: f64,
    unit: &'static str,
}

impl Clock {
    fn of(times_s: &[f64]) -> Self {
        let last = times_s.last().copied().unwrap_or(0.0);
        let (scale, unit) = match last {
            t if t < 2e-2 => (1e6, "µs"),
            t if t < 20.0 => (1e3, "ms"),
            _ => (1.0, "s"),
        };
        Self { scale, unit }
    }

    fn times(&self, times_s: &[f64]) -> Vec<f64> {
        times_s.iter().map(|t| t * self.scale).collect()
    }

    fn label(&self) -> String {
        format!("Time ({})", self.unit)
    }
}

/// Signals of sensors against time, one panel a quantity.
pub fn signals(title: &str, trace: &Trace, sensors: &[Sensor]) -> Figure {
    let clock = Clock::of(&trace.time_s);
    let times = clock.times(&trace.time_s);
    let panels = [
        ("N", "Force (N)"),
        ("m/s", "Velocity (m/s)"),
        ("m", "Displacement (m)"),
    ];
    let mut charts = Vec::new();
    for (unit, label) in panels {
        let shown = sensors.iter().zip(&trace.columns);
        let mut shown = shown
            .filter(|(sensor, _)| name(**sensor).1 == unit)
            .peekable();
        if shown.peek().is_some() {
            let chart = Chart::new(&clock.label(), label);
            charts.push(shown.fold(chart, |chart, (sensor, column)| {
                chart.with(Series::line(&name(*sensor).0, &times, column))
            }));
        }
    }
    if let Some(first) = charts.first_mut() {
        *first = first.clone().title(title);
    }
    let height_mm = 55.0 * charts.len().max(1) as f64 + 10.0;
    let empty = Figure::double_column(height_mm).share_x();
    charts.into_iter().fold(empty, Figure::panel)
}

/// Where the energy is, against time, and what is missing.
pub fn energy(budgets: &[Budget]) -> Figure {
    let times_s: Vec<f64> = budgets.iter().map(|budget| budget.time_s).collect();
    let clock = Clock::of(&times_s);
    let times = clock.times(&times_s);
    let line = |name: &str, of: &dyn Fn(&Budget) -> f64| {
        let values: Vec<f64> = budgets.iter().map(of).collect();
        Series::line(name, &times, &values)
    };
    let lost = |budget: &Budget| {
        budget
            .dissipated
            .iter()
            .map(|line| line.energy_j)
            .sum::<f64>()
    };
    let chart = Chart::new(&clock.label(), "Energy (J)")
        .with(line("kinetic", &|b| b.kinetic_j))
        .with(line("elastic", &|b| b.elastic_j))
        .with(line("dissipated", &lost))
        .with(line("gravity, preload, stop", &|b| {
            b.gravity_j + b.preload_j + b.stop_j
        }))
        .with(
            line("all", &|b| b.start_j + b.driven_j)
                .colour(Colour::BLACK)
                .dash(Dash::Dashed),
        );
    let residual =
        Chart::new(&clock.label(), "Residual, relative").with(line("", &Budget::relative_residual));
    Figure::single_column(100.0)
        .letters()
        .share_x()
        .panel(chart)
        .panel(residual)
}

/// Times of flight against speed with their power laws.
pub fn sweep(title: &str, sweep: &Sweep) -> Figure {
    let flights = sweep.flights();
    let speeds: Vec<f64> = flights.iter().map(|flight| flight.0).collect();
    let incident: Vec<f64> = flights.iter().map(|flight| flight.1).collect();
    let reflected: Vec<f64> = flights.iter().map(|f| f.2.unwrap_or(f64::NAN)).collect();
    let chart = Chart::new("Impact speed $v_0$ (m/s)", "Time of flight (µs)");
    let chart = chart.title(title).x_log().y_log();
    let chart = with(
        chart,
        "incident",
        &speeds,
        &incident,
        &sweep.incident,
        Colour::BLUE,
    );
    let chart = with(
        chart,
        "reflected",
        &speeds,
        &reflected,
        &sweep.reflected,
        Colour::VERMILION,
    );
    Figure::single_column(70.0).panel(chart)
}

fn with(
    chart: Chart,
    name: &str,
    speeds: &[f64],
    times_s: &[f64],
    fit: &Result<PowerLaw, FitError>,
    colour: Colour,
) -> Chart {
    let micro = |values: Vec<f64>| -> Vec<f64> { values.iter().map(|t| 1e6 * t).collect() };
    let points = Series::points(name, speeds, &micro(times_s.to_vec()))
        .marker(Marker::Circle)
        .colour(colour);
    let chart = chart.with(points);
    match fit {
        Err(_) => chart,
        Ok(law) => {
            let mut ends: Vec<f64> = speeds.to_vec();
            ends.sort_by(f64::total_cmp);
            let values = ends.iter().map(|v| law.at(*v)).collect();
            chart.with(
                Series::line("", &ends, &micro(values))
                    .colour(colour)
                    .width(0.7),
            )
        }
    }
}

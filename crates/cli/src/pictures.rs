//! Figures of a shot and of a sweep.

use hertzchain_chain::Sensor;
use hertzchain_chain::observe::Trace;
use hertzchain_chain::wave::Budget;
use hertzchain_experiment::{Experiment, Units};
use hertzchain_figures::{Chart, Colour, Dash, Figure, Marker, Series};
use hertzchain_signal::{FitError, PowerLaw};
use hertzchain_study::Sweep;

/// What a sensor is called in figures and its unit; the last contact is the wall's.
pub fn name(sensor: Sensor, wall: Option<usize>) -> (String, &'static str) {
    match sensor {
        Sensor::Bead(bead) => (format!("sensor bead {bead}"), "N"),
        Sensor::Contact(contact) if Some(contact) == wall => ("wall".into(), "N"),
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
    fn of(times_s: &[f64], units: Units) -> Self {
        if units == Units::Dimensionless {
            return Self {
                scale: 1.0,
                unit: "",
            };
        }
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
        match self.unit {
            "" => "Time".into(),
            unit => format!("Time ({unit})"),
        }
    }
}

/// An axis label with its SI unit, or without one in a dimensionless chain.
fn axis(quantity: &str, unit: &str, units: Units) -> String {
    match units {
        Units::Si => format!("{quantity} ({unit})"),
        Units::Dimensionless => quantity.to_owned(),
    }
}

/// Signals of sensors against time, one panel a quantity.
pub fn signals(experiment: &Experiment, trace: &Trace, sensors: &[Sensor]) -> Figure {
    let units = experiment.units();
    let clock = Clock::of(&trace.time_s, units);
    let wall = wall(experiment);
    let times = clock.times(&trace.time_s);
    let panels = [("N", "Force"), ("m/s", "Velocity"), ("m", "Displacement")];
    let mut charts = Vec::new();
    for (unit, quantity) in panels {
        let shown = sensors.iter().zip(&trace.columns);
        let mut shown = shown
            .filter(|(sensor, _)| name(**sensor, wall).1 == unit)
            .peekable();
        if shown.peek().is_some() {
            let chart = Chart::new(&clock.label(), &axis(quantity, unit, units));
            charts.push(shown.fold(chart, |chart, (sensor, column)| {
                chart.with(Series::line(&name(*sensor, wall).0, &times, column))
            }));
        }
    }
    if let Some(first) = charts.first_mut() {
        *first = first.clone().title(experiment.title());
    }
    let height_mm = 55.0 * charts.len().max(1) as f64 + 10.0;
    let empty = Figure::double_column(height_mm).share_x();
    charts.into_iter().fold(empty, Figure::panel)
}

/// The contact with the wall, if there is one.
pub fn wall(experiment: &Experiment) -> Option<usize> {
    experiment.has_wall().then(|| experiment.beads())
}

/// Where the energy is, against time, and what is missing.
pub fn energy(budgets: &[Budget], units: Units) -> Figure {
    let times_s: Vec<f64> = budgets.iter().map(|budget| budget.time_s).collect();
    let clock = Clock::of(&times_s, units);
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
    let outside = |b: &Budget| b.gravity_j + b.preload_j + b.stop_j;
    let chart = Chart::new(&clock.label(), &axis("Energy", "J", units))
        .with(line("kinetic", &|b| b.kinetic_j))
        .with(line("elastic", &|b| b.elastic_j))
        .with(line("dissipated", &lost))
        .with(
            line("all", &|b| b.start_j + b.driven_j)
                .colour(Colour::BLACK)
                .dash(Dash::Dashed),
        );
    let chart = match budgets.iter().any(|budget| outside(budget) != 0.0) {
        true => chart.with(line("gravity, preload, stop", &outside)),
        false => chart,
    };
    let residual =
        Chart::new(&clock.label(), "Residual, relative").with(line("", &Budget::relative_residual));
    Figure::single_column(100.0)
        .letters()
        .share_x()
        .panel(chart)
        .panel(residual)
}

/// Times of flight against speed with their power laws.
pub fn sweep(experiment: &Experiment, sweep: &Sweep) -> Figure {
    let flights = sweep.flights();
    let speeds: Vec<f64> = flights.iter().map(|flight| flight.0).collect();
    let incident: Vec<f64> = flights.iter().map(|flight| flight.1).collect();
    let reflected: Vec<f64> = flights.iter().map(|f| f.2.unwrap_or(f64::NAN)).collect();
    let units = experiment.units();
    let chart = Chart::new(
        &axis("Impact speed $v_0$", "m/s", units),
        &axis("Time of flight", "µs", units),
    );
    let chart = chart.title(experiment.title()).x_log().y_log();
    let scale = if units == Units::Si { 1e6 } else { 1.0 };
    let chart = with(
        chart,
        "incident",
        &speeds,
        &incident,
        &sweep.incident,
        (Colour::BLUE, Marker::Circle, scale),
    );
    let chart = with(
        chart,
        "reflected",
        &speeds,
        &reflected,
        &sweep.reflected,
        (Colour::VERMILION, Marker::OpenSquare, scale),
    );
    Figure::single_column(70.0).panel(chart)
}

fn with(
    chart: Chart,
    name: &str,
    speeds: &[f64],
    times_s: &[f64],
    fit: &Result<PowerLaw, FitError>,
    (colour, marker, scale): (Colour, Marker, f64),
) -> Chart {
    let micro = |values: Vec<f64>| -> Vec<f64> { values.iter().map(|t| scale * t).collect() };
    let points = Series::points(name, speeds, &micro(times_s.to_vec()))
        .marker(marker)
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

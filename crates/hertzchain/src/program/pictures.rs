//! Figures of a shot and of a sweep.

use hertzchain_chain::Sensor;
use hertzchain_chain::observe::Trace;
use hertzchain_chain::wave::Budget;
use hertzchain_experiment::{Experiment, Units};
use hertzchain_figures::{Chart, Colour, Dash, Figure, Marker, Series};
use hertzchain_measure::signal::{FitError, PowerLaw};
use hertzchain_sim::{BatchResult, Column};

/// What a sensor is called in figures and its unit; the last contact is the wall's.
pub(crate) fn name(sensor: Sensor, wall: Option<usize>) -> (String, &'static str) {
    match sensor {
        Sensor::Bead(bead) => (format!("sensor bead {bead}"), "N"),
        Sensor::Contact(contact) if Some(contact) == wall => ("wall".into(), "N"),
        Sensor::Contact(contact) => (format!("contact {contact}"), "N"),
        Sensor::Position(body) => (format!("position {body}"), "m"),
        Sensor::Velocity(body) => (format!("velocity {body}"), "m/s"),
        Sensor::BeadPlusWall(bead) => (format!("bead {bead} plus wall"), "N"),
    }
}

pub(crate) struct TimeAxis {
    /// Units in a second.
    pub scale: f64,
    /// Empty in a dimensionless chain.
    pub unit: &'static str,
}

impl TimeAxis {
    /// Clear for the latest of the times.
    pub(crate) fn of(times_s: &[f64], units: Units) -> Self {
        if units == Units::Dimensionless {
            return Self { scale: 1.0, unit: "" };
        }
        let last = times_s.iter().copied().fold(0.0, f64::max);
        let (scale, unit) = match last {
            t if t < 2e-2 => (1e6, "µs"),
            t if t < 20.0 => (1e3, "ms"),
            _ => (1.0, "s"),
        };
        Self { scale, unit }
    }

    fn scaled(&self, times_s: &[f64]) -> Vec<f64> {
        times_s.iter().map(|t| t * self.scale).collect()
    }

    fn label(&self, quantity: &str) -> String {
        match self.unit {
            "" => quantity.to_owned(),
            unit => format!("{quantity} ({unit})"),
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

/// Steep pulses are clearer unbroken: the first three colours differ enough in
/// hue and lightness, dashes help after them, and where the seven colours come again.
fn dash(line: usize) -> Dash {
    match line {
        0..3 => Dash::Solid,
        3..10 => Dash::Dashed,
        10..17 => Dash::DashDotted,
        _ => Dash::Dotted,
    }
}

/// Signals of sensors against time, one panel a quantity.
pub(crate) fn signals(
    experiment: &Experiment,
    trace: &Trace,
    (sensors, title): (&[Sensor], &str),
) -> Figure {
    let units = experiment.units();
    let clock = TimeAxis::of(&trace.time_s, units);
    let wall = wall(experiment);
    let times = clock.scaled(&trace.time_s);
    let panels = [("N", "Force"), ("m/s", "Velocity"), ("m", "Displacement")];
    let mut charts = Vec::new();
    for (unit, quantity) in panels {
        let shown = sensors.iter().zip(&trace.columns);
        let mut shown = shown.filter(|(sensor, _)| name(**sensor, wall).1 == unit).peekable();
        if shown.peek().is_some() {
            let chart = Chart::new(&clock.label("Time"), &axis(quantity, unit, units));
            let lines = shown.enumerate().map(|(i, (sensor, column))| {
                let name = legend(experiment, *sensor, wall);
                Series::line(&name, &times, column).dash(dash(i))
            });
            charts.push(lines.fold(chart, Chart::with));
        }
    }
    if let Some(first) = charts.first_mut() {
        *first = first.clone().title(title);
    }
    let height_mm = 50.0 * charts.len().max(1) as f64 + 12.0;
    let empty = Figure::single_column(height_mm).share_x();
    charts.into_iter().fold(empty, Figure::panel)
}

/// What a sensor is called in a legend; the axis names the quantity.
fn legend(experiment: &Experiment, sensor: Sensor, wall: Option<usize>) -> String {
    let body = match sensor {
        Sensor::Position(body) | Sensor::Velocity(body) => body,
        force => return name(force, wall).0,
    };
    match body {
        0 if experiment.speed_m_s().is_some() => "striker".into(),
        0 => "driven end".into(),
        body if body > experiment.beads() => "stop".into(),
        body => format!("bead {body}"),
    }
}

pub(crate) fn wall(experiment: &Experiment) -> Option<usize> {
    experiment.has_wall().then(|| experiment.beads())
}

pub(crate) fn sweep(part: &BatchResult) -> Figure {
    let flights = part.rows.flights();
    let incident: Vec<(f64, f64)> = flights.iter().map(|flight| (flight.0, flight.1)).collect();
    let reflected = flights.iter().filter_map(|f| f.2.map(|time_s| (f.0, time_s)));
    let reflected: Vec<(f64, f64)> = reflected.collect();
    let units = part.units;
    let all = incident.iter().chain(&reflected);
    let clock = TimeAxis::of(&all.map(|(_, time_s)| *time_s).collect::<Vec<_>>(), units);
    let chart =
        Chart::new(&axis("Striker speed $v_0$", "m/s", units), &clock.label("Time of flight"));
    let chart = chart.title(&part.title).x_log().y_log();
    let law = |column| part.rows.law(column, part.accuracy).0;
    let chart = branch(chart, &clock, "reflected", &reflected, &law(Column::Reflected));
    let chart = branch(chart, &clock, "incident", &incident, &law(Column::Incident));
    Figure::single_column(78.0).panel(chart)
}

/// Points of one branch and the power law through them.
fn branch(
    chart: Chart,
    clock: &TimeAxis,
    name: &str,
    flights: &[(f64, f64)],
    fit: &Result<PowerLaw, FitError>,
) -> Chart {
    if flights.is_empty() {
        return chart;
    }
    let (colour, marker) = match name {
        "incident" => (Colour::BLUE, Marker::Circle),
        _ => (Colour::VERMILION, Marker::OpenSquare),
    };
    let (mut speeds, times_s): (Vec<f64>, Vec<f64>) = flights.iter().copied().unzip();
    let points = |name: &str| {
        Series::points(name, &speeds, &clock.scaled(&times_s)).marker(marker).colour(colour)
    };
    let Ok(law) = fit else {
        return chart.with(points(name));
    };
    let named = format!("{name}, exponent {:.4}", law.exponent).replace('-', "\u{2212}");
    let points = points(&named);
    speeds.sort_by(f64::total_cmp);
    let fit_result: Vec<f64> = speeds.iter().map(|speed| law.at(*speed)).collect();
    let line = Series::line("", &speeds, &clock.scaled(&fit_result));
    chart.with(line.colour(colour).width(0.7)).with(points)
}

/// Parts that stay below this share of the largest energy are thinner than a line.
const LEAST_SEEN: f64 = 2e-3;

struct EnergyPart {
    name: &'static str,
    of: fn(&Budget) -> f64,
    look: (Colour, Dash),
    /// Shown even where it stays too small to be seen.
    always: bool,
}

const fn part(
    name: &'static str,
    of: fn(&Budget) -> f64,
    look: (Colour, Dash),
    always: bool,
) -> EnergyPart {
    EnergyPart { name, of, look, always }
}

/// No two parts have the same colour; those that most shots show differ by dash too.
const PARTS: [EnergyPart; 8] = [
    part("kinetic", |b| b.kinetic_j, (Colour::BLUE, Dash::Solid), true),
    part("elastic", |b| b.elastic_j, (Colour::VERMILION, Dash::Dashed), true),
    part("lost", dissipated_j, (Colour::GREEN, Dash::DashDotted), false),
    part("clipped", |b| b.clipped_j, (Colour::GREY, Dash::DashDotted), false),
    part("gravity", |b| b.gravity_j, (Colour::OCHRE, Dash::Solid), false),
    part("preload", |b| b.preload_j, (Colour::PURPLE, Dash::Solid), false),
    part("stop", |b| b.stop_j, (Colour::SKY, Dash::Solid), false),
    part("put in", |b| b.start_j + b.driven_j, (Colour::BLACK, Dash::Dotted), true),
];

fn dissipated_j(budget: &Budget) -> f64 {
    let lines = budget.dissipated.iter();
    lines.map(|line| line.energy_j).sum()
}

/// Where the energy is, against time, and what is missing.
pub(crate) fn energy(budgets: &[Budget], units: Units, title: &str) -> Figure {
    let times_s: Vec<f64> = budgets.iter().map(|budget| budget.time_s).collect();
    let clock = TimeAxis::of(&times_s, units);
    let times = clock.scaled(&times_s);
    let values = |of: fn(&Budget) -> f64| -> Vec<f64> { budgets.iter().map(of).collect() };
    let largest = PARTS.iter().map(|part| peak(&values(part.of)));
    let largest = largest.fold(0.0, f64::max);
    let (factor, label) = scale(largest, units);
    let seen = |part: &&EnergyPart| part.always || peak(&values(part.of)) > LEAST_SEEN * largest;
    let chart = Chart::new(&clock.label("Time"), &label);
    let chart = PARTS.iter().filter(seen).fold(chart, |chart, part| {
        let scaled: Vec<f64> = values(part.of).iter().map(|e| e * factor).collect();
        let (colour, dash) = part.look;
        chart.with(Series::line(part.name, &times, &scaled).colour(colour).dash(dash))
    });
    let missing = values(|budget| budget.relative_residual());
    let residual = Series::line("", &times, &missing).colour(Colour::BLACK).width(0.8);
    Figure::single_column(105.0)
        .letters()
        .share_x()
        .panel(chart)
        .panel(Chart::new(&clock.label("Time"), "Residual / input").with(residual))
        .title(title)
}

fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Factor from joules to the unit that suits the largest energy, and the axis label.
fn scale(largest_j: f64, units: Units) -> (f64, String) {
    if units == Units::Dimensionless {
        return (1.0, "Energy".into());
    }
    let prefixes = [(1e3, "kJ"), (1.0, "J"), (1e-3, "mJ"), (1e-6, "µJ"), (1e-9, "nJ")];
    let fitting = prefixes.iter().find(|(size, _)| largest_j >= *size);
    let (size, unit) = fitting.copied().unwrap_or((1.0, "J"));
    (1.0 / size, format!("Energy ({unit})"))
}

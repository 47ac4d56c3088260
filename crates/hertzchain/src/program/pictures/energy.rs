//! The energy of a shot against time.

use super::TimeAxis;
use hertzchain_chain::wave::Budget;
use hertzchain_experiment::Units;
use hertzchain_figures::{Chart, Colour, Dash, Figure, Series};

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

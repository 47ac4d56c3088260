//! K and A of the wet contacts against speed, beside those of known oils, or a film's number.

use crate::gauge::GaugeResult;
use hertzchain_figures::{Chart, Colour, Dash, Figure, Marker, Series, case_look};
use hertzchain_infer::gauge::{Branch, Contact, Oil, Pair, is_determined};
use hertzchain_infer::{Covariance, Parameter, Problem};

/// Speeds at which an oil's curve is drawn.
const POINTS: usize = 60;

pub(super) fn contacts(run_gauge: &GaugeResult) -> Figure {
    if let Some(number) = run_gauge.gauge.film_number() {
        return Figure::single_column(70.0).panel(film(run_gauge, &number));
    }
    match has_both(run_gauge) {
        true => Figure::single_column(120.0)
            .share_x()
            .panel(panel(run_gauge, 0, "$K$ (GN/m$^{3/2}$)", 1e-9))
            .panel(panel(run_gauge, 1, "$A$ (ns)", 1e9)),
        false => Figure::single_column(70.0).panel(panel(
            run_gauge,
            0,
            "$K$ if $A$ is as dry (GN/m$^{3/2}$)",
            1e-9,
        )),
    }
}

/// A film's number at each speed, and that of all speeds together with its standard error.
fn film(run_gauge: &GaugeResult, number: &Parameter) -> Chart {
    let end = number.name.rsplit('.').next().unwrap_or(&number.name).replace('_', "-");
    let label = format!("Film's {end} ({})", number.unit);
    let mut chart = Chart::new("Speed of the striker (m/s)", &label).x_log();
    if let Some((problem, fit, _)) = &run_gauge.film {
        let same = |of: &Parameter| of.name == number.name;
        let ends = [speeds(run_gauge)[0], speeds(run_gauge)[POINTS - 1]];
        if let Some(at) = problem.parameters().iter().position(same) {
            let (value, sd) = (fit.point[at], Covariance::new(problem.parameters(), fit).sd[at]);
            if is_determined(value, sd) {
                let band =
                    Series::band("its standard error", &ends, &[value - sd; 2], &[value + sd; 2]);
                chart = chart.with(band.colour(Colour::BLUE));
            }
            let line = Series::line("all speeds together", &ends, &[value; 2]);
            chart = chart.with(line.colour(Colour::BLUE));
        }
    }
    chart.with(measured(run_gauge, 0, 1.0))
}

/// Whether any row determines both K and A. If none does, an oil's K is another quantity than what
/// was measured.
fn has_both(run_gauge: &GaugeResult) -> bool {
    let both = |contact: &Contact| contact.combination.is_none();
    let mut reported = run_gauge.rows.iter().filter_map(|row| row.contact.as_ref().ok());
    reported.any(both)
}

fn panel(run_gauge: &GaugeResult, of: usize, label: &str, unit: f64) -> Chart {
    let chart = Chart::new("Speed of the striker (m/s)", label).x_log();
    let chart = match of {
        // K changes by some percent, A tenfold; one legend does for both.
        0 => chart,
        _ => chart.y_log().legend(false),
    };
    let shown = if has_both(run_gauge) { run_gauge.oils.len() } else { 0 };
    let oils = run_gauge.oils.iter().take(shown).enumerate();
    let chart =
        oils.fold(chart, |chart, (at, oil)| chart.with(curve(run_gauge, (at, oil), of, unit)));
    let points = measured(run_gauge, of, unit);
    let others = run_gauge.rows.iter().filter_map(|row| {
        let contact = row.contact.as_ref().ok()?;
        let others = match contact.branch {
            Branch::Unknown => contact.pairs(),
            _ => contact.others.iter().collect(),
        };
        let value = move |pair: &Pair| (row.speed_m_s, unit * pair.ln[of].exp());
        Some(others.into_iter().map(value))
    });
    let (speeds, values): (Vec<f64>, Vec<f64>) = others.flatten().unzip();
    match values.is_empty() {
        true => chart.with(points),
        false => {
            let others =
                Series::points("other pairs as good", &speeds, &values).marker(Marker::OpenCircle);
            chart.with(others.colour(Colour::BLACK)).with(points)
        }
    }
}

/// What the rows determine of a number, with its standard errors.
fn measured(run_gauge: &GaugeResult, of: usize, unit: f64) -> Series {
    let known = run_gauge.rows.iter().filter_map(|row| {
        let contact = row.contact.as_ref().ok()?;
        if contact.branch == Branch::Unknown {
            return None;
        }
        let (value, sd) = contact.first.estimates()[of];
        is_determined(value, sd).then_some((row.speed_m_s, unit * value, unit * sd))
    });
    let known: Vec<(f64, f64, f64)> = known.collect();
    let column = |of: fn(&(f64, f64, f64)) -> f64| known.iter().map(of).collect::<Vec<f64>>();
    let name = if known.is_empty() { "" } else { "measured" };
    Series::points(name, &column(|p| p.0), &column(|p| p.1))
        .y_error(&column(|p| p.2))
        .marker(Marker::Circle)
        .colour(Colour::BLACK)
}

/// Speeds in m/s at which lines are drawn.
fn speeds(run_gauge: &GaugeResult) -> Vec<f64> {
    let speeds = run_gauge.gauge.data.speeds_m_s();
    let first = speeds.first().copied().unwrap_or(0.1);
    let last = speeds.last().copied().unwrap_or(1.0);
    let speed = |at: usize| first * (last / first).powf(at as f64 / (POINTS - 1) as f64);
    (0..POINTS).map(speed).collect()
}

fn curve(run_gauge: &GaugeResult, (number, oil): (usize, &Oil), of: usize, unit: f64) -> Series {
    let speeds = speeds(run_gauge);
    let value = |speed: &f64| {
        let (k, a) = oil.contact(run_gauge.gauge.radius_m, *speed);
        unit * [k, a][of]
    };
    let values: Vec<f64> = speeds.iter().map(value).collect();
    let names: Vec<&str> = run_gauge.oils.iter().map(|oil| oil.name.as_str()).collect();
    let (colour, _) = case_look(&oil.name, &names);
    let dashes = [Dash::Solid, Dash::Dashed, Dash::DashDotted, Dash::Dotted];
    Series::line(&oil.name, &speeds, &values).colour(colour).dash(dashes[number % dashes.len()])
}

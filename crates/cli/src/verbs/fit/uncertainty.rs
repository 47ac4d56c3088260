//! Figures of uncertainty: profiles and samples.

use super::Fitted;
use hertzchain_figures::{Chart, Colour, Dash, Figure, Legend, Marker, Series};
use hertzchain_infer::{Parameter, Posterior, Problem, Profile, RISE_OF_95_PERCENT};
use std::f64::consts::TAU;

/// A parameter as an axis says it.
fn label(parameter: &Parameter) -> String {
    match parameter.unit.as_str() {
        "" => parameter.name.clone(),
        unit => format!("{} ({unit})", parameter.name),
    }
}

/// Height of a row of panels in mm.
const ROW_MM: f64 = 62.0;

/// Rise of chi-square along each parameter, beside the parabola that the
/// covariance stands for.
pub fn profiles(fitted: &Fitted, profiles: &[Profile]) -> Figure {
    let height_mm = ROW_MM * profiles.len().div_ceil(2) as f64;
    let figure = Figure::double_column(height_mm).columns(2);
    profiles.iter().fold(figure, |figure, profile| {
        figure.panel(profile_chart(fitted, profile))
    })
}

fn profile_chart(fitted: &Fitted, profile: &Profile) -> Chart {
    let at = profile.parameter;
    let (best, sd) = (fitted.fit.point[at], fitted.covariance.sd[at]);
    let parabola: Vec<f64> = profile
        .values
        .iter()
        .map(|value| ((value - best) / sd).powi(2))
        .collect();
    let name = label(&fitted.problem.parameters()[at]);
    Chart::new(&name, "Rise of chi-square")
        .h_line(1.0, "68 %")
        .h_line(RISE_OF_95_PERCENT, "95 %")
        .with(
            Series::line("covariance", &profile.values, &parabola)
                .colour(Colour::GREY)
                .dash(Dash::Dashed),
        )
        .with(
            Series::line("profile", &profile.values, &profile.rise)
                .colour(Colour::BLUE)
                .dash(Dash::Solid),
        )
}

/// Most samples drawn in a panel.
const MOST_POINTS: usize = 1200;

/// Bars of a histogram.
const BARS: usize = 30;

/// Parameters that fit on a page.
const MOST_PARAMETERS: usize = 5;

/// Samples of each pair of parameters with the covariance's ellipses of 68 and
/// 95 %, and a histogram of each parameter on the diagonal.
pub fn corner(fitted: &Fitted, posterior: &Posterior) -> Figure {
    let count = posterior.mean.len().min(MOST_PARAMETERS);
    let figure = Figure::double_column(ROW_MM * count as f64).columns(count);
    let cells = (0..count).flat_map(|row| (0..count).map(move |column| (column, row)));
    cells.fold(figure, |figure, (column, row)| {
        figure.panel(match column == row {
            true => histogram(fitted, posterior, row),
            false => pair(fitted, posterior, (column, row)),
        })
    })
}

/// Density of samples, and the covariance's normal distribution.
fn histogram(fitted: &Fitted, posterior: &Posterior, at: usize) -> Chart {
    let samples = &posterior.samples[at];
    let (from, to) = (posterior.quantile(at, 0.0), posterior.quantile(at, 1.0));
    let width = (to - from) / BARS as f64;
    let mut counts = vec![0.0; BARS];
    for value in samples {
        let bar = ((value - from) / width) as usize;
        counts[bar.min(BARS - 1)] += 1.0;
    }
    let most = counts.iter().copied().fold(1.0, f64::max);
    let middle = |bar: usize| from + (bar as f64 + 0.5) * width;
    let edges = (0..BARS).flat_map(|bar| [middle(bar) - 0.5 * width, middle(bar) + 0.5 * width]);
    let heights = counts.iter().flat_map(|count| [count / most; 2]);
    let (best, sd) = (fitted.fit.point[at], fitted.covariance.sd[at]);
    let middles: Vec<f64> = (0..BARS).map(middle).collect();
    let bell = |x: &f64| (-0.5 * ((x - best) / sd).powi(2)).exp();
    let bells: Vec<f64> = middles.iter().map(bell).collect();
    Chart::new(
        &label(&fitted.problem.parameters()[at]),
        "Density over its maximum",
    )
    .legend(Legend::Off)
    .with(
        Series::line("", &edges.collect::<Vec<_>>(), &heights.collect::<Vec<_>>())
            .colour(Colour::BLUE)
            .dash(Dash::Solid),
    )
    .with(
        Series::line("", &middles, &bells)
            .colour(Colour::BLACK)
            .dash(Dash::Dashed),
    )
}

fn pair(fitted: &Fitted, posterior: &Posterior, (x, y): (usize, usize)) -> Chart {
    let every = posterior.samples[x].len().div_ceil(MOST_POINTS).max(1);
    let thinned = |at: usize| -> Vec<f64> {
        posterior.samples[at]
            .iter()
            .step_by(every)
            .copied()
            .collect()
    };
    let parameters = fitted.problem.parameters();
    let chart = Chart::new(&label(&parameters[x]), &label(&parameters[y]))
        .legend(Legend::Off)
        .with(
            Series::points("", &thinned(x), &thinned(y))
                .marker(Marker::Circle)
                .colour(Colour::SKY)
                .width(0.4),
        );
    [1.515, 2.448].into_iter().fold(chart, |chart, radius| {
        let (xs, ys) = ellipse(fitted, (x, y), radius);
        chart.with(
            Series::line("", &xs, &ys)
                .colour(Colour::BLACK)
                .dash(Dash::Dashed),
        )
    })
}

/// Points of an ellipse of the covariance; two normal numbers lie within 1.515
/// of its standard errors in 68 % of cases, within 2.448 in 95 %.
fn ellipse(fitted: &Fitted, (x, y): (usize, usize), radius: f64) -> (Vec<f64>, Vec<f64>) {
    let (point, sd) = (&fitted.fit.point, &fitted.covariance.sd);
    let rho = fitted.covariance.correlation(x, y).unwrap_or(0.0);
    let place = |step: i32| {
        let (sin, cos) = (TAU * f64::from(step) / 120.0).sin_cos();
        let across = rho * cos + (1.0 - rho * rho).max(0.0).sqrt() * sin;
        (
            point[x] + radius * sd[x] * cos,
            point[y] + radius * sd[y] * across,
        )
    };
    (0..=120).map(place).unzip()
}

//! Figures of a fit and of its uncertainty: profiles, samples, and what the data determine.

use super::report::short;
use crate::fit::{Inferred, TableFit};
use hertzchain_figures::inference::{Corner, ProfileCurve, SingularValues, profile_figure};
use hertzchain_figures::{Chart, Colour, Dash, Figure, Marker, Series};
use hertzchain_infer::{Observable, Parameter, Posterior, Profile, RISE_OF_95_PERCENT};

const LOOKS: [(Colour, Marker); 4] = [
    (Colour::BLUE, Marker::Circle),
    (Colour::VERMILION, Marker::OpenSquare),
    (Colour::GREEN, Marker::Triangle),
    (Colour::PURPLE, Marker::Diamond),
];

/// Standard errors of the fitted curve that its band spans to either side: 95 %.
const BAND: f64 = 1.96;

/// Data with the fit and its band; residuals below.
pub(super) fn fit(table: &TableFit<'_>, inferred: &Inferred, title: &str) -> Figure {
    let data = &table.curve.data;
    let kinds = [true, false].map(|times| -> Vec<Observable> {
        let all = Observable::ALL.into_iter();
        all.filter(|of| of.is_time() == times && data.has(*of)).collect()
    });
    let charts = kinds.iter().filter(|shown| !shown.is_empty()).enumerate().map(|(at, shown)| {
        let chart = curves(table, shown);
        if at == 0 { chart.title(title) } else { chart }
    });
    let charts: Vec<Chart> = charts.collect();
    let empty = Figure::single_column(75.0 + 55.0 * charts.len() as f64).share_x();
    charts.into_iter().fold(empty, Figure::panel).panel(residuals(table, inferred))
}

fn scale(of: Observable) -> f64 {
    if of.is_time() { 1e6 } else { 1.0 }
}

fn curves(table: &TableFit<'_>, shown: &[Observable]) -> Chart {
    let times = shown.iter().any(|of| of.is_time());
    let label = if times { "Time of flight (µs)" } else { "Ratio of peaks" };
    let chart = Chart::new("Speed of the striker (m/s)", label).x_log();
    let chart = if times { chart.y_log() } else { chart };
    let named = shown.iter().enumerate();
    named.fold(chart, |chart, (at, of)| {
        let line = if at == 0 { "fit" } else { "" };
        with_curve(table, chart, *of, line)
    })
}

/// Measured points, the fitted line and its 95 % band.
fn with_curve(table: &TableFit<'_>, chart: Chart, of: Observable, line: &str) -> Chart {
    let rows = table.curve.data.rows.iter().enumerate();
    let rows: Vec<_> = rows.filter_map(|(at, row)| Some((at, row, row.value(of)?))).collect();
    let unit = scale(of);
    let column =
        |value: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..rows.len()).map(value).collect() };
    let speeds = column(&|i| rows[i].1.speed_m_s.value);
    let predicted = column(&|i| {
        let of_row = table.fit_curve.predicted.get(rows[i].0).and_then(|row| row[of as usize]);
        unit * of_row.unwrap_or(f64::NAN)
    });
    let spread = column(&|i| unit * BAND * table.fit_curve.sd[rows[i].0][of as usize]);
    let (colour, marker) = LOOKS[of as usize];
    let edge = |sign: f64| column(&|i| predicted[i] + sign * spread[i]);
    let points = Series::points(short(of), &speeds, &column(&|i| unit * rows[i].2.value))
        .y_error(&column(&|i| unit * rows[i].2.sigma))
        .x_error(&column(&|i| rows[i].1.speed_m_s.sigma));
    chart
        .with(Series::band("", &speeds, &edge(-1.0), &edge(1.0)).colour(colour))
        .with(Series::line(line, &speeds, &predicted).colour(colour).dash(Dash::Solid).width(0.7))
        .with(points.colour(colour).marker(marker))
}

/// Standardised residuals against speed, with the band that the parameters' errors
/// leave the fit, in the same standard errors.
fn residuals(table: &TableFit<'_>, inferred: &Inferred) -> Chart {
    let data = &table.curve.data;
    let label = "Residual (standard errors)";
    let chart = Chart::new("Speed of the striker (m/s)", label).x_log().h_line(0.0, "");
    let residuals = table.curve.measured().zip(table.residuals);
    let spreads = spreads(table, inferred);
    let all: Vec<_> = residuals.zip(&spreads).collect();
    let sizes = all.iter().map(|((_, residual), sd)| residual.abs().max(BAND * **sd));
    let reach = sizes.filter(|size| size.is_finite()).fold(1.0, f64::max);
    let chart = chart.y_range(-1.1 * reach, 1.1 * reach);
    Observable::ALL.into_iter().filter(|of| data.has(*of)).fold(chart, |chart, of| {
        let own = || all.iter().filter(|(((_, other), _), _)| *other == of);
        let (speeds, values): (Vec<f64>, Vec<f64>) = own()
            .map(|(((row, _), residual), _)| (data.rows[*row].speed_m_s.value, **residual))
            .unzip();
        let edge = |sign: f64| own().map(|(_, sd)| sign * BAND * **sd).collect::<Vec<_>>();
        let (colour, marker) = LOOKS[of as usize];
        let name = format!("95 % of the fit, {}", short(of));
        let first = Observable::ALL.iter().find(|of| data.has(**of)) == Some(&of);
        // A second band would hide the first.
        let chart = match first {
            true => {
                let band = Series::band(&name, &speeds, &edge(-1.0), &edge(1.0));
                chart.with(band.colour(colour))
            }
            false => [(-1.0, ""), (1.0, &name)].iter().fold(chart, |chart, (sign, name)| {
                let line = Series::line(name, &speeds, &edge(*sign));
                chart.with(line.colour(colour).dash(Dash::Dashed).width(0.7))
            }),
        };
        let points = Series::points("", &speeds, &values);
        chart.with(points.colour(colour).marker(marker))
    })
}

/// Standard errors of the fitted curve in those of each residual.
fn spreads(table: &TableFit<'_>, Inferred { fit, covariance, .. }: &Inferred) -> Vec<f64> {
    let slopes = |at: usize| {
        let columns = fit.jacobian.columns.iter();
        columns.map(move |column| column.get(at).copied().unwrap_or(f64::NAN))
    };
    (table.first..table.first + table.residuals.len())
        .map(|at| covariance.sd_of(&slopes(at).collect::<Vec<f64>>()))
        .collect()
}

fn labels(inferred: &Inferred) -> Vec<String> {
    let label = |parameter: &Parameter| match parameter.unit.as_str() {
        "" => parameter.name.clone(),
        unit => format!("{} ({})", parameter.name, in_markup(unit)),
    };
    inferred.parameters.iter().map(label).collect()
}

/// A unit with its powers raised: `N/m^(3/2)` as a figure shows it.
fn in_markup(unit: &str) -> String {
    let mut parts = unit.split('^');
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| {
        let (power, rest) = match part.strip_prefix('(').and_then(|part| part.split_once(')')) {
            Some(parts) => parts,
            None => part.split_at(part.find([' ', '/']).unwrap_or(part.len())),
        };
        format!("{text}$^{{{power}}}${rest}")
    })
}

/// Rise of chi-square along each parameter, beside the parabola that the
/// covariance stands for.
pub(super) fn profiles(inferred: &Inferred, profiles: &[Profile]) -> Figure {
    let labels = labels(inferred);
    let curves: Vec<ProfileCurve> = (profiles.iter())
        .map(|profile| ProfileCurve {
            label: &labels[profile.parameter],
            values: &profile.values,
            rise: &profile.rise,
            best: inferred.fit.point[profile.parameter],
            standard_error: Some(inferred.covariance.sd[profile.parameter]),
            levels: &[(1.0, "68 %"), (RISE_OF_95_PERCENT, "95 %")],
        })
        .collect();
    profile_figure(&curves)
}

/// The posterior of each parameter and pair, beside the covariance's.
pub(super) fn corner(inferred: &Inferred, posterior: &Posterior) -> Figure {
    Corner {
        labels: &labels(inferred),
        samples: &posterior.samples,
        marks: &inferred.fit.point,
        covariance: &inferred.covariance.matrix,
    }
    .figure()
}

/// Singular values of the Jacobian, each parameter in units of its scale.
pub(super) fn singular_values(inferred: &Inferred) -> Figure {
    let found = &inferred.identifiability;
    let names = inferred.parameters.iter().map(|p| p.name.clone());
    SingularValues {
        names: &names.collect::<Vec<String>>(),
        values: &found.singular_values,
        directions: &found.directions,
        floor: found.floor,
    }
    .figure()
}

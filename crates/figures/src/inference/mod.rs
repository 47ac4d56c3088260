//! Pictures of what fits leave uncertain: posteriors, profiles, singular values.

mod corner;

pub use corner::Corner;

use crate::{Chart, Colour, Dash, Figure, Marker, Series};

/// The least chi-square as a function of one parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileCurve<'a> {
    /// Label of the parameter, with its unit.
    pub label: &'a str,
    /// Values of the parameter, ascending.
    pub values: &'a [f64],
    /// Chi-square above its least at each.
    pub rise: &'a [f64],
    /// The parameter at the optimum.
    pub best: f64,
    /// Its standard error by the covariance, if it has one.
    pub standard_error: Option<f64>,
    /// Rises that bound intervals, and what to write beside them.
    pub levels: &'a [(f64, &'a str)],
}

/// Points drawn between two computed ones.
const BETWEEN: usize = 12;

/// One panel a parameter: the profile, and the parabola that the covariance takes it for.
pub fn profile_figure(curves: &[ProfileCurve<'_>]) -> Figure {
    let columns = if curves.len() > 1 { 2 } else { 1 };
    let rows = curves.len().div_ceil(columns).max(1);
    let height = 15.0 + 50.0 * rows as f64;
    let empty = match columns {
        1 => Figure::single_column(height),
        _ => Figure::double_column(height).letters(),
    };
    let figure =
        curves.iter().fold(empty.columns(columns), |figure, curve| figure.panel(curve.chart()));
    figure.title("Profiles of chi-square").caption(
        "Solid, with symbols where it was computed: the least chi-square for each value of the parameter, \
         all others re-optimised. Dashed: the parabola of the covariance. Where both part, the \
         covariance's interval is wrong.",
    )
}

impl ProfileCurve<'_> {
    fn chart(&self) -> Chart {
        let top = self.levels.iter().map(|level| level.0).fold(1.0, f64::max);
        let mut chart = Chart::new(self.label, r"$\Delta\chi^2$").y_range(0.0, 1.3 * top);
        for (level, text) in self.levels {
            chart = chart.h_line(*level, text);
        }
        let (x, y) = self.between();
        let profile = Series::line("", &x, &y).colour(Colour::BLUE).dash(Dash::Solid);
        let points = Series::points("profile", self.values, self.rise);
        let mut chart =
            chart.with(profile).with(points.colour(Colour::BLUE).marker(Marker::Circle));
        if let Some(error) = self.standard_error.filter(|e| *e > 0.0 && e.is_finite()) {
            let reach = error * (1.3 * top).sqrt();
            let x: Vec<f64> = (-50..=50).map(|i| self.best + reach * f64::from(i) / 50.0).collect();
            let y: Vec<f64> = x.iter().map(|x| ((x - self.best) / error).powi(2)).collect();
            let parabola = Series::line("covariance", &x, &y);
            chart = chart.with(parabola.colour(Colour::VERMILION).dash(Dash::Dashed));
        }
        chart
    }

    /// Straight between computed values in ±√rise, so that parabolas look like parabolas.
    fn between(&self) -> (Vec<f64>, Vec<f64>) {
        let root = |value: f64, rise: f64| (value - self.best).signum() * rise.max(0.0).sqrt();
        let pairs = self.values.iter().zip(self.rise);
        let met: Vec<(f64, f64)> = pairs.map(|(v, r)| (*v, root(*v, *r))).collect();
        let (mut x, mut y) = (Vec::new(), Vec::new());
        for pair in met.windows(2) {
            for i in 0..=BETWEEN {
                let share = i as f64 / BETWEEN as f64;
                let height = pair[0].1 + share * (pair[1].1 - pair[0].1);
                x.push(pair[0].0 + share * (pair[1].0 - pair[0].0));
                y.push(height * height);
            }
        }
        (x, y)
    }
}

/// Singular values of a fit's Jacobian and their directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingularValues<'a> {
    /// Names of the parameters.
    pub names: &'a [String],
    /// Singular values, largest first: standard deviations for a change by one scale.
    pub values: &'a [f64],
    /// One unit direction a value, in units of the parameters' scales.
    pub directions: &'a [Vec<f64>],
    /// Values up to here cannot be distinguished from 0.
    pub floor: f64,
}

impl SingularValues<'_> {
    /// Values above, the parameters' parts in each direction below.
    pub fn figure(&self) -> Figure {
        Figure::single_column(110.0)
            .panel(self.sizes())
            .panel(self.parts())
            .letters()
            .share_x()
            .title("What the data determine")
            .caption(
                "(a) Singular values of the Jacobian: by how many standard deviations all residuals \
                 together change for one scale along each direction. Below 1 the direction is not \
                 determined; below the derivatives' own error nothing is known of it; zero is drawn at the lower edge. (b) Parts of \
                 the parameters in each direction.",
            )
    }

    fn numbers(&self) -> Vec<f64> {
        (1..=self.values.len()).map(|i| i as f64).collect()
    }

    fn empty(&self, y_label: &str) -> Chart {
        Chart::new("Direction", y_label).x_whole().x_range(0.5, self.values.len() as f64 + 0.5)
    }

    fn sizes(&self) -> Chart {
        let largest = self.values.first().copied().unwrap_or(1.0).max(2.0);
        let least = self.values.iter().copied().fold(self.floor, f64::min);
        // Zeros, which have no place on this axis, are drawn at its lower end.
        let bottom = least.max(1e-3 * self.floor).max(1e-12 * largest).min(0.5) / 2.0;
        let shown: Vec<f64> = self.values.iter().map(|v| v.max(1.3 * bottom)).collect();
        let points = Series::points("", &self.numbers(), &shown);
        self.empty(r"Singular value ($\sigma$ per scale)")
            .y_log()
            .y_range(bottom, 3.0 * largest)
            .h_line(1.0, "undetermined below")
            .h_line(self.floor, "error of the derivatives")
            .with(points.colour(Colour::BLUE).marker(Marker::Circle))
    }

    fn parts(&self) -> Chart {
        let count = self.names.len();
        let chart = self.empty("Part in the direction").y_range(-1.1, 1.1).h_line(0.0, "");
        self.names.iter().enumerate().fold(chart, |chart, (k, name)| {
            let part = |direction: &Vec<f64>| direction.get(k).copied().unwrap_or(f64::NAN);
            let parts: Vec<f64> = self.directions.iter().map(part).collect();
            // Beside each other, so that equal parts are all seen.
            let aside = 0.5 * ((k as f64 + 0.5) / count as f64 - 0.5);
            let x: Vec<f64> = self.numbers().iter().map(|n| n + aside).collect();
            let points = Series::points(name, &x, &parts);
            chart.with(
                points
                    .colour(Colour::PALETTE[k % Colour::PALETTE.len()])
                    .marker(Marker::of_index(k)),
            )
        })
    }
}

//! What the data determine, direction by direction.

use crate::{Chart, Colour, Figure, Marker, Series};

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
    #[must_use]
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
        Chart::new("Direction", y_label)
            .x_whole()
            .x_range(0.5, self.values.len() as f64 + 0.5)
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
        let chart = self
            .empty("Part in the direction")
            .y_range(-1.1, 1.1)
            .h_line(0.0, "");
        self.names
            .iter()
            .enumerate()
            .fold(chart, |chart, (k, name)| {
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

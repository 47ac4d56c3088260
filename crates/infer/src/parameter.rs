//! A free parameter: where it starts, what it may be, what is known beforehand.

/// A free parameter of a [`Problem`](crate::Problem).
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name, as messages and tables show it.
    pub name: String,
    /// Unit of all its numbers; empty if it has none.
    pub unit: String,
    /// Where a fit starts.
    pub start: f64,
    /// Least value; −∞ if there is none.
    pub lower: f64,
    /// Largest value; +∞ if there is none.
    pub upper: f64,
    /// Size of a change that matters, positive: the start's magnitude, unless
    /// something better is known. Derivatives are taken over a small part of it,
    /// and identifiability is judged in its unit.
    pub scale: f64,
    /// What is known of it beside the data.
    pub prior: Prior,
}

/// What is known of a parameter beside the data.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Prior {
    /// Nothing but the bounds.
    #[default]
    Flat,
    /// As if it had been measured: normal around `mean`.
    Normal {
        /// Mean, in the parameter's unit.
        mean: f64,
        /// Standard deviation, in the parameter's unit, positive.
        sd: f64,
    },
    /// As if its logarithm had been measured: ln θ normal around ln `median`.
    LogNormal {
        /// Median, in the parameter's unit, positive.
        median: f64,
        /// Standard deviation of ln θ, positive.
        ln_sd: f64,
    },
}

impl std::fmt::Display for Prior {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Flat => write!(f, "no prior"),
            Self::Normal { mean, sd } => write!(f, "a prior {} ± {}", short(mean), short(sd)),
            Self::LogNormal { median, ln_sd } => {
                write!(
                    f,
                    "a prior {} times or over {}",
                    short(median),
                    short(&ln_sd.exp())
                )
            }
        }
    }
}

/// A number as people write it: conversions of units and logarithms leave a last digit that
/// nobody gave.
fn short(value: &f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(*value)
}

/// Why a parameter cannot be free as described.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ParameterError {
    /// Bounds in the wrong order, or not numbers.
    #[error("{name}: the bounds {} to {} leave nothing between them", short(.lower), short(.upper))]
    Bounds {
        /// The parameter.
        name: String,
        /// Its lower bound.
        lower: f64,
        /// Its upper bound.
        upper: f64,
    },
    /// The start is outside the bounds or not finite.
    #[error(
        "{name} starts at {}, outside its bounds {} to {}: start within them, or move them",
        short(.start), short(.lower), short(.upper)
    )]
    Start {
        /// The parameter.
        name: String,
        /// Its start.
        start: f64,
        /// Its lower bound.
        lower: f64,
        /// Its upper bound.
        upper: f64,
    },
    /// The scale is not positive and finite.
    #[error(
        "{name} has the scale {}: expected a positive number, the size of a change that matters",
        short(.scale)
    )]
    Scale {
        /// The parameter.
        name: String,
        /// Its scale.
        scale: f64,
    },
    /// A prior's width is not positive, or its centre impossible.
    #[error("{name}: {prior} is no distribution; widths and medians must be positive")]
    Prior {
        /// The parameter.
        name: String,
        /// Its prior.
        prior: Prior,
    },
    /// The prior makes the start all but impossible.
    #[error(
        "{name} starts at {}, {deviation:.1} standard deviations from the middle of its prior: start nearer, or widen the prior",
        short(.start)
    )]
    PriorExcludesStart {
        /// The parameter.
        name: String,
        /// Its start.
        start: f64,
        /// Distance in standard deviations of the prior.
        deviation: f64,
    },
}

/// Distance from the middle of a prior at which it excludes a start.
const EXCLUDED_SD: f64 = 6.0;

impl Prior {
    /// (θ − mean)/sd, of the logarithm for a log-normal prior: what a fit adds
    /// to its residuals. `None` if nothing is known; infinite where impossible.
    #[must_use]
    pub fn residual(&self, value: f64) -> Option<f64> {
        match *self {
            Self::Flat => None,
            Self::Normal { mean, sd } => Some((value - mean) / sd),
            Self::LogNormal { .. } if value <= 0.0 => Some(f64::INFINITY),
            Self::LogNormal { median, ln_sd } => Some((value / median).ln() / ln_sd),
        }
    }

    /// Logarithm of the density over θ itself up to a constant; a log-normal
    /// prior's has −ln θ beside the square of its residual.
    #[must_use]
    pub fn ln_density(&self, value: f64) -> f64 {
        let square = self.residual(value).map_or(0.0, |r| -0.5 * r * r);
        match self {
            Self::LogNormal { .. } if value > 0.0 => square - value.ln(),
            _ => square,
        }
    }

    fn is_sound(&self) -> bool {
        let width = |w: f64| w > 0.0 && w.is_finite();
        match *self {
            Self::Flat => true,
            Self::Normal { mean, sd } => mean.is_finite() && width(sd),
            Self::LogNormal { median, ln_sd } => width(median) && width(ln_sd),
        }
    }
}

/// A name, with a unit in parentheses if there is one.
#[must_use]
pub fn titled(name: &str, unit: &str) -> String {
    match unit {
        "" => name.to_owned(),
        unit => format!("{name} ({unit})"),
    }
}

impl Parameter {
    /// A parameter without bounds or prior, its scale the start's magnitude (1
    /// if it starts at 0).
    #[must_use]
    pub fn new(name: &str, unit: &str, start: f64) -> Self {
        Self {
            name: name.to_owned(),
            unit: unit.to_owned(),
            start,
            lower: f64::NEG_INFINITY,
            upper: f64::INFINITY,
            scale: if start == 0.0 { 1.0 } else { start.abs() },
            prior: Prior::Flat,
        }
    }

    /// Its name, with its unit in parentheses if it has one.
    #[must_use]
    pub fn title(&self) -> String {
        titled(&self.name, &self.unit)
    }

    /// The same parameter, bounded.
    #[must_use]
    pub fn within(mut self, lower: f64, upper: f64) -> Self {
        (self.lower, self.upper) = (lower, upper);
        self
    }

    /// The same parameter with a prior.
    #[must_use]
    pub fn with_prior(mut self, prior: Prior) -> Self {
        self.prior = prior;
        self
    }

    /// Whether a value is within the bounds.
    #[must_use]
    pub fn admits(&self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }

    /// Checks bounds, start, scale and prior against each other.
    ///
    /// # Errors
    /// The first thing that does not fit, see [`ParameterError`].
    pub fn check(&self) -> Result<(), ParameterError> {
        let (name, start) = (self.name.clone(), self.start);
        let (lower, upper) = (self.lower, self.upper);
        if lower.is_nan() || upper.is_nan() || lower >= upper {
            return Err(ParameterError::Bounds { name, lower, upper });
        }
        if !start.is_finite() || !self.admits(start) {
            return Err(ParameterError::Start {
                name,
                start,
                lower,
                upper,
            });
        }
        if !(self.scale > 0.0 && self.scale.is_finite()) {
            let scale = self.scale;
            return Err(ParameterError::Scale { name, scale });
        }
        self.check_prior()
    }

    fn check_prior(&self) -> Result<(), ParameterError> {
        let (name, start, prior) = (self.name.clone(), self.start, self.prior);
        if !prior.is_sound() {
            return Err(ParameterError::Prior { name, prior });
        }
        match prior.residual(start).map(f64::abs) {
            Some(deviation) if deviation > EXCLUDED_SD => Err(ParameterError::PriorExcludesStart {
                name,
                start,
                deviation,
            }),
            _ => Ok(()),
        }
    }
}

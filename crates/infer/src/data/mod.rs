//! Measured times of flight: tables of one row a speed.

mod check;
mod columns;
mod error;
mod read;
mod shots;

pub use check::wrong_speed;
pub use error::{DataError, Place};
pub(crate) use read::with_plain_ends;
pub use read::{Defaults, Scatter, Selection};
pub use shots::{FEWEST_SHOTS, Freedom, widening};

use hertzchain_measure::signal::Estimate;

/// A measured number of a row that a model can predict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Observable {
    /// Incident time of flight in s.
    Incident,
    /// Reflected time of flight in s.
    Reflected,
    /// Peak at the wall over the passing peak.
    WallOverPassing,
    /// Returning peak over the passing peak.
    ReturningOverPassing,
}

impl Observable {
    /// Every observable, in the order of a row.
    pub const ALL: [Self; 4] = [
        Self::Incident,
        Self::Reflected,
        Self::WallOverPassing,
        Self::ReturningOverPassing,
    ];

    /// Its column in a table.
    #[must_use]
    pub const fn column(self) -> &'static str {
        match self {
            Self::Incident => "tof_incident_s",
            Self::Reflected => "tof_reflected_s",
            Self::WallOverPassing => "wall_over_passing",
            Self::ReturningOverPassing => "returning_over_passing",
        }
    }

    /// The column that is read in its place where a table has it: what `measure`
    /// takes to the mean speed, shot by shot, scatters no longer with their speeds.
    pub(super) const fn finer_column(self) -> Option<&'static str> {
        match self {
            Self::Incident => Some("tof_incident_at_mean_speed_s"),
            Self::Reflected => Some("tof_reflected_at_mean_speed_s"),
            Self::WallOverPassing | Self::ReturningOverPassing => None,
        }
    }

    /// What it is called.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Incident => "incident ToF",
            Self::Reflected => "reflected ToF",
            Self::WallOverPassing => "wall/passing peak",
            Self::ReturningOverPassing => "returning/passing peak",
        }
    }

    /// Whether it is a time in s; else it is a ratio.
    #[must_use]
    pub const fn is_time(self) -> bool {
        matches!(self, Self::Incident | Self::Reflected)
    }

    pub(crate) const fn index(self) -> usize {
        self as usize
    }
}

/// What was measured at one speed.
#[derive(Clone, Debug, PartialEq)]
pub struct DataRow {
    /// Line of the file, from 1.
    pub line: u64,
    /// Speed of the striker in m/s; its sigma may be 0.
    pub speed_m_s: Estimate,
    /// Measured values in the order of [`Observable::ALL`].
    pub values: [Option<Estimate>; 4],
    /// Correlation of the errors of incident and reflected time, which share the wall's pick;
    /// without it they are taken as independent.
    pub correlation: Option<f64>,
    /// How well all these standard errors are known.
    pub freedom: Freedom,
}

impl DataRow {
    /// The measured value of an observable.
    #[must_use]
    pub fn value(&self, of: Observable) -> Option<Estimate> {
        self.values[of.index()]
    }

    /// Correlation of the errors of its first two values: of both times, where both are there.
    pub(crate) fn correlation(&self) -> f64 {
        match self.values {
            [Some(_), Some(_), ..] => self.correlation.unwrap_or(0.0),
            _ => 0.0,
        }
    }

    /// Degrees of freedom of the scatter that an observable's standard error comes from.
    pub(crate) fn freedom(&self, of: Observable) -> f64 {
        self.freedom.of(of)
    }

    /// The observables that were measured.
    pub fn observables(&self) -> impl Iterator<Item = Observable> + '_ {
        let measured = |of: &Observable| self.value(*of).is_some();
        Observable::ALL.into_iter().filter(measured)
    }
}

/// A curve: rows in order of speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    /// Where it comes from, as messages name it.
    pub file: String,
    /// The case of a table of several; empty where there is none.
    pub case: String,
    /// Rows in order of speed.
    pub rows: Vec<DataRow>,
}

impl Data {
    /// Speeds in m/s.
    #[must_use]
    pub fn speeds_m_s(&self) -> Vec<f64> {
        self.rows.iter().map(|row| row.speed_m_s.value).collect()
    }

    /// How many numbers were measured beside speeds.
    #[must_use]
    pub fn value_count(&self) -> usize {
        self.rows.iter().map(|row| row.observables().count()).sum()
    }

    /// Whether some row has an observable.
    #[must_use]
    pub fn has(&self, of: Observable) -> bool {
        self.rows.iter().any(|row| row.value(of).is_some())
    }

    /// Lines whose speeds have no error, or one of 0: they count as exactly known.
    #[must_use]
    pub fn lines_of_exact_speeds(&self) -> Vec<u64> {
        let exact = self.rows.iter().filter(|row| row.speed_m_s.sigma == 0.0);
        let mut lines: Vec<u64> = exact.map(|row| row.line).collect();
        lines.sort_unstable();
        lines
    }

    /// Lines with both times of flight whose errors have no stated correlation.
    #[must_use]
    pub fn lines_without_correlation(&self) -> Vec<u64> {
        let both = |row: &&DataRow| row.values[..2].iter().all(Option::is_some);
        let rows = self.rows.iter().filter(both);
        let unknown = rows.filter(|row| row.correlation.is_none());
        let mut lines: Vec<u64> = unknown.map(|row| row.line).collect();
        lines.sort_unstable();
        lines
    }

    /// How many rows have an error that is widened for its uncertainty, and the least and the
    /// most degrees of freedom among those errors; `None` if there is no such row.
    #[must_use]
    pub fn widened(&self) -> Option<(usize, [f64; 2])> {
        let own = |row: &DataRow| {
            let of = row.observables().map(|of| row.freedom(of));
            let all = of.chain([row.freedom.speed]);
            all.filter(|f| shots::is_widened(*f)).collect::<Vec<f64>>()
        };
        let rows = self.rows.iter().map(own).filter(|own| !own.is_empty());
        let rows: Vec<Vec<f64>> = rows.collect();
        let least = rows.iter().flatten().copied().reduce(f64::min)?;
        let most = rows.iter().flatten().copied().reduce(f64::max)?;
        Some((rows.len(), [least, most]))
    }

    /// Lines with errors from the scatter of so few shots that intervals can't be
    /// corrected for that: their errors count as known.
    #[must_use]
    pub fn lines_of_few_shots(&self) -> Vec<u64> {
        let few = self.rows.iter().filter(|row| row.freedom.is_too_small());
        let mut lines: Vec<u64> = few.map(|row| row.line).collect();
        lines.sort_unstable();
        lines
    }

    /// These data with some observables alone; rows that have none of them go.
    #[must_use]
    pub fn only(&self, wanted: &[Observable]) -> Self {
        let mut data = self.clone();
        for row in &mut data.rows {
            for of in Observable::ALL {
                if !wanted.contains(&of) {
                    row.values[of.index()] = None;
                }
            }
        }
        data.rows.retain(|row| row.observables().next().is_some());
        data
    }
}

//! Measured curves: times of flight and ratios of peaks, one row a speed.

mod table;

pub(crate) use table::with_plain_ends;
pub use table::{Scatter, Selection, wrong_speed};

use hertzchain_measure::signal::Estimate;

/// A measured number of a row that a model can predict.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Observable {
    /// Incident time of flight in s.
    Incident,
    /// Reflected time of flight in s.
    Reflected,
    /// Wall peak over incident peak.
    WallOverPassing,
    /// Reflected peak over incident peak.
    ReturningOverPassing,
}

impl Observable {
    /// Every observable, in the order of a row.
    pub const ALL: [Self; 4] =
        [Self::Incident, Self::Reflected, Self::WallOverPassing, Self::ReturningOverPassing];

    /// Its column in a table.
    pub const fn column(self) -> &'static str {
        match self {
            Self::Incident => "tof_incident_s",
            Self::Reflected => "tof_reflected_s",
            Self::WallOverPassing => "wall_over_incident",
            Self::ReturningOverPassing => "reflected_over_incident",
        }
    }

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Incident => "incident ToF",
            Self::Reflected => "reflected ToF",
            Self::WallOverPassing => "wall/incident peak",
            Self::ReturningOverPassing => "reflected/incident peak",
        }
    }

    /// Whether it is a time in s; else it is a ratio.
    pub const fn is_time(self) -> bool {
        matches!(self, Self::Incident | Self::Reflected)
    }

    pub(crate) const fn index(self) -> usize {
        self as usize
    }
}

/// Fewest shots whose scatter is an error that can be corrected for its own uncertainty.
pub const FEWEST_SHOTS: u32 = 6;

/// Least degrees of freedom of an error that can be corrected for.
const FEWEST: f64 = (FEWEST_SHOTS - 1) as f64;

/// Degrees of freedom of the scatter from which each of a row's standard errors comes: 19 for that
/// of 20 shots, infinite if it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freedom {
    /// Of the speed's.
    pub speed: f64,
    /// Of the measured values', in the order of [`Observable::ALL`].
    pub values: [f64; 4],
}

impl Freedom {
    /// All errors are known.
    pub const KNOWN: Self = Self::of_all(f64::INFINITY);

    /// All errors have these degrees of freedom.
    pub const fn of_all(freedom: f64) -> Self {
        Self { speed: freedom, values: [freedom; 4] }
    }
}

/// Factor on the standard error of part of a sum, if it comes from a scatter of ν degrees of freedom
/// and has this share h of the sum's variance, so that intervals of a fit hold the truth as often as
/// they say: 1/√(1 − 4h/ν). 1 if ν is too small for that ([`FEWEST_SHOTS`]).
///
/// Let C = Σ u uᵀ be a row's covariance, one u for each independent error, and the estimate Ĉ have
/// (1 + ε) u uᵀ in place of u uᵀ with ⟨ε²⟩ = 2/ν, P = C⁻¹. A fit says (Σ Xᵀ Ĉ⁻¹ X)⁻¹ of its
/// variance, which is that times Σ Xᵀ Ĉ⁻¹ C Ĉ⁻¹ X times it again. To second order in ε the means are
/// ⟨Ĉ⁻¹⟩ = P + Σ (2/ν) h P u uᵀ P and ⟨Ĉ⁻¹ C Ĉ⁻¹⟩ = P + Σ (6/ν) h P u uᵀ P with h = uᵀ P u. With
/// Σ u uᵀ/(1 − 4h/ν) in place of Ĉ both means are P − Σ (2/ν) h P u uᵀ P, row by row, so that a sum
/// over many rows is right.
///
/// For one error (h = 1) it is exact: ⟨χ²_ν⁻¹⟩ = 1/(ν − 2) and ⟨χ²_ν⁻²⟩ = 1/((ν − 2)(ν − 4)) make it
/// √(ν/(ν − 4)). For several in one sum it is the same with the degrees of freedom of Welch and
/// Satterthwaite, (Σ v)²/Σ (v²/ν) [Satterthwaite1946].
pub(crate) fn widening(share: f64, freedom: f64) -> f64 {
    match freedom >= FEWEST {
        true => (1.0 - 4.0 * share / freedom).sqrt().recip(),
        false => 1.0,
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

    pub(crate) fn observables(&self) -> impl Iterator<Item = Observable> + '_ {
        Observable::ALL.into_iter().filter(|of| self.value(*of).is_some())
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
    pub fn speeds_m_s(&self) -> Vec<f64> {
        self.rows.iter().map(|row| row.speed_m_s.value).collect()
    }

    /// Number of measured numbers without speeds.
    pub fn value_count(&self) -> usize {
        self.rows.iter().map(|row| row.observables().count()).sum()
    }

    /// Whether some row has an observable.
    pub fn has(&self, of: Observable) -> bool {
        self.rows.iter().any(|row| row.value(of).is_some())
    }

    fn lines(&self, of: impl Fn(&DataRow) -> bool) -> Vec<u64> {
        let rows = self.rows.iter().filter(|row| of(row));
        let mut lines: Vec<u64> = rows.map(|row| row.line).collect();
        lines.sort_unstable();
        lines
    }

    /// Lines whose speeds have no error, or one of 0: they count as exactly known.
    pub fn lines_of_exact_speeds(&self) -> Vec<u64> {
        self.lines(|row| row.speed_m_s.sigma == 0.0)
    }

    /// Lines with both times of flight whose errors have no stated correlation.
    pub fn lines_without_correlation(&self) -> Vec<u64> {
        let has_both = |row: &DataRow| row.values[..2].iter().all(Option::is_some);
        self.lines(|row| has_both(row) && row.correlation.is_none())
    }

    /// Lines with errors from the scatter of so few shots that intervals can't be corrected for
    /// that: their errors count as known.
    pub fn lines_of_few_shots(&self) -> Vec<u64> {
        let few =
            |freedom: &Freedom| freedom.values.iter().chain([&freedom.speed]).any(|f| *f < FEWEST);
        self.lines(|row| few(&row.freedom))
    }

    /// How many rows have an error that is widened for its uncertainty, and the least and the most
    /// degrees of freedom among those errors; `None` if there is no such row.
    pub fn widened(&self) -> Option<(usize, [f64; 2])> {
        let own = |row: &DataRow| -> Vec<f64> {
            let values = row.observables().map(|of| row.freedom.values[of.index()]);
            let all = values.chain([row.freedom.speed]);
            all.filter(|f| *f >= FEWEST && f.is_finite()).collect()
        };
        let rows: Vec<Vec<f64>> = self.rows.iter().map(own).filter(|own| !own.is_empty()).collect();
        let least = rows.iter().flatten().copied().reduce(f64::min)?;
        let most = rows.iter().flatten().copied().reduce(f64::max)?;
        Some((rows.len(), [least, most]))
    }

    /// These data with some observables alone; rows that have none of them go.
    pub fn only(&self, wanted: &[Observable]) -> Self {
        let mut data = self.clone();
        for row in &mut data.rows {
            for of in Observable::ALL.into_iter().filter(|of| !wanted.contains(of)) {
                row.values[of.index()] = None;
            }
        }
        data.rows.retain(|row| row.observables().next().is_some());
        data
    }
}

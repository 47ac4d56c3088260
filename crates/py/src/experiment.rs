//! Experiments: read, looked into, changed, pickled.

use crate::failure::PyFailure;
use hertzchain::failure::Failure;
use hertzchain_experiment as experiment;
use hertzchain_experiment::Units;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyTuple};

/// What has been done to an experiment since it was read.
#[derive(Clone, Debug, FromPyObject, IntoPyObject)]
enum ExperimentChange {
    /// Numbers set in SI.
    Numbers(Vec<(String, f64)>),
    /// Numbers set as text.
    Texts(Vec<(String, String)>),
    /// One of its cases chosen.
    Case(String),
}

/// A described experiment, valid and in SI; unchangeable and picklable.
///
/// Made by `hertzchain.load`, `hertzchain.preset` or `hertzchain.build`.
///
/// Attributes
/// ----------
/// name, title, text : str
///     Of the file or preset: its name, what it is, all that it says.
/// speed_m_s : float or None
///     Speed of the striker in m/s.
/// beads, sensor_bead : int
///     Number N of beads; number n of the one whose signal times the pulses.
/// has_wall, is_dimensionless : bool
///     Whether bead N leans on something; whether K = m = 1 stands for SI.
/// cases : list of str
///     Names of the chains that a campaign measures.
///
/// References
/// ----------
/// Words, signs and units: docs/reference/conventions.md.
#[pyclass(frozen, module = "hertzchain", name = "Experiment")]
#[derive(Clone, Debug)]
pub struct Experiment {
    /// As the libraries have it.
    pub inner: experiment::Experiment,
    changes: Vec<ExperimentChange>,
}

impl Experiment {
    fn read(inner: experiment::Experiment) -> Self {
        Self { inner, changes: Vec::new() }
    }

    fn changed(&self, change: ExperimentChange) -> Result<Self, PyFailure> {
        let inner = match &change {
            ExperimentChange::Numbers(values) => {
                let values: Vec<_> = values.iter().map(|(path, v)| (path.as_str(), *v)).collect();
                self.inner.set(&values)?
            }
            ExperimentChange::Texts(values) => {
                let values = values.iter().map(|(path, v)| (path.as_str(), v.as_str()));
                let values: Vec<_> = values.collect();
                self.inner.set_text(&values)?
            }
            ExperimentChange::Case(name) => {
                let found = self.inner.case(name);
                found.ok_or_else(|| self.no_case(name))??
            }
        };
        let changes = self.changes.iter().cloned().chain([change]);
        Ok(Self { inner, changes: changes.collect() })
    }

    fn no_case(&self, name: &str) -> Failure {
        Failure::User(match self.inner.cases() {
            known if known.is_empty() => {
                format!("there is no case `{name}`: the experiment has none")
            }
            known => format!("there is no case `{name}`; expected one of {}", known.join(", ")),
        })
    }
}

#[pymethods]
impl Experiment {
    /// Reads an experiment file: see `hertzchain.load`.
    ///
    /// Parameters
    /// ----------
    /// path : path
    ///
    /// Returns
    /// -------
    /// Experiment
    #[staticmethod]
    fn open(path: std::path::PathBuf) -> Result<Self, PyFailure> {
        Ok(Self::read(experiment::Experiment::open(path)?))
    }

    /// Reads an experiment from text: see `hertzchain.build`.
    ///
    /// Parameters
    /// ----------
    /// name, text : str
    ///     The name that messages use, and TOML.
    ///
    /// Returns
    /// -------
    /// Experiment
    #[staticmethod]
    fn from_text(name: &str, text: &str) -> Result<Self, PyFailure> {
        Ok(Self::read(experiment::Experiment::from_text(name, text)?))
    }

    /// Builds an experiment from tables as JSON: see `hertzchain.build`.
    ///
    /// Parameters
    /// ----------
    /// name, tables : str
    ///     The name that messages use, and the tables.
    ///
    /// Returns
    /// -------
    /// Experiment
    #[staticmethod]
    fn from_tables(name: &str, tables: &str) -> Result<Self, PyFailure> {
        let wrong = |error: &dyn std::fmt::Display| {
            Failure::User(format!("an experiment holds texts, numbers, lists and dicts: {error}"))
        };
        let tables: toml::Table = serde_json::from_str(tables).map_err(|error| wrong(&error))?;
        let text = toml::to_string(&tables).map_err(|error| wrong(&error))?;
        Self::from_text(name, &text)
    }

    /// An experiment that comes with the program; also `hertzchain.preset`.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     One of `presets`.
    ///
    /// Returns
    /// -------
    /// Experiment
    ///
    /// Raises
    /// ------
    /// OptionError
    ///     A name that no preset has.
    #[staticmethod]
    fn preset(name: &str) -> Result<Self, PyFailure> {
        Ok(Self::read(experiment::preset(name)?))
    }

    #[staticmethod]
    fn _restored(
        name: &str,
        text: &str,
        changes: Vec<ExperimentChange>,
    ) -> Result<Self, PyFailure> {
        let read = Self::from_text(name, text)?;
        let mut changes = changes.into_iter();
        changes.try_fold(read, |experiment, change| experiment.changed(change))
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let restored = py.get_type::<Self>().getattr("_restored")?;
        let parts = (self.inner.name(), self.inner.text(), self.changes.clone());
        Ok((restored, parts.into_pyobject(py)?))
    }

    /// Name of the file or preset.
    #[getter]
    fn name(&self) -> &str {
        self.inner.name()
    }

    /// What the experiment is.
    #[getter]
    fn title(&self) -> &str {
        self.inner.title()
    }

    /// The file's text, as it was read.
    #[getter]
    fn text(&self) -> &str {
        self.inner.text()
    }

    /// Whether K = m = 1 stands for SI.
    #[getter]
    fn is_dimensionless(&self) -> bool {
        self.inner.units() == Units::Dimensionless
    }

    /// Speed of the striker in m/s; None without a striker.
    #[getter]
    fn speed_m_s(&self) -> Option<f64> {
        self.inner.speed_m_s()
    }

    /// Number N of beads.
    #[getter]
    fn beads(&self) -> usize {
        self.inner.beads()
    }

    /// Number n of the bead whose signal times the pulses.
    #[getter]
    fn sensor_bead(&self) -> usize {
        self.inner.sensor_bead()
    }

    /// Whether bead N leans on something, so that there is a wall signal.
    #[getter]
    fn has_wall(&self) -> bool {
        self.inner.has_wall()
    }

    /// Names of the chains that a campaign measures.
    #[getter]
    fn cases(&self) -> Vec<&str> {
        self.inner.cases()
    }

    /// Every number that the file gives.
    ///
    /// Returns
    /// -------
    /// list of (str, float, str)
    ///     Path, value in SI, SI unit.
    fn numbers(&self) -> Vec<(String, f64, String)> {
        let all = self.inner.numbers().into_iter();
        let unit = |unit: String| if self.is_dimensionless() { "1".to_owned() } else { unit };
        all.filter_map(|named| Some((named.path, named.value?, unit(named.unit)))).collect()
    }

    /// One number in SI.
    ///
    /// Parameters
    /// ----------
    /// path : str
    ///     Its path, or an unmistakable end of it.
    ///
    /// Returns
    /// -------
    /// float
    ///
    /// Raises
    /// ------
    /// OptionError
    ///     A path that is no number's, or several'.
    fn get(&self, path: &str) -> Result<f64, PyFailure> {
        Ok(self.inner.get(path)?)
    }

    /// This experiment with numbers set.
    ///
    /// Parameters
    /// ----------
    /// values : dict of str to float or str
    ///     By path: in SI, or as text with a unit.
    ///
    /// Returns
    /// -------
    /// Experiment
    ///     Another one; this stays as it is.
    ///
    /// Raises
    /// ------
    /// OptionError, ExperimentError
    ///     Paths and values that do not fit.
    fn set(&self, values: Bound<'_, PyDict>) -> PyResult<Self> {
        let (mut numbers, mut texts) = (Vec::new(), Vec::new());
        for (path, value) in values {
            let path: String = path.extract()?;
            match value.extract::<String>() {
                Ok(text) => texts.push((path, text)),
                Err(_) => numbers.push((path, value.extract()?)),
            }
        }
        let changes = [
            (!numbers.is_empty()).then_some(ExperimentChange::Numbers(numbers)),
            (!texts.is_empty()).then_some(ExperimentChange::Texts(texts)),
        ];
        let mut changes = changes.into_iter().flatten();
        Ok(changes.try_fold(self.clone(), |experiment, change| experiment.changed(change))?)
    }

    /// The chain of one of a campaign's cases.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     One of ``cases``.
    ///
    /// Returns
    /// -------
    /// Experiment
    ///
    /// Raises
    /// ------
    /// OptionError
    ///     A name that no case has.
    fn case(&self, name: &str) -> Result<Self, PyFailure> {
        self.changed(ExperimentChange::Case(name.to_owned()))
    }

    fn __repr__(&self) -> String {
        let speed = self.inner.speed_m_s();
        let speed = speed.map_or(String::new(), |v| match self.inner.units() {
            Units::Si => format!(", striker at {v} m/s"),
            Units::Dimensionless => format!(", striker at {v}"),
        });
        format!("<Experiment {:?}: {} beads{speed}>", self.inner.title(), self.inner.beads())
    }
}

/// The experiments that come with the program.
///
/// Returns
/// -------
/// dict of str to str
///     Titles by name.
#[pyfunction]
pub(crate) fn presets(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    use experiment::{campaigns, examples, film_presets};
    let lists = [experiment::presets(), film_presets(), examples(), campaigns()];
    lists.into_iter().flatten().map(|preset| (preset.name, preset.title())).into_py_dict(py)
}

/// The JSON Schema of experiment files.
///
/// Returns
/// -------
/// str
///     JSON, with every key, its unit and what it means.
#[pyfunction]
pub(crate) fn schema() -> String {
    format!("{:#}", experiment::schema())
}

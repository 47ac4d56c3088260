//! Force laws written in Python, through the interface of all laws.

use hertzchain::failure::Failure;
use hertzchain_chain::BeadPair;
use hertzchain_chain::laws::{Closed, Columns, Contacts, Law, LawError, LawInfo, Nature};
use hertzchain_chain::{Chain, InstructionSet, Section};
use hertzchain_sim::Stop;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use std::fmt;
use std::ops::RangeInclusive;
use std::sync::{Arc, Mutex, PoisonError};

/// A force law of overlap and overlap rate, and the contacts on which it acts.
#[pyclass(frozen, module = "hertzchain._hertzchain")]
pub struct Force {
    info: &'static LawInfo,
    force: Py<PyAny>,
    energy: Option<Py<PyAny>>,
    first: usize,
    last: Option<usize>,
    beside: bool,
}

#[pymethods]
impl Force {
    /// Acts on contacts `first` to `last`, in place of the laws there or beside them.
    #[new]
    #[pyo3(signature = (name, equation, force, energy, first, last, beside))]
    fn new(
        name: String,
        equation: String,
        force: Py<PyAny>,
        energy: Option<Py<PyAny>>,
        first: usize,
        last: Option<usize>,
        beside: bool,
    ) -> Self {
        // Laws live as long as the program; so do the few words about each.
        let info = LawInfo {
            name: Box::leak(name.into_boxed_str()),
            equation: Box::leak(equation.into_boxed_str()),
            parameters: &[],
            validity: "what its author knows",
            reference: "",
            nature: match energy {
                Some(_) => Nature::ElasticPlastic,
                None => Nature::Elastic,
            },
            gated: true,
        };
        Self { info: Box::leak(Box::new(info)), force, energy, first, last, beside }
    }
}

/// What Python raised first within a shot.
type Raised = Arc<Mutex<Option<PyErr>>>;

/// A law whose force Python computes.
struct OfPython {
    info: &'static LawInfo,
    force: Py<PyAny>,
    energy: Option<Py<PyAny>>,
    raised: Raised,
    stop: Stop,
}

impl fmt::Debug for OfPython {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "OfPython({})", self.info.name)
    }
}

impl OfPython {
    /// Values of a function of columns; the first that is raised ends the shot.
    fn called(&self, function: &Py<PyAny>, columns: &[&[f64]]) -> Vec<f64> {
        let count = columns.first().map_or(0, |column| column.len());
        let values = Python::attach(|py| values(py, function, columns, count));
        values.unwrap_or_else(|error| {
            self.stop.ask();
            let mut raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
            raised.get_or_insert(error);
            vec![0.0; count]
        })
    }
}

fn values(
    py: Python<'_>,
    function: &Py<PyAny>,
    columns: &[&[f64]],
    count: usize,
) -> PyResult<Vec<f64>> {
    let arrays = columns.iter().map(|column| PyArray1::from_slice(py, column));
    let arguments = pyo3::types::PyTuple::new(py, arrays)?;
    let returned = function.bind(py).call1(arguments)?;
    let made = py.import("numpy")?.call_method1("asarray", (returned, "float64"))?;
    let array = made.extract::<PyReadonlyArray1<'_, f64>>();
    let array = array.map_err(|_| wrong_shape(count))?.to_owned_array();
    match array.len() == count {
        true => Ok(array.to_vec()),
        false => Err(wrong_shape(count)),
    }
}

fn wrong_shape(count: usize) -> PyErr {
    pyo3::exceptions::PyValueError::new_err(format!(
        "a force law must return one number a contact: expected an array of shape ({count},)"
    ))
}

impl Law for OfPython {
    fn info(&self) -> &'static LawInfo {
        self.info
    }

    fn coefficients(&self, _pair: &BeadPair) -> Result<Vec<f64>, LawError> {
        Ok(Vec::new())
    }

    fn width(&self) -> usize {
        0
    }

    fn add_forces(
        &self,
        _set: InstructionSet,
        _k: &Columns,
        _first: usize,
        contacts: Contacts<'_>,
        force_n: &mut [f64],
    ) {
        let count = force_n.len();
        let columns = [contacts.overlap, contacts.rate].map(|it| it.get(..count).unwrap_or(it));
        for (sum, force) in force_n.iter_mut().zip(self.called(&self.force, &columns)) {
            *sum += force;
        }
    }

    fn force(&self, _k: &Columns, _at: usize, contact: Closed) -> f64 {
        let columns: [&[f64]; 2] = [&[contact.overlap], &[contact.rate]];
        self.called(&self.force, &columns).first().copied().unwrap_or(0.0)
    }

    fn energy(&self, _k: &Columns, _at: usize, overlap: f64, _largest: f64) -> f64 {
        let called = |function| self.called(function, &[&[overlap]]).first().copied();
        self.energy.as_ref().and_then(called).unwrap_or(0.0)
    }
}

/// Laws of Python for one shot.
pub(crate) struct Replacing {
    laws: Vec<(RangeInclusive<usize>, bool, Arc<OfPython>)>,
    raised: Raised,
}

impl Replacing {
    /// Of these forces; an exception asks to stop.
    pub(crate) fn of(forces: &[Bound<'_, Force>], stop: &Stop) -> Self {
        let raised = Raised::default();
        let law = |force: &Bound<'_, Force>| {
            let py = force.py();
            let force = force.get();
            let law = OfPython {
                info: force.info,
                force: force.force.clone_ref(py),
                energy: force.energy.as_ref().map(|energy| energy.clone_ref(py)),
                raised: raised.clone(),
                stop: stop.clone(),
            };
            let contacts = force.first..=force.last.unwrap_or(usize::MAX);
            (contacts, force.beside, Arc::new(law))
        };
        Self { laws: forces.iter().map(law).collect(), raised: raised.clone() }
    }

    /// Whether the energy of all contacts is known.
    pub(crate) fn have_energy(&self) -> bool {
        self.laws.iter().all(|(_, _, law)| law.energy.is_some())
    }

    /// What was raised, if anything.
    pub(crate) fn raised(&self, _py: Python<'_>) -> PyResult<()> {
        let mut raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        raised.take().map_or(Ok(()), Err)
    }

    /// Puts the laws on their contacts; sections are cut where they begin and end.
    pub(crate) fn put_into(&self, chain: &mut Chain) -> Result<(), Failure> {
        let wall = chain.beads.len();
        for (contacts, beside, law) in &self.laws {
            if *contacts.start() > wall {
                let first = contacts.start();
                return Err(Failure::User(format!(
                    "there is no contact {first} in a chain of {wall} beads: expected 0 to {wall}"
                )));
            }
            let sections = std::mem::take(&mut chain.sections).into_iter();
            chain.sections = sections
                .flat_map(|section| cut(section, contacts))
                .map(|section| changed(section, contacts, *beside, law))
                .collect();
        }
        Ok(())
    }
}

/// A section in up to three: before, within and behind some contacts.
fn cut(section: Section, contacts: &RangeInclusive<usize>) -> Vec<Section> {
    let (first, last) = (*section.contacts.start(), *section.contacts.end());
    let (from, to) = (*contacts.start(), *contacts.end());
    let part = |first: usize, last: Option<usize>| Section {
        contacts: first..=last.unwrap_or(0),
        ..section.clone()
    };
    let before = (first < from).then(|| part(first, Some(last.min(from - 1))));
    let within = (from <= last && to >= first).then(|| part(first.max(from), Some(last.min(to))));
    let behind = (last > to).then(|| part(first.max(to.saturating_add(1)), Some(last)));
    [before, within, behind].into_iter().flatten().collect()
}

fn changed(
    mut section: Section,
    contacts: &RangeInclusive<usize>,
    beside: bool,
    law: &Arc<OfPython>,
) -> Section {
    if contacts.contains(section.contacts.start()) {
        if !beside {
            section.laws.clear();
        }
        section.laws.push(law.clone());
    }
    section
}

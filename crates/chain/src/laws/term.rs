//! The two faces of a contact law: [`Term`], which an author writes, and
//! [`Law`], which the wave loop calls.

use crate::instruction_set::InstructionSet;
use crate::material::BeadPair;
use fearless_simd::{dispatch, prelude::*};
use std::fmt::Debug;
use std::sync::Arc;

/// One closed contact, as a law sees it.
#[derive(Clone, Copy, Debug)]
pub struct Closed {
    /// Overlap δ ≥ 0 in m; below 0 across a gap for bridges and states that act there.
    pub overlap: f64,
    /// √δ, given by the loop so that laws need no square root of their own.
    pub root: f64,
    /// Overlap rate δ̇ in m/s, positive while approaching.
    pub rate: f64,
    /// Largest overlap so far, in m; never below `overlap`.
    pub largest: f64,
}

impl Closed {
    /// A contact that has never been deeper than now.
    pub fn new(overlap: f64, rate: f64) -> Self {
        Self { overlap, root: overlap.sqrt(), rate, largest: overlap }
    }
}

/// What a law does with energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nature {
    /// All work is stored and comes back: F = dU/dδ.
    Elastic,
    /// All work is lost: F δ̇ ≥ 0.
    Dissipative,
    /// Part is stored, part is lost, and the contact remembers how deep it was.
    ElasticPlastic,
    /// Part is stored, part is lost, by a [`ContactState`] of each contact.
    WithState,
    /// It pulls, from touch until a gap at which it lets go: [`Term::rupture`]. Work across
    /// the gap comes back; what it holds at touch is lost when it forms.
    Adhesive,
}

/// Where a parameter's value comes from when the user gives none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// The user must give it.
    Required,
    /// It follows from the materials, radii and masses of the two bodies.
    Materials,
    /// It is the stiffness K of the `elastic_hertz` beside this law, where a user
    /// gives that one; else it follows from materials and radii, as K does then.
    Hertz,
    /// It is that of the file's liquid; without one the user must give it.
    Liquid,
    /// A plain default.
    Default(f64),
}

impl Source {
    /// Whether other laws or the two bodies decide where the user gives nothing.
    pub const fn is_derived(self) -> bool {
        matches!(self, Self::Materials | Self::Hertz)
    }
}

/// One parameter that a user types.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Key in the experiment file.
    pub name: &'static str,
    /// SI unit, "1" for a plain number. `{name}` stands for the value of
    /// another parameter of the same law: `N/m^{exponent}`.
    pub unit: &'static str,
    /// Meaning in a few words.
    pub meaning: &'static str,
    /// Value when absent.
    pub source: Source,
    /// Smallest accepted value (itself accepted).
    pub least: f64,
}

/// What there is to know about a law before using it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawInfo {
    /// Name in the experiment file, general word first.
    pub name: &'static str,
    /// The equation, in plain text.
    pub equation: &'static str,
    /// What a user types.
    pub parameters: &'static [Parameter],
    /// Where it holds.
    pub validity: &'static str,
    /// Key into `references.bib`.
    pub reference: &'static str,
    /// What it does with energy.
    pub nature: Nature,
    /// Acts only while the contact is closed; all laws but one.
    pub gated: bool,
}

/// Why a law can't be used on a pair of bodies.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("law `{law}`: {what}")]
pub struct LawError {
    /// Name of the law.
    pub law: &'static str,
    /// What is wrong, and what was expected.
    pub what: String,
}

/// A contact law as its author writes it: fields are the user's parameters,
/// `C` numbers per contact are what the loop needs.
pub trait Term<const C: usize>: Debug + Clone + Send + Sync + 'static {
    /// Name, equation, parameters, source.
    const INFO: LawInfo;

    /// The law from parameter values in the order of `INFO.parameters`;
    /// `None` where nothing is given and the materials decide.
    fn new(values: &[Option<f64>]) -> Self;

    /// The numbers the loop needs for one contact.
    ///
    /// # Errors
    /// When the materials lack what the law needs.
    fn coefficients(&self, pair: &BeadPair) -> Result<[f64; C], LawError>;

    /// Force in N, positive when it pushes the bodies apart.
    fn force(k: &[f64; C], contact: Closed) -> f64;

    /// Energy in J that the contact would give back.
    fn energy(_k: &[f64; C], _overlap: f64, _largest: f64) -> f64 {
        0.0
    }

    /// Gap in m at which a law that is [`Nature::Adhesive`] lets go.
    fn rupture(_k: &[f64; C]) -> f64 {
        0.0
    }

    /// What one contact remembers, if the law is [`Nature::WithState`].
    fn state(_k: &[f64; C]) -> Option<Box<dyn ContactState>> {
        None
    }
}

/// State of one contact: numbers that are integrated beside the motion, from 0, and what changes
/// with every accepted step. Its force is added to [`Law::force`].
pub trait ContactState: Debug + Send + Sync {
    /// Begins anew at an overlap in m, at rest.
    fn begin(&mut self, overlap_m: f64);

    /// Whether it goes on where the contact is open: overlaps are then below 0 across a gap,
    /// and it does not begin anew there.
    fn acts_across(&self) -> bool {
        false
    }

    /// Force in N, and rates of change of the numbers in m/s.
    fn force_and_rates(&self, numbers_m: [f64; 4], contact: Closed) -> (f64, [f64; 4]);

    /// Energy in J that the contact would give back at the start of a step.
    fn energy_j(&self, numbers_m: [f64; 4], overlap_m: f64) -> f64;

    /// Falls below 0 where the contact begins to behave otherwise than at the start of
    /// the step, which must end there; dimensionless, of the order of 1.
    fn until_change(&self, numbers_m: [f64; 4], contact: Closed) -> f64;

    /// Makes the end of a step the start of the next; returns the numbers there, and whether
    /// force or rates are others there than at the end of the step.
    fn accept(&mut self, numbers_m: [f64; 4], contact: Closed) -> ([f64; 4], bool);

    /// A copy.
    fn boxed(&self) -> Box<dyn ContactState>;
}

impl Clone for Box<dyn ContactState> {
    fn clone(&self) -> Self {
        self.boxed()
    }
}

/// Coefficients of one law over consecutive contacts: column `j` holds
/// coefficient `j` of every contact.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    values: Vec<f64>,
    contacts: usize,
}

impl Columns {
    /// Columns from one row a contact.
    pub fn from_rows(rows: &[Vec<f64>]) -> Self {
        Self::from_runs(rows.iter().map(|row| (row.as_slice(), 1)))
    }

    /// Columns from rows and how many contacts in a row have each.
    pub(crate) fn from_runs<'a>(runs: impl Iterator<Item = (&'a [f64], usize)> + Clone) -> Self {
        let width = runs.clone().next().map_or(0, |(row, _)| row.len());
        let contacts = runs.clone().map(|(_, count)| count).sum();
        let mut values = Vec::with_capacity(width * contacts);
        for j in 0..width {
            for (row, count) in runs.clone() {
                values.resize(values.len() + count, row[j]);
            }
        }
        Self { values, contacts }
    }

    /// Coefficients a row.
    pub(crate) fn width(&self) -> usize {
        self.values.len() / self.contacts.max(1)
    }

    /// One coefficient of all rows.
    pub(crate) fn column(&self, j: usize) -> &[f64] {
        &self.values[j * self.contacts..][..self.contacts]
    }

    /// The rows of equally many contacts of several chains, side by side.
    pub(crate) fn interleaved<'a>(lanes: impl Iterator<Item = &'a Self>) -> Self {
        let lanes: Vec<&Self> = lanes.collect();
        let contacts = lanes.first().map_or(0, |columns| columns.contacts);
        let width = lanes.first().map_or(0, |columns| columns.width());
        let rows = (0..width).flat_map(|j| (0..contacts).map(move |c| (j, c)));
        let values =
            rows.flat_map(|(j, c)| lanes.iter().map(move |columns| columns.column(j)[c])).collect();
        Self { values, contacts: contacts * lanes.len() }
    }

    fn slices<const C: usize>(&self, first: usize, count: usize) -> [&[f64]; C] {
        std::array::from_fn(|j| &self.values[j * self.contacts + first..][..count])
    }

    fn at<const C: usize>(&self, contact: usize) -> [f64; C] {
        std::array::from_fn(|j| self.values[j * self.contacts + contact])
    }
}

/// State of consecutive contacts, as columns of equal length.
#[derive(Clone, Copy, Debug)]
pub struct Contacts<'a> {
    /// Overlaps, 0 where open.
    pub overlap: &'a [f64],
    /// Their square roots.
    pub root: &'a [f64],
    /// Overlap rates.
    pub rate: &'a [f64],
    /// Largest overlaps.
    pub largest: &'a [f64],
}

/// A contact law as the loop calls it: over columns, or for one contact.
pub trait Law: Debug + Send + Sync {
    /// Name, equation, parameters, source.
    fn info(&self) -> &'static LawInfo;

    /// The numbers the loop needs for one contact.
    ///
    /// # Errors
    /// When the materials lack what the law needs.
    fn coefficients(&self, pair: &BeadPair) -> Result<Vec<f64>, LawError>;

    /// How many coefficients there are.
    fn width(&self) -> usize;

    /// Adds the forces of consecutive contacts, the first being row `first`
    /// of the columns, to `force_n`.
    fn add_forces(
        &self,
        set: InstructionSet,
        k: &Columns,
        first: usize,
        contacts: Contacts<'_>,
        force_n: &mut [f64],
    );

    /// Force in N of one contact.
    fn force(&self, k: &Columns, at: usize, contact: Closed) -> f64;

    /// Energy in J that one contact would give back.
    fn energy(&self, k: &Columns, at: usize, overlap: f64, largest: f64) -> f64;

    /// Gap in m at which a law that is [`Nature::Adhesive`] lets go.
    fn rupture(&self, _k: &Columns, _at: usize) -> f64 {
        0.0
    }

    /// What one contact remembers, if the law is [`Nature::WithState`].
    fn state(&self, _k: &Columns, _at: usize) -> Option<Box<dyn ContactState>> {
        None
    }
}

/// The loop over contacts, compiled anew for every instruction set.
#[inline(always)]
fn add_forces<T: Term<C>, const C: usize>(
    k: [&[f64]; C],
    contacts: Contacts<'_>,
    force_n: &mut [f64],
) {
    let n = force_n.len();
    let (overlap, root) = (&contacts.overlap[..n], &contacts.root[..n]);
    let (rate, largest) = (&contacts.rate[..n], &contacts.largest[..n]);
    for i in 0..n {
        let row = std::array::from_fn(|j| k[j][i]);
        let contact =
            Closed { overlap: overlap[i], root: root[i], rate: rate[i], largest: largest[i] };
        force_n[i] += T::force(&row, contact);
    }
}

/// Makes a [`Term`] callable by the loop.
#[derive(Clone, Debug)]
struct Of<T, const C: usize>(T);

impl<T: Term<C>, const C: usize> Law for Of<T, C> {
    fn info(&self) -> &'static LawInfo {
        const { &T::INFO }
    }

    fn coefficients(&self, pair: &BeadPair) -> Result<Vec<f64>, LawError> {
        let k = self.0.coefficients(pair)?;
        match k.iter().all(|value| value.is_finite() && *value >= 0.0) {
            true => Ok(k.to_vec()),
            false => Err(LawError {
                law: T::INFO.name,
                what: format!(
                    "its coefficients {k:?} for this pair of bodies must be finite and not negative: give the \
                     bodies a material{}",
                    own_numbers(&T::INFO)
                ),
            }),
        }
    }

    fn width(&self) -> usize {
        C
    }

    fn add_forces(
        &self,
        set: InstructionSet,
        k: &Columns,
        first: usize,
        contacts: Contacts<'_>,
        force_n: &mut [f64],
    ) {
        let k = k.slices::<C>(first, force_n.len());
        dispatch!(set.level(), simd => simd.vectorize(
            #[inline(always)]
            || add_forces::<T, C>(k, contacts, force_n)
        ));
    }

    fn force(&self, k: &Columns, at: usize, contact: Closed) -> f64 {
        T::force(&k.at(at), contact)
    }

    fn energy(&self, k: &Columns, at: usize, overlap: f64, largest: f64) -> f64 {
        T::energy(&k.at(at), overlap, largest)
    }

    fn rupture(&self, k: &Columns, at: usize) -> f64 {
        T::rupture(&k.at(at))
    }

    fn state(&self, k: &Columns, at: usize) -> Option<Box<dyn ContactState>> {
        T::state(&k.at(at))
    }
}

/// A law ready for a chain.
pub fn law<T: Term<C>, const C: usize>(term: T) -> Arc<dyn Law> {
    Arc::new(Of(term))
}

/// One row of the registry.
#[derive(Debug)]
pub struct Row {
    /// Name, equation, parameters, source.
    pub info: LawInfo,
    /// Builds the law from values in the order of `info.parameters`.
    build: fn(&[Option<f64>]) -> Arc<dyn Law>,
}

/// The registry row of a law.
pub const fn row<T: Term<C>, const C: usize>() -> Row {
    Row { info: T::INFO, build: |values| law(T::new(values)) }
}

impl Row {
    /// The law from named parameter values in SI.
    ///
    /// # Errors
    /// An unknown or repeated name, a missing required parameter, or a value
    /// below the least one or not finite.
    pub fn build(&self, given: &[(&str, f64)]) -> Result<Arc<dyn Law>, LawError> {
        let fail = |what: String| LawError { law: self.info.name, what };
        let known = |name: &str| self.info.parameters.iter().any(|p| p.name == name);
        if let Some((name, _)) = given.iter().find(|(name, _)| !known(name)) {
            return Err(fail(format!("has no parameter `{name}`")));
        }
        let values = self.info.parameters.iter().map(|p| value_of(p, given).map_err(fail));
        Ok((self.build)(&values.collect::<Result<Vec<_>, _>>()?))
    }
}

/// What a law can be given in place of materials, in words.
fn own_numbers(info: &LawInfo) -> String {
    let own = info.parameters.iter();
    let own = own.filter(|p| matches!(p.source, Source::Materials | Source::Hertz));
    own.map(|p| format!(", or the law its `{}`", p.name)).collect()
}

/// The value of one parameter among those given.
fn value_of(parameter: &Parameter, given: &[(&str, f64)]) -> Result<Option<f64>, String> {
    let name = parameter.name;
    match given.iter().find(|(key, _)| *key == name) {
        Some(&(_, value)) if value.is_finite() && value >= parameter.least => Ok(Some(value)),
        Some(&(_, value)) => Err(format!(
            "`{name}` = {value} {} must be finite and at least {}",
            parameter.unit, parameter.least
        )),
        None => match parameter.source {
            Source::Required | Source::Liquid => {
                Err(format!("needs `{name}` ({}, in {})", parameter.meaning, parameter.unit))
            }
            Source::Materials | Source::Hertz => Ok(None),
            Source::Default(value) => Ok(Some(value)),
        },
    }
}

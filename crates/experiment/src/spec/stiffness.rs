//! Stiffnesses that a section leaves out and that its materials do not set.

use super::SectionSpec;
use crate::finding::Problem;
use crate::laws::LawSpec;
use hertzchain_chain::laws::{Nature, Parameter, Source};

/// Key of every stiffness that materials or other laws may set.
const STIFFNESS: &str = "stiffness";

/// Fills in what does not follow from materials: 1 in a chain without any
/// (`bare`), and the K of the section's `elastic_hertz` in laws that share it.
pub(super) fn fill(section: &mut SectionSpec, bare: bool) -> Result<(), Problem> {
    let bare = bare && section.material.is_none();
    let dissipative = |law: &LawSpec| law.row.info.nature == Nature::Dissipative;
    if bare {
        unit_stiffness(section, |law| !dissipative(law));
    }
    shared_stiffness(&mut section.laws)?;
    if bare {
        unit_stiffness(section, dissipative);
    }
    Ok(())
}

/// The value of a law's stiffness that the file leaves out.
fn left_out(law: &LawSpec, by: impl Fn(Source) -> bool) -> bool {
    let declares = |p: &Parameter| p.name == STIFFNESS && by(p.source);
    law.row.info.parameters.iter().any(declares) && given(law).is_none()
}

/// The contact that a law's stiffness belongs to.
fn reference(law: &LawSpec) -> Option<usize> {
    let mut own = law.references.iter().filter(|(name, _)| *name == STIFFNESS);
    own.next().map(|(_, contact)| *contact)
}

fn given(law: &LawSpec) -> Option<f64> {
    let mut given = law.given.iter().filter(|(name, _)| *name == STIFFNESS);
    given.next().map(|(_, value)| *value)
}

/// Without materials a stiffness that they would set is 1.
fn unit_stiffness(section: &mut SectionSpec, wanted: impl Fn(&LawSpec) -> bool) {
    let laws = section.laws.iter_mut().filter(|law| wanted(law));
    laws.filter(|law| left_out(law, Source::is_derived))
        .for_each(|law| law.given.push((STIFFNESS, 1.0)));
}

/// Damping whose equation has the contact's K takes that of `elastic_hertz`,
/// where the file gives it; forces of several add, so their K do.
fn shared_stiffness(laws: &mut [LawSpec]) -> Result<(), Problem> {
    let hertz = laws.iter().filter(|law| law.name() == "elastic_hertz");
    let found: Vec<Option<f64>> = hertz.map(given).collect();
    if found.iter().all(Option::is_none) {
        return Ok(());
    }
    let sum: Option<f64> = found.into_iter().sum();
    let hertz = laws.iter().filter(|law| law.name() == "elastic_hertz");
    let references: Vec<Option<usize>> = hertz.map(reference).collect();
    // Of a sum, parts that belong to other contacts have no value at one.
    let clear = references.windows(2).all(|pair| pair[0] == pair[1]);
    let sum = sum.filter(|_| clear);
    let reference = references.first().copied().flatten();
    let sharing = |law: &&mut LawSpec| left_out(law, |source| source == Source::Hertz);
    for law in laws.iter_mut().filter(sharing) {
        let stiffness = sum.ok_or_else(|| unclear(law))?;
        law.given.push((STIFFNESS, stiffness));
        law.references
            .extend(reference.map(|contact| (STIFFNESS, contact)));
    }
    Ok(())
}

/// One `elastic_hertz` has a number, another follows from the materials.
fn unclear(law: &LawSpec) -> Problem {
    let message = format!("the stiffness of law `{}` is not clear", law.name());
    let label = "expected a `stiffness` here";
    Problem::new(&law.span, message, label).help(
        "of several \"elastic_hertz\" in this section one has a stiffness and one leaves it to the \
         materials, or theirs belong to other contacts",
    )
}

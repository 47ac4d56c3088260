//! What the physics refuses, back at its place in the file.

use crate::finding::Problem;
use crate::spec::{Far, SectionSpec, Spec};
use hertzchain_chain::ChainError;
use hertzchain_chain::laws::LawError;
use hertzchain_chain::wave::SolveError;
use std::ops::Range;

/// The problem in the file behind a chain that can't be set up.
pub(crate) fn problem(spec: &Spec, error: &ChainError) -> Problem {
    match error {
        ChainError::Law { contact, error } => law(spec, *contact, error),
        ChainError::Equilibrium(why) => equilibrium(spec, why),
        ChainError::Value {
            what,
            value,
            expected,
        } => {
            let message = format!("{what} is {value}");
            Problem::new(
                &beads(spec),
                message,
                format!("expected it to be {expected}"),
            )
        }
        ChainError::Layout(why) | ChainError::NotConverged(why) => {
            Problem::new(&beads(spec), why, "expected parts that fit together")
        }
    }
}

/// No rest position: nothing holds the far end, or no law carries the load.
fn equilibrium(spec: &Spec, why: &str) -> Problem {
    let message = format!("the chain has no rest position: {why}");
    if let Some(span) = &spec.suspension_span {
        let label = "expected no [near_end] push and no incline beside threads";
        return Problem::new(span, message, label);
    }
    let inelastic = spec.sections.iter().find(|section| !section.is_elastic());
    match (&spec.far, inelastic) {
        (Far::Free | Far::Periodic { .. }, _) | (_, None) => {
            let label = "expected a far end that holds what pushes and pulls";
            Problem::new(&spec.far_span, message, label)
        }
        (_, Some(section)) => {
            let message = "the chain has no rest position: no law of these contacts carries a load";
            let label = "expected a law that pushes the beads apart";
            Problem::new(&section.laws_span, message, label).help("add \"elastic_hertz\" to `laws`")
        }
    }
}

/// What the wave loop says of a motion, at the laws of the contact where it
/// ended, or at the solver's settings.
pub(crate) fn unsolved(spec: &Spec, error: &SolveError) -> Problem {
    match error {
        SolveError::StepTooSmall { contact, .. }
        | SolveError::NotFinite { contact, .. }
        | SolveError::TooMuchWork { contact, .. } => {
            let contact = (*contact).min(spec.bead_count());
            let laws = format!("the laws of contact {contact}");
            Problem::new(&laws_of(spec, contact), error.to_string(), laws)
        }
        _ => unreached(spec, &error.to_string()),
    }
}

/// What is out of a solver's reach, at its settings; without any, at the laws.
pub(crate) fn unreached(spec: &Spec, why: &str) -> Problem {
    match &spec.solver_spans.table {
        Some(table) => Problem::new(table, why, "the solver is chosen here"),
        None => Problem::new(&laws_of(spec, 0), why, "the laws of contact 0"),
    }
}

fn laws_of(spec: &Spec, contact: usize) -> Range<usize> {
    section(spec, contact).map_or(0..0, |section| section.laws_span.clone())
}

fn section(spec: &Spec, contact: usize) -> Option<&SectionSpec> {
    let beads = spec.bead_count();
    let holds = |section: &&SectionSpec| (section.from..=section.last(beads)).contains(&contact);
    spec.sections.iter().find(holds)
}

fn beads(spec: &Spec) -> Range<usize> {
    spec.groups.first().map_or(0..0, |group| group.span.clone())
}

fn law(spec: &Spec, contact: usize, error: &LawError) -> Problem {
    let law =
        section(spec, contact).and_then(|s| s.laws.iter().find(|law| law.name() == error.law));
    let span = law.map_or(0..0, |law| law.span.clone());
    let message = format!("law `{}` can't be used on contact {contact}", error.law);
    let problem = Problem::new(&span, message, &error.what);
    let from_materials = law.map_or(Vec::new(), |law| {
        let parameters = law.row.info.parameters.iter();
        let given = |name: &str| law.given.iter().any(|(given, _)| *given == name);
        let left = parameters.filter(|p| p.source.is_derived() && !given(p.name));
        left.map(|p| format!("`{}`", p.name)).collect()
    });
    let bare = section(spec, contact).is_some_and(|section| section.material.is_none());
    let mut parts = spec.groups.iter().flat_map(|group| &group.cell);
    match from_materials.is_empty() {
        true if bare && parts.all(|part| part.material.is_none()) => {
            problem.help("it needs the stiffness of a material: name one in [[beads]]")
        }
        true => problem,
        false => problem.help(format!(
            "the materials must set {}, unless the law gives it",
            from_materials.join(" and ")
        )),
    }
}

//! Bodies pressed into each other beyond what any contact law is for.

use crate::finding::Problem;
use crate::spec::Spec;
use crate::value::{Units, rounded};
use hertzchain_chain::{Chain, FarEnd, System};

/// The first contact that is overlapped by more than the smaller radius at the
/// start, by load or by displacement. Dimensionless lengths have no radius to
/// be compared with.
pub(crate) fn problem(spec: &Spec, chain: &Chain, system: &System) -> Option<Problem> {
    if spec.units == Units::Dimensionless {
        return None;
    }
    let beads = chain.beads.len();
    let mut displaced_m = vec![0.0; beads + 2];
    for initial in &chain.initial {
        if let Some(place) = displaced_m.get_mut(initial.bead) {
            *place = initial.displacement_m;
        }
    }
    if let (FarEnd::Periodic { .. }, [_, first, .., last]) = (&chain.far, &mut displaced_m[..]) {
        *last = *first;
    }
    let inner = displaced_m.iter().zip(displaced_m.iter().skip(1)).skip(1);
    // What bead N leans on is at least as large, or of no radius at all.
    let right = chain.beads.iter().skip(1).chain(chain.beads.last());
    let radii = chain.beads.iter().zip(right);
    let mut contacts = (1..).zip(inner.zip(radii));
    contacts.find_map(|(contact, ((left_m, right_m), (left, right)))| {
        let at_rest_m = system.static_contact(contact).overlap_m;
        let overlap_m = at_rest_m + left_m - right_m;
        let radius_m = left.radius_m.min(right.radius_m);
        (overlap_m > radius_m).then(|| found(spec, contact, overlap_m, at_rest_m > radius_m))
    })
}

fn found(spec: &Spec, contact: usize, overlap_m: f64, by_load: bool) -> Problem {
    let message = format!(
        "contact {contact} is overlapped by {} m at the start, more than a bead's radius",
        rounded(overlap_m)
    );
    let touches = |bead: usize| bead == contact || bead == contact + 1;
    let moved = spec.initial.iter().find(|(i, _)| touches(i.bead));
    match moved {
        Some((_, span)) if !by_load => Problem::new(
            span,
            message,
            "expected a smaller displacement into its neighbour",
        ),
        _ => Problem::new(&spec.load_span, message, "expected less force on the chain"),
    }
}

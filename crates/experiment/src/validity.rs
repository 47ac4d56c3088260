//! Contact laws used beyond what they are for, estimated from two bodies that meet
//! at the speed that sets the chain in motion.

use crate::finding::Problem;
use crate::laws::LawSpec;
use crate::meeting::{Meeting, meetings};
use crate::spec::{MaterialSpec, Spec};
use crate::value::{Units, brief, rounded};
use hertzchain_chain::laws::{Nature, Source};
use hertzchain_chain::{Chain, FarEnd, System};
use std::ops::Range;

/// Largest overlap over the reduced radius for laws of touching spheres: the
/// contact circle is then a third of that radius, no longer small against it.
const DEEP: f64 = 0.1;

/// Overlap over the reduced radius that no law survives: two like spheres have
/// come nearer by one radius.
const CRUSHED: f64 = 2.0;

/// A dissipative force as large as the elastic one: the pair does not come apart
/// again, which laws of slow dissipation are not for.
const STRONG: f64 = 1.0;

/// A dissipative force so large that a pair stops within a millionth of the
/// time in which contacts act.
const OVERPOWERING: f64 = 1e6;

/// A dissipative force so small that no result shows it: below the tightest
/// accuracy.
const IDLE: f64 = 1e-13;

/// Faster than beads are ever shot at each other: the speed is then a slip
/// rather than the beads, in m/s.
const FAST_M_S: f64 = 50.0;

/// What can't be computed sensibly: crushed bodies, motion that stops at once.
pub(crate) fn refusal(spec: &Spec, chain: &Chain) -> Option<Problem> {
    let meetings = meetings(spec, chain);
    let mut crushed = meetings.iter().filter_map(|meeting| crushed(spec, meeting));
    let overpowering = || strengths(spec, &meetings).find_map(|used| used.overpowering());
    crushed.next().or_else(overpowering)
}

/// Laws outside their validity; of overlaps the worst.
pub(crate) fn warnings(spec: &Spec, chain: &Chain) -> Vec<Problem> {
    let meetings = meetings(spec, chain);
    let depth = |meeting: &Meeting<'_>| meeting.overlap_m / meeting.pair.radius_m;
    let spheres = meetings.iter().filter_map(|m| Some((m, of_spheres(m)?)));
    let deepest = spheres.max_by(|a, b| depth(a.0).total_cmp(&depth(b.0)));
    let deep = deepest.filter(|(m, _)| spec.units == Units::Si && depth(m) > DEEP);
    let deep = deep.map(|(meeting, law)| deep_contact(spec, meeting, law));
    let strong = strengths(spec, &meetings).filter_map(|used| used.warning());
    deep.into_iter().chain(strong).collect()
}

/// "two bodies that meet in contact 0 at 0.5 m/s".
fn bodies(spec: &Spec, meeting: &Meeting<'_>) -> String {
    let speed = spec.units.with_unit(&brief(meeting.speed_m_s), "m/s");
    format!(
        "two bodies that meet in contact {} at {speed}",
        meeting.contact
    )
}

/// The law of a meeting that takes the bodies for spheres: one whose stiffness
/// follows from radii and materials.
fn of_spheres<'a>(meeting: &Meeting<'a>) -> Option<&'a LawSpec> {
    meeting.section.laws.iter().find(|law| {
        let mut parameters = law.row.info.parameters.iter();
        let from_materials = parameters.any(|p| p.source == Source::Materials);
        match law.row.info.nature {
            Nature::Elastic => from_materials,
            Nature::ElasticPlastic => true,
            Nature::Dissipative => false,
        }
    })
}

/// Dimensionless lengths have no radius to be compared with.
fn crushed(spec: &Spec, meeting: &Meeting<'_>) -> Option<Problem> {
    let most_m = CRUSHED * meeting.pair.radius_m;
    if spec.units == Units::Dimensionless || meeting.overlap_m <= most_m {
        return None;
    }
    let message = format!(
        "{} overlap by {} m, more than a bead's radius",
        bodies(spec, meeting),
        brief(meeting.overlap_m)
    );
    let label = format!(
        "expected bodies that stop within {} m, twice their reduced radius",
        brief(most_m)
    );
    let elastic = |law: &&LawSpec| law.row.info.nature != Nature::Dissipative;
    let law = meeting.section.laws.iter().find(elastic)?;
    let problem = Problem::new(&softness(spec, meeting, law), message, label);
    Some(problem.help("take a lower speed or mass, or stiffer or larger bodies"))
}

fn deep_contact(spec: &Spec, meeting: &Meeting<'_>, law: &LawSpec) -> Problem {
    let message = format!(
        "{} overlap by {} m, {} of their reduced radius",
        bodies(spec, meeting),
        brief(meeting.overlap_m),
        brief(meeting.overlap_m / meeting.pair.radius_m)
    );
    let label = format!("beyond {DEEP} of it `{}` is out of its range", law.name());
    let place = softness(spec, meeting, law);
    Problem::new(&place, message, label).help(validity(law))
}

fn validity(law: &LawSpec) -> String {
    format!("validity of `{}`: {}", law.name(), law.row.info.validity)
}

/// What probably makes bodies overlap so much: the speed, the law's own
/// numbers, or else the material.
fn softness(spec: &Spec, meeting: &Meeting<'_>, law: &LawSpec) -> Range<usize> {
    if spec.units == Units::Si && meeting.speed_m_s > FAST_M_S {
        return spec.speed_span();
    }
    match material(spec, meeting) {
        Some(material) if law.given.is_empty() => material.modulus_span().clone(),
        _ => law.span.clone(),
    }
}

/// What the first bodies of a section are made of, or taken for.
fn material<'a>(spec: &'a Spec, meeting: &Meeting<'_>) -> Option<&'a MaterialSpec> {
    let bead = || spec.groups.first()?.cell.first()?.material;
    spec.materials
        .0
        .get(meeting.section.material.or_else(bead)?)
}

/// A dissipative law in the section where it acts.
struct Used<'a> {
    spec: &'a Spec,
    meeting: &'a Meeting<'a>,
    law: &'a LawSpec,
    /// Its force over the elastic one.
    strength: f64,
}

fn strengths<'a>(spec: &'a Spec, meetings: &'a [Meeting<'a>]) -> impl Iterator<Item = Used<'a>> {
    let of = move |meeting: &'a Meeting<'a>| {
        let used = move |(index, strength)| Used {
            spec,
            meeting,
            law: &meeting.section.laws[index],
            strength,
        };
        meeting.strengths().map(used)
    };
    meetings.iter().flat_map(of)
}

impl Used<'_> {
    fn overpowering(&self) -> Option<Problem> {
        let label = format!(
            "expected it at most {} times as strong: beyond, all motion stops at once",
            rounded(OVERPOWERING)
        );
        let problem = || self.problem(&label).help(self.balance());
        (self.strength > OVERPOWERING).then(problem)
    }

    /// Too strong for the law's range, or too weak to be seen.
    fn warning(&self) -> Option<Problem> {
        if self.strength > STRONG {
            let label = "the two then do not come apart again";
            return Some(self.problem(label).help(validity(self.law)));
        }
        let idle = self.strength > 0.0 && self.strength < IDLE;
        let label = "too weak to change any result";
        idle.then(|| self.problem(label).help(self.balance()))
    }

    fn problem(&self, label: &str) -> Problem {
        let message = format!(
            "law `{}` is {} times as strong as the elastic force of {}",
            self.law.name(),
            brief(self.strength),
            bodies(self.spec, self.meeting)
        );
        Problem::new(&self.place(), message, label)
    }

    /// The number that the user gave: in the law, or the larger viscosity.
    fn place(&self) -> Range<usize> {
        let viscosity = self.viscosity().and_then(MaterialSpec::viscosity_span);
        viscosity.unwrap_or(&self.law.span).clone()
    }

    /// The material whose viscosities make the law what it is.
    fn viscosity(&self) -> Option<&MaterialSpec> {
        let own = self.given().is_some()
            || self.law.row.info.parameters.first()?.source == Source::Required;
        material(self.spec, self.meeting).filter(|_| !own)
    }

    /// The law's first parameter as the file gives it.
    fn given(&self) -> Option<f64> {
        let name = self.law.row.info.parameters.first()?.name;
        let given = self.law.given.iter().find(|(given, _)| *given == name)?;
        Some(given.1)
    }

    /// The value at which the law is as strong as the elastic force: every
    /// dissipative law is proportional to its first parameter.
    fn balance(&self) -> String {
        match (self.law.row.info.parameters.first(), self.given()) {
            (Some(first), Some(value)) => {
                let plain = self.spec.units == Units::Dimensionless || first.unit == "1";
                let unit = match plain || first.unit.contains('{') {
                    true => String::new(),
                    false => format!(" {}", first.unit),
                };
                let equal = brief(value / self.strength);
                format!("both are equal at {} = {equal}{unit}", first.name)
            }
            _ => format!(
                "both are equal at viscosities {} times as large",
                brief(1.0 / self.strength)
            ),
        }
    }
}

/// The first contact that is overlapped by more than the smaller radius at the
/// start, by load or by displacement. Dimensionless lengths have no radius to
/// be compared with.
pub(crate) fn overlapped_at_start(spec: &Spec, chain: &Chain, system: &System) -> Option<Problem> {
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
        (overlap_m > radius_m).then(|| overlapped(spec, contact, overlap_m, at_rest_m > radius_m))
    })
}

fn overlapped(spec: &Spec, contact: usize, overlap_m: f64, by_load: bool) -> Problem {
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

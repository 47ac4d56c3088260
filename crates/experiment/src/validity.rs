//! What a shot would meet, estimated without running anything: laws used beyond their range, by
//! two bodies that meet at the speed that sets the chain in motion, and steps and durations with
//! which no shot comes to a sensible end.

use crate::bodies::MaterialSpec;
use crate::contacts::{LawSpec, SectionSpec};
use crate::report::{FileProblem, brief, to_digits};
use crate::settings::{Method, Near};
use crate::spec::Spec;
use crate::values::Units;
use hertzchain_chain::laws::{Closed, Columns, Law, Nature, Source};
use hertzchain_chain::{BeadPair, Chain, FarEnd, Gap, Push, Section, Start, System};
use std::f64::consts::TAU;
use std::ops::Range;
use std::sync::Arc;

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

/// The first two bodies of a section, meeting at the speed that sets the chain
/// in motion.
struct Collision<'a> {
    spec: &'a Spec,
    section: &'a SectionSpec,
    contact: usize,
    pair: BeadPair,
    speed_m_s: f64,
    /// Overlap at which the laws that push back have taken up the energy.
    overlap_m: f64,
    /// In the order of the section's laws.
    terms: Vec<LawTerm>,
}

/// One law with its numbers for the pair.
struct LawTerm {
    law: Arc<dyn Law>,
    columns: Columns,
}

/// The first reason why a chain can't be computed sensibly: crushed bodies, motion that stops at
/// once.
pub(crate) fn refusal(spec: &Spec, chain: &Chain) -> Option<FileProblem> {
    let collisions = collisions(spec, chain);
    let crushed = collisions.iter().find_map(Collision::crushed);
    crushed.or_else(|| {
        let mut damping = collisions.iter().flat_map(Collision::damping);
        damping.find_map(|damping| damping.overpowering())
    })
}

/// Laws outside their validity; of overlaps the worst.
pub(crate) fn warnings(spec: &Spec, chain: &Chain) -> Vec<FileProblem> {
    let collisions = collisions(spec, chain);
    let depth = |collision: &Collision<'_>| collision.overlap_m / collision.pair.radius_m;
    let spheres = collisions.iter().filter_map(|c| Some((c, c.law_of_spheres()?)));
    let deepest = spheres.max_by(|a, b| depth(a.0).total_cmp(&depth(b.0)));
    let deep = deepest.filter(|(c, _)| spec.units == Units::Si && depth(c) > DEEP);
    let deep = deep.map(|(collision, law)| collision.too_deep(law));
    let damping = collisions.iter().flat_map(Collision::damping);
    deep.into_iter().chain(damping.filter_map(|damping| damping.warning())).collect()
}

/// The collisions of all sections that have a law that pushes back; none where
/// nothing has a speed.
fn collisions<'a>(spec: &'a Spec, chain: &Chain) -> Vec<Collision<'a>> {
    let (speed_m_s, energy_j) = fastest(chain);
    let collision = |(written, section): (&'a SectionSpec, &Section)| {
        let mut contacts = section.contacts.clone();
        let (contact, pair) = contacts.find_map(|c| Some((c, chain.pair(c)?)))?;
        let terms = section.laws.iter().map(|law| {
            // A law that can't serve this pair is reported by those who set it up.
            let row = law.coefficients(&pair).ok()?;
            let columns = Columns::from_rows(&[row]);
            Some(LawTerm { law: law.clone(), columns })
        });
        let terms: Vec<LawTerm> = terms.collect::<Option<_>>()?;
        // No contact can hold more than what was put in.
        let own_j = 0.5 * pair.mass_kg * speed_m_s * speed_m_s;
        let overlap_m = overlap_m(&terms, own_j.min(energy_j))?;
        let section = written;
        Some(Collision { spec, section, contact, pair, speed_m_s, overlap_m, terms })
    };
    match speed_m_s > 0.0 && speed_m_s.is_finite() {
        true => spec.sections.iter().zip(&chain.sections).filter_map(collision).collect(),
        false => Vec::new(),
    }
}

/// Speed in m/s of the fastest body, and energy in J of all that move; a driven end has no end
/// of it.
fn fastest(chain: &Chain) -> (f64, f64) {
    let energy_j = |mass_kg: f64, speed_m_s: f64| 0.5 * mass_kg * speed_m_s * speed_m_s;
    let mut fastest = match &chain.start {
        Start::Striker { bead, speed_m_s } => (*speed_m_s, energy_j(bead.mass_kg, *speed_m_s)),
        Start::Driven { motion, .. } => (motion.largest_speed_m_s(), f64::INFINITY),
        Start::Free => (0.0, 0.0),
    };
    for initial in &chain.initial {
        let bead = initial.bead.checked_sub(1).and_then(|i| chain.beads.get(i));
        fastest.0 = fastest.0.max(initial.velocity_m_s.abs());
        fastest.1 += bead.map_or(0.0, |b| energy_j(b.mass_kg, initial.velocity_m_s));
    }
    fastest
}

impl LawTerm {
    fn is_dissipative(&self) -> bool {
        self.law.info().nature == Nature::Dissipative
    }

    fn force_n(&self, overlap_m: f64, rate_m_s: f64) -> f64 {
        let closed = Closed::new(overlap_m, rate_m_s);
        self.law.force(&self.columns, 0, closed)
    }

    /// Work of pressing two bodies together slowly.
    fn work_j(&self, overlap_m: f64) -> f64 {
        match self.law.info().nature {
            Nature::Dissipative | Nature::WithState | Nature::Adhesive => 0.0,
            Nature::Elastic => self.law.energy(&self.columns, 0, overlap_m, overlap_m),
            // ∫ F dδ by the midpoint rule: a part of it is not stored.
            Nature::ElasticPlastic => {
                const PARTS: u8 = 32;
                let part_m = overlap_m / f64::from(PARTS);
                let force_n = |i| self.force_n((f64::from(i) + 0.5) * part_m, 0.0);
                (0..PARTS).map(force_n).sum::<f64>() * part_m
            }
        }
    }
}

/// Where the slow work of all terms reaches an energy, to a hundredth; `None`
/// when it never does.
fn overlap_m(terms: &[LawTerm], energy_j: f64) -> Option<f64> {
    const FACTOR: f64 = 16.0;
    const WIDTH: f64 = 1.01;
    let enough = |overlap_m: f64| {
        let work_j: f64 = terms.iter().map(|term| term.work_j(overlap_m)).sum();
        work_j >= energy_j
    };
    // Outward from the micrometre at which contacts live.
    let mut high = 1e-6;
    while !enough(high) {
        high *= FACTOR;
        if high > 1e300 {
            return None;
        }
    }
    while high > 1e-300 && enough(high / FACTOR) {
        high /= FACTOR;
    }
    let mut low = high / FACTOR;
    while high / low > WIDTH {
        let middle = (low * high).sqrt();
        *(if enough(middle) { &mut high } else { &mut low }) = middle;
    }
    Some(high)
}

impl<'a> Collision<'a> {
    /// "two bodies that meet in contact 0 at 0.5 m/s".
    fn bodies(&self) -> String {
        let speed = self.spec.units.with_unit(&brief(self.speed_m_s), "m/s");
        format!("two bodies that meet in contact {} at {speed}", self.contact)
    }

    /// The law that takes the bodies for spheres: one whose stiffness
    /// follows from radii and materials.
    fn law_of_spheres(&self) -> Option<&'a LawSpec> {
        self.section.laws.iter().find(|law| {
            let mut parameters = law.row.info.parameters.iter();
            match law.row.info.nature {
                Nature::Elastic => parameters.any(|p| p.source == Source::Materials),
                Nature::ElasticPlastic => true,
                Nature::Dissipative | Nature::WithState | Nature::Adhesive => false,
            }
        })
    }

    fn crushed(&self) -> Option<FileProblem> {
        let most_m = CRUSHED * self.pair.radius_m;
        // Dimensionless lengths have no radius to be compared with.
        if self.spec.units == Units::Dimensionless || self.overlap_m <= most_m {
            return None;
        }
        let (bodies, overlap, most) = (self.bodies(), brief(self.overlap_m), brief(most_m));
        let message = format!("{bodies} overlap by {overlap} m, more than a bead's radius");
        let label =
            format!("expected bodies that stop within {most} m, twice their reduced radius");
        let law = self.section.laws.iter().find(|law| !law.is_dissipative())?;
        let problem = FileProblem::new(&self.cause(law), message, label);
        Some(problem.help("take a lower speed or mass, or stiffer or larger bodies"))
    }

    fn too_deep(&self, law: &LawSpec) -> FileProblem {
        let (bodies, overlap) = (self.bodies(), brief(self.overlap_m));
        let ratio = brief(self.overlap_m / self.pair.radius_m);
        let message = format!("{bodies} overlap by {overlap} m, {ratio} of their reduced radius");
        let label = format!("beyond {DEEP} of it `{}` is out of its range", law.name());
        FileProblem::new(&self.cause(law), message, label).help(validity(law))
    }

    /// What probably makes bodies overlap so much: the speed, the law's own
    /// numbers, or else the material.
    fn cause(&self, law: &LawSpec) -> Range<usize> {
        let fast = self.spec.units == Units::Si && self.speed_m_s > FAST_M_S;
        match (&self.spec.near, self.material()) {
            (Near::Striker { speed_span, .. }, _) if fast => speed_span.clone(),
            (near, _) if fast => near.span(),
            (_, Some(material)) if law.given.is_empty() => material.young_modulus.span.clone(),
            _ => law.span.clone(),
        }
    }

    /// The material of the section's first bodies, or the effective one.
    fn material(&self) -> Option<&'a MaterialSpec> {
        let bead = || self.spec.groups.first()?.cell.first()?.material;
        let index = self.section.material.or_else(bead)?;
        self.spec.materials.0.get(index)
    }

    /// Each dissipative law with its force at the largest overlap and the full speed over the
    /// elastic force. Both never act together; the ratio compares their sizes.
    fn damping(&self) -> impl Iterator<Item = Damping<'_>> {
        let elastic = self.terms.iter().filter(|term| !term.is_dissipative());
        let elastic_n: f64 = elastic.map(|term| term.force_n(self.overlap_m, 0.0)).sum();
        let terms = self.terms.iter().zip(&self.section.laws);
        let dissipative = terms.filter(|(term, _)| term.is_dissipative());
        dissipative.map(move |(term, law)| {
            let force_n = term.force_n(self.overlap_m, self.speed_m_s);
            let strength = force_n / elastic_n;
            Damping { collision: self, law, strength }
        })
    }
}

fn validity(law: &LawSpec) -> String {
    format!("validity of `{}`: {}", law.name(), law.row.info.validity)
}

/// A dissipative law in the section where it acts.
struct Damping<'a> {
    collision: &'a Collision<'a>,
    law: &'a LawSpec,
    /// Its force over the elastic one.
    strength: f64,
}

impl Damping<'_> {
    fn overpowering(&self) -> Option<FileProblem> {
        let most = to_digits(OVERPOWERING, 6);
        let label =
            format!("expected it at most {most} times as strong: beyond, all motion stops at once");
        let problem = || self.problem(&label).help(self.balance());
        (self.strength > OVERPOWERING).then(problem)
    }

    /// Too strong for the law's range, or too weak to be seen.
    fn warning(&self) -> Option<FileProblem> {
        if self.strength > STRONG {
            let label = "the two then part with less than half of their speed, if at all";
            return Some(self.problem(label).help(validity(self.law)));
        }
        if self.strength == 0.0 && self.needs_viscosity() {
            let label =
                "its material has no viscosity: give `shear_viscosity`, or leave the law out";
            return Some(self.problem(label));
        }
        let idle = self.strength > 0.0 && self.strength < IDLE;
        let label = "too weak to change any result";
        idle.then(|| self.problem(label).help(self.balance()))
    }

    /// A problem with the number that the user gave: in the law, or the larger viscosity of the
    /// material that makes the law what it is.
    fn problem(&self, label: &str) -> FileProblem {
        let (law, strength, bodies) = (self.law, brief(self.strength), self.collision.bodies());
        let message = format!(
            "law `{}` is {strength} times as strong as the elastic force of {bodies}",
            law.name()
        );
        let material = self.collision.material().filter(|_| !self.has_own_number());
        let viscosity = material.and_then(MaterialSpec::viscosity_span);
        FileProblem::new(viscosity.unwrap_or(&law.span), message, label)
    }

    /// Whether the law's first number stands in the law.
    fn has_own_number(&self) -> bool {
        let first = self.law.row.info.parameters.first();
        first.is_none_or(|p| p.source == Source::Required || self.law.value(p.name).is_some())
    }

    /// Whether the law's first number comes from a material that has none.
    fn needs_viscosity(&self) -> bool {
        let material = self.collision.material();
        !self.has_own_number() && material.is_some_and(|it| it.viscosity_span().is_none())
    }

    /// The value at which the law is as strong as the elastic force: every
    /// dissipative law is proportional to its first parameter.
    fn balance(&self) -> String {
        let first = self.law.row.info.parameters.first();
        let Some((first, value)) = first.and_then(|p| Some((p, self.law.value(p.name)?))) else {
            let times = brief(1.0 / self.strength);
            return format!("both are equal at viscosities {times} times as large");
        };
        let plain = first.unit == "1" || first.unit.contains('{');
        let equal = brief(value / self.strength);
        let equal = match plain {
            true => equal,
            false => self.collision.spec.units.with_unit(&equal, first.unit),
        };
        format!("both are equal at {} = {equal}", first.name)
    }
}

/// The first contact that is overlapped by more than the smaller radius at the
/// start, by load or by displacement. Dimensionless lengths have no radius to
/// be compared with.
pub(crate) fn overlapped_at_start(
    spec: &Spec,
    chain: &Chain,
    system: &System,
) -> Option<FileProblem> {
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
    (1..=beads).find_map(|contact| {
        let at_rest_m = system.static_contact(contact).overlap_m;
        let overlap_m = at_rest_m + displaced_m[contact] - displaced_m[contact + 1];
        // What bead N leans on is at least as large, or of no radius at all.
        let left_m = chain.beads[contact - 1].radius_m;
        let radius_m = chain.beads.get(contact).map_or(left_m, |bead| left_m.min(bead.radius_m));
        let touches = |bead: usize| bead == contact || bead == contact + 1;
        let moved = spec.initial.iter().find(|(i, _)| touches(i.bead) && at_rest_m <= radius_m);
        let (span, label) = match moved {
            Some((_, span)) => (span, "expected a smaller displacement into its neighbour"),
            None => (&spec.load_span, "expected less force on the chain"),
        };
        let overlap = to_digits(overlap_m, 6);
        (overlap_m > radius_m).then(|| {
            let message = format!(
                "contact {contact} is overlapped by {overlap} m at the start, more than a bead's radius"
            );
            FileProblem::new(span, message, label)
        })
    })
}

/// Most steps of one shot. More take hours even in short chains, and the
/// rounding of a billion steps, 1e-16 each, comes near the accuracies that are
/// asked for.
const MOST_STEPS: f64 = 1e9;

/// Steps that contacts take in a contact time while anything rings, about.
const STEPS_A_CONTACT_TIME: f64 = 10.0;

/// Fixed steps in a contact time that give good times of flight.
const GOOD_STEPS: f64 = 50.0;

/// The wave loop gives up after so many force passes, and so many more for
/// every contact time.
const PASSES: f64 = 1e7;
const PASSES_A_CONTACT_TIME: f64 = 1e4;

/// Contact times a bead that a shot without a duration lasts: 1.4 for each of
/// the ways of the pulse that are followed, six, and at most.
const USUAL: f64 = 10.0;
const LONGEST: f64 = 40.0;

/// Beads' worth of time that even the shortest chain gets.
const SHORT_CHAIN: f64 = 10.0;

/// Stiffest spring on bead 1 over the contacts' stiffness: its swing would be a
/// thousandth of a contact time, whatever it is meant to hold.
const STIFFEST: f64 = 1e6;

/// The steps that a shot would take.
struct ShotEffort<'a> {
    spec: &'a Spec,
    chain: &'a Chain,
    contact_time_s: f64,
    duration_s: f64,
    /// Longest duration that the wave loop is prepared for.
    prepared_s: f64,
}

/// Longest duration in s of a shot of a system: beyond, it would take more steps
/// than hours have time for.
pub fn longest_duration_s(system: &System) -> f64 {
    MOST_STEPS / STEPS_A_CONTACT_TIME * system.scales().time_s
}

/// The first reason why a shot of this system would not end sensibly.
pub(crate) fn effort_problem(spec: &Spec, chain: &Chain, system: &System) -> Option<FileProblem> {
    let scales = system.scales();
    let gaps_s = chain.gaps.iter().map(|gap| gap.gap_m).sum::<f64>() / scales.speed_m_s;
    let beads = chain.beads.len() as f64 + SHORT_CHAIN;
    let bead_times = |count: f64| count * (beads * scales.time_s + gaps_s);
    let swing_s = |length_m: f64| TAU * (length_m / chain.gravity_m_s2).sqrt();
    let swing_s = chain.suspension_m.map(swing_s).filter(|swing_s| swing_s.is_finite());
    let given_s = spec.solver.duration_s.or(swing_s);
    let effort = ShotEffort {
        spec,
        chain,
        contact_time_s: scales.time_s,
        duration_s: given_s.unwrap_or_else(|| bead_times(USUAL)),
        prepared_s: given_s.unwrap_or_else(|| bead_times(LONGEST)),
    };
    (effort.long_step())
        .or_else(|| effort.long_shot(longest_duration_s(system)))
        .or_else(|| effort.short_step())
        .or_else(|| effort.fast_drive())
        .or_else(|| effort.stiff_spring())
}

impl ShotEffort<'_> {
    fn time(&self, time_s: f64) -> String {
        self.spec.units.with_unit(&brief(time_s), "s")
    }

    fn good_step(&self) -> String {
        let good = self.time(self.contact_time_s / GOOD_STEPS);
        format!("{good}, a fiftieth of a contact's time, is sensible")
    }

    /// A whole contact would come and go within a step.
    fn long_step(&self) -> Option<FileProblem> {
        let step_s = self.spec.solver.step_s?;
        (step_s > self.contact_time_s).then(|| {
            let (step, contact) = (self.time(step_s), self.time(self.contact_time_s));
            let message = format!("a step of {step} is longer than a contact lasts, {contact}");
            let label = format!("expected a shorter step: {}", self.good_step());
            FileProblem::new(&self.spec.step_span, message, label)
        })
    }

    /// A shot of more contact times than can be stepped through.
    fn long_shot(&self, most_s: f64) -> Option<FileProblem> {
        if self.duration_s <= most_s {
            return None;
        }
        let (shot, most) = (self.time(self.duration_s), self.time(most_s));
        let steps = brief(STEPS_A_CONTACT_TIME * self.duration_s / self.contact_time_s);
        let message = |what: &str| format!("{what} takes {shot}, some {steps} steps");
        let largest = |a: &&(Gap, _), b: &&(Gap, _)| a.0.gap_m.total_cmp(&b.0.gap_m);
        let spec = self.spec;
        let gap = spec.gaps.iter().max_by(largest);
        let problem = match (spec.solver.duration_s, &spec.suspension_span, gap) {
            (Some(_), _, _) => {
                let message = format!("a shot of {shot} takes some {steps} steps");
                let label = format!("expected a duration of at most {most}");
                FileProblem::new(&spec.duration_span, message, label)
            }
            (None, Some(thread), _) => {
                let label = format!("expected a `duration` in [solver] of at most {most}");
                FileProblem::new(thread, message("one swing"), label)
            }
            (None, None, Some((_, span))) => {
                let label = "expected a smaller gap, or a faster striker";
                FileProblem::new(span, message("a shot across this gap"), label)
            }
            (None, None, None) => return None,
        };
        let contact = self.time(self.contact_time_s);
        Some(problem.help(format!(
            "contacts here last {contact} and take some ten steps each; a billion steps take hours"
        )))
    }

    /// More fixed steps than the wave loop does.
    fn short_step(&self) -> Option<FileProblem> {
        let step_s = self.spec.solver.step_s?;
        let contact_times = self.prepared_s / self.contact_time_s;
        let passes = PASSES + PASSES_A_CONTACT_TIME * contact_times;
        let passes_a_step = match self.spec.solver.method {
            Method::Rk4 => 4.0,
            Method::Verlet | Method::Adaptive => 1.0,
        };
        let most = MOST_STEPS.min(passes / passes_a_step);
        let steps = self.duration_s / step_s;
        if steps <= most {
            return None;
        }
        let (shot, step) = (self.time(self.duration_s), self.time(step_s));
        let message = format!("a shot of about {shot} takes {} steps of {step}", brief(steps));
        let least = self.time(self.duration_s / most);
        let label = format!("expected at least {least}; {}", self.good_step());
        let most = brief(most);
        let problem = FileProblem::new(&self.spec.step_span, message, label).help(format!(
            "at most {most} steps are done: shorter ones add rounding errors, not accuracy"
        ));
        Some(match self.spec.solver.duration_s {
            Some(_) => problem.also(&self.spec.duration_span, "the duration"),
            None => problem,
        })
    }

    /// A driven end that swings too often.
    fn fast_drive(&self) -> Option<FileProblem> {
        let Near::Driven { shape, motion } = &self.spec.near else {
            return None;
        };
        let steps = self.duration_s / motion.longest_step_s();
        (steps > MOST_STEPS).then(|| {
            let (shot, contact) = (self.time(self.duration_s), self.time(self.contact_time_s));
            let message = format!("following this motion for {shot} takes {} steps", brief(steps));
            let label = format!("expected a slower motion: contacts last {contact}");
            FileProblem::new(&shape.span, message, label).help(format!(
                "at most {} steps are done; a shorter `duration` in [solver] makes them fewer",
                brief(MOST_STEPS)
            ))
        })
    }

    /// A spring on bead 1 that swings within a contact time over and over.
    fn stiff_spring(&self) -> Option<FileProblem> {
        let Push::Spring { stiffness_n_m, .. } = self.chain.push else {
            return None;
        };
        let mass_kg = self.chain.beads.first()?.mass_kg;
        let most_n_m = STIFFEST * mass_kg / (self.contact_time_s * self.contact_time_s);
        (stiffness_n_m > most_n_m).then(|| {
            let message = "the spring on bead 1 is over a million times stiffer than its contact";
            let most = self.spec.units.with_unit(&brief(most_n_m), "N/m");
            let label = format!("expected a stiffness of at most {most}");
            FileProblem::new(&self.spec.load_span, message, label)
                .help("the steps would follow the spring alone; push = \"constant\" holds as well")
        })
    }
}

//! Steps and durations with which no shot comes to a sensible end, reported at
//! their place in the file before anything runs.

use crate::finding::Problem;
use crate::spec::{Method, Near, Spec};
use crate::value::brief;
use hertzchain_chain::{Chain, Gap, Push, System};
use std::f64::consts::TAU;

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

/// What a shot would take.
struct Effort<'a> {
    spec: &'a Spec,
    chain: &'a Chain,
    contact_time_s: f64,
    duration_s: f64,
    /// Longest duration that the wave loop is prepared for.
    longest_s: f64,
}

/// Longest duration in s of a shot of a system: beyond, it would take more steps
/// than hours have time for.
pub fn longest_duration_s(system: &System) -> f64 {
    bearable_s(system.scales().time_s)
}

fn bearable_s(contact_time_s: f64) -> f64 {
    MOST_STEPS / STEPS_A_CONTACT_TIME * contact_time_s
}

/// The first reason why a shot of this system would not end sensibly.
pub(crate) fn problem(spec: &Spec, chain: &Chain, system: &System) -> Option<Problem> {
    let effort = Effort::of(spec, chain, system);
    let checks = [
        Effort::long_step,
        Effort::long_way,
        Effort::short_step,
        Effort::quick_drive,
        Effort::stiff_spring,
    ];
    checks.iter().find_map(|check| check(&effort))
}

/// Force passes of one step.
fn passes_a_step(method: Method) -> f64 {
    match method {
        Method::Rk4 => 4.0,
        Method::Verlet | Method::Adaptive => 1.0,
    }
}

impl<'a> Effort<'a> {
    fn of(spec: &'a Spec, chain: &'a Chain, system: &System) -> Self {
        let scales = system.scales();
        let gaps_s = chain.gaps.iter().map(|gap| gap.gap_m).sum::<f64>() / scales.speed_m_s;
        let beads = chain.beads.len() as f64 + SHORT_CHAIN;
        let bead_times = |count: f64| count * (beads * scales.time_s + gaps_s);
        let swing_s = chain
            .suspension_m
            .map(|length_m| TAU * (length_m / chain.gravity_m_s2).sqrt())
            .filter(|swing_s| swing_s.is_finite());
        let given_s = spec.solver.duration_s.or(swing_s);
        Self {
            spec,
            chain,
            contact_time_s: scales.time_s,
            duration_s: given_s.unwrap_or_else(|| bead_times(USUAL)),
            longest_s: given_s.unwrap_or_else(|| bead_times(LONGEST)),
        }
    }

    fn time(&self, time_s: f64) -> String {
        self.spec.units.with_unit(&brief(time_s), "s")
    }

    fn good_step(&self) -> String {
        let good = self.time(self.contact_time_s / GOOD_STEPS);
        format!("{good}, a fiftieth of a contact's time, is sensible")
    }

    /// A whole contact would come and go within a step.
    fn long_step(&self) -> Option<Problem> {
        let step_s = self.spec.solver.step_s?;
        (step_s > self.contact_time_s).then(|| {
            let (step, contact) = (self.time(step_s), self.time(self.contact_time_s));
            let message = format!("a step of {step} is longer than a contact lasts, {contact}");
            let label = format!("expected a shorter step: {}", self.good_step());
            Problem::new(&self.spec.solver_spans.step, message, label)
        })
    }

    /// A shot of more contact times than can be stepped through.
    fn long_way(&self) -> Option<Problem> {
        let most_s = bearable_s(self.contact_time_s);
        if self.duration_s <= most_s {
            return None;
        }
        let (shot, most) = (self.time(self.duration_s), self.time(most_s));
        let steps = brief(STEPS_A_CONTACT_TIME * self.duration_s / self.contact_time_s);
        let help = format!(
            "contacts here last {} and take some ten steps each; a billion steps take hours",
            self.time(self.contact_time_s)
        );
        let message = |what: &str| format!("{what} takes {shot}, some {steps} steps");
        let largest = |a: &&(Gap, _), b: &&(Gap, _)| a.0.gap_m.total_cmp(&b.0.gap_m);
        let gap = self.spec.gaps.iter().max_by(largest);
        let spec = self.spec;
        let problem = match (spec.solver.duration_s, &spec.suspension_span, gap) {
            (Some(_), _, _) => {
                let message = format!("a shot of {shot} takes some {steps} steps");
                let label = format!("expected a duration of at most {most}");
                Problem::new(&spec.solver_spans.duration, message, label)
            }
            (None, Some(thread), _) => {
                let label = format!("expected a `duration` in [solver] of at most {most}");
                Problem::new(thread, message("one swing"), label)
            }
            (None, None, Some((_, span))) => {
                let label = "expected a smaller gap, or a faster striker";
                Problem::new(span, message("a shot across this gap"), label)
            }
            (None, None, None) => return None,
        };
        Some(problem.help(help))
    }

    /// More fixed steps than the wave loop does.
    fn short_step(&self) -> Option<Problem> {
        let step_s = self.spec.solver.step_s?;
        let contact_times = self.longest_s / self.contact_time_s;
        let passes = PASSES + PASSES_A_CONTACT_TIME * contact_times;
        let most = MOST_STEPS.min(passes / passes_a_step(self.spec.solver.method));
        let steps = self.duration_s / step_s;
        (steps > most).then(|| {
            let message = format!(
                "a shot of about {} takes {} steps of {}",
                self.time(self.duration_s),
                brief(steps),
                self.time(step_s)
            );
            let least = self.time(self.duration_s / most);
            let label = format!("expected at least {least}; {}", self.good_step());
            let problem = Problem::new(&self.spec.solver_spans.step, message, label).help(format!(
                "at most {} steps are done: shorter ones add rounding errors, not accuracy",
                brief(most)
            ));
            match self.spec.solver.duration_s {
                Some(_) => problem.beside(&self.spec.solver_spans.duration, "the duration"),
                None => problem,
            }
        })
    }

    /// A driven end that swings too often.
    fn quick_drive(&self) -> Option<Problem> {
        let Near::Driven { shape, motion } = &self.spec.near else {
            return None;
        };
        let steps = self.duration_s / motion.longest_step_s();
        (steps > MOST_STEPS).then(|| {
            let message = format!(
                "following this motion for {} takes {} steps",
                self.time(self.duration_s),
                brief(steps)
            );
            let label = format!(
                "expected a slower motion: contacts last {}",
                self.time(self.contact_time_s)
            );
            Problem::new(&shape.span, message, label).help(format!(
                "at most {} steps are done; a shorter `duration` in [solver] makes them fewer",
                brief(MOST_STEPS)
            ))
        })
    }

    /// A spring on bead 1 that swings within a contact time over and over.
    fn stiff_spring(&self) -> Option<Problem> {
        let Push::Spring { stiffness_n_m, .. } = self.chain.push else {
            return None;
        };
        let mass_kg = self.chain.beads.first()?.mass_kg;
        let most_n_m = STIFFEST * mass_kg / (self.contact_time_s * self.contact_time_s);
        (stiffness_n_m > most_n_m).then(|| {
            let message = "the spring on bead 1 is over a million times stiffer than its contact";
            let most = self.spec.units.with_unit(&brief(most_n_m), "N/m");
            let label = format!("expected a stiffness of at most {most}");
            Problem::new(&self.spec.load_span, message, label)
                .help("the steps would follow the spring alone; push = \"constant\" holds as well")
        })
    }
}

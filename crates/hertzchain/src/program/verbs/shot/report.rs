//! A shot in words.

use crate::contact::HertzContact;
use crate::missing;
use crate::program::format::pairs;
use crate::program::{Style, digits, heading};
use hertzchain_chain::Start;
use hertzchain_chain::observe::{Maximum, Passage, Pulse};
use hertzchain_chain::wave::Budget;
use hertzchain_experiment::Experiment;
use hertzchain_sim::{Plan, Shot};

type Rows = Vec<(String, String)>;

pub(super) fn text(experiment: &Experiment, plan: &Plan, shot: &Shot) -> String {
    let accuracy = shot.accuracy_reached.unwrap_or(plan.accuracy);
    let style = Style::of_accuracy(accuracy, experiment.units());
    let mut text = format!("{}\n", heading(experiment.title()));
    if let Start::Striker { speed_m_s, .. } = &plan.chain.start {
        let speed = Style::brief(style.units).quantity(*speed_m_s, "m/s");
        text += &format!("Striker at {speed}, {}\n", experiment.reading());
    }
    text += &format!("\n{}", pairs(flight(style, shot)));
    text += &match &shot.passage {
        Ok(seen) => {
            let mut rows = pulses(style, seen);
            rows.extend(contact(style, plan, shot));
            format!("\n{}\n{}", heading("Pulses"), pairs(rows))
        }
        Err(reason) => format!(
            "\nNo time of flight: {}.\n{}",
            missing::reason(&plan.chain.far, style.units, reason),
            last_speeds(style, shot)
        ),
    };
    if let Some(budget) = &shot.budget {
        text += &format!("\n{}\n{}", heading("Energy at the end"), pairs(energy(style, budget)));
    }
    text += &format!("\n{}\n{}", heading("Computation"), pairs(computation(style, shot)));
    for note in &shot.notes {
        text += &format!("\nNote: {note}.\n");
    }
    text
}

/// Rows of which the value is known.
fn known<const N: usize>(rows: [(&str, Option<String>); N]) -> Rows {
    rows.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?))).collect()
}

fn flight(style: Style, shot: &Shot) -> Rows {
    let brief = Style::brief(style.units);
    let moved = |(time, velocity): (f64, f64)| {
        format!("{} at {}", brief.quantity(velocity, "m/s"), brief.quantity(time, "s"))
    };
    let reflected = |time: Option<f64>| match time {
        Some(time) => style.exact(time, "s"),
        None => no_return(brief, shot),
    };
    let first = |first: Option<_>| first.map_or("it never left bead 1".to_owned(), moved);
    let end = |end: Option<_>| end.map_or("not followed to its end".to_owned(), moved);
    let mut rows = known([
        ("incident time of flight", shot.flight.map(|it| style.exact(it.incident_s, "s"))),
        ("reflected time of flight", shot.flight.map(|it| reflected(it.reflected_s))),
        (
            "pulse speed, sensor bead to wall",
            shot.pulse_speed_beads_s.map(|speed| brief.quantity(speed, "beads/s")),
        ),
        ("striker when it first separates", shot.rebound.map(|it| first(it.first))),
        ("striker when it last separates", shot.rebound.map(|it| end(it.end_s.zip(it.end_m_s)))),
    ]);
    if shot.flight.is_none() {
        let peaks = shot.sensor_maxima.iter().take(5);
        rows.extend(peaks.map(|peak| ("peak of the sensor bead".into(), at(brief, peak))));
    }
    rows
}

/// Why there is no reflected time of flight.
fn no_return(brief: Style, shot: &Shot) -> String {
    let searched_s = (shot.passage.as_ref()).map_or(0.0, |seen| seen.search_ends_s);
    if shot.passage.as_ref().is_ok_and(|seen| seen.reflected.is_some()) {
        return "none by this pick: the pulses overlap".to_owned();
    }
    match shot.duration_s < searched_s {
        true => "not waited for".to_owned(),
        false => format!("no pulse came back until {}", brief.quantity(searched_s, "s")),
    }
}

/// Longer chains have traces for that.
const MOST_BODIES: usize = 12;

/// What is left when pulses have passed: how fast each body flies.
fn last_speeds(style: Style, shot: &Shot) -> String {
    if shot.velocity_m_s.len() > MOST_BODIES {
        return String::new();
    }
    let brief = Style::brief(style.units);
    let bodies = shot.velocity_m_s.iter().enumerate();
    let bodies = bodies.take(shot.velocity_m_s.len() - 1);
    let rows = bodies.map(|(body, v)| (format!("body {body}"), brief.quantity(*v, "m/s")));
    format!("\n{}\n{}", heading("Velocities at the end"), pairs(rows))
}

fn at(style: Style, peak: &Maximum) -> String {
    format!("{} at {}", style.quantity(peak.value, "N"), style.quantity(peak.time_s, "s"))
}

/// Most other maxima of the sensor bead that are listed.
const MOST_OTHERS: usize = 8;

/// Most maxima that could be a pulse's peak that are listed, the highest first.
const MOST_COMPETING: usize = 3;

fn pulses(style: Style, seen: &Passage) -> Rows {
    let brief = Style::brief(style.units);
    let mut rows = Rows::new();
    let mut pulse = |name: &str, peak: &Maximum, width: Option<f64>| {
        let width = width.map_or(String::new(), |width| {
            format!(", {} wide at half maximum", brief.quantity(width, "s"))
        });
        rows.push((name.to_owned(), format!("{}{width}", at(brief, peak))));
    };
    pulse("sensor bead, incident", &seen.incident, seen.incident_width_s);
    pulse("wall", &seen.wall, seen.wall_width_s);
    if let Some(peak) = &seen.reflected {
        pulse("sensor bead, reflected", peak, seen.reflected_width_s);
    }
    for pulse in [Pulse::Incident, Pulse::Wall, Pulse::Reflected] {
        let of_pulse = seen.competing.iter().filter(|other| other.pulse == pulse);
        let mut highest: Vec<_> = of_pulse.collect();
        highest.sort_by(|a, b| b.share.total_cmp(&a.share));
        let name = format!("{} pulse, competing", pulse.name());
        let shown = highest.iter().take(MOST_COMPETING);
        rows.extend(shown.map(|other| (name.clone(), at(brief, &other.maximum))));
    }
    let others: Vec<&Maximum> = (seen.sensor_maxima.iter())
        .filter(|peak| **peak != seen.incident && Some(**peak) != seen.reflected)
        .collect();
    let shown = others.iter().take(MOST_OTHERS);
    rows.extend(shown.map(|peak| ("sensor bead, also".to_owned(), at(brief, peak))));
    if others.len() > MOST_OTHERS {
        let more = format!("and {} more, all with --json", others.len() - MOST_OTHERS);
        rows.push((String::new(), more));
    }
    rows
}

/// The contact of the highest pressure, and when its balls yield.
fn contact(style: Style, plan: &Plan, shot: &Shot) -> Option<(String, String)> {
    let found = HertzContact::hardest(style.units, plan, shot)?;
    let quantity = |value, unit| Style::brief(style.units).quantity(value, unit);
    let [radius, pressure] = [(found.radius_m, "m"), (found.pressure_pa, "Pa")];
    let needed = quantity(found.yield_strength_pa, "Pa");
    let verdict = match found.material_yield_strength_pa {
        Some(own) if own < found.yield_strength_pa => {
            format!("yields, as {} is below {needed}", quantity(own, "Pa"))
        }
        Some(own) => format!("does not yield, as {} is above {needed}", quantity(own, "Pa")),
        None => format!("balls of a yield strength below {needed} yield"),
    };
    let text = format!(
        "contact {} at {}: radius {}, largest pressure {}: {verdict}",
        found.contact,
        quantity(found.force_n, "N"),
        quantity(radius.0, radius.1),
        quantity(pressure.0, pressure.1),
    );
    Some(("hardest contact".to_owned(), text))
}

fn energy(style: Style, budget: &Budget) -> Rows {
    let brief = Style::brief(style.units);
    let part = |value_j: f64| (value_j != 0.0).then(|| brief.quantity(value_j, "J"));
    let mut rows = known([
        ("at the start", part(budget.start_j)),
        ("put in by the driven end", part(budget.driven_j)),
        ("kinetic", part(budget.kinetic_j)),
        ("elastic", part(budget.elastic_j)),
    ]);
    let lost = budget.dissipated.iter();
    rows.extend(
        lost.filter_map(|lost| Some((format!("dissipated by {}", lost.law), part(lost.energy_j)?))),
    );
    let residual = format!("{} of the input", digits(budget.relative_residual(), 2));
    rows.extend(known([
        ("clipped", part(budget.clipped_j)),
        ("gravity", part(budget.gravity_j)),
        ("preload", part(budget.preload_j)),
        ("stop", part(budget.stop_j)),
        ("residual", Some(residual)),
    ]));
    rows
}

fn computation(style: Style, shot: &Shot) -> Rows {
    let brief = Style::brief(style.units);
    let work = format!("{} in {} steps", shot.work.force_passes, shot.work.steps);
    known([
        ("duration", Some(brief.quantity(shot.duration_s, "s"))),
        ("solver", Some(shot.solver.clone())),
        ("accuracy asked", Some(digits(shot.accuracy_asked, 2))),
        ("accuracy reached", shot.accuracy_reached.map(|reached| digits(reached, 2))),
        ("tolerance per step", shot.tolerance.map(|tolerance| digits(tolerance, 2))),
        ("step", shot.step_s.map(|step_s| brief.quantity(step_s, "s"))),
        ("force passes", Some(work)),
    ])
}

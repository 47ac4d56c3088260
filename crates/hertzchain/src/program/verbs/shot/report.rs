//! A shot in words.

use crate::contact::HertzContact;
use crate::missing;
use crate::program::format::{Style, digits, pairs};
use crate::program::print::heading;
use hertzchain_chain::Start;
use hertzchain_chain::observe::{Maximum, Passage, Pulse};
use hertzchain_chain::wave::Budget;
use hertzchain_experiment::Experiment;
use hertzchain_sim::{Plan, Shot};

type Rows = Vec<(String, String)>;

/// Everything that was asked of the shot.
pub(super) fn text(experiment: &Experiment, plan: &Plan, shot: &Shot) -> String {
    let accuracy = shot.accuracy_reached.unwrap_or(plan.accuracy);
    let style = Style::of_accuracy(accuracy, experiment.units());
    let mut text = format!("{}\n", heading(experiment.title()));
    if let Start::Striker { speed_m_s, .. } = &plan.chain.start {
        let speed = Style::brief(style.units).quantity(*speed_m_s, "m/s");
        text += &format!("Striker at {speed}, {}\n", experiment.reading());
    }
    text += &format!("\n{}", pairs(&flight(style, shot)));
    text += &match &shot.passage {
        Ok(seen) => {
            let mut rows = pulses(style, seen);
            rows.extend(contact(style, plan, shot));
            format!("\n{}\n{}", heading("Pulses"), pairs(&rows))
        }
        Err(reason) => format!(
            "\nNo time of flight: {}.\n{}",
            missing::reason(&plan.chain.far, style.units, reason),
            last_speeds(style, shot)
        ),
    };
    if let Some(budget) = &shot.budget {
        text += &format!("\n{}\n{}", heading("Energy at the end"), pairs(&energy(style, budget)));
    }
    text += &format!("\n{}\n{}", heading("Computation"), pairs(&computation(style, shot)));
    for note in &shot.notes {
        text += &format!("\nNote: {note}.\n");
    }
    text
}

fn flight(style: Style, shot: &Shot) -> Rows {
    let brief = Style::brief(style.units);
    let mut rows = Rows::new();
    if let Some(flight) = shot.flight {
        let reflected = flight.reflected_s.map(|time| style.exact(time, "s"));
        rows.push(("incident time of flight".into(), style.exact(flight.incident_s, "s")));
        let reflected = reflected.unwrap_or_else(|| no_return(brief, shot));
        rows.push(("reflected time of flight".into(), reflected));
    }
    if let Some(speed) = shot.pulse_speed_beads_s {
        let speed = brief.quantity(speed, "beads/s");
        rows.push(("pulse speed, sensor bead to wall".into(), speed));
    }
    if let Some(rebound) = shot.rebound {
        let at = |(time, velocity): (f64, f64)| {
            let (velocity, time) = (brief.quantity(velocity, "m/s"), brief.quantity(time, "s"));
            format!("{velocity} at {time}")
        };
        let first = rebound.first.map_or_else(|| "it never left bead 1".to_owned(), at);
        rows.push(("striker when it first separates".into(), first));
        let end = rebound.end_s.zip(rebound.end_m_s);
        let end = end.map_or_else(|| "not followed to its end".to_owned(), at);
        rows.push(("striker at the end of the shot".into(), end));
    }
    if shot.flight.is_none() {
        let peaks = shot.sensor_maxima.iter().take(5);
        rows.extend(peaks.map(|peak| ("peak of the sensor bead".into(), at(brief, peak))));
    }
    rows
}

/// Why there is no reflected time of flight.
fn no_return(brief: Style, shot: &Shot) -> String {
    let searched_s = (shot.passage.as_ref()).map_or(0.0, |seen| seen.search_ends_s);
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
    let rows: Rows =
        bodies.map(|(body, v)| (format!("body {body}"), brief.quantity(*v, "m/s"))).collect();
    format!("\n{}\n{}", heading("Velocities at the end"), pairs(&rows))
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

/// The wall contact at the pulse's peak, and when its balls yield.
fn contact(style: Style, plan: &Plan, shot: &Shot) -> Option<(String, String)> {
    let found = HertzContact::of_wall(style.units, plan, shot)?;
    let brief = Style::brief(style.units);
    let text = format!(
        "radius {}, largest pressure {}: balls of a yield strength below {} yield",
        brief.quantity(found.radius_m, "m"),
        brief.quantity(found.pressure_pa, "Pa"),
        brief.quantity(found.yield_strength_pa, "Pa"),
    );
    Some(("wall contact at its peak".to_owned(), text))
}

fn energy(style: Style, budget: &Budget) -> Rows {
    let brief = Style::brief(style.units);
    let mut rows = Rows::new();
    let mut line = |name: &str, value: f64| {
        if value != 0.0 {
            rows.push((name.to_owned(), brief.quantity(value, "J")));
        }
    };
    line("at the start", budget.start_j);
    line("put in by the driven end", budget.driven_j);
    line("kinetic", budget.kinetic_j);
    line("elastic", budget.elastic_j);
    for lost in &budget.dissipated {
        line(&format!("dissipated by {}", lost.law), lost.energy_j);
    }
    line("clipped", budget.clipped_j);
    line("gravity", budget.gravity_j);
    line("preload", budget.preload_j);
    line("stop", budget.stop_j);
    let residual = format!("{} of the input", digits(budget.relative_residual(), 2));
    rows.push(("residual".to_owned(), residual));
    rows
}

fn computation(style: Style, shot: &Shot) -> Rows {
    let brief = Style::brief(style.units);
    let mut rows = vec![
        ("duration".to_owned(), brief.quantity(shot.duration_s, "s")),
        ("solver".to_owned(), shot.solver.clone()),
        ("accuracy asked".to_owned(), digits(shot.accuracy_asked, 2)),
    ];
    if let Some(reached) = shot.accuracy_reached {
        rows.push(("accuracy reached".to_owned(), digits(reached, 2)));
    }
    if let Some(tolerance) = shot.tolerance {
        rows.push(("tolerance per step".to_owned(), digits(tolerance, 2)));
    }
    if let Some(step) = shot.step_s {
        rows.push(("step".to_owned(), brief.quantity(step, "s")));
    }
    let work = format!("{} in {} steps", shot.work.force_passes, shot.work.steps);
    rows.push(("force passes".to_owned(), work));
    rows
}

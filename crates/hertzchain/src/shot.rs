//! One shot: prepared from an experiment and options, computed, serialised.

use crate::contact::HertzContact;
use crate::failure::Failure;
use crate::options::ShotOptions;
use crate::{input, missing};
use hertzchain_chain::observe::{Competing, Maximum};
use hertzchain_chain::wave::Budget;
use hertzchain_experiment::{Experiment, Units, Warning};
use hertzchain_sim::{Plan, Shot, shoot_checked, shoot_estimated};
use serde::{Serialize, Serializer};
use serde_json::{Value, json};
use std::ops::Deref;

/// A shot that is ready to run.
///
/// ```
/// use hertzchain::prelude::*;
///
/// let row = preset("dry")?;
/// let options = ShotOptions::at(0.5);
/// let mut prepared = PreparedShot::new(&row, &options)?;
/// prepared.plan = prepared.plan.watching(row.sensors(), None); // sample the sensors
/// assert!(prepared.run()?.trace.is_some());
/// # Ok::<(), hertzchain::Failure>(())
/// ```
pub struct PreparedShot<'a> {
    experiment: &'a Experiment,
    options: &'a ShotOptions,
    speed_m_s: Option<f64>,
    /// The chain, what is watched, and how it is computed.
    pub plan: Plan,
    /// Warnings about the chain at this speed.
    pub warnings: Vec<Warning>,
}

impl<'a> PreparedShot<'a> {
    /// Prepares a shot of an experiment, with an energy budget.
    ///
    /// # Errors
    /// Options that the experiment does not take, and what the physics rejects.
    pub fn new(experiment: &'a Experiment, options: &'a ShotOptions) -> Result<Self, Failure> {
        let given = options.speed.as_ref();
        let speed_m_s = input::speed(given, experiment)?;
        input::check_times(&options.how, experiment)?;
        let planned = Plan::from_experiment(experiment, speed_m_s);
        let (mut plan, warnings) = input::at_speed(given, planned)?;
        input::adjust(&options.how, &mut plan);
        input::check_effort(&options.how, &plan, experiment.units())?;
        plan.budget = true;
        let speed_m_s = speed_m_s.or(experiment.speed_m_s());
        Ok(Self { experiment, options, speed_m_s, plan, warnings })
    }

    /// Computes the shot, and an estimate or a bound of its error.
    ///
    /// # Errors
    /// What prevents the integration, at its place in the experiment.
    pub fn run(self) -> Result<ShotResult, Failure> {
        let how = &self.options.how;
        let shot = match how.check {
            true => shoot_checked(&self.plan),
            false => shoot_estimated(&self.plan),
        };
        let shot = shot.map_err(|error| Failure::of_shot(self.experiment, how, error))?;
        Ok(ShotResult {
            experiment: self.experiment.name().to_owned(),
            speed_m_s: self.speed_m_s,
            units: self.experiment.units(),
            assumed_model: input::assumed(&self.options.input),
            plan: self.plan,
            warnings: self.warnings,
            shot,
        })
    }
}

/// The result of one shot; it dereferences to the numbers and serialises in SI.
///
/// ```
/// use hertzchain::prelude::*;
///
/// let shot = shot(&preset("dry")?, &ShotOptions::at(0.5))?;
/// let flight = shot.flight.expect("the pulse reaches the wall");
/// assert!(flight.reflected_s > Some(flight.incident_s));
/// let json = serde_json::to_value(&shot)?;
/// assert_eq!(json["tof_incident_s"], flight.incident_s);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct ShotResult {
    /// Name of the experiment.
    pub experiment: String,
    /// Speed of the striker in m/s.
    pub speed_m_s: Option<f64>,
    /// Units of the experiment.
    pub units: Units,
    /// The default experiment that was assumed, in words.
    pub assumed_model: Option<String>,
    /// What was computed.
    pub plan: Plan,
    /// Warnings about the chain at this speed.
    pub warnings: Vec<Warning>,
    /// Times of flight, peaks, rebound, energy.
    pub shot: Shot,
}

impl Deref for ShotResult {
    type Target = Shot;

    fn deref(&self) -> &Shot {
        &self.shot
    }
}

/// Computes one shot of an experiment.
///
/// ```
/// use hertzchain::prelude::*;
///
/// let shot = shot(&preset("hertz")?, &ShotOptions::at(1.0))?;
/// let incident_s = shot.flight.expect("the pulse reaches the wall").incident_s;
/// // The reference's value; the accuracy asked by default is 1e-6.
/// assert!((incident_s / 630.841591e-6 - 1.0).abs() < 1e-6);
/// # Ok::<(), hertzchain::Failure>(())
/// ```
///
/// # Errors
/// As [`PreparedShot::new`] and [`PreparedShot::run`].
pub fn shot(experiment: &Experiment, options: &ShotOptions) -> Result<ShotResult, Failure> {
    PreparedShot::new(experiment, options)?.run()
}

impl Serialize for ShotResult {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut all = json(&self.shot, self.units, &self.plan);
        all["experiment"] = self.experiment.as_str().into();
        all["speed_m_s"] = self.speed_m_s.into();
        if let Some(assumed) = &self.assumed_model {
            all["assumed_model"] = assumed.as_str().into();
        }
        all.serialize(serializer)
    }
}

/// One shot of a plan that differs from this one in speed at most.
pub(crate) fn json(shot: &Shot, units: Units, plan: &Plan) -> Value {
    json!({
        "tof_incident_s": shot.flight.map(|flight| flight.incident_s),
        "tof_reflected_s": shot.flight.and_then(|flight| flight.reflected_s),
        "accuracy_asked": shot.accuracy_asked,
        "accuracy_reached": shot.accuracy_reached,
        "passage": passage(shot, units, plan),
        "wall_contact": HertzContact::of_wall(units, plan, shot),
        "hardest_contact": HertzContact::hardest(units, plan, shot),
        "sensor_maxima": shot.sensor_maxima.iter().map(peak).collect::<Value>(),
        "pulse_speed_beads_per_s": shot.pulse_speed_beads_s,
        "striker_rebound": shot.rebound.map(|rebound| json!({
            "first_separation_time_s": rebound.first.map(|first| first.0),
            "first_separation_m_s": rebound.first.map(|first| first.1),
            "end_time_s": rebound.end_s,
            "end_m_s": rebound.end_m_s,
        })),
        "energy": shot.budget.as_ref().map(energy),
        "duration_s": shot.duration_s,
        "solver": shot.solver,
        "tolerance": shot.tolerance,
        "step_s": shot.step_s,
        "force_passes": shot.work.force_passes,
        "steps": shot.work.steps,
        "notes": shot.notes,
    })
}

/// A maximum of a signal.
fn peak(of: &Maximum) -> Value {
    json!({ "time_s": of.time_s, "value": of.value })
}

/// The three pulses, or why they are not seen.
fn passage(shot: &Shot, units: Units, plan: &Plan) -> Value {
    let seen = match &shot.passage {
        Ok(seen) => seen,
        Err(error) => {
            let missing = missing::reason(&plan.chain.far, units, error);
            return json!({ "missing": missing, "wall": shot.wall().as_ref().map(peak) });
        }
    };
    let competing = |other: &Competing| {
        let mut all = peak(&other.maximum);
        (all["pulse"], all["share"]) = (other.pulse.name().into(), other.share.into());
        all
    };
    json!({
        "incident": peak(&seen.incident),
        "wall": peak(&seen.wall),
        "reflected": seen.reflected.as_ref().map(peak),
        "search_ends_s": seen.search_ends_s,
        "competing": seen.competing.iter().map(competing).collect::<Value>(),
        "wall_maxima": seen.wall_maxima.iter().map(peak).collect::<Value>(),
        "incident_width_s": seen.incident_width_s,
        "wall_width_s": seen.wall_width_s,
        "reflected_width_s": seen.reflected_width_s,
    })
}

pub(crate) fn energy(budget: &Budget) -> Value {
    let lost = budget.dissipated.iter().map(|line| (line.law.to_owned(), line.energy_j.into()));
    json!({
        "time_s": budget.time_s,
        "start_j": budget.start_j,
        "driven_j": budget.driven_j,
        "kinetic_j": budget.kinetic_j,
        "elastic_j": budget.elastic_j,
        "dissipated_j": Value::Object(lost.collect()),
        "clipped_j": budget.clipped_j,
        "gravity_j": budget.gravity_j,
        "preload_j": budget.preload_j,
        "stop_j": budget.stop_j,
        "residual_j": budget.residual_j(),
        "relative_residual": budget.relative_residual(),
    })
}

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
            assumed_model: None,
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
        let view = ShotView {
            assumed_model: self.assumed_model.as_deref(),
            experiment: Some(&self.experiment),
            speed_m_s: self.speed_m_s,
            ..ShotView::new(&self.shot, self.units, &self.plan)
        };
        view.serialize(serializer)
    }
}

/// A shot as JSON, by the alphabet.
#[derive(Serialize)]
pub(crate) struct ShotView<'a> {
    accuracy_asked: f64,
    accuracy_reached: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    assumed_model: Option<&'a str>,
    duration_s: f64,
    pub(crate) energy: Option<Energy>,
    #[serde(skip_serializing_if = "Option::is_none")]
    experiment: Option<&'a str>,
    force_passes: u64,
    hardest_contact: Option<HertzContact>,
    notes: &'a [String],
    passage: PassageView,
    pulse_speed_beads_per_s: Option<f64>,
    sensor_maxima: Vec<Peak>,
    solver: &'a str,
    pub(crate) speed_m_s: Option<f64>,
    step_s: Option<f64>,
    steps: u64,
    striker_rebound: Option<ReboundView>,
    tof_incident_s: Option<f64>,
    tof_reflected_s: Option<f64>,
    tolerance: Option<f64>,
    wall_contact: Option<HertzContact>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) warnings: Option<&'a [String]>,
}

impl<'a> ShotView<'a> {
    /// One shot of a plan that differs from this one in speed at most.
    pub(crate) fn new(shot: &'a Shot, units: Units, plan: &Plan) -> Self {
        Self {
            accuracy_asked: shot.accuracy_asked,
            accuracy_reached: shot.accuracy_reached,
            assumed_model: None,
            duration_s: shot.duration_s,
            energy: shot.budget.as_ref().map(|budget| Energy::Kept(energy(budget))),
            experiment: None,
            force_passes: shot.work.force_passes,
            hardest_contact: HertzContact::hardest(units, plan, shot),
            notes: &shot.notes,
            passage: PassageView::new(shot, units, plan),
            pulse_speed_beads_per_s: shot.pulse_speed_beads_s,
            sensor_maxima: shot.sensor_maxima.iter().map(Peak::of).collect(),
            solver: &shot.solver,
            speed_m_s: None,
            step_s: shot.step_s,
            steps: shot.work.steps,
            striker_rebound: shot.rebound.map(|rebound| ReboundView {
                end_m_s: rebound.end_m_s,
                end_time_s: rebound.end_s,
                first_separation_m_s: rebound.first.map(|first| first.1),
                first_separation_time_s: rebound.first.map(|first| first.0),
            }),
            tof_incident_s: shot.flight.map(|flight| flight.incident_s),
            tof_reflected_s: shot.flight.and_then(|flight| flight.reflected_s),
            tolerance: shot.tolerance,
            wall_contact: HertzContact::of_wall(units, plan, shot),
            warnings: None,
        }
    }
}

/// An energy budget, or why there is none.
#[derive(Serialize)]
#[serde(untagged)]
pub(crate) enum Energy {
    Kept(Value),
    Missing { missing: &'static str },
}

/// A maximum of a signal.
#[derive(Serialize)]
struct Peak {
    time_s: f64,
    value: f64,
}

impl Peak {
    fn of(maximum: &Maximum) -> Self {
        Self { time_s: maximum.time_s, value: maximum.value }
    }
}

#[derive(Serialize)]
struct CompetingView {
    pulse: &'static str,
    share: f64,
    #[serde(flatten)]
    maximum: Peak,
}

#[derive(Serialize)]
struct ReboundView {
    end_m_s: Option<f64>,
    end_time_s: Option<f64>,
    first_separation_m_s: Option<f64>,
    first_separation_time_s: Option<f64>,
}

/// The three pulses, or why they are not seen.
#[derive(Serialize)]
#[serde(untagged)]
enum PassageView {
    Missing {
        missing: String,
        wall: Option<Peak>,
    },
    Seen {
        competing: Vec<CompetingView>,
        incident: Peak,
        incident_width_s: Option<f64>,
        reflected: Option<Peak>,
        reflected_width_s: Option<f64>,
        search_ends_s: f64,
        wall: Peak,
        wall_maxima: Vec<Peak>,
        wall_width_s: Option<f64>,
    },
}

impl PassageView {
    fn new(shot: &Shot, units: Units, plan: &Plan) -> Self {
        let seen = match &shot.passage {
            Ok(seen) => seen,
            Err(error) => {
                let missing = missing::reason(&plan.chain.far, units, error);
                return Self::Missing { missing, wall: shot.wall().as_ref().map(Peak::of) };
            }
        };
        let competing = |other: &Competing| CompetingView {
            pulse: other.pulse.name(),
            share: other.share,
            maximum: Peak::of(&other.maximum),
        };
        Self::Seen {
            competing: seen.competing.iter().map(competing).collect(),
            incident: Peak::of(&seen.incident),
            incident_width_s: seen.incident_width_s,
            reflected: seen.reflected.as_ref().map(Peak::of),
            reflected_width_s: seen.reflected_width_s,
            search_ends_s: seen.search_ends_s,
            wall: Peak::of(&seen.wall),
            wall_maxima: seen.wall_maxima.iter().map(Peak::of).collect(),
            wall_width_s: seen.wall_width_s,
        }
    }
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

//! One shot: prepared from an experiment and options, computed, serialised.

use crate::contact::HertzContact;
use crate::failure::Failure;
use crate::options::ShotOptions;
use crate::{input, missing};
use hertzchain_chain::observe::{Competing, Maximum};
use hertzchain_chain::wave::Budget;
use hertzchain_experiment::{Experiment, Units, Warning};
use hertzchain_sim::{BatchShot, Plan, Rebound, Shot, shoot_checked, shoot_estimated};
use serde::{Serialize, Serializer};
use std::collections::BTreeMap;
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
        let view = ShotView {
            experiment: Some(&self.experiment),
            speed_m_s: self.speed_m_s,
            assumed_model: self.assumed_model.as_deref(),
            ..ShotView::of(&self.shot, self.units, &self.plan)
        };
        view.serialize(serializer)
    }
}

/// A maximum of a signal.
#[derive(Serialize)]
struct Peak {
    time_s: f64,
    value: f64,
}

impl From<&Maximum> for Peak {
    fn from(maximum: &Maximum) -> Self {
        Self { time_s: maximum.time_s, value: maximum.value }
    }
}

fn peaks<S: Serializer>(maxima: &&[Maximum], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(maxima.iter().map(Peak::from))
}

/// One shot as it is serialised.
#[derive(Serialize)]
pub(crate) struct ShotView<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    experiment: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    assumed_model: Option<&'a str>,
    speed_m_s: Option<f64>,
    tof_incident_s: Option<f64>,
    tof_reflected_s: Option<f64>,
    accuracy_asked: f64,
    accuracy_reached: Option<f64>,
    passage: PassageView<'a>,
    wall_contact: Option<HertzContact>,
    #[serde(serialize_with = "peaks")]
    sensor_maxima: &'a [Maximum],
    pulse_speed_beads_per_s: Option<f64>,
    striker_rebound: Option<ReboundView>,
    energy: Option<EnergyView>,
    duration_s: f64,
    solver: &'a str,
    tolerance: Option<f64>,
    step_s: Option<f64>,
    force_passes: u64,
    steps: u64,
    notes: &'a [String],
    #[serde(skip_serializing_if = "Option::is_none")]
    warnings: Option<&'a [String]>,
}

/// What stands in the place of the energy budget in a sweep.
const NO_BUDGET: &str =
    "a sweep asks for times of flight and keeps no energy budget; `hertzchain shot` does";

impl<'a> ShotView<'a> {
    /// A shot of a sweep.
    pub(crate) fn of_sweep(
        (point, shot): (&'a BatchShot, &'a Shot),
        units: Units,
        plan: &Plan,
    ) -> Self {
        let view = Self::of(shot, units, plan);
        Self {
            speed_m_s: Some(point.speed_m_s),
            warnings: Some(&point.warnings),
            energy: view.energy.or(Some(EnergyView::Missing { missing: NO_BUDGET })),
            ..view
        }
    }

    /// One shot of a plan that differs from this one in speed at most.
    fn of(shot: &'a Shot, units: Units, plan: &Plan) -> Self {
        Self {
            experiment: None,
            assumed_model: None,
            speed_m_s: None,
            tof_incident_s: shot.flight.map(|flight| flight.incident_s),
            tof_reflected_s: shot.flight.and_then(|flight| flight.reflected_s),
            accuracy_asked: shot.accuracy_asked,
            accuracy_reached: shot.accuracy_reached,
            passage: PassageView::of(shot, units, plan),
            wall_contact: HertzContact::of_wall(units, plan, shot),
            sensor_maxima: &shot.sensor_maxima,
            pulse_speed_beads_per_s: shot.pulse_speed_beads_s,
            striker_rebound: shot.rebound.map(ReboundView::of),
            energy: shot.budget.as_ref().map(EnergyView::of),
            duration_s: shot.duration_s,
            solver: &shot.solver,
            tolerance: shot.tolerance,
            step_s: shot.step_s,
            force_passes: shot.work.force_passes,
            steps: shot.work.steps,
            notes: &shot.notes,
            warnings: None,
        }
    }
}

/// The striker afterwards.
#[derive(Serialize)]
struct ReboundView {
    first_separation_time_s: Option<f64>,
    first_separation_m_s: Option<f64>,
    end_time_s: Option<f64>,
    end_m_s: Option<f64>,
}

impl ReboundView {
    fn of(rebound: Rebound) -> Self {
        Self {
            first_separation_time_s: rebound.first.map(|first| first.0),
            first_separation_m_s: rebound.first.map(|first| first.1),
            end_time_s: rebound.end_s,
            end_m_s: rebound.end_m_s,
        }
    }
}

/// The three pulses, or why they are not seen.
#[derive(Serialize)]
#[serde(untagged)]
enum PassageView<'a> {
    Missing {
        missing: String,
        wall: Option<Peak>,
    },
    Seen {
        incident: Peak,
        wall: Peak,
        reflected: Option<Peak>,
        search_ends_s: f64,
        #[serde(serialize_with = "others")]
        competing: &'a [Competing],
        #[serde(serialize_with = "peaks")]
        wall_maxima: &'a [Maximum],
        incident_width_s: Option<f64>,
        wall_width_s: Option<f64>,
        reflected_width_s: Option<f64>,
    },
}

impl<'a> PassageView<'a> {
    fn of(shot: &'a Shot, units: Units, plan: &Plan) -> Self {
        match &shot.passage {
            Err(error) => Self::Missing {
                missing: missing::reason(&plan.chain.far, units, error),
                wall: shot.wall().as_ref().map(Peak::from),
            },
            Ok(seen) => Self::Seen {
                incident: Peak::from(&seen.incident),
                wall: Peak::from(&seen.wall),
                reflected: seen.reflected.as_ref().map(Peak::from),
                search_ends_s: seen.search_ends_s,
                competing: &seen.competing,
                wall_maxima: &seen.wall_maxima,
                incident_width_s: seen.incident_width_s,
                wall_width_s: seen.wall_width_s,
                reflected_width_s: seen.reflected_width_s,
            },
        }
    }
}

fn others<S: Serializer>(others: &&[Competing], serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct View {
        pulse: &'static str,
        time_s: f64,
        value: f64,
        share: f64,
    }
    serializer.collect_seq(others.iter().map(|other| View {
        pulse: other.pulse.name(),
        time_s: other.maximum.time_s,
        value: other.maximum.value,
        share: other.share,
    }))
}

/// The energy at the end, or why it is not known.
#[derive(Serialize)]
#[serde(untagged)]
enum EnergyView {
    Missing {
        missing: &'static str,
    },
    Budget {
        time_s: f64,
        start_j: f64,
        driven_j: f64,
        kinetic_j: f64,
        elastic_j: f64,
        dissipated_j: BTreeMap<&'static str, f64>,
        clipped_j: f64,
        gravity_j: f64,
        preload_j: f64,
        stop_j: f64,
        residual_j: f64,
        relative_residual: f64,
    },
}

impl EnergyView {
    fn of(budget: &Budget) -> Self {
        let lines = budget.dissipated.iter();
        Self::Budget {
            time_s: budget.time_s,
            start_j: budget.start_j,
            driven_j: budget.driven_j,
            kinetic_j: budget.kinetic_j,
            elastic_j: budget.elastic_j,
            dissipated_j: lines.map(|line| (line.law, line.energy_j)).collect(),
            clipped_j: budget.clipped_j,
            gravity_j: budget.gravity_j,
            preload_j: budget.preload_j,
            stop_j: budget.stop_j,
            residual_j: budget.residual_j(),
            relative_residual: budget.relative_residual(),
        }
    }
}

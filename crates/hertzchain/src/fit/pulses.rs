//! Whole pulses of recordings to parameters.

use super::{Curves, Inferred, best_fit, fit_settings, inferred, joined, more, unasked};
use crate::csv::{self, columns, view};
use crate::failure::Failure;
use crate::inference::{self, check_cancelled, user};
use crate::measure::{files, list};
use crate::options::{Filter, FitOptions as Arguments};
use hertzchain_experiment::{Amplifier as Numbers, Experiment};
use hertzchain_infer::{Covariance, Goodness, Model, Problem, PulseProblem, Pulses};
use hertzchain_measure::ShotList;
use hertzchain_measure::records::{ReadOptions, Record, read};
use hertzchain_measure::signal::Estimate;
use hertzchain_sim::rig::Amplifier;
use serde_json::{Value, json};

/// A fit of recordings.
pub struct Pulsed {
    /// What was fitted.
    pub problem: PulseProblem,
    /// What came of it.
    pub inferred: Inferred,
    /// What was left out, and why.
    pub refused: Vec<String>,
}

/// The model of recordings, and those of them that can be fitted.
pub struct Recorded {
    model: Model,
    records: Vec<Pulses>,
    refused: Vec<String>,
}

/// Reads recordings, and the model they are to be held against.
///
/// # Errors
/// Mistakes in the model or in what is free; files that are not there.
pub fn recorded(arguments: &Arguments) -> Result<Recorded, Failure> {
    let case = arguments.measured.case.as_deref();
    let experiment = inference::experiment(&arguments.modelled, case)?;
    recorded_of(&experiment, arguments)
}

/// The same where the model's experiment is at hand, in its case and with what is set.
///
/// # Errors
/// As [`recorded`].
pub fn recorded_of(experiment: &Experiment, arguments: &Arguments) -> Result<Recorded, Failure> {
    super::validation::of_recordings(arguments)?;
    let experiment = &with_filter(experiment, arguments)?;
    let model = inference::model(experiment, &arguments.modelled, &arguments.freed)?;
    let (records, refused) = records(experiment, arguments)?;
    Ok(Recorded { model, records: spread(records, arguments.recorded.most_shots.0), refused })
}

/// The experiment with the low-pass that options say.
fn with_filter(experiment: &Experiment, arguments: &Arguments) -> Result<Experiment, Failure> {
    let recorded = &arguments.recorded;
    let name = |value: Option<Filter>| value.map(Filter::names);
    let (order, kind) = name(recorded.filter).unzip();
    let changed =
        experiment.with_low_pass(recorded.low_pass.map(|corner| corner.0), order, kind.flatten());
    changed.map_err(user)
}

/// Refused records that are reported one by one.
pub(crate) const REPORTED: usize = 5;

/// An error, and what was refused before it.
fn none_left(error: &dyn std::fmt::Display, refused: &[String]) -> Failure {
    let lines: Vec<String> = refused.iter().take(REPORTED).map(|r| format!("\n  {r}")).collect();
    Failure::User(format!(
        "{error}{}\n(A table of curves, which is no record, begins with a line that names its columns, speed_m_s among them.)",
        lines.concat()
    ))
}

/// Every record that can be fitted, and why others can't.
fn records(
    experiment: &Experiment,
    arguments: &Arguments,
) -> Result<(Vec<Pulses>, Vec<String>), Failure> {
    let recorded = &arguments.recorded;
    let reported = recorded.shots.as_deref().map(list).transpose()?;
    let reading = ReadOptions {
        rate_hz: recorded.rate.map(|rate| rate.0),
        channels: recorded.channel.clone(),
        ..ReadOptions::default()
    };
    let (mut good, mut refused) = (Vec::new(), Vec::new());
    for file in files(&arguments.data, recorded.shots.as_deref())?.0 {
        for record in read(&file, &reading) {
            check_cancelled()?;
            let record = match record {
                Ok(record) => record,
                Err(error) => {
                    refused.push(error.to_string());
                    continue;
                }
            };
            let asked = arguments.measured.case.as_deref();
            let listed = reported.as_ref().and_then(|list| list.case(&record.file, record.shot));
            let own = listed.or(record.case.as_deref());
            if asked.is_some_and(|case| own.is_some_and(|own| own != case)) {
                continue;
            }
            let speed = speed(&record, reported.as_ref(), experiment, arguments);
            let volts: Vec<Vec<f64>> = record.channels.into_iter().map(|c| c.volts).collect();
            let speeds = (speed, record.programmed_speed_m_s);
            match Pulses::of(&record.source, speeds, record.interval_s, &volts) {
                Ok(pulses) => good.push(pulses),
                Err(error) => refused.push(error.to_string()),
            }
        }
    }
    Ok((good, refused))
}

/// The speed of a record's striker: as the table of shots says, or the record;
/// its error as either says, or the command line, or the model's photogate.
fn speed(
    record: &Record,
    reported: Option<&ShotList>,
    experiment: &Experiment,
    arguments: &Arguments,
) -> Option<Estimate> {
    let listed = reported.and_then(|list| list.speed(&record.file, record.shot));
    // A record without a speed of its own must not end the look at the table.
    let recorded = || Some((record.speed_m_s?, record.speed_error_m_s));
    let (value, error) = listed.or_else(recorded)?;
    let usual = experiment.campaign().photogate.error_m_s;
    Some(Estimate {
        value,
        sigma: error.or(arguments.measured.speed_error.map(|error| error.0)).unwrap_or(usual),
    })
}

/// At most so many, spread evenly.
fn spread(records: Vec<Pulses>, most: usize) -> Vec<Pulses> {
    let count = records.len();
    let kept = |at: &usize| at * most / count.max(1) != (at + 1) * most / count.max(1);
    let all = records.into_iter().enumerate();
    all.filter(|(at, _)| count <= most || kept(at)).map(|(_, r)| r).collect()
}

/// What an amplifier's filters make of a signal.
fn filtered(numbers: &Numbers, signal: &[f64], interval_s: f64) -> Vec<f64> {
    let plain =
        Numbers { sensitivity_c_n: 1.0, wall_sensitivity_c_n: 1.0, gain_v_c: 1.0, ..*numbers };
    let force_n = |at: usize| [signal.get(at).copied().unwrap_or_default(), 0.0];
    Amplifier::new(&plain, interval_s).follow(signal.len(), force_n)
}

/// Fits whole pulses and determines the uncertainty as the method asks.
///
/// # Errors
/// What is in the way of a fit; where no record is left, why.
pub fn fit_result(recorded: Recorded, arguments: &Arguments) -> Result<Pulsed, Failure> {
    let mut refused = recorded.refused;
    let problem = PulseProblem::new(recorded.model, recorded.records, filtered);
    let problem = problem.map_err(|error| none_left(&error, &refused))?;
    refused.extend(problem.left_out.iter().cloned());
    let problem = inference::pulses(problem, &arguments.freed)?;
    let nuisances = problem.nuisance_count();
    let finer = |problem: PulseProblem| {
        let accuracy = 0.1 * problem.model.accuracy;
        problem.with_accuracy(accuracy)
    };
    let (problem, fit) = best_fit(problem, nuisances, &fit_settings(arguments), finer)?;
    let covariance = Covariance::new(problem.parameters(), &fit);
    let how = Curves::Computed(None);
    let more = more::more_of(&problem, &problem, (&fit, &covariance), how, arguments)?;
    let goodness = Goodness::with_nuisances(problem.nuisance_count(), &problem, &fit);
    let label = |at: usize| problem.residual_label(at);
    let found = Inferred::new(&problem, (fit, covariance, more), goodness, label)?;
    Ok(Pulsed { problem, inferred: found, refused })
}

impl Pulsed {
    /// What was done beyond what was asked for, so that the fit found the minimum, one sentence
    /// each.
    pub(crate) fn unasked(&self, arguments: &Arguments) -> Vec<String> {
        let accuracy = (arguments.modelled.accuracy.0, self.problem.model.accuracy);
        unasked(&self.inferred.fit, accuracy, arguments.starts.0)
    }

    /// The amplifier's filters that the model's signals have passed, in words.
    pub(crate) fn filters(&self) -> String {
        let model = &self.problem.model;
        let mut amplifier = model.experiment.campaign().amplifier;
        let mut numbers = model.numbers.iter();
        let free = numbers.find(|number| number.path() == Some(LOW_PASS));
        let parameters = self.inferred.parameters.iter();
        let mut corner = parameters.zip(&self.inferred.fit.point);
        let corner = free.and_then(|free| corner.find(|(p, _)| p.name == free.name()));
        if let Some((_, corner_hz)) = corner {
            amplifier.low_pass_hz = *corner_hz;
        }
        amplifier.filters()
    }
}

/// The corner of the amplifier's low-pass, where it may be free.
const LOW_PASS: &str = "campaign.amplifier.low_pass";

/// Everything, to be read by programs and to be repeated.
pub fn json(pulsed: &Pulsed, arguments: &Arguments) -> Value {
    let records = pulsed.problem.records.iter();
    let own = json!({
        "model": pulsed.problem.model.experiment.name(),
        "kept": inference::unit_changes(&pulsed.problem.model, &arguments.modelled.set),
        "held_loads": inference::held_loads(&pulsed.problem.model),
        "references": inference::references_json(&pulsed.problem.model),
        "warnings": inference::warnings_json([&pulsed.problem.model.experiment]),
        "filters": pulsed.filters(),
        "unasked": pulsed.unasked(arguments),
        "residuals": pulsed.problem.residual_count(),
        "fitted_to_single_records": pulsed.problem.nuisance_count(),
        "records": records.map(|record| json!({
            "source": record.source,
            "speed_m_s": record.speed_m_s.value,
            "speed_error_m_s": record.speed_m_s.sigma,
            "samples_in_a_mean": record.width,
            "error_of_means_v": record.sigma_v,
        })).collect::<Value>(),
        "left_out": pulsed.refused,
    });
    joined(own, inferred(&pulsed.inferred, arguments))
}

/// A record's channel as it was measured and as the fit has it.
pub struct Shown<'a> {
    /// The record.
    pub record: &'a Pulses,
    /// The channel's number from 0.
    pub channel: usize,
    /// Times in s, measured and fitted voltages.
    pub columns: [Vec<f64>; 3],
}

/// All records at the best fit.
///
/// # Errors
/// What is in the way of a shot.
pub fn shown(pulsed: &Pulsed) -> Result<Vec<Shown<'_>>, Failure> {
    let records = pulsed.problem.records.iter().enumerate();
    let all = records.flat_map(|(at, record)| {
        (0..record.means_v.len()).map(move |channel| {
            let point = &pulsed.inferred.fit.point;
            let columns = pulsed.problem.picture(point, at, channel).map_err(user)?;
            Ok(Shown { record, channel, columns })
        })
    });
    all.collect()
}

pub(crate) fn pulses_csv(shown: &[Shown<'_>]) -> String {
    let titles = "source,channel,time_s,measured_V=measured_v,error_V=error_v,fitted_V=fitted_v";
    view(csv::list(&rows_json(shown)), &columns(titles))
}

/// Every mean of samples beside the fitted one.
pub fn rows_json(shown: &[Shown<'_>]) -> Value {
    let rows = shown.iter().flat_map(|shown| {
        let [times, measured, fitted] = &shown.columns;
        let means = times.iter().zip(measured).zip(fitted);
        means.map(|((time_s, measured_v), fitted_v)| {
            json!({
                "source": shown.record.source,
                "channel": shown.channel + 1,
                "time_s": time_s,
                "measured_v": measured_v,
                "error_v": shown.record.sigma_v[shown.channel],
                "fitted_v": fitted_v,
            })
        })
    });
    rows.collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]
#[path = "tests/pulses.rs"]
mod tests;

//! The whole of a reproduction, from shots to verdicts.

use super::cases::{CASES, Cases, SPEEDS_M_S, failed};
use super::films::{Film, SignalShot, films, signals};
use super::gather::{Effort, Gathering, gather};
use super::provenance::machine;
use super::tables::{oils_csv, power_law_residuals_csv, power_laws_csv, ratios_csv, tof_csv};
use super::{Provenance, ReproduceError, ReproduceProgress};
use crate::claims::{
    EvaluatedClaim, Evidence, MEANING, claims, claims_json, claims_markdown, evaluate_all,
};
use crate::readings::{
    DryPoisson, ReadingScan, rounded_evidence, scan, scan_csv, scan_markdown, two_digits_markdown,
};
use hertzchain_experiment::Reading;
use hertzchain_sim::commit;
use hertzchain_sim::{Plan, shoot};
use serde_json::json;
use std::time::Instant;

/// What to compute, and how well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReproduceOptions {
    /// Relative accuracy asked of the ToFs in the tables.
    pub accuracy: f64,
    /// Seed of the draws within rounding.
    pub seed: u64,
    /// Draws of the printed constants within their rounding.
    pub draws: usize,
    /// Most readings that are tried; 0 leaves the scan out.
    pub readings: usize,
}

impl Default for ReproduceOptions {
    fn default() -> Self {
        Self { accuracy: 1e-8, seed: 1, draws: 64, readings: 0 }
    }
}

impl ReproduceOptions {
    /// With the scan over readings, and draws enough to see rare flips.
    pub fn with_readings(self) -> Self {
        Self { draws: 200, readings: usize::MAX, ..self }
    }
}

/// Accuracy of shots that decide claims in other readings.
const SCAN_ACCURACY: f64 = 1e-6;

/// Everything that was computed.
#[derive(Clone, Debug)]
pub struct Reproduction {
    /// What the paper leaves open, as read here.
    pub reading: Reading,
    pub(crate) cases: Cases,
    /// Times of flight, peaks and the rest.
    pub evidence: Evidence,
    /// The claims with their verdicts.
    pub evaluated: Vec<EvaluatedClaim>,
    /// The same with [`DryPoisson::TwoDigits`], if readings were asked for.
    pub(crate) two_digits: Option<Vec<EvaluatedClaim>>,
    pub(crate) signals: Vec<SignalShot>,
    /// One dry and one wet shot bead by bead.
    pub(crate) films: Vec<Film>,
    /// Which claims hold in which reading, if that was asked for.
    pub scan: Option<ReadingScan>,
    /// Where the numbers come from.
    pub provenance: Provenance,
}

/// Computes everything in the paper, for the default reading.
///
/// # Errors
/// The first shot that can't be computed.
pub fn reproduce(
    options: &ReproduceOptions,
    progress: &dyn ReproduceProgress,
) -> Result<Reproduction, ReproduceError> {
    let start = Instant::now();
    let reading = Reading::default();
    let cases = Cases::new(&reading)?;
    let done = || progress.advance();
    progress.begin("times of flight", (CASES.len() * SPEEDS_M_S.len()) as u64);
    let how = Gathering {
        cases: &cases,
        speeds_m_s: &SPEEDS_M_S,
        accuracy: options.accuracy,
        effort: Effort::Checked,
    };
    let evidence = gather(&how, None, &done)?;
    progress.begin("signals and films", 2);
    let signals = signals(&cases, options.accuracy)?;
    progress.advance();
    let films = films(&cases)?;
    progress.advance();
    let (one_digit, two_digits) = (DryPoisson::OneDigit, DryPoisson::TwoDigits);
    let verdicts = evaluated(options, (&reading, one_digit), &evidence, progress)?;
    let (two_digits, scan) = match options.readings {
        0 => (None, None),
        most => {
            let two_digits = evaluated(options, (&reading, two_digits), &evidence, progress)?;
            let mut scan = scan(most, &SPEEDS_M_S, SCAN_ACCURACY, progress)?;
            scan.flipped_by_rounding = flipped(&verdicts);
            let closest = scan.closest().reading;
            let cases = &Cases::new(&closest)?;
            let how = Gathering { cases, accuracy: SCAN_ACCURACY, ..how };
            let evidence = gather(&how, None, &|| {})?;
            let rounded = evaluated(options, (&closest, one_digit), &evidence, progress)?;
            scan.flipped_in_closest = flipped(&rounded);
            (Some(two_digits), Some(scan))
        }
    };
    Ok(Reproduction {
        provenance: provenance(options, &cases, &evidence, start)?,
        reading,
        cases,
        evidence,
        evaluated: verdicts,
        two_digits,
        signals,
        films,
        scan,
    })
}

/// The claims, decided on the tables and under rounding, in a reading.
fn evaluated(
    options: &ReproduceOptions,
    (reading, dry_poisson): (&Reading, DryPoisson),
    evidence: &Evidence,
    progress: &dyn ReproduceProgress,
) -> Result<Vec<EvaluatedClaim>, ReproduceError> {
    let evaluators = claims()?;
    progress.begin("rounding of the printed constants", options.draws as u64);
    let done = || progress.advance();
    let draws = (options.seed, options.draws);
    let draws = rounded_evidence(&evaluators, reading, draws, dry_poisson, &done)?;
    Ok(evaluate_all(&evaluators, evidence, &draws))
}

fn flipped(evaluated: &[EvaluatedClaim]) -> Vec<usize> {
    let flipped = evaluated.iter().enumerate();
    let flipped = flipped.filter(|(_, evaluated)| evaluated.flips_by_rounding());
    flipped.map(|(claim, _)| claim).collect()
}

fn provenance(
    options: &ReproduceOptions,
    cases: &Cases,
    evidence: &Evidence,
    start: Instant,
) -> Result<Provenance, ReproduceError> {
    let hertz = cases.get("hertz")?;
    let (plan, _warnings) = Plan::from_experiment(hertz, None)?;
    let shot = shoot(&plan.with_accuracy(options.accuracy))
        .map_err(|error| failed("hertz", hertz.speed_m_s().unwrap_or(0.0), error))?;
    let points = evidence.curves.iter().flat_map(|curve| &curve.points);
    Ok(Provenance {
        version: env!("CARGO_PKG_VERSION"),
        commit: commit(),
        solver: shot.solver,
        tolerance: shot.tolerance.unwrap_or(f64::NAN),
        accuracy_asked: options.accuracy,
        accuracy_reached: points.map(|p| p.accuracy_reached).fold(0.0, f64::max),
        seed: options.seed,
        draws: options.draws,
        machine: machine(),
        wall_time_s: start.elapsed().as_secs_f64(),
    })
}

impl Reproduction {
    /// The tables and claims as files: name and content.
    ///
    /// # Errors
    /// An oil that can't be described.
    pub fn tables(&self) -> Result<Vec<(&'static str, String)>, ReproduceError> {
        let reading = stated(&self.reading);
        let mut files = vec![
            ("tof.csv", tof_csv(&self.evidence)),
            ("ratios.csv", ratios_csv(&self.evidence)),
            ("power_laws.csv", power_laws_csv(&self.evidence)),
            ("power_law_residuals.csv", power_law_residuals_csv(&self.evidence)),
            ("oils.csv", oils_csv(&self.cases)?),
            (
                "claims.json",
                json(&json!({
                    "reading": reading,
                    "meaning": MEANING,
                    "claims": claims_json(&self.evaluated),
                })),
            ),
            ("claims.md", claims_markdown(&self.evaluated, &head(&reading))),
        ];
        if let Some(scan) = &self.scan {
            files.push(("readings.csv", scan_csv(scan)));
            let two_digits = self.two_digits.as_deref().unwrap_or_default();
            let page = scan_markdown(scan) + &two_digits_markdown(&self.evaluated, two_digits);
            files.push(("readings.md", page));
        }
        Ok(files)
    }

    /// The provenance as a file named [`PROVENANCE`](super::PROVENANCE), which lists itself and
    /// the files of those names.
    pub fn provenance_json(&self, files: &[&str]) -> String {
        json(&self.provenance.json(files))
    }
}

fn head(reading: &str) -> String {
    format!("# What the paper says, and what its model shows\n\nRead as: {reading}.\n\n{MEANING}")
}

fn json(value: &serde_json::Value) -> String {
    format!("{value:#}\n")
}

/// A reading with every switch spelled out.
fn stated(reading: &Reading) -> String {
    let switches = Reading::switches().iter();
    let options = switches.filter_map(|s| Some(format!("{} = {}", s.name, reading.get(s.name)?)));
    let options: Vec<String> = options.collect();
    format!("{reading} ({})", options.join(", "))
}

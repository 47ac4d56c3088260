//! Ours, theirs, ours, theirs: medians of both, errors of both.

use crate::case::{Case, speeds_m_s};
use crate::converged::{Converged, errors};
use crate::ours::{Setting, ours, tune};
use crate::python::Worker;
use crate::scan::{Point, count_for};
use crate::tool::{Timed, Tool, measured};

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Question {
    /// Laws.
    pub case: Case,
    /// Largest allowed relative error of both ToFs.
    pub accuracy: f64,
    /// How often each tool runs.
    pub rounds: usize,
    /// Seconds of shots per run.
    pub seconds: f64,
    /// Fewest shots of a tool that makes more than 500 a second.
    pub fewest_fast: usize,
    /// Shots over which our setting is chosen.
    pub tuned_on: usize,
}

/// One tool's answer.
#[derive(Clone, Debug)]
pub struct Answer {
    /// Method chosen.
    pub method: &'static str,
    /// Setting chosen; 0 for ours, which is asked for an accuracy.
    pub setting: f64,
    /// Largest errors of the incident and the reflected ToF.
    pub errors: (f64, f64),
    /// Shots in the ensemble.
    pub shots: usize,
    /// Median.
    pub shots_per_s: f64,
}

/// What came out of a contest.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Ours.
    pub of_us: Answer,
    /// The peer's.
    pub of_them: Answer,
    /// Our speed over theirs.
    pub ratio: Ratio,
}

/// Our speed over a peer's, from rounds each of which runs both.
#[derive(Clone, Copy, Debug)]
pub struct Ratio {
    /// Median over the rounds.
    pub median: f64,
    /// Least and most of any round.
    pub range: [f64; 2],
    /// Of both medians of shots per second.
    pub of_medians: f64,
}

impl Ratio {
    /// Ours over ours.
    pub const ONE: Self = Self {
        median: 1.0,
        range: [1.0; 2],
        of_medians: 1.0,
    };
}

impl Question {
    fn count(&self, shots_per_s: f64, fewest: usize) -> usize {
        let fewest = if shots_per_s > 500.0 {
            self.fewest_fast.max(fewest)
        } else {
            fewest
        };
        count_for(shots_per_s, self.seconds, fewest, 1000)
    }

    /// Our setting, chosen as every peer's is: the cheapest that meets the
    /// accuracy at every speed.
    pub fn our_setting(&self, converged: &Converged) -> Setting {
        let speeds = speeds_m_s(self.tuned_on);
        tune(self.case, self.accuracy, &speeds, converged)
    }

    /// Our shots: as many as fit into the time of a run.
    fn our_speeds(&self, setting: Setting) -> Vec<f64> {
        let few = speeds_m_s(20);
        let timed = measured(|| ours(self.case, &few, setting));
        speeds_m_s(self.count(few.len() as f64 / timed.seconds, 20))
    }

    /// Runs ours and one peer alternately. The first candidate that is
    /// accurate over the whole ensemble is taken.
    pub fn ask(
        &self,
        tool: &Tool,
        worker: &Worker,
        candidates: &[Point],
        converged: &Converged,
    ) -> Option<Outcome> {
        let (point, speeds) = self.choose(tool, worker, candidates, converged)?;
        let setting = self.our_setting(converged);
        let our_speeds = self.our_speeds(setting);
        let (mut our_runs, mut their_runs) = (Vec::new(), Vec::new());
        for _ in 0..self.rounds {
            let theirs = tool.run(worker, point.method, self.case, point.setting, &speeds);
            our_runs.push(self.run_as_long((&our_speeds, setting), theirs.seconds));
            their_runs.push(theirs);
        }
        let ratios = our_runs.iter().zip(&their_runs).map(|(ours, theirs)| {
            theirs.seconds / speeds.len() as f64 * our_speeds.len() as f64 / ours.seconds
        });
        let ratios: Vec<f64> = ratios.collect();
        let of_us = answer(("", 0.0), &our_runs, &converged.tofs_s(&our_speeds));
        let of_them = answer(
            (point.method, point.setting),
            &their_runs,
            &converged.tofs_s(&speeds),
        );
        let ratio = Ratio {
            range: [
                ratios.iter().copied().fold(f64::INFINITY, f64::min),
                ratios.iter().copied().fold(0.0, f64::max),
            ],
            of_medians: of_us.shots_per_s / of_them.shots_per_s,
            median: median(ratios),
        };
        Some(Outcome {
            of_us,
            of_them,
            ratio,
        })
    }

    /// Our shots again and again for about as long as a peer took, so that both
    /// see the same weather on the machine; seconds of one run.
    fn run_as_long(&self, (speeds_m_s, setting): (&[f64], Setting), seconds: f64) -> Timed {
        let run = || measured(|| ours(self.case, speeds_m_s, setting));
        let first = run();
        let more = (seconds / first.seconds).min(1000.0) as usize;
        let rest: f64 = (0..more).map(|_| run().seconds).sum();
        Timed {
            seconds: (first.seconds + rest) / (more + 1) as f64,
            ..first
        }
    }

    fn choose(
        &self,
        tool: &Tool,
        worker: &Worker,
        candidates: &[Point],
        converged: &Converged,
    ) -> Option<(Point, Vec<f64>)> {
        let mut last = None;
        for point in candidates {
            let speeds = speeds_m_s(self.count(point.shots_per_s, tool.fewest()));
            let timed = tool.run(worker, point.method, self.case, point.setting, &speeds);
            let (incident, reflected) = errors(&timed.tofs_s, &converged.tofs_s(&speeds));
            last = Some((*point, speeds));
            if incident <= self.accuracy && reflected <= self.accuracy {
                break;
            }
        }
        last
    }
}

fn answer(
    (method, setting): (&'static str, f64),
    runs: &[Timed],
    converged: &[(f64, f64)],
) -> Answer {
    let median = median(runs.iter().map(|run| run.seconds).collect());
    Answer {
        method,
        setting,
        errors: runs
            .first()
            .map_or((f64::NAN, f64::NAN), |run| errors(&run.tofs_s, converged)),
        shots: converged.len(),
        shots_per_s: converged.len() as f64 / median,
    }
}

/// The middle one of some numbers.
pub fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    let middle = numbers.get(numbers.len() / 2);
    middle.copied().unwrap_or(f64::NAN)
}

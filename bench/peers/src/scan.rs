//! Every peer's settings tried from coarse to fine, for each case.

use crate::case::{Case, speeds_m_s};
use crate::converged::{Converged, errors};
use crate::python::Worker;
use crate::tool::Tool;

/// One setting of one method and what it gives.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// Method.
    pub method: &'static str,
    /// Tolerance or step.
    pub setting: f64,
    /// Largest relative ToF error.
    pub error: f64,
    /// Speed.
    pub shots_per_s: f64,
}

/// Finer settings than needed for this are not tried.
const FINEST: f64 = 5e-8;

/// How long one setting is tried, in s, and when a setting costs too much to
/// go on with finer ones.
#[derive(Clone, Copy, Debug)]
pub struct Patience {
    /// Seconds of shots per setting.
    pub seconds: f64,
    /// Seconds for the fewest shots.
    pub most_s: f64,
}

/// All settings of a tool for a case, from coarse to fine.
pub fn scan(
    tool: &Tool,
    worker: &Worker,
    case: Case,
    converged: &Converged,
    patience: Patience,
) -> Vec<Point> {
    let mut points = Vec::new();
    for method in tool.methods {
        let (mut setting, ratio, count) = tool.ladder;
        let mut shots = tool.fewest();
        for _ in 0..count {
            let speeds = speeds_m_s(shots);
            let timed = tool.run(worker, method, case, setting, &speeds);
            let (incident, reflected) = errors(&timed.tofs_s, &converged.tofs_s(&speeds));
            let error = incident.max(reflected);
            let shots_per_s = speeds.len() as f64 / timed.seconds;
            if !incident.is_nan() && !reflected.is_nan() && shots_per_s.is_finite() {
                points.push(Point {
                    method,
                    setting,
                    error,
                    shots_per_s,
                });
                shots = count_for(shots_per_s, patience.seconds, tool.fewest(), 200);
            }
            if error < FINEST || timed.seconds > patience.most_s {
                break;
            }
            setting *= ratio;
        }
    }
    points
}

/// Sizes of ensembles: few, so that ensembles share speeds.
const SIZES: [usize; 8] = [1000, 500, 200, 100, 50, 20, 10, 4];

/// Shots that take about `seconds`.
pub fn count_for(shots_per_s: f64, seconds: f64, fewest: usize, most: usize) -> usize {
    let wanted = ((shots_per_s * seconds) as usize).clamp(fewest, most);
    SIZES
        .into_iter()
        .find(|size| *size <= wanted)
        .unwrap_or(fewest)
}

/// How finely a rung of the ladder is divided between the last setting that
/// missed an accuracy and the first that met it.
const PARTS: u8 = 8;

/// Met settings of which the rung before is divided.
const DIVIDED: usize = 2;

/// Settings worth a closer look for an accuracy, the cheapest first: those
/// that met it, each preceded by what is coarser by less than a rung. If none
/// met it, the most accurate one.
pub fn candidates(points: &[Point], accuracy: f64, ratio: f64) -> Vec<Point> {
    let mut met: Vec<Point> = points
        .iter()
        .copied()
        .filter(|p| p.error <= accuracy)
        .collect();
    met.sort_by(|a, b| b.shots_per_s.total_cmp(&a.shots_per_s));
    if met.is_empty() {
        let best = points
            .iter()
            .copied()
            .reduce(|a, b| if b.error < a.error { b } else { a });
        return best.into_iter().collect();
    }
    let rung = |p: Point, parts: u8| {
        (0..parts).rev().map(move |part| Point {
            setting: p.setting / ratio.powf(f64::from(part) / f64::from(parts)),
            ..p
        })
    };
    let met = met.into_iter().take(6).enumerate();
    met.flat_map(|(i, p)| rung(p, if i < DIVIDED { PARTS } else { 2 }))
        .collect()
}

//! Which calibration shots say how wrong a shot is: those most like it.

use crate::plan::Plan;
use crate::shot::Shot;
use hertzchain_chain::Start;

/// Shots that say how wrong one between them is: what a row does behind its pulse changes with
/// speed and losses.
const NEAREST: usize = 16;

/// Where shots of a family stand: by their speeds or, where other numbers differ too, by speed and
/// by what pulses lose on their way to the wall and back.
#[derive(Clone, Debug)]
pub(crate) struct Places {
    pub by_speed: bool,
    all: Vec<[f64; 3]>,
    /// Their ranges.
    scales: [f64; 3],
}

impl Places {
    /// Of calibration shots, in the order of their speeds.
    pub(crate) fn new(plans: &[&Plan], shots: &[Option<Shot>], by_speed: bool) -> Self {
        let shots = plans.iter().zip(shots);
        let all: Vec<[f64; 3]> =
            shots.map(|(plan, shot)| place(plan, shot.as_ref(), by_speed)).collect();
        let range = |axis: usize| {
            let values = || all.iter().map(|place| place[axis]).filter(|value| value.is_finite());
            values().fold(f64::MIN_POSITIVE, f64::max) - values().fold(f64::INFINITY, f64::min)
        };
        let scales = std::array::from_fn(|axis| range(axis).abs().max(f64::MIN_POSITIVE));
        Self { by_speed, all, scales }
    }

    /// Calibration shots most like one of them.
    pub(crate) fn near(&self, at: usize) -> Vec<usize> {
        let count = self.all.len();
        if self.by_speed {
            let first = at.saturating_sub(NEAREST / 2).min(count.saturating_sub(NEAREST));
            return (first..(first + NEAREST).min(count)).collect();
        }
        let mut near: Vec<usize> = (0..count).collect();
        let off: Vec<f64> = self.all.iter().map(|it| self.off(it, &self.all[at])).collect();
        near.sort_by(|&a, &b| off[a].total_cmp(&off[b]));
        near.truncate(NEAREST);
        near
    }

    /// A calibration shot and those of the next lower and higher speed.
    pub(crate) fn next_to(&self, at: usize) -> std::ops::Range<usize> {
        at.saturating_sub(1)..(at + 2).min(self.all.len())
    }

    /// The calibration shot most like a shot.
    pub(crate) fn closest(&self, plan: &Plan, shot: Option<&Shot>) -> Option<usize> {
        let own = place(plan, shot, self.by_speed);
        let (first, count) = match self.by_speed {
            true => (self.all.partition_point(|it| it[0] < own[0]).saturating_sub(1), 2),
            false => (0, self.all.len()),
        };
        let near = first..(first + count).min(self.all.len());
        let off = |at: &usize| self.off(&self.all[*at], &own);
        near.min_by(|a, b| off(a).total_cmp(&off(b)))
    }

    fn off(&self, one: &[f64; 3], other: &[f64; 3]) -> f64 {
        let axes = one.iter().zip(other).zip(&self.scales);
        axes.map(|((one, other), scale)| ((one - other) / scale).powi(2)).sum()
    }
}

/// The striker's speed in m/s, 0 without one.
pub(crate) fn speed_m_s(plan: &Plan) -> f64 {
    match plan.chain.start {
        Start::Striker { speed_m_s, .. } => speed_m_s,
        _ => 0.0,
    }
}

/// Not a number where a shot has no pulse, which is then like no other.
fn place(plan: &Plan, shot: Option<&Shot>, by_speed: bool) -> [f64; 3] {
    let speed_m_s = speed_m_s(plan);
    if by_speed {
        return [speed_m_s, 0.0, 0.0];
    }
    let passage = shot.and_then(|shot| shot.passage.as_ref().ok());
    let [there, back] = passage.map_or([f64::NAN; 2], |passage| {
        let reflected = passage.reflected.map_or(f64::NAN, |peak| peak.value);
        [passage.wall.value / passage.incident.value, reflected / passage.wall.value]
    });
    [speed_m_s.ln(), there.ln(), back.ln()]
}

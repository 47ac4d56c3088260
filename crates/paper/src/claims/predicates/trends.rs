//! Predicates on how the ratios of different liquids go together.

use super::{Worst, curves, missing};
use crate::claims::{Branch, Claim, Curve, Evidence, Finding, Ratio, Tally};

/// Two ratio curves at the speeds that both have, each speed with its weight.
struct Pair {
    one: Vec<Ratio>,
    other: Vec<Ratio>,
    weights: Vec<f64>,
}

impl Pair {
    /// Each speed weighs as much as the stretch of ln v around it, so that it
    /// does not matter where speeds lie close together; `None` with fewer than three.
    fn of(evidence: &Evidence, one: &str, other: &str) -> Option<Self> {
        let (a, b) = (evidence.ratios(one), evidence.ratios(other));
        let partner = |r: &Ratio| b.iter().find(|s| s.speed_m_s == r.speed_m_s).copied();
        let pairs = a.iter().filter_map(|r| Some((*r, partner(r)?)));
        let (one, other): (Vec<Ratio>, Vec<Ratio>) = pairs.unzip();
        let speeds: Vec<f64> = one.iter().map(|r| r.speed_m_s.ln()).collect();
        (one.len() > 2).then(|| Self {
            one,
            other,
            weights: weights(&speeds),
        })
    }

    /// Pearson's correlation of the ratios; not a number where one is constant.
    fn correlation(&self) -> f64 {
        let mean = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
            let terms = self.one.iter().zip(&self.other).zip(&self.weights);
            terms.map(|((a, b), w)| w * f(a.incident, b.incident)).sum()
        };
        let (mean_a, mean_b) = (mean(&|a, _| a), mean(&|_, b| b));
        let product = mean(&|a, b| (a - mean_a) * (b - mean_b));
        let squares = mean(&|a, _| (a - mean_a).powi(2)) * mean(&|_, b| (b - mean_b).powi(2));
        product / squares.sqrt()
    }

    /// Absolute accuracy of the correlation ρ: Σ |ρ(a₁, …, aᵢ + Δaᵢ, …) − ρ| over
    /// all ratios of both curves, each moved alone by its own accuracy. Errors
    /// that go together can't do more to first order.
    fn accuracy(&mut self) -> f64 {
        let exact = self.correlation();
        let mut sum = 0.0;
        for i in 0..self.one.len() {
            for curve in [Self::one, Self::other] {
                let Some(ratio) = curve(self).get(i).copied() else {
                    continue;
                };
                curve(self)[i].incident += ratio.accuracy_reached * ratio.incident;
                sum += (self.correlation() - exact).abs();
                curve(self)[i] = ratio;
            }
        }
        sum
    }

    fn one(&mut self) -> &mut Vec<Ratio> {
        &mut self.one
    }

    fn other(&mut self) -> &mut Vec<Ratio> {
        &mut self.other
    }
}

/// Correlation of two ratio curves over ln v and its absolute accuracy.
fn correlation(evidence: &Evidence, one: &str, other: &str) -> Option<(f64, f64)> {
    let mut pair = Pair::of(evidence, one, other)?;
    let value = pair.correlation();
    value.is_finite().then(|| (value, pair.accuracy()))
}

/// Weights of the trapezoidal rule over ascending abscissas, adding up to 1.
fn weights(at: &[f64]) -> Vec<f64> {
    let last = at.len().saturating_sub(1);
    let around = |i: usize| Some(at.get((i + 1).min(last))? - at.get(i.saturating_sub(1))?);
    let spans: Vec<f64> = (0..at.len()).filter_map(around).collect();
    let all: f64 = spans.iter().sum();
    spans.iter().map(|span| span / all).collect()
}

/// The two ratio curves correlate by more than the threshold.
pub(super) fn same_trends(claim: &Claim, evidence: &Evidence) -> Finding {
    let [one, other] = &claim.cases[..] else {
        return missing();
    };
    let Some((value, accuracy)) = correlation(evidence, one, other) else {
        return missing();
    };
    let mut tally = Tally::default();
    tally.margin(value - claim.threshold, accuracy);
    let mut worst = Worst::none();
    worst.see(0.0, value, accuracy, || format!("{one} with {other}"));
    worst.finding(tally)
}

/// The first case goes with the second more than with the third, although
/// its viscosity is nearer to the third's. The accuracies of the two
/// correlations add up.
pub(super) fn against_viscosity(claim: &Claim, evidence: &Evidence) -> Finding {
    let [one, similar, other] = &claim.cases[..] else {
        return missing();
    };
    let correlations = (
        correlation(evidence, one, similar),
        correlation(evidence, one, other),
    );
    let viscosity = |case: &str| Some(evidence.oil(case)?.dynamic_viscosity_pa_s().ln());
    let viscosities = (viscosity(one), viscosity(similar), viscosity(other));
    let ((Some(near), Some(far)), (Some(a), Some(b), Some(c))) = (correlations, viscosities) else {
        return missing();
    };
    let ((near, near_accuracy), (far, far_accuracy)) = (near, far);
    let (value, accuracy) = (near - far, near_accuracy + far_accuracy);
    let mut tally = Tally::default();
    // What the claim says of the viscosities comes first.
    match (a - b).abs() > (a - c).abs() {
        true => tally.margin(value - claim.threshold, accuracy),
        false => tally.answer(false),
    }
    let mut worst = Worst::none();
    worst.see(0.0, value, accuracy, || {
        format!("{one} with {similar} {near:.3}, with {other} {far:.3}")
    });
    worst.finding(tally)
}

/// At every speed the ratios are neither in the order of the viscosities nor
/// in the reverse one. A step between two ratios is as wrong as both.
pub(super) fn viscosity_does_not_order_ratios(claim: &Claim, evidence: &Evidence) -> Finding {
    let mut oils: Vec<(f64, Vec<_>)> = Vec::new();
    for case in &claim.cases {
        match evidence.oil(case) {
            Some(oil) => oils.push((oil.dynamic_viscosity_pa_s(), evidence.ratios(case))),
            None => return missing(),
        }
    }
    oils.sort_by(|a, b| a.0.total_cmp(&b.0));
    let speeds = oils
        .first()
        .map_or(Vec::new(), |(_, ratios)| ratios.clone());
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for (i, first) in speeds.iter().enumerate() {
        let row: Vec<&Ratio> = oils.iter().filter_map(|(_, r)| r.get(i)).collect();
        let steps: Vec<f64> = row
            .windows(2)
            .filter_map(|w| Some(w.last()?.incident - w.first()?.incident))
            .collect();
        let unsure = row.iter().map(|r| r.accuracy_reached * r.incident);
        // Out of order by as much as the smaller of the largest rise and fall.
        let rise = steps.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let fall = -steps.iter().copied().fold(f64::INFINITY, f64::min);
        let value = rise.min(fall);
        let accuracy = 2.0 * unsure.fold(0.0, f64::max);
        tally.margin(value - claim.threshold, accuracy);
        worst.see(value - claim.threshold, value, accuracy, || {
            format!("{} m/s", first.speed_m_s)
        });
    }
    worst.finding(tally)
}

/// At every speed the ratios of two cases differ by more than the threshold times
/// the standard error of their difference. The dry ToF cancels: the number is
/// |T₁ − T₂|/s with s² = s₁² + s₂², and Δ = (ΔT₁ + ΔT₂)/s + (|T₁ − T₂|/s) Δs/s.
pub(super) fn ratios_differ(claim: &Claim, evidence: &Evidence) -> Finding {
    let curves = curves(claim, evidence).unwrap_or_default();
    let [one, other] = curves[..] else {
        return missing();
    };
    let branch = Branch::Incident;
    let unsure = |curve: &Curve| {
        let slopes = curve.slope_accuracies(branch);
        slopes.into_iter().fold(0.0, f64::max)
    };
    let of_error = unsure(one).max(unsure(other));
    let errors = other.standard_errors_s(branch);
    let others: Vec<_> = other.points.iter().zip(errors).collect();
    let (mut tally, mut worst) = (Tally::default(), Worst::none());
    for (a, error) in one.points.iter().zip(one.standard_errors_s(branch)) {
        let partner = others.iter().find(|(b, _)| b.speed_m_s == a.speed_m_s);
        let Some((b, as_unsure)) = partner else {
            continue;
        };
        let error = error.hypot(*as_unsure);
        let value = (a.tof_s(branch) - b.tof_s(branch)).abs() / error;
        let of_tofs = a.tof_accuracy_s(branch) + b.tof_accuracy_s(branch);
        let accuracy = of_tofs / error + value * of_error;
        tally.margin(value - claim.threshold, accuracy);
        worst.see(value - claim.threshold, value, accuracy, || {
            format!("{} and {} at {} m/s", one.case, other.case, a.speed_m_s)
        });
    }
    worst.finding(tally)
}

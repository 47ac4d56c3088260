//! Predicates on power laws, and on how the ratios of different liquids go together.

use super::{branches, curves, missing};
use crate::claims::evidence::TofRatio;
use crate::claims::finding::{ClaimFinding, Comparisons};
use crate::claims::{Claim, Curve, Evidence, TofBranch};
use hertzchain_measure::signal::PowerLaw;

/// R² of the straight line in log–log is at least the threshold, for every
/// case and branch; in part if it is at least the weaker one.
pub(super) fn r_squared(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let finding = r_squared_above(claim.threshold, claim, evidence);
    let weaker = claim.partly.map(|least| r_squared_above(least, claim, evidence));
    finding.or_in_part(weaker.as_ref())
}

fn r_squared_above(least: f64, claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    each_fit(claim, evidence, &|curve, branch| {
        let fit = curve.power_law(branch).ok()?;
        let accuracy = r_squared_accuracy(curve, branch, &fit);
        Some((fit.r_squared, fit.r_squared - least, accuracy))
    })
}

/// Accuracy of R² = 1 − S/S₀, where S and S₀ are the sums of squares of N residuals
/// and of ln T about its mean: errors of at most a in ln T change √S and √S₀ by
/// at most a√N, so Δ = (2 √S a√N + a² N)/S₀ + (S/S₀) 2 a√N/√S₀.
fn r_squared_accuracy(curve: &Curve, branch: TofBranch, fit: &PowerLaw) -> f64 {
    let logs: Vec<f64> = curve.tofs_s(branch).iter().map(|tof| tof.ln()).collect();
    let mean = logs.iter().sum::<f64>() / logs.len() as f64;
    let all: f64 = logs.iter().map(|log| (log - mean).powi(2)).sum();
    let left: f64 = fit.residuals.iter().map(|r| r * r).sum();
    let off = accuracy(curve) * (logs.len() as f64).sqrt();
    (2.0 * left.sqrt() * off + off * off) / all + left / all * 2.0 * off / all.sqrt()
}

/// Accuracy of ToFs over the root mean square of a fit's residuals: by which
/// fraction, at most, they change the root of the residuals' sum of squares.
fn of_residual(curve: &Curve, fit: &PowerLaw) -> f64 {
    let sum: f64 = fit.residuals.iter().map(|r| r * r).sum();
    accuracy(curve) * (fit.residuals.len() as f64 / sum).sqrt()
}

/// The largest residual of the weighted fit, in standard errors of the
/// paper's points, is at most the threshold, for every case and branch. With
/// value r/s, a residual is as wrong as its ToF and the fit, 2 ΔT/T, and a
/// standard error as the slope that it comes from: Δ = 2 (ΔT/T)/s + (r/s) Δs/s.
pub(super) fn residuals(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    each_fit(claim, evidence, &|curve, branch| {
        let fit = curve.weighted_power_law(branch).ok()?;
        let errors = curve.standard_errors_s(branch);
        let tofs = curve.tofs_s(branch);
        let relative: Vec<f64> = errors.iter().zip(&tofs).map(|(error, tof)| error / tof).collect();
        let scaled = fit.residuals.iter().zip(&relative);
        let value = scaled.map(|(r, error)| (r.exp_m1() / error).abs()).fold(0.0, f64::max);
        let finest = relative.iter().copied().fold(f64::INFINITY, f64::min);
        let slopes = curve.slope_accuracies(branch).into_iter();
        let unsure = slopes.fold(0.0, f64::max);
        let accuracy = 2.0 * accuracy(curve) / finest + value * unsure;
        Some((value, claim.threshold - value, accuracy))
    })
}

fn accuracy(curve: &Curve) -> f64 {
    curve.points.iter().map(|p| p.accuracy_reached).fold(0.0, f64::max)
}

/// Evaluates a fit: the value, its margin and their accuracy.
type FitValue<'a> = &'a dyn Fn(&Curve, TofBranch) -> Option<(f64, f64, f64)>;

fn each_fit(claim: &Claim, evidence: &Evidence, measure: FitValue<'_>) -> ClaimFinding {
    let Some(curves) = curves(claim, evidence) else {
        return missing();
    };
    let mut comparisons = Comparisons::default();
    for curve in curves {
        for branch in branches(claim) {
            let Some((value, margin, accuracy)) = measure(curve, branch) else {
                return ClaimFinding::without_numbers("no power law can be fitted");
            };
            comparisons.add(margin, value, accuracy, || {
                format!("{} ToF of {}", branch.name(), curve.case)
            });
        }
    }
    comparisons.finding()
}

/// The exponents of two cases differ by more than the threshold times their
/// combined standard error, in every branch. With value d/s, the exponents are
/// as wrong as the ToFs, which lie between about ±1 in ln v, and the standard error
/// as the residuals that it comes from. The accuracy is the distance to the worst
/// of these towards the threshold: d/s − (d − Δd)/(s + Δs), or (d + Δd)/(s − Δs) − d/s.
pub(super) fn exponents_differ(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let curves = curves(claim, evidence).unwrap_or_default();
    let [one, other] = curves[..] else {
        return missing();
    };
    let mut comparisons = Comparisons::default();
    for branch in branches(claim) {
        let fits = (one.power_law(branch), other.power_law(branch));
        let (Ok(a), Ok(b)) = fits else {
            return ClaimFinding::without_numbers("no power law can be fitted");
        };
        let error = a.exponent_error.hypot(b.exponent_error);
        let difference = (b.exponent - a.exponent).abs();
        let value = difference / error;
        let of_exponents = accuracy(one) + accuracy(other);
        let of_error = |curve, fit: &PowerLaw| fit.exponent_error * of_residual(curve, fit);
        let of_error = of_error(one, &a).hypot(of_error(other, &b));
        let accuracy = match value > claim.threshold {
            true => value - (difference - of_exponents) / (error + of_error),
            false => (difference + of_exponents) / (error - of_error).max(0.0) - value,
        };
        comparisons.add(value - claim.threshold, value, accuracy, || {
            format!(
                "{}, {:.4} ± {:.4} against {:.4} ± {:.4}",
                branch.name(),
                a.exponent,
                a.exponent_error,
                b.exponent,
                b.exponent_error
            )
        });
    }
    comparisons.finding()
}

/// Two ratio curves at the speeds that both have, each speed with its weight.
struct RatioPair {
    ratios: [Vec<TofRatio>; 2],
    weights: Vec<f64>,
}

impl RatioPair {
    /// Each speed weighs as much as the stretch of ln v around it, so that it
    /// does not matter where speeds lie close together; `None` with fewer than three.
    fn of(evidence: &Evidence, one: &str, other: &str) -> Option<Self> {
        let (a, b) = (evidence.ratios(one), evidence.ratios(other));
        let partner = |r: &TofRatio| b.iter().find(|s| s.speed_m_s == r.speed_m_s).copied();
        let pairs = a.iter().filter_map(|r| Some((*r, partner(r)?)));
        let (one, other): (Vec<TofRatio>, Vec<TofRatio>) = pairs.unzip();
        let speeds: Vec<f64> = one.iter().map(|r| r.speed_m_s.ln()).collect();
        (one.len() > 2).then(|| Self { ratios: [one, other], weights: weights(&speeds) })
    }

    /// Pearson's correlation of the ratios; not a number where one is constant.
    fn correlation(&self) -> f64 {
        let mean = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
            let [one, other] = &self.ratios;
            let terms = one.iter().zip(other).zip(&self.weights);
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
        for i in 0..self.weights.len() {
            for of in [0, 1] {
                let ratio = self.ratios[of][i];
                self.ratios[of][i].incident += ratio.accuracy();
                sum += (self.correlation() - exact).abs();
                self.ratios[of][i] = ratio;
            }
        }
        sum
    }
}

/// Correlation of two ratio curves over ln v and its absolute accuracy.
fn correlation(evidence: &Evidence, one: &str, other: &str) -> Option<(f64, f64)> {
    let mut pair = RatioPair::of(evidence, one, other)?;
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
pub(super) fn same_trends(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let [one, other] = &claim.cases[..] else {
        return missing();
    };
    let Some((value, accuracy)) = correlation(evidence, one, other) else {
        return missing();
    };
    let mut comparisons = Comparisons::default();
    let margin = value - claim.threshold;
    comparisons.add(margin, value, accuracy, || format!("{one} with {other}"));
    comparisons.finding()
}

/// The first case goes with the second more than with the third, although its viscosity is nearer
/// to the third's. The accuracies of the two correlations add up.
pub(super) fn against_viscosity(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let [one, similar, other] = &claim.cases[..] else {
        return missing();
    };
    let correlations = (correlation(evidence, one, similar), correlation(evidence, one, other));
    let viscosity = |case: &str| Some(evidence.oil(case)?.dynamic_viscosity_pa_s().ln());
    let viscosities = (viscosity(one), viscosity(similar), viscosity(other));
    let ((Some(near), Some(far)), (Some(a), Some(b), Some(c))) = (correlations, viscosities) else {
        return missing();
    };
    let ((near, near_accuracy), (far, far_accuracy)) = (near, far);
    let (value, accuracy) = (near - far, near_accuracy + far_accuracy);
    // What the claim says of the viscosities comes first.
    let (margin, margin_accuracy) = match (a - b).abs() > (a - c).abs() {
        true => (value - claim.threshold, accuracy),
        false => (-1.0, 0.0),
    };
    let mut comparisons = Comparisons::default();
    comparisons.compare(margin, margin_accuracy, value, accuracy, || {
        format!("{one} with {similar} {near:.3}, with {other} {far:.3}")
    });
    comparisons.finding()
}

/// At every speed the ratios are neither in the order of the viscosities nor
/// in the reverse one. A step between two ratios is as wrong as both.
pub(super) fn viscosity_does_not_order_ratios(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let mut oils: Vec<(f64, Vec<_>)> = Vec::new();
    for case in &claim.cases {
        match evidence.oil(case) {
            Some(oil) => oils.push((oil.dynamic_viscosity_pa_s(), evidence.ratios(case))),
            None => return missing(),
        }
    }
    oils.sort_by(|a, b| a.0.total_cmp(&b.0));
    let speeds = oils.first().map_or(Vec::new(), |(_, ratios)| ratios.clone());
    let mut comparisons = Comparisons::default();
    for (i, first) in speeds.iter().enumerate() {
        let row: Vec<&TofRatio> = oils.iter().filter_map(|(_, r)| r.get(i)).collect();
        let steps: Vec<f64> =
            row.windows(2).filter_map(|w| Some(w.last()?.incident - w.first()?.incident)).collect();
        let unsure = row.iter().map(|r| r.accuracy());
        // Out of order by as much as the smaller of the largest rise and fall.
        let rise = steps.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let fall = -steps.iter().copied().fold(f64::INFINITY, f64::min);
        let value = rise.min(fall);
        let accuracy = 2.0 * unsure.fold(0.0, f64::max);
        comparisons
            .add(value - claim.threshold, value, accuracy, || format!("{} m/s", first.speed_m_s));
    }
    comparisons.finding()
}

/// At every speed the ratios of two cases differ by more than the threshold times
/// the standard error of their difference. The dry ToF cancels: the number is
/// |T₁ − T₂|/s with s² = s₁² + s₂², and Δ = (ΔT₁ + ΔT₂)/s + (|T₁ − T₂|/s) Δs/s.
pub(super) fn ratios_differ(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let curves = curves(claim, evidence).unwrap_or_default();
    let [one, other] = curves[..] else {
        return missing();
    };
    let branch = TofBranch::Incident;
    let unsure = |curve: &Curve| {
        let slopes = curve.slope_accuracies(branch);
        slopes.into_iter().fold(0.0, f64::max)
    };
    let of_error = unsure(one).max(unsure(other));
    let errors = other.standard_errors_s(branch);
    let others: Vec<_> = other.points.iter().zip(errors).collect();
    let mut comparisons = Comparisons::default();
    for (a, error) in one.points.iter().zip(one.standard_errors_s(branch)) {
        let partner = others.iter().find(|(b, _)| b.speed_m_s == a.speed_m_s);
        let Some((b, as_unsure)) = partner else {
            continue;
        };
        let error = error.hypot(*as_unsure);
        let value = (a.tof_s(branch) - b.tof_s(branch)).abs() / error;
        let of_tofs = a.tof_accuracy_s(branch) + b.tof_accuracy_s(branch);
        let accuracy = of_tofs / error + value * of_error;
        comparisons.add(value - claim.threshold, value, accuracy, || {
            format!("{} and {} at {} m/s", one.case, other.case, a.speed_m_s)
        });
    }
    comparisons.finding()
}

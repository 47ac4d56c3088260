//! Predicates: code that decides a claim on numbers, by name. Here those on single shots and on
//! printed constants.

mod curves;
mod ratios;

use super::claim::Predicate;
use super::evidence::SPEED_SCATTER_M_S;
use super::finding::{ClaimFinding, Comparisons};
use super::{Claim, Curve, Evidence, MeasuredKind, ShotPoint, TofBranch};

static PREDICATES: &[(&str, Predicate<Evidence>)] = &[
    ("pulses-separate", pulses_separate),
    ("return-takes-longer", return_takes_longer),
    ("return-is-split", return_is_split),
    (CLOSING, closing_gaps_shortens_return),
    ("return-scatters-more", return_scatters_more),
    ("gaps-open", gaps_open),
    ("tof-falls", tof_falls),
    ("peaks-rise", peaks_rise),
    ("power-law-r-squared", curves::r_squared),
    ("power-law-residuals", curves::residuals),
    ("exponents-differ", curves::exponents_differ),
    ("ratio-below", |claim, evidence| ratios::side(claim, evidence, -1.0)),
    ("ratio-above", |claim, evidence| ratios::side(claim, evidence, 1.0)),
    ("ratio-crosses-once", ratios::crosses_once_upward),
    ("ratio-crosses-at", ratios::crosses_at_speed),
    ("ratio-mainly-rises", |claim, evidence| ratios::mainly_rises(claim, evidence, |v| v)),
    ("ratio-mainly-rises-log", |claim, evidence| ratios::mainly_rises(claim, evidence, f64::ln)),
    ("ratio-ends-higher", ratios::ends_higher),
    ("ratio-has-dips", ratios::has_dips),
    ("oil-either-way", ratios::either_way),
    ("ratios-differ", curves::ratios_differ),
    ("trends-alike", curves::same_trends),
    ("trend-against-viscosity", curves::against_viscosity),
    ("viscosity-orders-ratios", curves::viscosity_does_not_order_ratios),
    ("attenuates-more", attenuates_more),
    ("dynamic-viscosity", dynamic_viscosity),
    ("viscosity-ratio", viscosity_ratio),
    ("viscosities-similar", viscosities_similar),
    ("relaxation-time", |claim, evidence| near(claim, evidence.viscosity_over_modulus_s)),
    ("relaxation-order", |claim, evidence| near(claim, evidence.viscosity_over_modulus_s.log10())),
    ("no-rebound", no_rebound),
    ("peaks-overlap-data", |claim, evidence| {
        overlap(claim, evidence, &[MeasuredKind::SensorOverWall])
    }),
    ("tofs-overlap-data", |claim, evidence| {
        overlap(claim, evidence, &TofBranch::BOTH.map(MeasuredKind::Tof))
    }),
    ("ratios-overlap-data", |claim, evidence| overlap(claim, evidence, &[MeasuredKind::Ratio])),
];

/// Predicates on what a shot leaves behind when the pulses have passed.
pub(super) static OF_THE_END: [&str; 2] = ["gaps-open", "no-rebound"];

/// The predicate on shots whose gaps close when the pulse meets the wall.
pub(super) const CLOSING: &str = "closing-gaps-shortens-return";

/// A predicate on single shots by its name.
pub(crate) fn find(name: &str) -> Option<Predicate<Evidence>> {
    let row = PREDICATES.iter().find(|(known, _)| *known == name);
    row.map(|(_, predicate)| *predicate)
}

fn curves<'a>(claim: &Claim, evidence: &'a Evidence) -> Option<Vec<&'a Curve>> {
    let curves = claim.cases.iter().map(|case| evidence.curve(case));
    let curves: Option<Vec<_>> = curves.collect();
    curves.filter(|curves| !curves.is_empty())
}

/// The answer when a case of the claim was not computed.
fn missing() -> ClaimFinding {
    ClaimFinding::without_numbers("a case that this claim is about was not computed")
}

/// The branches of a claim; both when it names none.
fn branches(claim: &Claim) -> Vec<TofBranch> {
    let named = |branch: &TofBranch| {
        claim.branches.is_empty() || claim.branches.iter().any(|name| name == branch.name())
    };
    TofBranch::BOTH.into_iter().filter(named).collect()
}

fn within<'a>(claim: &Claim, curve: &'a Curve) -> impl Iterator<Item = &'a ShotPoint> {
    let speeds = claim.from_m_s..=claim.to_m_s;
    curve.points.iter().filter(move |p| speeds.contains(&p.speed_m_s))
}

/// Compares every curve of a claim's cases.
fn each_curve(
    claim: &Claim,
    evidence: &Evidence,
    mut compare: impl FnMut(&mut Comparisons, &Curve),
) -> ClaimFinding {
    let Some(curves) = curves(claim, evidence) else {
        return missing();
    };
    let mut comparisons = Comparisons::default();
    curves.into_iter().for_each(|curve| compare(&mut comparisons, curve));
    comparisons.finding()
}

/// Compares every shot of a claim's cases at its speeds.
fn each_point(
    claim: &Claim,
    evidence: &Evidence,
    mut compare: impl FnMut(&mut Comparisons, &Curve, &ShotPoint),
) -> ClaimFinding {
    each_curve(claim, evidence, |comparisons, curve| {
        within(claim, curve).for_each(|p| compare(comparisons, curve, p));
    })
}

fn place(curve: &Curve, p: &ShotPoint) -> String {
    format!("{} at {} m/s", curve.case, p.speed_m_s)
}

/// Incident, wall and reflected pulse follow each other, apart in time: each ToF exceeds the
/// threshold times the mean full width at half maximum of its two pulses. A pulse out of order has
/// a negative ToF. Relative errors of the ToF and of the widths add up.
fn pulses_separate(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    each_point(claim, evidence, |comparisons, curve, p| {
        let [incident, wall, reflected] = p.widths_s;
        let ways = [(p.tof_incident_s, incident + wall), (p.tof_reflected_s, wall + reflected)];
        for (tof, widths) in ways {
            let value = tof / (0.5 * widths);
            let accuracy = value.abs() * (p.accuracy_reached + p.width_accuracy);
            comparisons.add(value - claim.threshold, value, accuracy, || place(curve, p));
        }
    })
}

/// Reflected over incident ToF exceeds the threshold at every speed.
fn return_takes_longer(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    each_point(claim, evidence, |comparisons, curve, p| {
        let value = p.tof_reflected_s / p.tof_incident_s;
        let accuracy = 2.0 * value * p.accuracy_reached;
        comparisons.add(value - claim.threshold, value, accuracy, || place(curve, p));
    })
}

/// A second reflected maximum of at least the threshold times the first; in
/// part above the weaker threshold. With r = p₂/p₁, Δr = Δp₂/p₁ + r Δp₁/p₁.
fn return_is_split(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let curves = curves(claim, evidence).unwrap_or_default();
    let Some(p) = curves.iter().flat_map(|curve| within(claim, curve)).next() else {
        return missing();
    };
    let value = p.second_returning_peak_n / p.returning_peak_n;
    let accuracy = p.second_peak_accuracy_n / p.returning_peak_n + value * p.peak_accuracy;
    let detail = format!(
        "reflected peaks of {:.3} N and {:.3} N at {} m/s",
        p.returning_peak_n, p.second_returning_peak_n, p.speed_m_s
    );
    let above =
        |threshold| ClaimFinding::of_one(value - threshold, value, accuracy, detail.clone());
    above(claim.threshold).or_in_part(claim.partly.map(above).as_ref())
}

/// Share of (reflected − incident ToF) that is gone when the gaps behind the pulse
/// close as it meets the wall, above the threshold at every speed; in part above
/// the weaker one. The share is 1 − c/e, with Δ = (Δc + |c/e| Δe)/e. Chains without losses are
/// loosened as well: the detail has their difference.
fn closing_gaps_shortens_return(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let mut most = f64::NEG_INFINITY;
    let mut above = |threshold: f64| {
        each_point(claim, evidence, |comparisons, curve, p| {
            let [open, closed] = p.excess_s;
            let value = 1.0 - closed / open;
            let accuracy = p.excess_accuracy_s * (1.0 + (closed / open).abs()) / open.abs();
            most = most.max(value);
            comparisons.add(value - threshold, value, accuracy, || {
                format!("{}, {}", place(curve, p), differences(p, evidence))
            });
        })
    };
    let full = above(claim.threshold);
    let weaker = above(claim.partly.unwrap_or(claim.threshold));
    let finding = full.or_in_part(Some(&weaker));
    ClaimFinding { detail: format!("{}; largest share {most:.4}", finding.detail), ..finding }
}

/// Reflected less incident ToF with gaps, with closed ones and without losses, in words.
fn differences(p: &ShotPoint, evidence: &Evidence) -> String {
    let lossless = evidence.curve("hertz").and_then(|c| c.at(p.speed_m_s));
    let lossless = lossless.map(|p| p.tof_reflected_s - p.tof_incident_s);
    let lossless = lossless.map_or(String::new(), |difference_s| {
        format!(", {:.2} µs without losses", 1e6 * difference_s)
    });
    let [open, closed] = p.excess_s.map(|difference_s| 1e6 * difference_s);
    format!("{open:.2} µs with gaps, {closed:.2} µs with closed ones{lossless}")
}

/// The scatter of the striker's speed makes the reflected ToF scatter more
/// than the incident one: ratio of the two |dT/dv| above the threshold.
fn return_scatters_more(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    each_curve(claim, evidence, |comparisons, curve| {
        let [incident, reflected] = TofBranch::BOTH.map(|branch| {
            let slopes = curve.slopes_s2_m(branch).into_iter();
            slopes.zip(curve.slope_accuracies(branch))
        });
        for (p, (incident, reflected)) in curve.points.iter().zip(incident.zip(reflected)) {
            let value = reflected.0 / incident.0;
            let accuracy = value.abs() * (incident.1 + reflected.1);
            comparisons.add(value - claim.threshold, value, accuracy, || {
                let us = reflected.0.abs() * SPEED_SCATTER_M_S * 1e6;
                format!("{}, reflected ToF ± {us:.2} µs", place(curve, p))
            });
        }
    })
}

/// The gaps between beads, less the overlaps, exceed the threshold when the
/// reflected pulse has passed, and stay below the most that the claim allows.
fn gaps_open(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let largest = claim.at_most.unwrap_or(f64::INFINITY);
    each_point(claim, evidence, |comparisons, curve, p| {
        let (value, accuracy) = (p.loosened_m, p.loosened_accuracy_m);
        for margin in [value - claim.threshold, largest - value] {
            comparisons.add(margin, value, accuracy, || place(curve, p));
        }
    })
}

/// The striker's velocity, at first separation and at the end, is above the threshold.
fn no_rebound(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    each_point(claim, evidence, |comparisons, curve, p| {
        let moments = [
            ("first separation", p.striker_separation_m_s),
            ("end of the shot", p.striker_rebound_m_s),
        ];
        for (moment, value) in moments.into_iter().filter(|(_, value)| !value.is_nan()) {
            let accuracy = p.striker_accuracy_m_s;
            comparisons.add(value - claim.threshold, value, accuracy, || {
                format!("{}, {moment}", place(curve, p))
            });
        }
    })
}

/// Wall over sensor peak and reflected over incident peak, each divided by
/// the same of the dry chain, lie below the threshold at every speed. Its accuracy
/// is that of the four peaks, whose relative errors add up.
fn attenuates_more(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let Some(dry) = evidence.curve("dry") else {
        return missing();
    };
    let left = |p: &ShotPoint| {
        let [wall, reflected] = [p.wall_peak_n, p.returning_peak_n];
        [("wall", wall / p.sensor_peak_n), ("return", reflected / p.sensor_peak_n)]
    };
    each_point(claim, evidence, |comparisons, curve, p| {
        let Some(d) = dry.at(p.speed_m_s) else {
            return;
        };
        for ((name, wet_left), (_, dry_left)) in left(p).into_iter().zip(left(d)) {
            let value = wet_left / dry_left;
            let accuracy = 2.0 * value * (p.peak_accuracy + d.peak_accuracy);
            comparisons.add(claim.threshold - value, value, accuracy, || {
                format!("{name} of {}", place(curve, p))
            });
        }
    })
}

/// Between neighbouring speeds every ToF falls by more than the threshold.
fn tof_falls(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let named = branches(claim);
    let all: [Quantity; 2] = [
        (TofBranch::Incident.name(), |p| (-p.tof_incident_s.ln(), p.accuracy_reached)),
        (TofBranch::Reflected.name(), |p| (-p.tof_reflected_s.ln(), p.accuracy_reached)),
    ];
    let all = all.into_iter().filter(|(name, _)| named.iter().any(|branch| branch.name() == *name));
    rises(claim, evidence, &all.collect::<Vec<_>>())
}

/// Between neighbouring speeds every peak rises by more than the threshold.
fn peaks_rise(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let peaks: [Quantity; 3] = [
        ("sensor peak", |p| (p.sensor_peak_n.ln(), p.peak_accuracy)),
        ("wall peak", |p| (p.wall_peak_n.ln(), p.peak_accuracy)),
        ("reflected peak", |p| (p.returning_peak_n.ln(), p.peak_accuracy)),
    ];
    rises(claim, evidence, &peaks)
}

/// A quantity's name, and its logarithm with its accuracy.
type Quantity = (&'static str, fn(&ShotPoint) -> (f64, f64));

/// Logarithms rise between neighbouring speeds; the value is the smallest d ln(quantity)/d
/// ln(speed), its accuracy that of both ends over the step in ln(speed).
fn rises(claim: &Claim, evidence: &Evidence, quantities: &[Quantity]) -> ClaimFinding {
    each_curve(claim, evidence, |comparisons, curve| {
        for (name, log) in quantities {
            for pair in curve.points.windows(2) {
                let (low, high) = (&pair[0], &pair[1]);
                let span = (high.speed_m_s / low.speed_m_s).ln();
                let ((from, from_off), (to, to_off)) = (log(low), log(high));
                let (value, accuracy) = ((to - from) / span, (from_off + to_off) / span);
                comparisons.add(value - claim.threshold, value, accuracy, || {
                    format!("{name} of {} above {} m/s", curve.case, low.speed_m_s)
                });
            }
        }
    })
}

/// Measured points lie within the threshold times their standard error of the model's; not decidable
/// without any. Their errors are in their standard errors: the accuracy is that of the model.
fn overlap(claim: &Claim, evidence: &Evidence, of: &[MeasuredKind]) -> ClaimFinding {
    let mut comparisons = Comparisons::default();
    for point in evidence.digitised.iter().filter(|p| of.contains(&p.what)) {
        let model = model(evidence, point.what, &point.case, point.speed_m_s);
        let Some((model, accuracy)) = model else {
            continue;
        };
        let value = (model - point.value).abs() / point.standard_error;
        let accuracy = accuracy / point.standard_error;
        comparisons.add(claim.threshold - value, value, accuracy, || {
            format!("{} at {} m/s", point.case, point.speed_m_s)
        });
    }
    match comparisons.is_empty() {
        true => {
            ClaimFinding::without_numbers("the paper prints no digitised point to compare with")
        }
        false => comparisons.finding(),
    }
}

/// The model's number for a measured point, with its absolute accuracy.
fn model(
    evidence: &Evidence,
    what: MeasuredKind,
    case: &str,
    speed_m_s: f64,
) -> Option<(f64, f64)> {
    let p = evidence.curve(case)?.at(speed_m_s)?;
    Some(match what {
        MeasuredKind::SensorOverWall => {
            let ratio = p.sensor_peak_n / p.wall_peak_n;
            (ratio, 2.0 * p.peak_accuracy * ratio)
        }
        MeasuredKind::Tof(branch) => (p.tof_s(branch), p.tof_accuracy_s(branch)),
        MeasuredKind::Ratio => {
            let dry = evidence.curve("dry")?.at(speed_m_s)?;
            let ratio = p.tof_incident_s / dry.tof_incident_s;
            (ratio, ratio * (p.accuracy_reached + dry.accuracy_reached))
        }
    })
}

/// Dynamic viscosity in Pa s of a claim's case, by its place.
fn viscosity_pa_s(claim: &Claim, evidence: &Evidence, at: usize) -> Option<f64> {
    let oil = evidence.oil(claim.cases.get(at)?)?;
    Some(oil.dynamic_viscosity_pa_s())
}

/// The first case's dynamic viscosity, in Pa s, lies near the printed one.
fn dynamic_viscosity(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let viscosity = viscosity_pa_s(claim, evidence, 0);
    viscosity.map_or_else(missing, |viscosity| near(claim, viscosity))
}

/// The first case's dynamic viscosity over the second's lies near the printed ratio.
fn viscosity_ratio(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let [a, b] = [0, 1].map(|at| viscosity_pa_s(claim, evidence, at));
    a.zip(b).map_or_else(missing, |(a, b)| near(claim, a / b))
}

/// The larger of two dynamic viscosities is less than the threshold times the smaller.
fn viscosities_similar(claim: &Claim, evidence: &Evidence) -> ClaimFinding {
    let [a, b] = [0, 1].map(|at| viscosity_pa_s(claim, evidence, at));
    a.zip(b).map_or_else(missing, |(a, b)| {
        let value = a.max(b) / a.min(b);
        of_constants(value, claim.threshold - value, None)
    })
}

/// A value lies within the threshold of the printed one.
fn near(claim: &Claim, value: f64) -> ClaimFinding {
    let expected = claim.expected.first().copied().unwrap_or(f64::NAN);
    let margin = claim.threshold - (value - expected).abs();
    of_constants(value, margin, Some(expected))
}

/// Of arithmetic on printed constants, as wrong as double precision rounds, n ε |x|.
fn of_constants(value: f64, margin: f64, expected: Option<f64>) -> ClaimFinding {
    /// Most operations behind a value.
    const OPERATIONS: f64 = 10.0;
    let accuracy = OPERATIONS * f64::EPSILON * value.abs();
    let detail = "from the printed constants alone".to_owned();
    ClaimFinding { expected, ..ClaimFinding::of_one(margin, value, accuracy, detail) }
}

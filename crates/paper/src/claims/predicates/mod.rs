//! Predicates: code that decides a claim on numbers, by name.

mod attenuation;
mod constants;
mod crossing;
mod data;
mod fits;
mod monotony;
mod passages;
mod ratios;
mod striker;
mod trends;

use super::claim::Predicate;
use super::{Branch, Claim, Curve, Evidence, Finding, Point, Verdict, Worst};

static PREDICATES: &[(&str, Predicate<Evidence>)] = &[
    ("pulses-separate", passages::pulses_separate),
    ("return-takes-longer", passages::return_takes_longer),
    ("return-is-split", passages::return_is_split),
    (CLOSING, passages::closing_gaps_shortens_return),
    ("return-scatters-more", passages::return_scatters_more),
    ("gaps-open", passages::gaps_open),
    ("tof-falls", monotony::tof_falls),
    ("peaks-rise", monotony::peaks_rise),
    ("power-law-r-squared", fits::r_squared),
    ("power-law-residuals", fits::residuals),
    ("exponents-differ", fits::exponents_differ),
    ("ratio-below", ratios::below),
    ("ratio-above", ratios::above),
    ("ratio-crosses-once", crossing::once_upward),
    ("ratio-crosses-at", crossing::at_speed),
    ("ratio-mainly-rises", ratios::mainly_rises),
    ("ratio-mainly-rises-log", ratios::mainly_rises_log),
    ("ratio-ends-higher", ratios::ends_higher),
    ("ratio-has-dips", ratios::has_dips),
    ("oil-either-way", ratios::either_way),
    ("ratios-differ", trends::ratios_differ),
    ("trends-alike", trends::same_trends),
    ("trend-against-viscosity", trends::against_viscosity),
    (
        "viscosity-orders-ratios",
        trends::viscosity_does_not_order_ratios,
    ),
    ("attenuates-more", attenuation::attenuates_more),
    ("dynamic-viscosity", constants::dynamic_viscosity),
    ("viscosity-ratio", constants::viscosity_ratio),
    ("viscosities-similar", constants::viscosities_similar),
    ("relaxation-time", constants::relaxation_time),
    ("relaxation-order", constants::relaxation_order),
    ("no-rebound", striker::no_rebound),
    ("peaks-overlap-data", data::peaks),
    ("tofs-overlap-data", data::tofs),
    ("ratios-overlap-data", data::ratios),
];

/// Predicates on what a shot leaves behind when the pulses have passed.
pub(super) static OF_THE_END: [&str; 2] = ["gaps-open", "no-rebound"];

/// The predicate on shots whose gaps close when the pulse meets the wall.
pub(super) const CLOSING: &str = "closing-gaps-shortens-return";

/// A predicate on single shots by its name.
#[must_use]
pub fn find(name: &str) -> Option<Predicate<Evidence>> {
    let row = PREDICATES.iter().find(|(known, _)| *known == name);
    row.map(|(_, predicate)| *predicate)
}

/// The curves of a claim's cases, if none is missing.
fn curves<'a>(claim: &Claim, evidence: &'a Evidence) -> Option<Vec<&'a Curve>> {
    let curves: Option<Vec<_>> = claim
        .cases
        .iter()
        .map(|case| evidence.curve(case))
        .collect();
    curves.filter(|curves| !curves.is_empty())
}

/// The answer when a case of the claim was not computed.
fn missing() -> Finding {
    Finding::without_numbers("a case that this claim is about was not computed")
}

/// A verdict at the threshold, or in part where only the weaker one is met.
fn or_in_part(verdict: Verdict, weaker: Option<Verdict>) -> Verdict {
    match (verdict, weaker) {
        (Verdict::Fails, Some(Verdict::Holds)) => Verdict::InPart,
        (Verdict::Fails, Some(Verdict::NotDecidable)) => Verdict::NotDecidable,
        (verdict, _) => verdict,
    }
}

/// The branches of a claim; both when it names none.
fn branches(claim: &Claim) -> Vec<Branch> {
    let named = |branch: &Branch| {
        claim.branches.is_empty() || claim.branches.iter().any(|name| name == branch.name())
    };
    Branch::BOTH.into_iter().filter(named).collect()
}

/// The shots of a curve at the speeds of a claim.
fn within<'a>(claim: &Claim, curve: &'a Curve) -> Vec<&'a Point> {
    let inside = |p: &&Point| (claim.from_m_s..=claim.to_m_s).contains(&p.speed_m_s);
    curve.points.iter().filter(inside).collect()
}

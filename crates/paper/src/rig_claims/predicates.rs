//! Predicates: code that decides a claim on what rigs have shown, by name.

use super::evidence::{
    Observed, RigEvidence, SpeedSeries, WithError, deviation, each, largest_m, mean_of,
    rebound_m_s, root_mean_square, spread_s, tof_s, typical,
};
use crate::claims::{Claim, ClaimFinding, Comparisons, Needs, Predicate, TofBranch};
use hertzchain_sim::rig::Shot;

static PREDICATES: &[(&str, Predicate<RigEvidence>)] = &[
    ("rebounds-differ", rebounds_differ),
    ("spread-beside-scatter", spread_and_scatter),
    ("taps-shrink-own", taps_shrink_own),
    ("taps-shrink-seen", taps_shrink_seen),
    ("return-longer", return_longer),
    ("return-spreads-own", return_spreads_own),
    ("return-spreads-seen", return_spreads_seen),
    ("gaps-left", gaps_left),
    ("gaps-closed", gaps_closed),
    ("rebound-below", rebound),
    ("rebound-above", rebound),
];

pub(super) fn find(name: &str) -> Option<Predicate<RigEvidence>> {
    let row = PREDICATES.iter().find(|(known, _)| *known == name);
    row.map(|(_, predicate)| *predicate)
}

/// A spread of rebounds that is no spread, in m/s.
const LEAST_M_S: f64 = 1e-9;

/// Strikers that all stay have a spread of 0: hence a root mean square.
fn rebounds_differ(claim: &Claim, evidence: &RigEvidence) -> ClaimFinding {
    let spread = |at: &SpeedSeries| deviation(&each(&at.loose, rebound_m_s));
    a_rig_each(claim, evidence, |observed| {
        let of_series: Vec<f64> = within(claim, observed).map(spread).collect();
        root_mean_square(&of_series, LEAST_M_S)
    })
}

fn spread_and_scatter(claim: &Claim, evidence: &RigEvidence) -> ClaimFinding {
    a_rig_each(claim, evidence, |observed| {
        let series = observed.with_scatter_s(TofBranch::Incident);
        let ratio = |(at, scatter_s): (&SpeedSeries, f64)| incident_s(&at.loose) / scatter_s;
        typical(series.map(ratio))
    })
}

fn taps_shrink_own(claim: &Claim, evidence: &RigEvidence) -> ClaimFinding {
    a_rig_each(claim, evidence, |observed| {
        let ratio = |at: &SpeedSeries| incident_s(&at.loose) / incident_s(&at.tapped);
        typical(within(claim, observed).map(ratio))
    })
}

fn taps_shrink_seen(claim: &Claim, evidence: &RigEvidence) -> ClaimFinding {
    a_rig_each(claim, evidence, |observed| {
        let series = observed.with_scatter_s(TofBranch::Incident);
        let ratio = |(at, scatter_s): (&SpeedSeries, f64)| {
            incident_s(&at.loose).hypot(scatter_s) / incident_s(&at.tapped).hypot(scatter_s)
        };
        typical(series.map(ratio))
    })
}

fn return_spreads_own(claim: &Claim, evidence: &RigEvidence) -> ClaimFinding {
    a_rig_each(claim, evidence, |observed| {
        let ratio =
            |at: &SpeedSeries| spread_s(&at.tapped, TofBranch::Reflected) / incident_s(&at.tapped);
        typical(within(claim, observed).map(ratio))
    })
}

fn return_spreads_seen(claim: &Claim, evidence: &RigEvidence) -> ClaimFinding {
    a_rig_each(claim, evidence, |observed| {
        let [incident, reflected] = TofBranch::BOTH.map(|branch| {
            let series = observed.with_scatter_s(branch);
            series.map(move |(at, scatter_s)| spread_s(&at.tapped, branch).hypot(scatter_s))
        });
        let ratios = reflected.zip(incident).map(|(r, i)| r / i);
        typical(ratios)
    })
}

fn incident_s(shots: &[Shot]) -> f64 {
    spread_s(shots, TofBranch::Incident)
}

fn return_longer(claim: &Claim, evidence: &RigEvidence) -> ClaimFinding {
    a_series_each(claim, evidence, |at| {
        let [incident, reflected] =
            TofBranch::BOTH.map(|branch| mean_of(&each(&at.tapped, |shot| tof_s(shot, branch))));
        let value = reflected.value / incident.value;
        let relative = incident.error / incident.value + reflected.error / reflected.value;
        WithError { value, error: value * relative }
    })
}

fn gaps_left(claim: &Claim, evidence: &RigEvidence) -> ClaimFinding {
    let gap_m = |shot: &Shot| largest_m(&shot.gaps_after_m);
    a_series_each(claim, evidence, |at| mean_of(&each(&at.tapped, gap_m)))
}

fn gaps_closed(claim: &Claim, evidence: &RigEvidence) -> ClaimFinding {
    let gap_m = |shot: &Shot| largest_m(&shot.gaps_before_m);
    a_series_each(claim, evidence, |at| mean_of(&each(&at.tapped, gap_m)))
}

fn rebound(claim: &Claim, evidence: &RigEvidence) -> ClaimFinding {
    // Not a negation: a striker that stays has 0, not −0.
    let away_m_s = |shot: &Shot| 0.0 - rebound_m_s(shot);
    a_series_each(claim, evidence, |at| mean_of(&each(&at.tapped, away_m_s)))
}

fn within<'a>(claim: &Claim, observed: &'a Observed) -> impl Iterator<Item = &'a SpeedSeries> {
    let speeds = claim.from_m_s..=claim.to_m_s;
    let series = observed.speeds.iter();
    series.filter(move |at| speeds.contains(&at.speed_m_s))
}

/// One comparison a rig, of the logarithm of what its series have together.
fn a_rig_each(
    claim: &Claim,
    evidence: &RigEvidence,
    log_of: impl Fn(&Observed) -> WithError,
) -> ClaimFinding {
    let mut comparisons = Comparisons::default();
    for observed in &evidence.rigs {
        let log = log_of(observed);
        let (margin, value) = (log.value - claim.threshold.ln(), log.value.exp());
        comparisons
            .compare(margin, log.error, value, value * log.error, || observed.rig.name.clone());
    }
    comparisons.finding()
}

fn a_series_each(
    claim: &Claim,
    evidence: &RigEvidence,
    of_series: impl Fn(&SpeedSeries) -> WithError,
) -> ClaimFinding {
    let most = claim.at_most.unwrap_or(f64::INFINITY);
    let side = match claim.needs {
        Needs::Below => -1.0,
        Needs::Above | Needs::Within => 1.0,
    };
    let mut comparisons = Comparisons::default();
    for observed in &evidence.rigs {
        for at in within(claim, observed) {
            let WithError { value, error } = of_series(at);
            let margin = (side * (value - claim.threshold)).min(most - value);
            comparisons.add(margin, value, error, || {
                format!("{}, {:.3} m/s", observed.rig.name, at.speed_m_s)
            });
        }
    }
    comparisons.finding()
}

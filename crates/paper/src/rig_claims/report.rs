//! Verdicts on the rig's claims as JSON, Markdown and CSV.

use super::claims;
use super::design::{FACTORS, RigDesign, TriedRig};
use super::evidence::{
    Observed, RigEvidence, SpeedSeries, deviation, each, largest_m, mean, rebound_m_s, tof_s,
};
use crate::claims::{
    ClaimError, EvaluatedClaim, TofBranch, claims_json, claims_markdown, computed_text,
    evaluate_all, table_head, table_row,
};
use hertzchain_sim::rig::Shot;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// What a claim that fails means, above the table of claims.
pub const MEANING: &str = "A claim that fails is a statement that virtual rigs do not show, whose friction, laying, \
    sizes and push are assumptions, as the paper prints none; this does not make it wrong of the paper's own rig.";

/// The claims, evaluated on all dry rigs of a design and on each rig alone.
#[derive(Clone, Debug)]
pub struct RigClaims {
    /// On all dry rigs together.
    pub evaluated: Vec<EvaluatedClaim>,
    pub(crate) rigs: Vec<(TriedRig, Vec<EvaluatedClaim>)>,
    /// How many dry rigs there are.
    pub dry_rigs: usize,
    /// What the rigs did, in words.
    about: String,
}

impl RigClaims {
    /// Evaluates all claims.
    ///
    /// # Errors
    /// When the claims' data file is damaged, which a test rules out.
    pub fn evaluate(design: &RigDesign, evidence: &RigEvidence) -> Result<Self, ClaimError> {
        let evaluators = claims()?;
        let alone = evidence.alone().flat_map(|alone| {
            let evaluated = evaluate_all(&evaluators, &alone, &[]);
            let rig = alone.rigs.into_iter().next();
            rig.map(|observed| (observed.rig, evaluated))
        });
        Ok(Self {
            evaluated: evaluate_all(&evaluators, evidence, &[]),
            rigs: alone.collect(),
            dry_rigs: evidence.rigs.len(),
            about: about(design, evidence),
        })
    }

    /// As a page for people.
    pub fn markdown(&self) -> String {
        let head = format!(
            "# What the paper says of its rig, and what virtual ones show\n\n{}\n\n{MEANING}",
            self.about
        );
        let mut page = claims_markdown(&self.evaluated, &head);
        page.push_str("\n## Rig by rig\n\n");
        let ids = self.evaluated.iter().map(|evaluated| evaluated.claim.id.as_str());
        page += &table_head(std::iter::once("rig").chain(ids));
        for (rig, evaluated) in &self.rigs {
            let cells = evaluated.iter().map(|j| format!("{}: {}", j.verdict, computed_text(j)));
            page += &table_row(std::iter::once(rig.name.clone()).chain(cells));
        }
        page
    }

    /// As JSON.
    pub fn json(&self) -> Value {
        let rigs = self.rigs.iter().map(|(rig, evaluated)| {
            let values = FACTORS.iter().zip(rig.values);
            let values: Map<String, Value> =
                values.map(|(factor, value)| (factor.path.to_owned(), json!(value))).collect();
            json!({ "rig": rig.name, "values_si": values, "claims": claims_json(evaluated) })
        });
        json!({
            "about": self.about,
            "meaning": MEANING,
            "claims": claims_json(&self.evaluated),
            "rigs": rigs.collect::<Vec<Value>>(),
        })
    }
}

fn about(design: &RigDesign, evidence: &RigEvidence) -> String {
    let speeds = evidence.rigs.first().map_or(&[][..], |rig| &rig.speeds);
    let end = |at: Option<&SpeedSeries>| at.map_or(f64::NAN, |at| at.speed_m_s);
    format!(
        "Computed on {} virtual rigs: {}, then others in what the paper does not state, friction with the track, push on \
         bead 1, gaps as the chain is laid and unlike radii, in this order where a name has all four. Chains are dry; {} more, as the preset with oil, are evaluated one by one and count in no verdict on all. On each, series at {} speeds from {:.3} to {:.3} m/s, once \
         without taps and once with {} taps before every shot; {} shots of a series count, after {} that do not. All \
         shots of a series have exactly the same speed, so that spreads are the chain's own; times of flight are \
         those of the true peaks, without noise.\n\n\
         Errors (±) are for 95 %. Spreads are standard deviations within a series; of a rig, the geometric mean of those \
         at all speeds that have pulses (of rebounds, which may all be 0, the root mean square), with an error by bootstrap: whole series are drawn with replacement, because shots of one \
         series hang together and series do not. Errors of means are 1.96 standard errors of the shots of a series. \
         A claim on spreads is one comparison a rig, any other one a series.",
        evidence.rigs.len(),
        evidence.rigs.first().map_or("", |rig| &rig.rig.name),
        evidence.wet.len(),
        speeds.len(),
        end(speeds.first()),
        end(speeds.last()),
        design.taps(),
        design.shots,
        design.first,
    )
}

const HEADER: &str = "rig,friction,push_n,gap_scatter_m,radius_spread,taps,speed_m_s,shots,incident_tof_s,\
    incident_spread_s,reflected_tof_s,reflected_spread_s,rebound_m_s,rebound_spread_m_s,\
    gaps_before_m,largest_gap_before_m,gaps_after_m,largest_gap_after_m";

/// Means and standard deviations of every series as CSV. Gaps are means of the sum and of the
/// largest. The standard error of a standard deviation s of n normal shots is s/√(2(n − 1)).
pub fn series_csv(evidence: &RigEvidence) -> String {
    let mut csv = format!("{HEADER}\n");
    for Observed { rig, speeds } in evidence.rigs.iter().chain(&evidence.wet) {
        for at in speeds {
            for (taps, shots) in [("without", &at.loose), ("with", &at.tapped)] {
                let values = rig.values.map(|value| value.to_string()).join(",");
                let numbers = numbers(shots).map(|n| match n.is_finite() {
                    true => format!("{n:.9e}"),
                    false => String::new(),
                });
                let _ = writeln!(
                    csv,
                    "\"{}\",{values},{taps},{},{},{}",
                    rig.name,
                    at.speed_m_s,
                    shots.len(),
                    numbers.join(",")
                );
            }
        }
    }
    csv
}

fn numbers(shots: &[Shot]) -> [f64; 10] {
    let of = |what: &dyn Fn(&Shot) -> f64| {
        let values = each(shots, what);
        (mean(&values), deviation(&values))
    };
    let [incident, reflected] = TofBranch::BOTH.map(|branch| of(&|shot| tof_s(shot, branch)));
    let rebound = of(&rebound_m_s);
    [
        incident.0,
        incident.1,
        reflected.0,
        reflected.1,
        rebound.0,
        rebound.1,
        of(&|shot| shot.gaps_before_m.iter().sum()).0,
        of(&|shot| largest_m(&shot.gaps_before_m)).0,
        of(&|shot| shot.gaps_after_m.iter().sum()).0,
        of(&|shot| largest_m(&shot.gaps_after_m)).0,
    ]
}

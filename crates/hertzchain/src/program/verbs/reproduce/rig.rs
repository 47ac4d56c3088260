//! `hertzchain reproduce --rig`: what the paper says of its rig.

use super::verdicts;
use crate::program::{Counter, Failure, Folder};
use hertzchain_experiment::preset;
use hertzchain_paper::figures::rig_figures;
use hertzchain_paper::rig_claims::{MEANING, RigClaims, RigDesign, observe, series_csv};

/// Runs the campaigns and writes verdicts, table and pictures; returns what was found, for people.
pub(super) fn run(into: &mut Folder, counter: &Counter) -> Result<String, Failure> {
    let ours = |error: &dyn std::error::Error| Failure::Ours(error.to_string());
    let paper = preset("paper").map_err(|error| ours(&error))?;
    let design = RigDesign::about(paper);
    let evidence = observe(&design, counter).map_err(|error| ours(&error))?;
    let claims = RigClaims::evaluate(&design, &evidence).map_err(|error| ours(&error))?;
    let json = format!("{:#}\n", claims.json());
    into.write("rig-claims.json", json.as_bytes())?;
    into.write("rig-claims.md", claims.markdown().as_bytes())?;
    into.write("rig-series.csv", series_csv(&evidence).as_bytes())?;
    for (name, figure) in rig_figures(&evidence, &claims) {
        into.figure(name, &figure)?;
    }
    Ok(format!(
        "\nOn {} dry virtual rigs. {MEANING}\n\n{}\nRig by rig: {}; pictures rig_verdicts, rig_spreads, rig_rebounds, rig_gaps\n",
        claims.dry_rigs,
        verdicts(&claims.evaluated),
        into.path().join("rig-claims.md").display(),
    ))
}

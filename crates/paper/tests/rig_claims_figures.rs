//! Figures of the claims about the rig.

use super::Silent;
use crate::figures::rig_figures;
use crate::rig_claims::{RigClaims, RigDesign, TriedRig, observe};
use hertzchain_experiment::Experiment;

/// Lines, ticks and markers: a path may have many.
fn marks(svg: &str) -> usize {
    let paths = svg.split("<path d=\"").skip(1);
    let path = |rest: &str| rest.split_once('"').unwrap().0.matches('M').count();
    paths.map(path).sum()
}

#[test]
fn a_small_design_has_all_its_pictures() {
    let text = include_str!("../../sim/tests/small.toml");
    let design = RigDesign {
        rigs: vec![TriedRig::usual(), TriedRig::but(0, 0.2), TriedRig::but(3, 2e-3)],
        speeds: 3,
        shots: 2,
        first: 1,
        ..RigDesign::about(Experiment::from_text("small.toml", text).unwrap())
    };
    let evidence = observe(&design, &Silent).unwrap();
    let claims = RigClaims::evaluate(&design, &evidence).unwrap();
    for (name, figure) in rig_figures(&evidence, &claims) {
        let svg = figure.svg();
        let marks = marks(&svg);
        assert!(marks > 20, "{name}: {marks}");
        if name == "rig_gaps" {
            assert!(svg.contains("friction 0.2, push 0.24 N"));
        }
    }
}

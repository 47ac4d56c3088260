//! `docs/how-to/add-a-contact-law.md`, compiled and run: every block of Rust on that
//! page is a piece of this folder, word for word, and the first test says so.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

#[path = "../common/mod.rs"]
mod common;
mod laws;

/// Stands where `crates/chain/src/material.rs` stands.
mod material {
    pub use hertzchain_chain::BeadPair;
}

use common::{close, row, shoot};
use hertzchain_chain::{BeadPair, Chain};
use laws::{Closed, Columns, ElasticCone, LAWS, Row, law};

#[test]
fn page_shows_nothing_but_code_that_runs_here() {
    let page = include_str!("../../../../docs/how-to/add-a-contact-law.md");
    let code = [
        include_str!("main.rs"),
        include_str!("laws/mod.rs"),
        include_str!("laws/elastic_cone.rs"),
    ];
    let blocks = page.split("```rust\n").skip(1);
    let blocks: Vec<&str> = blocks.map(|rest| rest.split("```").next().unwrap()).collect();
    assert!(blocks.len() >= 4, "the page has lost its code");
    for block in blocks {
        let runs = code.iter().any(|file| words(file).contains(&words(block)));
        assert!(runs, "this block of the page is not run:\n{block}");
    }
}

/// Indentation belongs to the place where a block stands.
fn words(code: &str) -> String {
    code.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn cone_pushes_with_the_slope_of_its_energy() {
    let steel = BeadPair {
        left: common::STEEL,
        right: common::STEEL,
        radius_m: 3.175e-3,
        mass_kg: 4.27e-3,
    };
    let cone = law(ElasticCone { slope: 0.02 });
    let k = Columns::from_rows(&[cone.coefficients(&steel).unwrap()]);
    let (overlap, step) = (2e-6, 2e-9);
    let energy = |overlap| cone.energy(&k, 0, overlap, overlap);
    let slope = (energy(overlap + step) - energy(overlap - step)) / (2.0 * step);
    // A central difference of δ³ at a step of 1e-3 δ is off by a third of its square.
    close(slope, cone.force(&k, 0, Closed::new(overlap, 0.0)), 4e-7);
}

fn find(name: &str) -> Option<&'static Row> {
    LAWS.iter().find(|row| row.info.name == name)
}

#[test]
fn a_user_gets_it_by_name_and_is_told_what_is_missing() {
    let cone = find("elastic_cone").unwrap();
    assert!(cone.build(&[("slope", 0.02)]).is_ok());
    let missing = cone.build(&[]).unwrap_err();
    assert_eq!(
        missing.to_string(),
        "law `elastic_cone`: needs `slope` (sum of the slopes s of both tips, in 1)"
    );
}

#[test]
fn wave_on_cones_runs_as_the_cube_root_of_the_speed() {
    let chain = |speed_m_s| row(40, speed_m_s, vec![law(ElasticCone { slope: 0.02 })]);
    let tof_s = |chain: &Chain| shoot(chain, 1e-9).0.tof_incident_s();
    // Eight times the speed, half the time: F ∝ δⁿ gives v^{−(n−1)/(n+1)}.
    // Each ToF is right to about twice the tolerance.
    close(tof_s(&chain(0.1)) / tof_s(&chain(0.8)), 2.0, 1e-8);
}

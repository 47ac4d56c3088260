//! The paper's figures from a whole, coarse reproduction.

use super::Silent;
use super::covered::covered;
use super::type_size::smallest_type;
use crate::claims::{Claim, ClaimVerdict, claims};
use crate::figures;
use crate::readings::{ReadingRow, ReadingScan};
use crate::reproduce::{PROVENANCE, ReproduceOptions, Reproduction, reproduce};
use hertzchain_experiment::Reading;
use hertzchain_figures::Figure;
use std::collections::BTreeSet;

const TABLES: [&str; 8] = [
    "claims.json",
    "claims.md",
    "oils.csv",
    "power_law_residuals.csv",
    "power_laws.csv",
    "provenance.json",
    "ratios.csv",
    "tof.csv",
];

const FIGURES: [&str; 6] = ["energy", "figure1", "figure2", "figure3", "figure4", "space_time"];

/// All figures, with a scan in which so many readings move some verdicts.
fn pictures(computed: &mut Reproduction, moving: usize) -> Vec<(&'static str, Figure)> {
    let claims: Vec<Claim> =
        claims().unwrap().into_iter().map(|evaluator| evaluator.claim).collect();
    let row = |reading: Reading, moved: usize| ReadingRow {
        reading,
        verdicts: (0..claims.len())
            .map(|claim| match moved > 0 && claim % (moved + 2) == 1 {
                true => ClaimVerdict::Fails,
                false => ClaimVerdict::Holds,
            })
            .collect(),
        values: vec![0.0; claims.len()],
    };
    let default = row(Reading::default(), 0);
    let switches = Reading::switches().iter();
    let changed = switches.flat_map(|switch| {
        let options = switch.options.iter().skip(1);
        options.map(|option| Reading::default().with(switch.name, option).unwrap())
    });
    let single = changed.enumerate();
    let single = single.map(|(i, reading)| row(reading, if i < moving { i + 1 } else { 0 }));
    computed.scan = Some(ReadingScan {
        single: single.collect(),
        default,
        claims,
        product_of: Vec::new(),
        left_out: Vec::new(),
        product: Vec::new(),
        search: Vec::new(),
        flipped_by_rounding: vec![0, 1],
        flipped_in_closest: Vec::new(),
    });
    figures::figures(computed).unwrap()
}

#[test]
fn a_reproduction_writes_all_its_tables_and_figures_and_is_legible_in_a_column() {
    let coarse = ReproduceOptions { accuracy: 1e-4, draws: 0, ..ReproduceOptions::default() };
    let mut computed = reproduce(&coarse, &Silent).unwrap();
    for (name, figure) in pictures(&mut computed, 3) {
        assert_eq!(covered(&figure.svg()).1, 0, "{name}: a legend hides data");
        let (smallest, width_mm) = smallest_type(&figure.svg());
        // Page sizes are written with two decimals.
        assert!(smallest > 6.0 - 5e-3, "{name}: type of {smallest} points");
        assert_eq!(width_mm, 85.0, "{name} is not as wide as a column");
        assert!(figure.caption_text().len() > 40, "{name} has no caption");
    }
    // A scan in which every switch moves something takes two columns at most.
    let (_, wide) = pictures(&mut computed, 100).pop().unwrap();
    let (smallest, width_mm) = smallest_type(&wide.svg());
    assert!(smallest > 6.0 - 5e-3 && width_mm == 175.0, "{width_mm} mm");
    assert!(wide.caption_text().contains("† Not decidable"));
    computed.scan = None;
    let tables = computed.tables().unwrap();
    let pictures = figures::figures(&computed).unwrap();
    let drawn: BTreeSet<&str> = pictures.iter().map(|(name, _)| *name).collect();
    assert_eq!(drawn, BTreeSet::from(FIGURES));
    let names: Vec<&str> = tables.iter().map(|(name, _)| *name).chain([PROVENANCE]).collect();
    assert_eq!(names.iter().copied().collect::<BTreeSet<_>>(), BTreeSet::from(TABLES));
    let provenance = computed.provenance_json(&names);
    for name in names {
        assert!(provenance.contains(&format!("\"{name}\"")), "{name}");
    }
    let captions = figures::captions(&pictures);
    assert!(drawn.iter().all(|name| captions.contains(&format!("## {name}\n"))));
    assert!(pictures[0].1.png(100.0).unwrap().starts_with(b"\x89PNG"));
}

//! Stands where `crates/chain/src/laws/mod.rs` stands for a law that lives there.

mod elastic_cone;

pub use elastic_cone::ElasticCone;
pub use hertzchain_chain::laws::*;

pub static LAWS: &[Row] = &[
    row::<ElasticHertz, 1>(),
    row::<ElasticPower, 2>(),
    // The row that the page adds.
    row::<ElasticCone, 1>(),
];

//! Contact laws: one small file each, one row each in [`LAWS`].
//!
//! To add a law: write a file with a struct of public fields that implements
//! [`Term`], and add its row to [`LAWS`]. Tests, the command line, the
//! experiment file and the documentation enumerate the registry; nothing else
//! changes. `docs/how-to/add-a-contact-law.md` walks through it.

mod capillary_bridge;
mod damping_brilliantov_1996;
mod damping_cubic;
mod damping_cubic_ungated;
mod damping_kuwabara_kono;
mod damping_linear;
mod damping_power;
mod damping_tsuji;
mod damping_viscoelastic;
mod elastic_hertz;
mod elastic_plastic_thornton;
mod elastic_power;
mod film_drained;
mod film_entrained;
mod term;

pub use self::{
    damping_brilliantov_1996::DampingBrilliantov1996,
    damping_cubic::DampingCubic,
    damping_cubic_ungated::DampingCubicUngated,
    damping_kuwabara_kono::DampingKuwabaraKono,
    damping_linear::DampingLinear,
    damping_power::DampingPower,
    damping_tsuji::DampingTsuji,
    damping_viscoelastic::DampingViscoelastic,
    elastic_hertz::ElasticHertz,
    elastic_plastic_thornton::ElasticPlasticThornton,
    elastic_power::ElasticPower,
    film_entrained::FilmEntrained,
    term::{
        Closed, Columns, ContactState, Contacts, Law, LawError, LawInfo, Nature, Parameter, Row,
        Source, Term, law, row,
    },
};

/// Every contact law, in the order in which the tools list them.
pub static LAWS: &[Row] = &[
    row::<ElasticHertz, 1>(),
    row::<ElasticPower, 2>(),
    row::<ElasticPlasticThornton, 5>(),
    row::<DampingViscoelastic, 1>(),
    row::<DampingCubic, 1>(),
    row::<DampingCubicUngated, 1>(),
    row::<DampingBrilliantov1996, 1>(),
    row::<DampingKuwabaraKono, 1>(),
    row::<DampingTsuji, 1>(),
    row::<DampingLinear, 1>(),
    row::<DampingPower, 3>(),
    row::<FilmEntrained, 5>(),
    row::<film_drained::FilmDrained, 4>(),
    row::<capillary_bridge::CapillaryBridge, 3>(),
];

/// The row of a law by its name.
pub fn find(name: &str) -> Option<&'static Row> {
    LAWS.iter().find(|row| row.info.name == name)
}

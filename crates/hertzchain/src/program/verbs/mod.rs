//! One file a verb.

pub(crate) mod campaign;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod design;
#[cfg(feature = "explore")]
pub(crate) mod explore;
pub(crate) mod fit;
pub(crate) mod gauge;
pub(crate) mod laws;
pub(crate) mod live;
pub(crate) mod man;
pub(crate) mod measure;
pub(crate) mod merge;
pub(crate) mod presets;
pub(crate) mod reproduce;
pub(crate) mod schema;
pub(crate) mod shot;
pub(crate) mod sweep;
pub(crate) mod theory;
pub(crate) mod version;

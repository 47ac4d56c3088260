//! One file a verb.

pub mod campaign;
pub mod check;
pub mod completions;
pub mod design;
pub mod fit;
pub mod gauge;
pub mod laws;
pub mod man;
pub mod measure;
pub mod merge;
pub mod presets;
pub mod reproduce;
pub mod schema;
pub mod shot;
pub mod sweep;
pub mod theory;
pub mod version;

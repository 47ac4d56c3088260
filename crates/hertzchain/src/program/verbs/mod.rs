//! One file a verb, but for the shortest.

pub(crate) mod about;
pub(crate) mod campaign;
pub(crate) mod design;
#[cfg(feature = "explore")]
pub(crate) mod explore;
pub(crate) mod fit;
pub(crate) mod gauge;
pub(crate) mod live;
pub(crate) mod measure;
pub(crate) mod merge;
pub(crate) mod reproduce;
pub(crate) mod shot;
pub(crate) mod sweep;

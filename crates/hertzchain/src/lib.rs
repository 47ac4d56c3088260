//! What the verbs do, for every front: options in words, results as plain data,
//! mistakes as reports. A front prints, draws and keeps files; nothing here
//! knows a terminal.

pub mod arguments;
pub mod bibliography;
pub mod csv;
pub mod design;
pub mod failure;
pub mod fit;
pub mod gauge;
pub mod given;
pub mod inference;
pub mod input;
pub mod json;
pub mod laws;
pub mod measure;
pub mod missing;
pub mod quantity;
pub mod table;

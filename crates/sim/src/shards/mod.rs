//! Sweeps in parts, for several machines.
//!
//! A [`Run`](hertzchain_sim::Run) is a sweep with everything that its numbers
//! follow from; each of its parts is a shard, whose name is a hash of these
//! inputs and whose bits depend on nothing else. [`run`] computes a shard into a
//! folder unless it is there and whole, [`gather`] puts the shards of some folders
//! together.
//!
//! ```
//! use hertzchain_sim::{Column, How, Run, Shard};
//!
//! let hertz = hertzchain_experiment::preset("hertz")?;
//! let sweep = Run::new(&hertz, vec![0.2, 0.4, 0.8], How::of(&hertz))?;
//! let folder = std::env::temp_dir().join(format!("hertzchain-shards-{}", std::process::id()));
//! for shard in Shard::all(2) {
//!     hertzchain_sim::shards::run(&sweep, shard, &folder, &|| {})?;
//! }
//! let whole = hertzchain_sim::shards::gather(&[&folder])?;
//! let alone = sweep.part(Shard::WHOLE, &|| {});
//! assert_eq!(whole.rows.column(Column::Incident), alone.rows.column(Column::Incident));
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod error;
mod file;
mod gather;
mod run;

pub use error::ShardsError;
pub use file::{read, write};
pub use gather::{ENDING, PREFIX, gather, is_shard};
pub use run::{Done, run};

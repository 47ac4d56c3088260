//! What of the recordings could not be measured.

use crate::records::RecordError;
use crate::signal::SignalError;
use std::path::PathBuf;

/// Why a record, or a whole recording, was not measured.
#[derive(Debug, thiserror::Error)]
pub enum Refused {
    /// It cannot be read.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// No shot in it.
    #[error(
        "{source_name}: never passes the level of {level_v} V; its samples lie between {low_v:.4} \
         and {high_v:.4} V"
    )]
    NeverPassed {
        /// Which recording.
        source_name: String,
        /// The level in V.
        level_v: f64,
        /// Its least sample in V.
        low_v: f64,
        /// Its largest sample in V.
        high_v: f64,
    },
    /// Speeds of which nobody can tell whose they are.
    #[error(
        "{}: tells {told} speeds, and {found} shot{} were found in it: none was given a speed; say \
         which is which with --shots, or cut it otherwise with --level or --shot-samples",
        .file.display(), if *.found == 1 { "" } else { "s" }
    )]
    Speeds {
        /// Which file.
        file: PathBuf,
        /// How many speeds it has.
        told: usize,
        /// How many shots were found.
        found: u64,
    },
    /// A level that is none.
    #[error("{source_name}: cannot be cut: {cause}")]
    Uncuttable {
        /// Which recording.
        source_name: String,
        /// Why.
        cause: SignalError,
    },
}

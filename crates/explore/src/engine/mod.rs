//! What the page asks for and what it gets: one function, requests and replies in JSON.

mod array;
mod batch;
mod edit;
mod effort;
mod outline;
mod refusal;
mod shot;
mod words;

pub use array::Array;
pub use batch::{BatchReply, PowerLawReply, Speeds};
pub use edit::{Edit, Step};
pub use refusal::{Mistake, Refusal};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use hertzchain_sim::Stop;
use serde::{Deserialize, Deserializer};
use serde_json::{Value, json};

/// What the page asks for.
#[derive(Debug, Deserialize)]
#[serde(tag = "verb", rename_all = "kebab-case")]
pub enum Request {
    /// The experiments that come with the program.
    Presets,
    /// All contact laws with equation, parameters, units and source.
    Laws,
    /// The JSON Schema of experiment files.
    Schema,
    /// An experiment, after edits: what is understood of it, or its mistakes.
    Check {
        /// Text of the experiment.
        text: String,
        /// Changes to make first.
        #[serde(default)]
        edits: Vec<Edit>,
    },
    /// One shot: times of flight, signals, motion, energy.
    Shot {
        /// Text of the experiment.
        text: String,
        /// Changes to make first.
        #[serde(default)]
        edits: Vec<Edit>,
        /// Samples of signals and motion; 0 for none.
        #[serde(default)]
        samples: usize,
        /// Without energy and an estimate of the error: while a slider moves.
        #[serde(default)]
        draft: bool,
    },
    /// Times of flight against speed.
    Batch {
        /// Text of the experiment.
        text: String,
        /// Speeds of the striker.
        speeds: Speeds,
        /// Number of a shard from 1, and how many there are, if not the whole is asked for.
        #[serde(default)]
        shard: Option<(usize, usize)>,
    },
    /// A curve from its shards.
    Join {
        /// All of them, the first one first.
        shards: Vec<BatchReply>,
    },
    /// What theory says of the chain's waves.
    Theory {
        /// Text of the experiment.
        text: String,
    },
    /// Times of flight on a recording, or the curve of a table.
    Measure(Recording),
    /// Parameters of an experiment from a curve.
    Fit {
        /// Text of the experiment.
        text: String,
        /// Table (CSV) of times of flight against speed.
        table: String,
        /// Options of the program's verb `fit` by name.
        #[serde(default)]
        options: Value,
    },
}

/// A file that was dropped on the page.
#[derive(Debug, Deserialize)]
pub struct Recording {
    /// Its name, of which the ending counts.
    pub name: String,
    /// Its content, base64 in JSON.
    #[serde(deserialize_with = "bytes")]
    pub bytes: Vec<u8>,
    /// Options of the program's verb `measure` by name.
    #[serde(default)]
    pub options: Value,
}

fn bytes<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<u8>, D::Error> {
    let text = String::deserialize(from)?;
    STANDARD.decode(text).map_err(serde::de::Error::custom)
}

/// The verbs of the program that are no simulation; each returns what its `--json` prints.
pub trait Verbs: Send + Sync + 'static {
    /// All contact laws.
    fn laws(&self) -> Value;

    /// Times of flight on a recording, or the curve of a table.
    ///
    /// # Errors
    /// What the program says of a file or an option that can't be used.
    fn measure(&self, recording: &Recording) -> Result<Value, String>;

    /// Parameters of an experiment from a table of times of flight.
    ///
    /// # Errors
    /// What the program says of an experiment, a table or an option that can't be used.
    fn fit(&self, text: &str, table: &str, options: &Value) -> Result<Value, String>;
}

/// Answers a request, in JSON, on threads that end early once `stop` is asked for.
///
/// # Errors
/// Mistakes in the experiment with their places, and whatever else keeps from an answer.
pub fn answer(request: &Request, verbs: &dyn Verbs, stop: &Stop) -> Result<Value, Refusal> {
    let reply = if cfg!(target_family = "wasm") {
        // No threads there: the page runs several engines.
        stop.clone().adopt();
        dispatch(request, verbs)
    } else {
        stop.pool(0).map_err(Refusal::words)?.install(|| dispatch(request, verbs))
    };
    match stop.is_asked() {
        true => Err(Refusal::Stopped),
        false => reply,
    }
}

fn dispatch(request: &Request, verbs: &dyn Verbs) -> Result<Value, Refusal> {
    match request {
        Request::Presets => Ok(outline::presets()),
        Request::Laws => Ok(verbs.laws()),
        Request::Schema => Ok(hertzchain_experiment::schema()),
        Request::Check { text, edits } => outline::check(text, edits),
        Request::Shot { text, edits, samples, draft } => {
            shot::shot(&edit::edited(text, edits)?, *samples, *draft)
        }
        Request::Batch { text, speeds, shard } => {
            batch::batch(text, speeds, *shard).map(|reply| json!(reply))
        }
        Request::Join { shards } => Ok(json!(batch::join(shards))),
        Request::Theory { text } => outline::theory(text),
        Request::Measure(recording) => verbs.measure(recording).map_err(Refusal::Error),
        Request::Fit { text, table, options } => {
            verbs.fit(text, table, options).map_err(Refusal::Error)
        }
    }
}

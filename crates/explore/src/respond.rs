//! The engine as a program: one request from a stream to another.

use crate::engine::{Refusal, Request, Verbs, answer};
use hertzchain_sim::Stop;
use serde::Serialize;
use serde_json::{Value, json};
use std::io::{self, BufReader, BufWriter, Read, Write};

/// A reply or why there is none, as the page reads it.
#[derive(Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Response {
    /// The answer.
    Reply(Value),
    /// Why there is none.
    Refused(Refusal),
}

impl From<Result<Value, Refusal>> for Response {
    fn from(answered: Result<Value, Refusal>) -> Self {
        match answered {
            Ok(reply) => Self::Reply(reply),
            Err(refusal) => Self::Refused(refusal),
        }
    }
}

/// Answers the request that `input` holds, both in JSON, and writes progress to standard error, a
/// line of JSON each.
///
/// # Errors
/// Output that can't be written.
pub fn respond(verbs: &dyn Verbs, input: impl Read, output: impl Write) -> io::Result<()> {
    let stop = Stop::watched(|stop| {
        let (done, steps, note) = (stop.done(), stop.steps(), stop.note());
        eprintln!("{}", json!({ "done": done, "steps": steps, "note": note }));
    });
    let answered = serde_json::from_reader::<_, Request>(BufReader::new(input))
        .map_err(Refusal::unread)
        .and_then(|request| answer(&request, verbs, &stop));
    let mut output = BufWriter::new(output);
    serde_json::to_writer(&mut output, &Response::from(answered))?;
    output.flush()
}

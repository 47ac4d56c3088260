//! What tests share: verbs that stand in for the program's, and replies as JSON.

use hertzchain_explore::{Recording, Refusal, Request, Verbs, answer};
use hertzchain_sim::{Stop, stopped};
use serde_json::{Value, json};
use std::thread::sleep;
use std::time::Duration;

/// Verbs that say what they were given; a fit that goes on until it is stopped.
pub struct Echo;

impl Verbs for Echo {
    fn laws(&self) -> Value {
        json!([])
    }

    fn measure(&self, recording: &Recording) -> Result<Value, String> {
        match recording.bytes.is_empty() {
            true => Err(format!("{} is empty", recording.name)),
            false => Ok(json!({ "name": recording.name, "bytes": recording.bytes.len() })),
        }
    }

    fn fit(&self, _text: &str, _table: &str, _options: &Value) -> Result<Value, String> {
        while !stopped() {
            sleep(Duration::from_millis(5));
        }
        Err("broken off".to_owned())
    }
}

/// The reply to a request in JSON.
pub fn reply(request: Value) -> Value {
    answered(request).unwrap()
}

pub fn refusal(request: Value) -> Refusal {
    answered(request).unwrap_err()
}

fn answered(request: Value) -> Result<Value, Refusal> {
    let request: Request = serde_json::from_value(request).unwrap();
    answer(&request, &Echo, &Stop::default())
}

/// The text of a preset.
pub fn text(preset: &str) -> String {
    hertzchain_experiment::preset(preset).unwrap().text().to_owned()
}

//! Options of each verb: one struct of typed fields, from which command line, Python's keywords and the
//! `options` of result files derive.

/// Declares the names of an option's values, described for its help; after `for`, of the variants
/// of another enum, which they become.
macro_rules! names {
    ($(#[$doc:meta])* $name:ident { $($(#[$what:meta])* $variant:ident,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        pub enum $name { $($(#[$what])* $variant,)* }
    };
    ($(#[$doc:meta])* $name:ident for $of:path { $($(#[$what:meta])* $variant:ident,)* }) => {
        names!($(#[$doc])* $name { $($(#[$what])* $variant,)* });

        impl From<$name> for $of {
            fn from(name: $name) -> Self {
                match name { $($name::$variant => Self::$variant,)* }
            }
        }
    };
}

mod given;
mod infer;
mod measure;
mod simulate;
mod values;

pub use self::{given::*, infer::*, measure::*, simulate::*, values::*};
pub(crate) use given::has_unit;

use crate::failure::Failure;
use clap::{Arg, ArgAction, Args, Command};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use std::any::TypeId;

/// Returns the options of a verb from words, as a command line has them.
///
/// # Errors
/// Words that are no options, or values that an option does not take.
pub fn parsed<A: Args>(verb: &'static str, words: &[String]) -> Result<A, Failure> {
    let command = Command::new(verb).no_binary_name(true);
    let command = A::augment_args(command.disable_help_flag(true));
    let reported = |error: clap::Error| {
        let text = error.to_string();
        let text = text.split("\n\nUsage:").next().unwrap_or_default();
        let text = text.split("\n\nFor more information").next();
        let text = text.unwrap_or_default().trim();
        Failure::User(text.strip_prefix("error: ").unwrap_or(text).to_owned())
    };
    let matches = command.try_get_matches_from(words).map_err(reported)?;
    A::from_arg_matches(&matches).map_err(reported)
}

/// Returns the options of a verb from a JSON object: keys are the fields' names, null is the default.
///
/// ```
/// use hertzchain::options::{FitOptions, from_json};
/// let options = serde_json::json!({"free": ["eta", "B"], "speed_error": "0.7 mm/s", "starts": 3});
/// let options: FitOptions = from_json("fit", options)?;
/// assert_eq!(options.measured.speed_error.unwrap().0, 0.0007);
/// # Ok::<(), hertzchain::Failure>(())
/// ```
///
/// # Errors
/// A key that is no option, or a value that it does not take.
pub fn from_json<A: Args + DeserializeOwned>(
    verb: &'static str,
    options: Value,
) -> Result<A, Failure> {
    let Value::Object(mut options) = options else {
        return Err(Failure::User(format!("{verb}: expected an object of options, not {options}")));
    };
    options.retain(|_, value| !value.is_null());
    let command = A::augment_args(Command::new(verb));
    for (name, value) in &mut options {
        let option = command.get_arguments().find(|arg| arg.get_id() == name.as_str());
        let unknown = || Failure::User(format!("{verb} has no option `{name}`"));
        let option = option.ok_or_else(unknown)?;
        listed(option, value);
        named(option, value);
    }
    serde_json::from_value(Value::Object(options.clone())).map_err(|error| {
        // Flattened structs lose the key of a wrong value: each is tried by itself.
        let alone = |(name, value): (&String, &Value)| {
            serde_json::from_value::<A>(json!({ name: value })).err()
        };
        let wrong = options.iter().find_map(|one| Some((one, alone(one)?)));
        Failure::User(match wrong {
            Some(((name, value), error)) => format!("{name} = {value}: {error}"),
            None => format!("{verb}: {error}"),
        })
    })
}

/// Makes a single value of an option that takes several a list, split where the option splits it.
fn listed(option: &Arg, value: &mut Value) {
    let several =
        matches!(option.get_action(), ArgAction::Append) || option.get_value_delimiter().is_some();
    if !several || value.is_array() || value.is_object() {
        return;
    }
    *value = match (value.as_str(), option.get_value_delimiter()) {
        (Some(text), Some(between)) => text.split(between).map(str::trim).collect(),
        _ => json!([value]),
    };
}

/// Makes numbers texts where an option has names: a case can be called 1.
fn named(option: &Arg, value: &mut Value) {
    if option.get_value_parser().type_id() != TypeId::of::<String>() {
        return;
    }
    match value {
        Value::Array(all) => all.iter_mut().for_each(|one| named(option, one)),
        Value::Number(number) => *value = number.to_string().into(),
        _ => {}
    }
}

/// Options as a result file records them: without places of files, threads and other things that no
/// number depends on.
pub fn recorded(options: &impl Serialize) -> Value {
    serde_json::to_value(options).unwrap_or_default()
}

/// The options of an empty command line.
fn defaults<A: Args>() -> A {
    let command = A::augment_args(Command::new("options").no_binary_name(true));
    let command = command.mut_args(|arg| arg.required(false));
    let options =
        command.try_get_matches_from([""; 0]).and_then(|matches| A::from_arg_matches(&matches));
    options.expect("every option has a default or is optional")
}

macro_rules! default_options {
    ($($name:ident)*) => {$(
        impl Default for $name {
            fn default() -> Self {
                defaults()
            }
        }
    )*};
}

default_options!(
    CampaignOptions CheckOptions Input ShotOptions SimulationOptions SweepOptions CurveOptions DesignOptions FitOptions
    GaugeOptions ModelOptions ParameterOptions RecordOptions LiveOptions MeasureOptions PickOptions ReadingOptions
);

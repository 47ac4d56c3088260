//! Runs of the program under test and what they say.

use crate::arrival::{Arrival, PULSES};
use crate::motion::Maximum;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A run that takes longer is stopped: of processor time in s where the system says it, else of
/// the clock's.
const PATIENCE_S: f64 = 5.0;

/// One way to ask the program.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ask {
    /// `shot` or `sweep`.
    pub verb: &'static str,
    pub options: Vec<String>,
}

impl Ask {
    pub(crate) fn new(verb: &'static str, options: &[&str]) -> Self {
        let options = options.iter().map(|&option| option.to_owned()).collect();
        Self { verb, options }
    }

    /// As typed after the file's name.
    pub(crate) fn name(&self) -> String {
        let words: Vec<&str> =
            std::iter::once(self.verb).chain(self.options.iter().map(String::as_str)).collect();
        words.join(" ")
    }
}

/// What a run said.
#[derive(Clone, Debug)]
pub(crate) struct Answer {
    /// The peaks, or why there are none.
    pub peaks: Result<Arrival, String>,
    pub asked: f64,
    pub reached: Option<f64>,
    pub duration_s: f64,
    /// Of the sensor bead and of the wall.
    pub maxima: [Vec<Maximum>; 2],
    /// Of the incident, the wall's and the reflected pulse.
    pub competing: [Vec<Maximum>; 3],
    pub notes: Vec<String>,
    pub force_passes: f64,
}

/// Why a run said nothing.
#[derive(Clone, Debug)]
pub(crate) enum Silence {
    /// With its first line.
    Refused(String),
    TooSlow,
}

/// Asks the program about an experiment file.
pub(crate) fn ask(
    program: &Path,
    file: &Path,
    speed_m_s: f64,
    ask: &Ask,
) -> Result<Answer, Silence> {
    let mut command = Command::new(program);
    command.arg(ask.verb).arg(file).arg("--json").args(&ask.options);
    if ask.verb == "sweep" {
        command.args(["--speeds", &format!("{speed_m_s:?} m/s"), "--threads", "1"]);
    }
    let text = output(&mut command)?;
    let json: Value =
        serde_json::from_str(&text).map_err(|error| Silence::Refused(error.to_string()))?;
    let shot = match ask.verb {
        "sweep" => &json["points"][0],
        _ => &json,
    };
    match shot["error"].as_str() {
        Some(error) => Err(Silence::Refused(error.to_owned())),
        None => Ok(answer(shot)),
    }
}

/// Standard output of a command that ends well and in time.
fn output(command: &mut Command) -> Result<String, Silence> {
    let refused = |error: std::io::Error| Silence::Refused(error.to_string());
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).stdin(Stdio::null());
    let mut child = command.spawn().map_err(refused)?;
    // Read while it runs: a full pipe would stop it.
    let mut pipes = (child.stdout.take(), child.stderr.take());
    let reader = std::thread::spawn(move || {
        let mut texts = (String::new(), String::new());
        if let Some(pipe) = &mut pipes.0 {
            let _ = std::io::Read::read_to_string(pipe, &mut texts.0);
        }
        if let Some(pipe) = &mut pipes.1 {
            let _ = std::io::Read::read_to_string(pipe, &mut texts.1);
        }
        texts
    });
    let begun = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().map_err(refused)? {
            break status;
        }
        if processor_s(child.id()).unwrap_or(begun.elapsed().as_secs_f64()) > PATIENCE_S {
            let _ = child.kill();
            let _ = child.wait();
            return Err(Silence::TooSlow);
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let (text, errors) = reader.join().unwrap_or_default();
    match status.success() {
        true => Ok(text),
        false => {
            let lines = errors.lines().filter(|line| !line.trim().is_empty());
            let first: Vec<&str> = lines.take(3).map(str::trim).collect();
            Err(Silence::Refused(first.join(" | ")))
        }
    }
}

/// Processor time of a process so far, in s: Linux alone has this file.
fn processor_s(process: u32) -> Option<f64> {
    let text = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let after_name = text.rsplit_once(')')?.1;
    // Its user and system time in hundredths of a second.
    let mut times = after_name.split_whitespace().skip(11);
    let hundredths: f64 = times.next()?.parse::<f64>().ok()? + times.next()?.parse::<f64>().ok()?;
    Some(0.01 * hundredths)
}

fn maximum(json: &Value) -> Option<Maximum> {
    Some(Maximum { time_s: json["time_s"].as_f64()?, height_n: json["value"].as_f64()? })
}

fn maxima(json: &Value) -> Vec<Maximum> {
    let list = json.as_array();
    list.map_or_else(Vec::new, |list| list.iter().filter_map(maximum).collect())
}

fn answer(shot: &Value) -> Answer {
    let passage = &shot["passage"];
    let peaks = match maximum(&passage["wall"]) {
        Some(wall) => Ok(Arrival {
            incident: maximum(&passage["incident"]),
            wall,
            reflected: maximum(&passage["reflected"]),
        }),
        None => Err(passage["missing"].as_str().unwrap_or("no reason given").to_owned()),
    };
    let competing = |pulse: &str| {
        let all = passage["competing"].as_array().into_iter().flatten();
        let of_pulse = all.filter(|it| it["pulse"].as_str() == Some(pulse));
        of_pulse.filter_map(maximum).collect()
    };
    let notes = shot["notes"].as_array().into_iter().flatten();
    Answer {
        peaks,
        asked: shot["accuracy_asked"].as_f64().unwrap_or(f64::NAN),
        reached: shot["accuracy_reached"].as_f64(),
        duration_s: shot["duration_s"].as_f64().unwrap_or(f64::NAN),
        maxima: [&shot["sensor_maxima"], &passage["wall_maxima"]].map(maxima),
        competing: PULSES.map(competing),
        notes: notes.filter_map(|note| Some(note.as_str()?.to_owned())).collect(),
        force_passes: shot["force_passes"].as_f64().unwrap_or(f64::NAN),
    }
}

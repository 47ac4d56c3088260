//! Coverage of the stated errors of picked pulses, by computed records with known times.
//!
//! `cargo run --release -p hertzchain-picking -- 20` puts noise, saturation, crosstalk, precursors,
//! drift and a low-pass into 20 computed shots of each preset at six speeds, measures them, and prints one
//! line of a table for each kind of records.
#![allow(clippy::print_stdout, reason = "the table is what it is for")]

mod comparison;
mod fault;
mod row;
mod tally;

use fault::{Drift, Fault, HARD, KNEE, SHORT_KNEE, TANH};
use hertzchain_measure::signal::Bandwidth;
use row::Row;
use std::error::Error;
use std::path::PathBuf;
use tally::Tally;

const PRESETS: [&str; 4] = ["dry", "pump", "gear", "motor"];
const SPEEDS_M_S: [f64; 6] = [0.08, 0.2, 0.5, 1.2, 2.0, 2.5];
const USAGE: &str = "usage: hertzchain-picking [SHOTS] [--seed N] [--only TEXT] [--each] \
                     [--alone] [--compare] [--beads N] [--chains N] [--first N] [--write FOLDER]";
const HEADER: &str = "\
| records | shots | timed | counted | incident: within 1.96, % | made/stated | mean pull \
| reflected: % | made/stated | mean pull | counted, incident: % | made/stated | mean pull \
| reflected: % | made/stated | mean pull | returns | χ² of means, incident | reflected \
| χ² of exponents, incident | reflected | correlation made | stated | worst row, incident | reflected |
|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|";

const COMPARED: &str = "\
| records | incident, ns: default | quartic | averaged | default within 1.1 of the best, most \
| reflected, ns: default | quartic | averaged | default within 1.1 of the best, most |
|---|---|---|---|---|---|---|---|---|";

/// What the command line asks for.
#[derive(Default)]
struct Options {
    shots: u64,
    seed: u64,
    only: String,
    each: bool,
    /// Whether each shot is picked alone.
    alone: bool,
    /// Whether a quartic and averaged pulses pick the same records.
    compare: bool,
    /// Beads of the presets' chains in place of their own.
    beads: Option<u64>,
    /// So many chains at random in place of the presets' rows, from this number on.
    chains: u64,
    first: u64,
    /// Where the rows' forces are written, in place of a table.
    write: Option<PathBuf>,
}

impl Options {
    fn parse(mut words: impl Iterator<Item = String>) -> Result<Self, Box<dyn Error>> {
        let mut options = Self { shots: 20, seed: 1, ..Self::default() };
        while let Some(word) = words.next() {
            match word.as_str() {
                "--seed" => options.seed = words.next().ok_or(USAGE)?.parse()?,
                "--only" => options.only = words.next().ok_or(USAGE)?,
                "--chains" => options.chains = words.next().ok_or(USAGE)?.parse()?,
                "--first" => options.first = words.next().ok_or(USAGE)?.parse()?,
                "--beads" => options.beads = Some(words.next().ok_or(USAGE)?.parse()?),
                "--write" => options.write = words.next().map(PathBuf::from),
                "--each" => options.each = true,
                "--alone" => options.alone = true,
                "--compare" => options.compare = true,
                count => options.shots = count.parse().map_err(|_| USAGE)?,
            }
        }
        Ok(options)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse(std::env::args().skip(1))?;
    let rows = match options.chains {
        0 => preset_rows(options.beads)?,
        count => {
            let numbers = options.first..options.first + count;
            numbers.filter_map(|number| Row::at_random(number).ok()).collect()
        }
    };
    if let Some(folder) = options.write {
        for row in &rows {
            row.write(&folder)?;
        }
        return Ok(());
    }
    println!("{}", if options.compare { COMPARED } else { HEADER });
    for (name, faults) in families() {
        if !name.contains(&options.only) {
            continue;
        }
        for (name, fault) in faults {
            let tally = Tally::of(&rows, &fault, &options);
            match options.compare {
                true => println!("| {name} | {} |", tally.comparison.cells()),
                false => println!("{}", line(&name, &tally)),
            }
        }
    }
    Ok(())
}

fn preset_rows(beads: Option<u64>) -> Result<Vec<Row>, Box<dyn Error>> {
    let speeds = |preset| SPEEDS_M_S.map(|speed_m_s| Row::of_preset(preset, beads, speed_m_s));
    PRESETS.into_iter().flat_map(speeds).collect()
}

/// A line of the table.
fn line(name: &str, tally: &Tally) -> String {
    let count = tally.correlations.len().max(1) as f64;
    let made = tally.correlations.iter().map(|(made, _)| made).sum::<f64>() / count;
    let stated = tally.correlations.iter().map(|(_, stated)| stated).sum::<f64>() / count;
    let worst = tally.worst.each_ref().map(|(share, row)| format!("{share:.0}: {row}"));
    format!(
        "| {name} | {} | {} | {} | {} | {} | {} | {} | {} | {made:.2} | {stated:.2} | {} |",
        tally.shots,
        tally.timed,
        tally.counted,
        tally.all.cells(),
        tally.of_counted.cells(),
        tally.all.returns(),
        tally.means.squares(),
        tally.exponents.squares(),
        worst.join(" | "),
    )
}

/// Wall sensors that are more sensitive than the sensor bead's.
fn wall_sensors() -> Vec<(String, Fault)> {
    let at = |wall_gain: f64| {
        [40.0, 60.0].map(|noise_db| {
            let name = format!("wall sensor {wall_gain} times as sensitive, {noise_db} dB");
            (name, Fault { noise_db, wall_gain, ..Fault::default() })
        })
    };
    [2.0, 5.0].into_iter().flat_map(at).collect()
}

/// Hum of the mains, ramps and steps under the pulses.
fn drifts() -> Vec<(String, Fault)> {
    let none = Drift::default();
    let kinds = [
        ("hum of 0.1 %", Drift { hum: 0.001, ..none }),
        ("hum of 1 %", Drift { hum: 0.01, ..none }),
        ("hum of 5 %", Drift { hum: 0.05, ..none }),
        ("hum of 20 %", Drift { hum: 0.2, ..none }),
        ("ramps to 50/s", Drift { ramp_per_s: 50.0, ..none }),
        ("hum of 5 %, ramps to 50/s", Drift { hum: 0.05, ramp_per_s: 50.0, ..none }),
        ("step of 1 %", Drift { step: 0.01, ..none }),
        ("hum of 5 %, step of 1 %", Drift { hum: 0.05, step: 0.01, ..none }),
    ];
    let at = |(name, drift): (&str, Drift)| {
        [40.0, 60.0].map(|noise_db| {
            (format!("{name}, {noise_db} dB"), Fault { noise_db, drift, ..Fault::default() })
        })
    };
    kinds.into_iter().flat_map(at).collect()
}

/// Kinds of records: a name to choose them by, and each with what is done to it.
fn families() -> Vec<(&'static str, Vec<(String, Fault)>)> {
    let at = |noise_db: f64| Fault { noise_db, ..Fault::default() };
    let each = |levels: &[f64], of: &dyn Fn(f64) -> (String, Fault)| -> Vec<(String, Fault)> {
        levels.iter().map(|level| of(*level)).collect()
    };
    let mut families = vec![
        (
            "noise",
            each(&[20.0, 25.0, 30.0, 40.0, 50.0, 60.0, 80.0], &|db| (format!("{db} dB"), at(db))),
        ),
        (
            "speeds",
            each(&[30.0, 40.0, 60.0], &|db| {
                let name = format!("speeds differ by 3 mm/s, {db} dB");
                (name, Fault { speeds_differ: true, ..at(db) })
            }),
        ),
        (
            "crosstalk",
            each(&[40.0, 60.0], &|db| {
                let name = format!("two channels, crosstalk of 10 %, {db} dB");
                (name, Fault { separate: true, crosstalk: 0.1, ..at(db) })
            }),
        ),
        (
            "separate",
            each(&[40.0, 60.0], &|db| {
                (format!("two channels, {db} dB"), Fault { separate: true, ..at(db) })
            }),
        ),
        ("wall sensor", wall_sensors()),
        (
            "no return",
            each(&[20.0, 30.0, 40.0, 60.0], &|db| {
                (format!("return cut out, {db} dB"), Fault { without_return: true, ..at(db) })
            }),
        ),
    ];
    let mut precursors = Vec::new();
    for lead_s in [60e-6, 80e-6] {
        precursors.extend(each(&[40.0, 60.0], &|db| {
            let name = format!("precursors of 5 %, {:.0} µs before, {db} dB", 1e6 * lead_s);
            (name, Fault { precursor: (0.05, lead_s), ..at(db) })
        }));
    }
    families.push(("precursors", precursors));
    let mut filtered = Vec::new();
    for order in [1, 2] {
        for corrected in [false, true] {
            filtered.extend(each(&[40.0, 60.0], &|db| {
                let how = if corrected { "taken out" } else { "left" };
                let low_pass = Some(Bandwidth { corner_hz: 50e3, order, bessel: false });
                let name = format!("low-pass of 50 kHz, order {order}, {how}, {db} dB");
                (name, Fault { low_pass, corrected, ..at(db) })
            }));
        }
    }
    families.push(("low-pass", filtered));
    families.push(("drift", drifts()));
    let clips = [("hard", HARD), ("tanh", TANH), ("short knee", SHORT_KNEE), ("knee", KNEE)];
    for (kind, clip) in clips {
        let mut clipped = Vec::new();
        for share in [0.95, 0.9, 0.83, 0.75, 0.6] {
            clipped.extend(each(&[30.0, 40.0, 60.0, 80.0], &|db| {
                let name = format!("clipped, {kind}, at {share}, {db} dB");
                (name, Fault { clip: Some((clip, share)), ..at(db) })
            }));
        }
        families.push((kind, clipped));
    }
    families
}

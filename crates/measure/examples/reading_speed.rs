//! How fast recordings become times of flight: `cargo run --release -p hertzchain-measure
//! --example reading_speed [MEGABYTES] [THREADS]`.
//!
//! Writes one recording of 16-bit samples at 1 MS/s, 100,000 a shot as those of a
//! campaign, without compression as NPY, WAV and HDF5, and measures each from the file to
//! both times of flight of every shot; reports also the most memory that was needed meanwhile.
#![allow(clippy::print_stdout, reason = "an example talks")]

#[path = "../tests/signal/common/mod.rs"]
mod common;

use common::Scene;
use hertzchain_measure::records::{Parts, ReadOptions};
use hertzchain_measure::signal;
use hertzchain_measure::{Cut, Level, Options, measure};
use rust_hdf5::H5File;
use std::error::Error;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

type Anyhow = Result<(), Box<dyn Error>>;

const SAMPLES_A_SHOT: usize = 100_000;
const RATE_HZ: u32 = 1_000_000;
/// Readings of the highest incident pulse.
const STEPS: f64 = 10_000.0;
/// Shots that differ in noise; a recording repeats them.
const DIFFERENT: usize = 20;

fn main() -> Anyhow {
    let number = |at: usize, usual: usize| match std::env::args().nth(at) {
        Some(text) => text.parse(),
        None => Ok(usual),
    };
    let (megabytes, threads) = (number(1, 200)?, number(2, 2)?);
    let shots = (megabytes * 1_000_000).div_ceil(2 * SAMPLES_A_SHOT);
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    let folder = std::env::temp_dir().join(format!("hertzchain-throughput-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    let reported = all(&folder, shots, threads);
    fs::remove_dir_all(&folder)?;
    reported
}

fn all(folder: &Path, shots: usize, threads: usize) -> Anyhow {
    let different: Vec<Vec<i16>> = (1..=DIFFERENT as u64).map(shot).collect();
    let recording = || (0..shots).map(|at| different[at % DIFFERENT].as_slice());
    let rows = Options {
        reading: ReadOptions { rate_hz: Some(f64::from(RATE_HZ)), ..ReadOptions::default() },
        ..Options::default()
    };
    let parts = Options {
        reading: ReadOptions { parts: Parts::Shots(SAMPLES_A_SHOT), ..ReadOptions::default() },
        ..Options::default()
    };
    let level = Options {
        cutting: Cut::Level(Level {
            volts: 0.3 * STEPS / f64::from(1 << 15),
            samples: Some(SAMPLES_A_SHOT * 9 / 10),
        }),
        ..Options::default()
    };
    let path = folder.join("rows.npy");
    npy(&path, shots, recording())?;
    let megabytes = 2e-6 * (shots * SAMPLES_A_SHOT) as f64;
    let time = |name, path: &Path, options| time(name, path, megabytes, options, threads);
    time("NPY, a row a shot", &path, &rows)?;
    let path = folder.join("rows.h5");
    hdf5(&path, shots, recording())?;
    time("HDF5, a row a shot", &path, &rows)?;
    let path = folder.join("long.wav");
    wav(&path, shots, recording())?;
    time("WAV, cut into equal lengths", &path, &parts)?;
    time("WAV, cut at a level", &path, &level)
}

/// One shot as a 16-bit digitiser gives it, 50 dB above its noise.
fn shot(seed: u64) -> Vec<i16> {
    let scene =
        Scene { samples: SAMPLES_A_SHOT, noise: 3e-3, offset: 0.02, seed, ..Scene::default() };
    let digits = |x: &f64| (x * STEPS).round() as i16;
    scene.summed().iter().map(digits).collect()
}

/// Measures a file of so many megabytes of samples and reports how long it took.
fn time(name: &str, path: &Path, megabytes: f64, options: &Options, threads: usize) -> Anyhow {
    let files: [PathBuf; 1] = [path.to_owned()];
    // The kernel begins anew with its record of the most memory.
    fs::write("/proc/self/clear_refs", "5").unwrap_or_default();
    let (start, before_s) = (Instant::now(), processor_s());
    let measured = measure(&files, options, &());
    let seconds = start.elapsed().as_secs_f64();
    let own_s = processor_s().zip(before_s).map(|(after, before)| after - before);
    let whole = measured.shots.iter().filter(|shot| {
        let flight = shot.flight.as_ref();
        flight.is_ok_and(|flight| flight.reflected_s.is_some())
    });
    println!(
        "{name}: {} of {} shots in {seconds:.2} s, {:.0} MB/s on {threads} threads; {:.0} MB in a second of one core; {:.0} MiB of memory",
        whole.count(),
        measured.shots.len(),
        megabytes / seconds,
        megabytes / own_s.unwrap_or(f64::NAN),
        most_mib().unwrap_or(f64::NAN),
    );
    Ok(())
}

/// What all threads have had of processors so far, in s, where the system reports it: on a
/// machine with other work, time on the clock says little.
fn processor_s() -> Option<f64> {
    let line = fs::read_to_string("/proc/self/stat").ok()?;
    // After the program's name in brackets; in hundredths of a second.
    let (_, after) = line.rsplit_once(')')?;
    let mut fields = after.split_whitespace().skip(11);
    let mut next = || fields.next()?.parse::<f64>().ok();
    Some(0.01 * (next()? + next()?))
}

/// Most memory that was needed since the kernel began its record, in MiB.
fn most_mib() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib / 1024.0)
}

fn bytes(samples: &[i16]) -> Vec<u8> {
    samples.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn npy<'a>(path: &Path, shots: usize, rows: impl Iterator<Item = &'a [i16]>) -> Anyhow {
    let mut file = BufWriter::new(File::create(path)?);
    let header = format!(
        "{{'descr': '<i2', 'fortran_order': False, 'shape': ({shots}, {SAMPLES_A_SHOT}), }}"
    );
    // Magic, version and length take ten bytes; all together a multiple of 64.
    let length = (10 + header.len() + 1).next_multiple_of(64) - 10;
    file.write_all(b"\x93NUMPY\x01\x00")?;
    file.write_all(&u16::try_from(length)?.to_le_bytes())?;
    file.write_all(format!("{header:<width$}\n", width = length - 1).as_bytes())?;
    for row in rows {
        file.write_all(&bytes(row))?;
    }
    Ok(file.flush()?)
}

fn wav<'a>(path: &Path, shots: usize, rows: impl Iterator<Item = &'a [i16]>) -> Anyhow {
    let mut file = BufWriter::new(File::create(path)?);
    let data = u32::try_from(2 * shots * SAMPLES_A_SHOT)?;
    file.write_all(b"RIFF")?;
    file.write_all(&(36 + data).to_le_bytes())?;
    file.write_all(b"WAVEfmt ")?;
    // Whole numbers, one channel of two bytes.
    for number in [16, 1 | 1 << 16, RATE_HZ, 2 * RATE_HZ, 2 | 16 << 16] {
        file.write_all(&u32::to_le_bytes(number))?;
    }
    file.write_all(b"data")?;
    file.write_all(&data.to_le_bytes())?;
    for row in rows {
        file.write_all(&bytes(row))?;
    }
    Ok(file.flush()?)
}

fn hdf5<'a>(path: &Path, shots: usize, rows: impl Iterator<Item = &'a [i16]>) -> Anyhow {
    let file = H5File::create(path)?;
    let samples = file.new_dataset::<i16>().shape([shots, SAMPLES_A_SHOT]).create("samples")?;
    for (at, row) in rows.enumerate() {
        samples.write_slice(&[at, 0], &[1, SAMPLES_A_SHOT], row)?;
    }
    Ok(file.close()?)
}

//! Speeds that a file tells of its shots in order, dealt once all of them are cut out.

use crate::error::{MeasureError, file_name};
use crate::records::{Parts, Record};
use crate::{Measurement, Options, Shot};
use std::path::{Path, PathBuf};

/// Files that tell speeds of shots which had yet to be cut out, with the speeds in m/s.
#[derive(Debug, Default)]
pub(crate) struct Speeds {
    files: Vec<(PathBuf, Vec<f64>)>,
}

impl Speeds {
    /// Takes down what the file of a record tells.
    pub(crate) fn hear(&mut self, record: &Record) {
        let known = self
            .files
            .last()
            .is_some_and(|(file, _)| *file == record.file);
        if !known && !record.speeds_m_s.is_empty() {
            self.files
                .push((record.file.clone(), record.speeds_m_s.clone()));
        }
    }

    /// Gives every shot its speed. Where there are not as many speeds as shots, nobody knows
    /// whose they are: shots that the list tells nothing of have none then, and that is told.
    pub(crate) fn deal(
        self,
        measurement: &mut Measurement,
        options: &Options,
        refused: &[PathBuf],
    ) {
        for (file, speeds) in self.files {
            let of_file = |shot: &&mut Shot| shot.file == file;
            let shots: Vec<&mut Shot> = measurement.shots.iter_mut().filter(of_file).collect();
            let found = shots.iter().map(|shot| number(shot)).max().unwrap_or(0);
            let lost = lost(&file, options, refused);
            let told = speeds.len();
            if !(found..=found + lost).contains(&(told as u64)) {
                let nameless = shots.iter().any(|shot| shot.speed_m_s.is_none());
                let unlike = nameless.then(|| unmatched(&file, told, found));
                measurement.refused.extend(unlike);
                continue;
            }
            let examples = measurement
                .examples
                .iter_mut()
                .map(|example| &mut example.shot);
            let shots = shots.into_iter().chain(examples.filter(of_file));
            for shot in shots {
                let speed = speeds.get((number(shot) as usize).saturating_sub(1));
                shot.take(speed.copied().filter(|speed| speed.is_finite()), options);
            }
        }
    }
}

/// The error where speeds are not as many as shots.
fn unmatched(file: &Path, speeds: usize, shots: u64) -> MeasureError {
    let s = if shots == 1 { "" } else { "s" };
    let detail = format!(
        "has {speeds} speeds, and {shots} shot{s} were found in it: none was given a speed; say \
         which is which with --shots, or cut it otherwise with --level or --shot-samples"
    );
    MeasureError::Shots(file_name(file), detail)
}

/// Of a shot in its file, from 1.
fn number(shot: &Shot) -> u64 {
    shot.shot.unwrap_or(1)
}

/// Shots of equal length keep their numbers where others were refused, maybe the last ones.
fn lost(file: &Path, options: &Options, refused: &[PathBuf]) -> u64 {
    match options.reading.parts {
        Parts::Shots(_) => refused.iter().filter(|other| *other == file).count() as u64,
        _ => 0,
    }
}

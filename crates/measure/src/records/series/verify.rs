//! Whether a file is the series that somebody is about to write.

use super::read::{attribute_text, channels, column};
use super::{SeriesInfo, layout};
use crate::records::checksum;
use crate::records::error::RecordError;
use crate::records::hdf5::damaged;
use rust_hdf5::{H5File, Hdf5Error};
use std::fs::File;
use std::path::Path;

/// Opens a finished series and compares it with what a writer would have been
/// told: every text of the information, the shape of each channel, the numbers and
/// the programmed speed of the shots, and the checksum of the file.
///
/// # Errors
/// [`RecordError::Malformed`] with what is damaged, missing or other than expected.
pub fn verify(
    file: &Path,
    info: &SeriesInfo,
    shots: usize,
    programmed_speed_m_s: f64,
) -> Result<(), RecordError> {
    let open = File::open(file).map_err(|cause| RecordError::reading(file, cause))?;
    let agrees = checksum::agrees(&open).map_err(|cause| RecordError::reading(file, cause))?;
    let broken = match agrees {
        Some(true) => None,
        Some(false) => Some("damaged: its bytes do not have its checksum"),
        None => Some("cut short or damaged: its checksum is missing"),
    };
    if let Some(what) = broken {
        return Err(RecordError::malformed(file, "this series", what));
    }
    let found = differs(file, info, shots, programmed_speed_m_s);
    match found.unwrap_or_else(|error| Some(damaged(&error))) {
        Some(what) => Err(RecordError::malformed(file, "this series", what)),
        None => Ok(()),
    }
}

/// The first thing that is other than expected.
fn differs(
    file: &Path,
    info: &SeriesInfo,
    shots: usize,
    programmed_speed_m_s: f64,
) -> Result<Option<String>, Hdf5Error> {
    let open = H5File::open(file)?;
    let own = [
        (layout::FORMAT.0, layout::FORMAT.1),
        (layout::CASE, &info.case),
        (layout::EXPERIMENT, &info.experiment),
    ];
    let more = info.more.iter().map(|(name, text)| (&**name, &**text));
    for (name, text) in own.into_iter().chain(more) {
        if attribute_text(&open, name).as_deref() != Some(text) {
            return Ok(Some(format!("its `{name}` is another")));
        }
    }
    let channels = channels(&open)?;
    let names = channels.iter().map(|(name, _)| name);
    if !names.eq(info.channels.names()) {
        return Ok(Some("it has other channels".to_owned()));
    }
    let shape = [shots, info.samples_per_shot];
    if let Some((name, found)) = channels.iter().find(|(_, found)| found.shape() != shape) {
        let found = found.shape();
        return Ok(Some(format!(
            "`{name}` has the axes {found:?}, not {shape:?}"
        )));
    }
    let numbers = column::<i64>(&open, layout::SHOT, shots)?;
    let speeds = column::<f64>(&open, layout::PROGRAMMED, shots)?;
    if !numbers.into_iter().eq(0..shots as i64) {
        return Ok(Some("it has other shots".to_owned()));
    }
    let same = speeds.iter().all(|speed| *speed == programmed_speed_m_s);
    Ok((!same).then(|| "it has another programmed speed".to_owned()))
}

//! LabVIEW's TDMS. Written here: tdms-rs reads neither interleaved
//! channels nor several chunks a segment, which most of LabVIEW's files have.

mod index;
mod metadata;
mod scaling;

use crate::error::{MeasureError, file_name};
use crate::records::arrays;
use crate::records::interval::seconds_taken;
use crate::records::options::{ReadOptions, chosen};
use crate::records::read::Raw;
use crate::records::record::Samples;
use crate::records::stream::{Cut, Head, MOST_SAMPLES, Stream};
use index::{Channel, Index, Piece};
use scaling::value;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Opens a TDMS file: every group with samples is a record, or several if it is
/// to be cut.
pub(crate) fn open(file: &Path, options: &ReadOptions) -> Result<Raw, MeasureError> {
    let index = Index::of(file)?;
    let several = index.groups.len() > 1;
    let mut records: Vec<Raw> = Vec::new();
    for (number, group) in index.groups.into_iter().enumerate() {
        let shot = several.then_some(number as u64 + 1);
        let opened = open_group(file, group.0, group.1, options);
        let opened = opened.unwrap_or_else(|error| Box::new(std::iter::once(Err(error))));
        records.push(Box::new(opened.map(move |record| {
            let mut record = record?;
            record.shot = record.shot.or(shot);
            Ok(record)
        })));
    }
    if records.is_empty() && index.cut_short.is_none() {
        return Err(MeasureError::empty(file_name(file)));
    }
    let file = file_name(file);
    let end = index
        .cut_short
        .map(move |detail| Err(MeasureError::truncated(file, detail)));
    Ok(Box::new(records.into_iter().flatten().chain(end)))
}

fn open_group(
    file: &Path,
    group: String,
    channels: Vec<Channel>,
    options: &ReadOptions,
) -> Result<Raw, MeasureError> {
    let (channels, step) = without_times(file, channels, options);
    let names: Vec<String> = channels
        .iter()
        .map(|channel| channel.name.clone())
        .collect();
    let picked = chosen(file, &names, options)?;
    let source = format!("{}, {group}", file_name(file));
    let kept = picked.into_iter().filter_map(|at| channels.get(at));
    let kept: Result<Vec<Channel>, MeasureError> = kept
        .map(|channel| {
            channel.clone().scaled().map_err(|scale| {
                let name = &channel.name;
                let detail = format!("{name:?} has {scale}; export it with scaled values");
                MeasureError::malformed(file, "TDMS", detail)
            })
        })
        .collect();
    let kept = kept?;
    let total = kept.first().map_or(0, Channel::len);
    if total == 0 {
        return Err(MeasureError::empty(source));
    }
    if let Some(other) = kept.iter().find(|channel| channel.len() != total) {
        let why = "as in its first channel";
        return Err(MeasureError::lengths(source, other.len(), total, why));
    }
    let stated_s = kept.iter().find_map(Channel::interval_s);
    let own_s = step
        .as_ref()
        .and_then(|(_, step)| arrays::step_s(*step, options));
    let times = step.filter(|_| stated_s.is_none() && own_s.is_some());
    let note = times.and_then(|(name, _)| seconds_taken(&name, None, options));
    let names = kept.iter().map(|channel| channel.name.clone()).collect();
    let head = Head {
        part: Some(group),
        note,
        ..Head::new(file, names, stated_s.or(own_s), total, options)?
    };
    let opened = File::open(file).map_err(|cause| MeasureError::reading(file, cause))?;
    let stream = Group {
        file: file.to_owned(),
        opened,
        channels: kept,
        at: 0,
    };
    Ok(Box::new(Cut::new(head.divided(options.parts), stream)))
}

/// Channels but for one that rises evenly, as times do and no signal, with its name and step.
/// Where channels are chosen by name, all stay.
fn without_times(
    file: &Path,
    mut channels: Vec<Channel>,
    options: &ReadOptions,
) -> (Vec<Channel>, Option<(String, f64)>) {
    if channels.len() < 2 {
        return (channels, None);
    }
    let step = |channel: &Channel| {
        if options.channels.contains(&channel.name) {
            return None;
        }
        let channel = channel.clone().scaled().ok()?;
        let mut opened = File::open(file).ok()?;
        let samples = part(
            &mut opened,
            &channel,
            0,
            channel.len().min(arrays::TIMES_SEEN),
        );
        arrays::even_step(&samples.ok()?.volts())
    };
    let found = channels
        .iter()
        .enumerate()
        .find_map(|(at, channel)| Some((at, step(channel)?)));
    match found {
        Some((at, step)) => {
            let times = channels.get(at).map(|channel| (channel.name.clone(), step));
            if options.channels.is_empty() {
                channels.remove(at);
            }
            (channels, times)
        }
        None => (channels, None),
    }
}

/// The channels of a group, read piece by piece.
struct Group {
    file: PathBuf,
    opened: File,
    channels: Vec<Channel>,
    at: usize,
}

impl Stream for Group {
    fn take(&mut self, count: usize) -> Result<Vec<Samples>, MeasureError> {
        let (from, to) = (self.at, self.at + count);
        self.at = to;
        let Self {
            channels, opened, ..
        } = self;
        let taken: std::io::Result<Vec<Samples>> = channels
            .iter()
            .map(|channel| part(opened, channel, from, to))
            .collect();
        taken.map_err(|cause| MeasureError::reading(&self.file, cause))
    }
}

/// Samples `from..to` of a channel, gathered from the pieces that hold them.
fn part(opened: &mut File, channel: &Channel, from: usize, to: usize) -> std::io::Result<Samples> {
    let wide = channel.number.width();
    let mut numbers = Vec::new();
    let mut begin = 0;
    for piece in &channel.pieces {
        let end = begin + piece.count * piece.chunks;
        let mut at = from.max(begin);
        while at < to.min(end) {
            let chunk = (at - begin) / piece.count;
            let first = (at - begin) % piece.count;
            let count = (piece.count - first).min(to - at);
            numbers.extend(run(opened, piece, chunk, first, count, wide)?);
            at += count;
        }
        begin = end;
    }
    let samples = channel.number.samples(&numbers, 0, 1);
    Ok(match channel.powers.as_slice() {
        [] => samples,
        powers => Samples::Volts(
            samples
                .volts()
                .into_iter()
                .map(|x| value(powers, x))
                .collect(),
        ),
    })
}

/// The bytes of `count` numbers in one chunk, side by side.
fn run(
    opened: &mut File,
    piece: &Piece,
    chunk: usize,
    first: usize,
    count: usize,
    wide: usize,
) -> std::io::Result<Vec<u8>> {
    let start = piece.offset + (chunk * piece.chunk_bytes + first * piece.stride) as u64;
    opened.seek(SeekFrom::Start(start))?;
    let bytes = (count - 1) * piece.stride + wide;
    let mut raw = Vec::new();
    let read = opened.by_ref().take(bytes as u64).read_to_end(&mut raw)?;
    if read < bytes || count > MOST_SAMPLES {
        return Err(std::io::ErrorKind::UnexpectedEof.into());
    }
    if piece.stride == wide {
        return Ok(raw);
    }
    let numbers = raw.chunks(piece.stride).filter_map(|row| row.get(..wide));
    Ok(numbers.flatten().copied().collect())
}

//! LabVIEW's TDMS. Written here: the crate there is reads neither interleaved
//! channels nor several chunks a segment, which most of LabVIEW's files have.

mod bytes;
mod daqmx;
mod index;
mod lead;
mod scaling;

use crate::records::arrays;
use crate::records::channels::chosen;
use crate::records::cut::{Cut, Head, MOST_SAMPLES, Stream};
use crate::records::error::{RecordError, name};
use crate::records::interval::{interval_s, seconds_taken};
use crate::records::options::ReadOptions;
use crate::records::read::Raw;
use crate::records::record::Samples;
use index::{Channel, Index, Piece};
use scaling::value;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Opens a TDMS file: every group with samples is a record, or several if it is
/// to be cut.
pub(crate) fn open(file: &Path, options: &ReadOptions) -> Result<Raw, RecordError> {
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
        return Err(RecordError::Empty {
            source_name: name(file),
        });
    }
    let file = name(file);
    let end = index
        .cut_short
        .map(move |detail| Err(RecordError::truncated(file, detail)));
    Ok(Box::new(records.into_iter().flatten().chain(end)))
}

fn open_group(
    file: &Path,
    group: String,
    channels: Vec<Channel>,
    options: &ReadOptions,
) -> Result<Raw, RecordError> {
    let (channels, step) = without_times(file, channels, options);
    let names: Vec<String> = channels
        .iter()
        .map(|channel| channel.name.clone())
        .collect();
    let picked = chosen(file, &names, options)?;
    let source_name = format!("{}, {group}", name(file));
    let kept = picked.into_iter().filter_map(|at| channels.get(at));
    let kept: Result<Vec<Channel>, RecordError> = kept
        .map(|channel| {
            channel.clone().scaled().map_err(|scale| {
                let name = &channel.name;
                let detail = format!("{name:?} has {scale}; export it with scaled values");
                RecordError::malformed(file, "TDMS", detail)
            })
        })
        .collect();
    let kept = kept?;
    let total = kept.first().map_or(0, Channel::len);
    if total == 0 {
        return Err(RecordError::Empty { source_name });
    }
    if let Some(other) = kept.iter().find(|channel| channel.len() != total) {
        return Err(RecordError::MixedLengths {
            source_name,
            found: other.len(),
            expected: total,
            why: "as in its first channel",
        });
    }
    let stated_s = kept.iter().find_map(Channel::interval_s);
    let own_s = step
        .as_ref()
        .and_then(|(_, step)| arrays::of_step(*step, options));
    let times = step.filter(|_| stated_s.is_none() && own_s.is_some());
    let note = times.and_then(|(name, _)| seconds_taken(&name, None, options));
    let head = Head {
        file: file.to_owned(),
        part: Some(group),
        names: kept.iter().map(|channel| channel.name.clone()).collect(),
        interval_s: interval_s(file, stated_s.or(own_s), options)?,
        total,
        row: total,
        each: total,
        pieces: false,
        note: None,
    };
    let opened = File::open(file).map_err(|cause| RecordError::reading(file, cause))?;
    let stream = Group {
        file: file.to_owned(),
        opened,
        channels: kept,
        at: 0,
    };
    let records = Cut::new(head.divided(options.parts), stream);
    Ok(Box::new(records.map(move |record| {
        record.map(|mut record| {
            record.notes.extend(note.clone());
            record
        })
    })))
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
            channel.len().min(arrays::LOOKED_AT),
        );
        arrays::rises(&samples.ok()?.volts())
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
    fn take(&mut self, count: usize) -> Result<Vec<Samples>, RecordError> {
        let (from, to) = (self.at, self.at + count);
        self.at = to;
        let Self {
            channels, opened, ..
        } = self;
        let taken: std::io::Result<Vec<Samples>> = channels
            .iter()
            .map(|channel| part(opened, channel, from, to))
            .collect();
        taken.map_err(|cause| RecordError::reading(&self.file, cause))
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

//! Streams of samples, cut into records.

use crate::records::error::{RecordError, name};
use crate::records::numbers::Number;
use crate::records::options::Parts;
use crate::records::record::{Channel, Record, Samples};
use std::io::Read;
use std::path::PathBuf;

/// Most samples of a channel in one record: 0.27 GB of `f64`.
pub(crate) const MOST_SAMPLES: usize = 1 << 25;

/// Samples of several channels that come one after the other.
pub(crate) trait Stream {
    /// The next `count` samples of every chosen channel.
    fn take(&mut self, count: usize) -> Result<Vec<Samples>, RecordError>;
}

/// What all records of a stream share.
#[derive(Clone, Debug)]
pub(crate) struct Head {
    pub file: PathBuf,
    /// Group or array in the file.
    pub part: Option<String>,
    pub names: Vec<String>,
    pub interval_s: f64,
    /// Samples of a channel, in all.
    pub total: usize,
    /// Samples of a channel in a row of a table, as long as all where there is but one.
    pub row: usize,
    /// Samples of a channel in a record.
    pub each: usize,
    /// Whether records are pieces of one recording and not shots.
    pub pieces: bool,
    /// What was taken for granted.
    pub note: Option<String>,
}

impl Head {
    /// Divides what would be one record. Pieces end where rows do; several rows are not
    /// divided into shots here, which are counted by row first.
    pub(super) fn divided(self, parts: Parts) -> Self {
        match parts {
            Parts::Shots(most) if self.row == self.total => Self {
                each: most.max(1),
                ..self
            },
            Parts::Pieces(most) => Self {
                each: most.clamp(1, self.row.max(1)),
                pieces: true,
                ..self
            },
            Parts::Shots(_) | Parts::Whole => self,
        }
    }

    /// Samples of what has a number of its own: a shot, or a row of which records are pieces.
    fn shot(&self) -> usize {
        if self.pieces { self.row } else { self.each }
    }

    /// Whether several shots come of it.
    fn several(&self) -> bool {
        self.total > self.shot()
    }

    /// Of the shot in which sample `start` lies, from 1.
    fn number(&self, start: usize) -> u64 {
        (start / self.shot().max(1)) as u64 + 1
    }

    fn source(&self, start: usize) -> String {
        let part = self
            .part
            .as_ref()
            .map_or(String::new(), |part| format!(", {part}"));
        let shot = match self.several() {
            true => format!(", shot {}", self.number(start)),
            false => String::new(),
        };
        let source = name(&self.file) + &part + &shot;
        from_sample(source, self.first_sample(start))
    }

    /// Of a piece in its row; shots begin anew.
    fn first_sample(&self, start: usize) -> u64 {
        match self.pieces {
            true => (start % self.row.max(1)) as u64,
            false => 0,
        }
    }

    /// The record of this stream that begins with sample `start`.
    pub(super) fn record(&self, start: usize, samples: Vec<Samples>) -> Record {
        let channels = self.names.iter().zip(samples);
        let channels = channels.map(|(name, samples)| Channel {
            name: name.clone(),
            samples,
        });
        Record {
            shot: self.several().then(|| self.number(start)),
            first_sample: self.first_sample(start),
            notes: self.note.iter().cloned().collect(),
            ..Record::new(
                self.source(start),
                &self.file,
                self.interval_s,
                channels.collect(),
            )
        }
    }
}

/// What a piece of a recording is called.
pub(crate) fn from_sample(source: String, first_sample: u64) -> String {
    match first_sample {
        0 => source,
        first => format!("{source}, from sample {} on", first + 1),
    }
}

/// An iterator over a stream's records.
pub(crate) struct Cut<S> {
    head: Head,
    stream: S,
    done: usize,
}

impl<S: Stream> Cut<S> {
    pub(super) fn new(head: Head, stream: S) -> Self {
        Self {
            head,
            stream,
            done: 0,
        }
    }
}

impl<S: Stream> Iterator for Cut<S> {
    type Item = Result<Record, RecordError>;

    fn next(&mut self) -> Option<Self::Item> {
        let start = self.done;
        let left = self.head.total.saturating_sub(start);
        let of_row = self.head.row - start % self.head.row.max(1);
        let count = left.min(of_row).min(self.head.each);
        if count == 0 {
            return None;
        }
        self.done += count;
        if count > MOST_SAMPLES {
            self.done = self.head.total;
            return Some(Err(RecordError::TooLong {
                source_name: self.head.source(start),
                most: MOST_SAMPLES,
            }));
        }
        let taken = self.stream.take(count);
        if taken.is_err() {
            self.done = self.head.total;
        }
        Some(taken.map(|samples| self.head.record(start, samples)))
    }
}

/// Raw numbers of several channels, sample by sample.
pub(crate) struct RawNumbers<R> {
    pub reader: R,
    pub file: PathBuf,
    pub number: Number,
    /// Channels that are stored.
    pub stored: usize,
    /// Those of them that are wanted.
    pub chosen: Vec<usize>,
}

impl<R: Read> Stream for RawNumbers<R> {
    fn take(&mut self, count: usize) -> Result<Vec<Samples>, RecordError> {
        let wide = self.number.width();
        let bytes = count
            .checked_mul(self.stored)
            .and_then(|n| n.checked_mul(wide));
        let bytes = bytes.filter(|bytes| *bytes <= MOST_SAMPLES * 8);
        let bytes = bytes.ok_or_else(|| RecordError::TooLong {
            source_name: name(&self.file),
            most: MOST_SAMPLES,
        })?;
        let mut raw = Vec::new();
        // Grows with what there is, whatever a damaged header promises.
        let mut limited = self.reader.by_ref().take(bytes as u64);
        let read = limited.read_to_end(&mut raw);
        let read = read.map_err(|cause| RecordError::reading(&self.file, cause))?;
        if read < bytes {
            return Err(RecordError::truncated(
                name(&self.file),
                format!("{read} of {bytes} bytes of a record"),
            ));
        }
        let one = |channel: &usize| self.number.samples(&raw, *channel, self.stored);
        Ok(self.chosen.iter().map(one).collect())
    }
}

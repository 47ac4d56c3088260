//! Arrays whose samples of one record do not lie side by side.

use super::place::Bytes;
use crate::records::cut::{Head, RawNumbers, Stream};
use crate::records::error::RecordError;
use crate::records::read::Raw;
use crate::records::record::Samples;

/// Channels of which each is stored in one stretch a shot, with a place in the file for each.
pub(super) struct Planes {
    /// One that begins with its own first sample for each channel.
    pub channels: Vec<RawNumbers<Bytes>>,
    /// Bytes from the end of one's stretch to where its next one begins.
    pub between: u64,
    /// Samples of a stretch.
    pub frames: usize,
    /// Samples that are read.
    pub at: usize,
}

impl Stream for Planes {
    fn take(&mut self, count: usize) -> Result<Vec<Samples>, RecordError> {
        let between = match self.at {
            at if at > 0 && at % self.frames == 0 => self.between,
            _ => 0,
        };
        self.at += count;
        let mut taken = Vec::new();
        for channel in &mut self.channels {
            let skipped = channel.reader.skip(between);
            skipped.map_err(|cause| RecordError::reading(&channel.file, cause))?;
            taken.extend(channel.take(count)?);
        }
        Ok(taken)
    }
}

/// Opens an array's numbers from the first on, to read one of the shots that alternate.
pub(super) type Pass = Box<dyn Fn(usize) -> Result<RawNumbers<Bytes>, RecordError>>;

/// Shots whose samples alternate, too many to be held: the file is gone through for each.
pub(super) struct Passes {
    pub open: Pass,
    /// How many shots.
    pub shots: usize,
    /// Samples of a shot.
    pub frames: usize,
    /// Samples that are read, of one shot after the other.
    pub at: usize,
    pub under_way: Option<RawNumbers<Bytes>>,
}

/// Numbers of all shots that are read at a time.
const BLOCK: usize = 1 << 22;

impl Stream for Passes {
    fn take(&mut self, count: usize) -> Result<Vec<Samples>, RecordError> {
        let mut shot = match self.under_way.take() {
            Some(shot) if !self.at.is_multiple_of(self.frames) => shot,
            _ => (self.open)(self.at / self.frames)?,
        };
        let block = (BLOCK / self.shots).max(1);
        let mut all: Option<Samples> = None;
        for start in (0..count).step_by(block) {
            for part in shot.take(block.min(count - start))? {
                match &mut all {
                    Some(all) => all.append(&part, 0, part.len()),
                    None => all = Some(part),
                }
            }
        }
        self.at += count;
        self.under_way = Some(shot);
        Ok(all.into_iter().collect())
    }
}

/// Shots whose samples alternate, read together.
pub(super) fn side_by_side(head: Head, mut stream: RawNumbers<Bytes>) -> Raw {
    let shots = match stream.take(head.each) {
        Ok(shots) => shots,
        Err(error) => return Box::new(std::iter::once(Err(error))),
    };
    let record = move |(row, samples)| Ok(head.record(row * head.row, vec![samples]));
    Box::new(shots.into_iter().enumerate().map(record))
}

//! Where each channel's samples are: all segments' metadata, no samples.

use super::bytes::{Bytes, Property, TEXT, kind, width};
use super::lead::{LEAD, Lead};
use crate::error::{RecordError, name};
use crate::numbers::Number;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// Most bytes of metadata in one segment.
const MOST_METADATA: u64 = 1 << 28;

/// Equal runs of samples, one a chunk.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// Of the first sample, from the file's beginning.
    pub offset: u64,
    /// Samples a chunk.
    pub count: usize,
    /// Bytes from a sample to the next.
    pub stride: usize,
    pub chunks: usize,
    /// Bytes from a chunk to the next.
    pub chunk_bytes: usize,
}

/// A channel of numbers.
#[derive(Clone, Debug)]
pub(super) struct Channel {
    pub name: String,
    pub number: Number,
    /// Sampling interval in s, if its properties say.
    pub interval_s: Option<f64>,
    pub pieces: Vec<Piece>,
}

impl Channel {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.pieces
            .iter()
            .map(|piece| piece.count * piece.chunks)
            .sum()
    }
}

/// A file's groups with their channels, and whether it ends before its end.
pub(super) struct Index {
    pub groups: Vec<(String, Vec<Channel>)>,
    pub cut_short: Option<String>,
}

/// An object as the list of a segment holds it.
#[derive(Clone, Debug)]
struct Object {
    path: String,
    /// Type, values a chunk and bytes a chunk, of one with samples.
    raw: Option<(u32, usize, usize)>,
}

/// The state while segments are read.
struct Walk {
    objects: Vec<Object>,
    /// Last known layout of objects that had samples once.
    known: Vec<Object>,
    groups: Vec<(String, Vec<Channel>)>,
}

impl Index {
    /// Reads all metadata of a file.
    pub fn of(file: &Path) -> Result<Self, RecordError> {
        let reading = |cause| RecordError::reading(file, cause);
        let mut opened = File::open(file).map_err(reading)?;
        let length = opened.metadata().map_err(reading)?.len();
        let mut walk = Walk {
            objects: Vec::new(),
            known: Vec::new(),
            groups: Vec::new(),
        };
        let mut at = 0;
        let mut cut_short = None;
        while at < length && cut_short.is_none() {
            let lead = bytes(&mut opened, at, LEAD as u64).map_err(reading)?;
            let Some(lead) = Lead::of(&lead) else {
                cut_short = Some(format!("no segment begins at byte {at}"));
                break;
            };
            let begin = at + LEAD as u64;
            let end = begin.checked_add(lead.next).filter(|end| *end <= length);
            if end.is_none() {
                cut_short = Some(format!("the segment at byte {at} was never completed"));
            }
            let end = end.unwrap_or(length);
            let raw = begin.saturating_add(lead.raw).min(end);
            if lead.has_metadata() {
                let size = (raw - begin).min(MOST_METADATA);
                let metadata = bytes(&mut opened, begin, size).map_err(reading)?;
                if walk.metadata(&lead, &metadata).is_none() {
                    let detail = format!("the segment at byte {at} has metadata it cannot have");
                    return Err(RecordError::malformed(file, "TDMS", detail));
                }
            }
            if lead.has_samples() && lead.is_unscaled() {
                let detail = "it holds raw data of DAQmx; export it with scaled values";
                return Err(RecordError::malformed(file, "TDMS", detail));
            }
            if lead.has_samples() {
                walk.samples(&lead, raw, end);
            }
            at = end;
        }
        if walk.groups.is_empty()
            && let Some(detail) = cut_short
        {
            return Err(RecordError::truncated(name(file), detail));
        }
        walk.groups
            .iter_mut()
            .for_each(|group| group.1.retain(|channel| channel.len() > 0));
        walk.groups.retain(|group| !group.1.is_empty());
        Ok(Self {
            groups: walk.groups,
            cut_short,
        })
    }
}

fn bytes(opened: &mut File, at: u64, count: u64) -> std::io::Result<Vec<u8>> {
    opened.seek(SeekFrom::Start(at))?;
    let mut bytes = Vec::new();
    opened.by_ref().take(count).read_to_end(&mut bytes)?;
    Ok(bytes)
}

impl Walk {
    /// One segment's list of objects; `None` if it is cut short.
    fn metadata(&mut self, lead: &Lead, metadata: &[u8]) -> Option<()> {
        let mut bytes = Bytes {
            left: metadata,
            big_endian: lead.is_big_endian(),
        };
        if lead.has_new_list() {
            self.objects.clear();
        }
        for _ in 0..bytes.u32()? {
            let path = bytes.text()?;
            let object = self.object(&mut bytes, path)?;
            let mut properties = Vec::new();
            for _ in 0..bytes.u32()? {
                properties.push(bytes.property()?);
            }
            self.describe(&object, lead.is_big_endian(), &properties);
            self.list(object);
        }
        Some(())
    }

    /// Where an object's samples are: none, as before, or told now.
    fn object(&self, bytes: &mut Bytes<'_>, path: String) -> Option<Object> {
        let raw = match bytes.u32()? {
            u32::MAX => None,
            0 => {
                let before = self.known.iter().find(|known| known.path == path);
                before.and_then(|known| known.raw)
            }
            // Those of DAQmx, whose segments are refused by their flags.
            0x6912_0000 | 0x6912_6900 | 0x6913_0000 | 0x6913_6900 => {
                return self.daqmx(bytes, path);
            }
            _ => {
                let code = bytes.u32()?;
                let _dimension = bytes.u32()?;
                let count = usize::try_from(bytes.u64()?).ok()?;
                let size = match code {
                    TEXT => usize::try_from(bytes.u64()?).ok()?,
                    _ => count.checked_mul(width(code)?)?,
                };
                Some((code, count, size))
            }
        };
        Some(Object { path, raw })
    }

    /// Skips the layout of DAQmx' raw data.
    fn daqmx(&self, bytes: &mut Bytes<'_>, path: String) -> Option<Object> {
        bytes.take(4 + 4 + 8)?;
        let scalers = bytes.u32()? as usize;
        bytes.take(scalers.checked_mul(20)?)?;
        let widths = bytes.u32()? as usize;
        bytes.take(widths.checked_mul(4)?)?;
        Some(Object { path, raw: None })
    }

    fn list(&mut self, object: Object) {
        for list in [&mut self.objects, &mut self.known] {
            match list.iter_mut().find(|listed| listed.path == object.path) {
                Some(listed) => *listed = object.clone(),
                None => list.push(object.clone()),
            }
        }
    }

    /// Keeps what a channel's properties say.
    fn describe(&mut self, object: &Object, big_endian: bool, properties: &[(String, Property)]) {
        let code = object.raw.map(|raw| raw.0);
        let Some(channel) = self.channel(&object.path, code, big_endian) else {
            return;
        };
        let number = |wanted: &str| {
            properties.iter().find_map(|(name, value)| match value {
                Property::Number(number) if name == wanted => Some(*number),
                _ => None,
            })
        };
        let linear = properties.iter().any(|(name, value)| {
            name == "NI_Scale[0]_Scale_Type" && *value == Property::Text("Linear".to_owned())
        });
        if let Some(interval_s) = number("wf_increment") {
            channel.interval_s = Some(interval_s);
        }
        if linear {
            let slope = number("NI_Scale[0]_Linear_Slope");
            channel.number.scale = slope.unwrap_or(channel.number.scale);
            let offset = number("NI_Scale[0]_Linear_Y_Intercept");
            channel.number.offset = offset.unwrap_or(channel.number.offset);
        }
    }

    /// The channel of a path like `/'group'/'channel'`, if it has numbers.
    fn channel(&mut self, path: &str, code: Option<u32>, big: bool) -> Option<&mut Channel> {
        let (group, name) = parts(path)?;
        let at = self.groups.iter().position(|known| known.0 == group);
        let at = at.unwrap_or_else(|| {
            self.groups.push((group, Vec::new()));
            self.groups.len() - 1
        });
        let channels = &mut self.groups.get_mut(at)?.1;
        let known = channels.iter().position(|channel| channel.name == name);
        let index = match (known, code.and_then(kind)) {
            (Some(index), _) => index,
            (None, None) => return None,
            (None, Some(kind)) => {
                channels.push(Channel {
                    name,
                    number: Number::plain(kind, big),
                    interval_s: None,
                    pieces: Vec::new(),
                });
                channels.len() - 1
            }
        };
        channels.get_mut(index)
    }

    /// Where the samples of one segment are.
    fn samples(&mut self, lead: &Lead, raw: u64, end: u64) {
        let with = self
            .objects
            .iter()
            .filter_map(|object| Some((object.path.clone(), object.raw?)));
        let with: Vec<(String, (u32, usize, usize))> = with.collect();
        let sizes = with.iter().map(|object| object.1.2);
        let chunk_bytes = sizes.fold(0, usize::saturating_add);
        if chunk_bytes == 0 {
            return;
        }
        let room = usize::try_from(end - raw).unwrap_or(usize::MAX);
        let chunks = room / chunk_bytes;
        let row: usize = with.iter().filter_map(|object| width(object.1.0)).sum();
        let (mut offset, big) = (raw, lead.is_big_endian());
        for (path, (code, count, size)) in with {
            let wide = width(code).unwrap_or(0);
            let stride = if lead.is_interleaved() { row } else { wide };
            if count > 0
                && let Some(channel) = self.channel(&path, Some(code), big)
            {
                channel.pieces.push(Piece {
                    offset,
                    count,
                    stride,
                    chunks,
                    chunk_bytes,
                });
            }
            let next = if lead.is_interleaved() { wide } else { size };
            offset = offset.saturating_add(next as u64);
        }
    }
}

/// Group and channel of a path; quotes inside a name are doubled.
fn parts(path: &str) -> Option<(String, String)> {
    let inner = path.strip_prefix("/'")?.strip_suffix('\'')?;
    let (group, channel) = inner.split_once("'/'")?;
    Some((group.replace("''", "'"), channel.replace("''", "'")))
}

//! Where each channel's samples are: all segments' metadata, no samples.

use super::metadata::{
    ANALOGUE, Bytes, DIGITAL, LEAD, Layout, Lead, Property, TEXT, cards, kind, width,
};
use super::scaling::{Properties, polynomial};
use crate::error::{MeasureError, file_name};
use crate::records::stream::Number;
use std::collections::HashMap;
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
    pub properties: Properties,
    /// Powers of a stored number that make volts, where slope and offset do not.
    pub powers: Vec<f64>,
    pub pieces: Vec<Piece>,
}

impl Channel {
    /// Sampling interval in s, if its properties say.
    pub(super) fn interval_s(&self) -> Option<f64> {
        match self.properties.get("wf_increment") {
            Some(Property::Number(number)) => Some(*number),
            _ => None,
        }
    }

    /// Takes its scales from its properties.
    ///
    /// # Errors
    /// What a scale is that is not known here.
    pub(super) fn scaled(mut self) -> Result<Self, String> {
        let powers = polynomial(&self.properties)?;
        match powers.as_slice() {
            [] => {}
            [offset] => (self.number.offset, self.number.scale) = (*offset, 0.0),
            [offset, slope] => (self.number.offset, self.number.scale) = (*offset, *slope),
            _ => self.powers = powers,
        }
        Ok(self)
    }

    /// Number of samples.
    pub(super) fn len(&self) -> usize {
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
    raw: Option<Values>,
}

/// Where the values of an object are in a chunk.
#[derive(Clone, Debug)]
enum Values {
    /// Type, number and bytes of them: one object's after the other's, or row by row.
    Own(u32, usize, usize),
    /// In the rows of a DAQ card.
    Card(Layout),
}

impl Values {
    fn code(&self) -> u32 {
        match self {
            Self::Own(code, ..) => *code,
            Self::Card(layout) => layout.code,
        }
    }
}

/// Objects in the order in which they came, each found by its path.
#[derive(Default)]
struct Objects {
    list: Vec<Object>,
    places: HashMap<String, usize>,
}

impl Objects {
    fn put(&mut self, object: Object) {
        match self.places.get(&object.path) {
            Some(at) => self.list[*at] = object,
            None => {
                self.places.insert(object.path.clone(), self.list.len());
                self.list.push(object);
            }
        }
    }

    fn get(&self, path: &str) -> Option<&Object> {
        self.places.get(path).and_then(|at| self.list.get(*at))
    }
}

/// Most objects of all segments together: a day of a hundred channels, a segment a second.
const MOST_OBJECTS: usize = 1 << 23;

/// The state while segments are read.
#[derive(Default)]
struct Walk {
    objects: Objects,
    /// Last known layout of objects that had samples once.
    known: Objects,
    groups: Vec<(String, Vec<Channel>)>,
    /// Places of groups by their names, and of channels in them by both.
    group_places: HashMap<String, usize>,
    channel_places: HashMap<(usize, String), usize>,
    /// Objects of the segments so far.
    seen: usize,
}

impl Index {
    /// Reads all metadata of a file.
    pub(super) fn of(file: &Path) -> Result<Self, MeasureError> {
        let reading = |cause| MeasureError::reading(file, cause);
        let mut opened = File::open(file).map_err(reading)?;
        let length = opened.metadata().map_err(reading)?.len();
        let mut walk = Walk::default();
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
            if lead.has_metadata {
                let size = (raw - begin).min(MOST_METADATA);
                let metadata = bytes(&mut opened, begin, size).map_err(reading)?;
                if walk.metadata(&lead, &metadata).is_none() {
                    let detail = format!("the segment at byte {at} has metadata it cannot have");
                    return Err(MeasureError::malformed(file, "TDMS", detail));
                }
            }
            if lead.has_samples {
                walk.samples(&lead, raw, end);
            }
            walk.seen = walk.seen.saturating_add(walk.objects.list.len());
            if walk.seen > MOST_OBJECTS {
                let detail = format!(
                    "its segments list more than {MOST_OBJECTS} channels in all; defragment it, or \
                     export parts of it"
                );
                return Err(MeasureError::malformed(file, "TDMS", detail));
            }
            at = end;
        }
        if walk.groups.is_empty()
            && let Some(detail) = cut_short
        {
            return Err(MeasureError::truncated(file_name(file), detail));
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
            big_endian: lead.is_big_endian,
        };
        if lead.has_new_list {
            self.objects = Objects::default();
        }
        for _ in 0..bytes.u32()? {
            let path = bytes.text()?;
            let object = self.object(&mut bytes, path)?;
            let mut properties = Vec::new();
            for _ in 0..bytes.u32()? {
                properties.push(bytes.property()?);
            }
            let code = object.raw.as_ref().map(Values::code);
            if let Some(channel) = self.channel(&object.path, code, lead.is_big_endian) {
                channel.properties.extend(properties);
            }
            self.objects.put(object.clone());
            self.known.put(object);
        }
        Some(())
    }

    /// Where an object's samples are: none, as before, or stated now.
    fn object(&self, bytes: &mut Bytes<'_>, path: String) -> Option<Object> {
        let raw = match bytes.u32()? {
            u32::MAX => None,
            0 => {
                let before = self.known.get(&path);
                before.and_then(|known| known.raw.clone())
            }
            kind @ (ANALOGUE | DIGITAL) => Some(Values::Card(Layout::of(bytes, kind)?)),
            _ => {
                let code = bytes.u32()?;
                let _dimension = bytes.u32()?;
                let count = usize::try_from(bytes.u64()?).ok()?;
                let size = match code {
                    TEXT => usize::try_from(bytes.u64()?).ok()?,
                    _ => count.checked_mul(width(code)?)?,
                };
                Some(Values::Own(code, count, size))
            }
        };
        Some(Object { path, raw })
    }

    /// The channel of a path like `/'group'/'channel'`, if it has numbers.
    fn channel(&mut self, path: &str, code: Option<u32>, big: bool) -> Option<&mut Channel> {
        let (group, name) = parts(path)?;
        let at = self.group_places.get(&group).copied();
        let at = at.unwrap_or_else(|| {
            self.group_places.insert(group.clone(), self.groups.len());
            self.groups.push((group, Vec::new()));
            self.groups.len() - 1
        });
        let channels = &mut self.groups.get_mut(at)?.1;
        let place = (at, name);
        let known = self.channel_places.get(&place).copied();
        let index = match (known, code.and_then(kind)) {
            (Some(index), _) => index,
            (None, None) => return None,
            (None, Some(kind)) => {
                channels.push(Channel {
                    name: place.1.clone(),
                    number: Number::plain(kind, big),
                    properties: Properties::new(),
                    powers: Vec::new(),
                    pieces: Vec::new(),
                });
                self.channel_places.insert(place, channels.len() - 1);
                channels.len() - 1
            }
        };
        channels.get_mut(index)
    }

    /// Where the samples of one segment are.
    fn samples(&mut self, lead: &Lead, raw: u64, end: u64) {
        if end <= raw {
            return;
        }
        let objects = self.objects.list.iter();
        let with = objects.filter_map(|object| Some((object.path.clone(), object.raw.clone()?)));
        let with: Vec<(String, Values)> = with.collect();
        let (places, chunk_bytes) = match lead.is_of_cards {
            true => of_cards(&with),
            false => of_objects(&with, lead.is_interleaved),
        };
        if chunk_bytes == 0 {
            return;
        }
        let room = usize::try_from(end - raw).unwrap_or(usize::MAX);
        for place in places.into_iter().filter(|place| place.count > 0) {
            let code = Some(place.code);
            if let Some(channel) = self.channel(place.path, code, lead.is_big_endian) {
                channel.pieces.push(Piece {
                    offset: raw.saturating_add(place.begin as u64),
                    count: place.count,
                    stride: place.stride,
                    chunks: room / chunk_bytes,
                    chunk_bytes,
                });
            }
        }
    }
}

/// A channel's place in every chunk of a segment.
struct Place<'a> {
    path: &'a str,
    code: u32,
    /// Bytes before its first value.
    begin: usize,
    count: usize,
    stride: usize,
}

/// Places of objects one after the other, or row by row, and the bytes of a chunk.
fn of_objects(with: &[(String, Values)], rows: bool) -> (Vec<Place<'_>>, usize) {
    let own = with.iter().filter_map(|(path, values)| match values {
        Values::Own(code, count, size) => Some((path, *code, *count, *size)),
        Values::Card(_) => None,
    });
    let row: usize = own.clone().filter_map(|own| width(own.1)).sum();
    let (mut places, mut begin, mut chunk_bytes) = (Vec::new(), 0_usize, 0_usize);
    for (path, code, count, size) in own {
        let wide = width(code).unwrap_or(0);
        places.push(Place {
            path,
            code,
            begin,
            count,
            stride: if rows { row } else { wide },
        });
        begin = begin.saturating_add(if rows { wide } else { size });
        chunk_bytes = chunk_bytes.saturating_add(size);
    }
    (places, chunk_bytes)
}

/// Places of channels in the rows of DAQ cards, and the bytes of a chunk.
fn of_cards(with: &[(String, Values)]) -> (Vec<Place<'_>>, usize) {
    let own = with.iter().filter_map(|(path, values)| match values {
        Values::Card(layout) => Some((path.as_str(), layout)),
        Values::Own(..) => None,
    });
    let layouts: Vec<&Layout> = own.clone().map(|(_, layout)| layout).collect();
    let (begins, chunk_bytes) = cards(&layouts);
    let places = own.filter_map(|(path, layout)| in_row(path, layout, &begins));
    (places.collect(), chunk_bytes)
}

/// Place of a channel in its card's rows; none of one that is beyond them.
fn in_row<'a>(path: &'a str, layout: &Layout, begins: &[usize]) -> Option<Place<'a>> {
    let stride = *layout.rows.get(layout.card)?;
    let end = layout.within.checked_add(width(layout.code)?)?;
    (end <= stride).then_some(Place {
        path,
        code: layout.code,
        begin: begins.get(layout.card)?.saturating_add(layout.within),
        count: layout.count,
        stride,
    })
}

/// Group and channel of a path; quotes inside a name are doubled.
fn parts(path: &str) -> Option<(String, String)> {
    let inner = path.strip_prefix("/'")?.strip_suffix('\'')?;
    let (group, channel) = inner.split_once("'/'")?;
    Some((group.replace("''", "'"), channel.replace("''", "'")))
}

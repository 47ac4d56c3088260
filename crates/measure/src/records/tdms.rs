//! LabVIEW's TDMS. Written here: tdms-rs reads neither interleaved channels nor several chunks a
//! segment, which most of LabVIEW's files have.

use crate::error::{MeasureError, Result, file_name};
use crate::records::arrays;
use crate::records::interval::{interval_s, seconds_assumed};
use crate::records::options::{ReadOptions, chosen};
use crate::records::read::{Raw, or_error};
use crate::records::stored::{
    Head, HeaderBytes, NumberKind, SampleRuns, StoredChannel, StoredNumber,
};
use crate::records::text::{seconds, volts};
use crate::signal::extremes;
use indexmap::IndexMap;
use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// Opens a TDMS file: every group with samples is a record, or several if it is to be cut.
pub(crate) fn open(file: &Path, options: &ReadOptions) -> Result<Raw> {
    let (groups, cut_short) = index(file)?;
    if groups.is_empty() && cut_short.is_none() {
        return Err(MeasureError::empty(file_name(file)));
    }
    let several = groups.len() > 1;
    let mut records: Vec<Raw> = Vec::new();
    for (number, (group, channels)) in (1..).zip(groups) {
        let opened = or_error(open_group(file, group, channels, options));
        records.push(Box::new(opened.map(move |record| {
            let mut record = record?;
            record.shot = record.shot.or(several.then_some(number));
            Ok(record)
        })));
    }
    let file = file_name(file);
    let end = cut_short.map(|detail| Err(MeasureError::truncated(file, detail)));
    Ok(Box::new(records.into_iter().flatten().chain(end)))
}

fn open_group(
    file: &Path,
    group: String,
    mut channels: Channels,
    options: &ReadOptions,
) -> Result<Raw> {
    let reading = |cause| MeasureError::reading(file, cause);
    let mut opened = File::open(file).map_err(reading)?;
    let times = times(&mut opened, &channels, options);
    let unit_s = |(name, of): (&String, &TdmsChannel)| Some((name.clone(), seconds(of.unit()?)?));
    let units: HashMap<String, f64> = channels.iter().filter_map(unit_s).collect();
    if let Some((name, _)) = times.as_ref().filter(|_| options.channels.is_empty()) {
        channels.shift_remove(name);
    }
    let names: Vec<String> = channels.keys().cloned().collect();
    let picked = chosen(file, &names, options)?;
    let names: Vec<String> = picked.iter().map(|at| names[*at].clone()).collect();
    let scaled = |name: &String| {
        channels[name].scaled().map_err(|scale| {
            let detail = format!("{name:?} has {scale}; export it with scaled values");
            MeasureError::malformed(file, "TDMS", detail)
        })
    };
    let stored: Vec<StoredChannel> = names.iter().map(scaled).collect::<Result<_, _>>()?;
    let source = format!("{}, {group}", file_name(file));
    let frames = stored.first().map_or(0, StoredChannel::len);
    if frames == 0 {
        return Err(MeasureError::empty(source));
    }
    if let Some(other) = stored.iter().find(|channel| channel.len() != frames) {
        let why = "as in its first channel";
        return Err(MeasureError::lengths(source, other.len(), frames, why));
    }
    let stated = |property: &str| -> Vec<f64> {
        names.iter().filter_map(|name| channels[name].number(property)).collect()
    };
    let (starts, stated_s) = (
        extremes(&stated("wf_start_offset")),
        arrays::one_interval(file, stated("wf_increment"), options)?,
    );
    let own = times.filter(|_| stated_s.is_none()).and_then(|(name, step)| {
        let unit_s = units.get(&name).copied();
        let step_s = unit_s.map(|unit| unit * step).or_else(|| arrays::step_s(step, options));
        Some((step_s?, seconds_assumed(&name, unit_s, options)))
    });
    let (own_s, note) = own.map_or((None, None), |(step_s, note)| (Some(step_s), note));
    let interval_s = interval_s(file, stated_s.or(own_s), options)?;
    let apart_s = starts.1 - starts.0;
    let apart = (apart_s > 0.5 * interval_s).then(|| {
        let apart_us = 1e6 * apart_s;
        format!(
            "its channels begin {apart_us:.3} µs apart (wf_start_offset), and are taken as if they began together; \
             --skew takes a delay of the wall's out"
        )
    });
    let head = Head {
        file: file.to_owned(),
        part: Some(group),
        names,
        interval_s,
        rows: 1,
        frames,
        note: note.or(apart),
    };
    Ok(head.stored(options.parts, opened, stored, 0))
}

/// Name and step of a channel that rises evenly, as times do and no signal, of several. One that
/// is chosen by name is none.
fn times(opened: &mut File, channels: &Channels, options: &ReadOptions) -> Option<(String, f64)> {
    let several = channels.len() > 1;
    let mut free = channels.iter();
    free.find_map(|(name, channel)| {
        let is_free = several && !options.channels.contains(name);
        let stored = channel.scaled().ok().filter(|_| is_free)?;
        let seen = stored.len().min(arrays::TIMES_SEEN);
        let samples = stored.read(opened, 0, 0..seen).ok()?;
        Some((name.clone(), arrays::even_step(&samples)?))
    })
}

type Channels = IndexMap<String, TdmsChannel>;
type Groups = IndexMap<String, Channels>;

struct TdmsChannel {
    stored: StoredChannel,
    properties: HashMap<String, Property>,
}

#[derive(Clone, Debug, PartialEq)]
enum Property {
    Number(f64),
    Text(String),
    Other,
}

/// Input of a scale that takes the stored numbers: no scale's number.
const STORED: f64 = u32::MAX as f64;
/// Most scales in a row that are followed, as they may go in circles; highest power of one.
const MOST_SCALES: usize = 16;
const HIGHEST: usize = 16;

impl TdmsChannel {
    fn number(&self, name: &str) -> Option<f64> {
        match self.properties.get(name) {
            Some(Property::Number(number)) => Some(*number),
            _ => None,
        }
    }

    fn unit(&self) -> Option<&str> {
        match self.properties.get("unit_string") {
            Some(Property::Text(unit)) => Some(unit),
            _ => None,
        }
    }

    /// The stored numbers with the scales that make volts of them; what a scale is that is not
    /// known here.
    fn scaled(&self) -> Result<StoredChannel, String> {
        let mut stored = self.stored.clone();
        let mut scales = self.scales()?;
        scales.extend(self.unit().and_then(volts).map(|unit| vec![0.0, unit]));
        if scales.iter().any(|powers| powers.len() > 2) {
            stored.scales = scales;
            return Ok(stored);
        }
        for powers in scales {
            let (level, slope) = (powers[0], powers.get(1).copied().unwrap_or(0.0));
            stored.number.offset = level + slope * stored.number.offset;
            stored.number.scale *= slope;
        }
        Ok(stored)
    }

    /// Coefficients of polynomials, the first of the stored numbers, each later one of what the one
    /// before returns. None where numbers are volts; a scale that the properties do not describe
    /// takes numbers as the card returned them.
    fn scales(&self) -> Result<Vec<Vec<f64>>, String> {
        let mut scales = Vec::new();
        if self.properties.get("NI_Scaling_Status") == Some(&Property::Text("scaled".to_owned())) {
            return Ok(scales);
        }
        let there = |at: &usize| {
            let kind = format!("NI_Scale[{at}]_Scale_Type");
            self.properties.contains_key(&kind)
        };
        let found = (0..MOST_SCALES).rev().find(there).map(|at| at as f64);
        let stated = self.number("NI_Number_Of_Scales").map(|count| count - 1.0);
        let mut at = stated.or(found).unwrap_or(STORED);
        while let Some((powers, input)) = self.scale(at)? {
            scales.insert(0, powers);
            at = input;
            if scales.len() > MOST_SCALES {
                return Err("scales that go in circles".to_owned());
            }
        }
        Ok(scales)
    }

    /// Coefficients of a scale and the number of its input, if it is described.
    fn scale(&self, at: f64) -> Result<Option<(Vec<f64>, f64)>, String> {
        let prefix = format!("NI_Scale[{at}]");
        let kind = match self.properties.get(&format!("{prefix}_Scale_Type")) {
            None => return Ok(None),
            Some(Property::Text(kind)) => kind.as_str(),
            Some(_) => "",
        };
        let of = |what: &str| self.number(&format!("{prefix}_{kind}_{what}"));
        let powers: Option<Vec<f64>> = match kind {
            "Linear" => of("Y_Intercept").zip(of("Slope")).map(|(a, b)| vec![a, b]),
            "Polynomial" => {
                let count = of("Coefficients_Size").unwrap_or(4.0) as usize;
                let power = |at| of(&format!("Coefficients[{at}]"));
                (0..count.min(HIGHEST)).map(power).collect()
            }
            _ => None,
        };
        let powers = powers.filter(|powers| !powers.is_empty());
        let powers = powers.ok_or_else(|| format!("a scale of the kind {kind:?}"))?;
        Ok(Some((powers, of("Input_Source").unwrap_or(STORED))))
    }
}

const LEAD: u64 = 28;
const MOST_METADATA: u64 = 1 << 28;
/// Most objects of all segments together: a day of a hundred channels, a segment a second.
const MOST_OBJECTS: usize = 1 << 23;

const METADATA: u32 = 1 << 1;
const NEW_LIST: u32 = 1 << 2;
const SAMPLES: u32 = 1 << 3;
const INTERLEAVED: u32 = 1 << 5;
const BIG_ENDIAN: u32 = 1 << 6;
const CARDS: u32 = 1 << 7;

/// In place of an index's length: readings of a DAQ card's inputs, and its lines.
const ANALOGUE: u32 = 0x1269;
const DIGITAL: u32 = 0x126a;

/// Type of texts, and of lines of a port, which are no voltages.
const TEXT: u32 = 0x20;
const NO_TYPE: u32 = u32::MAX;
/// Types of a DAQ card's readings as LabVIEW numbers them elsewhere, by their number here.
const CARD_TYPES: [u32; 10] = [5, 1, 6, 2, 7, 3, 8, 4, 9, 10];

fn kind(code: u32) -> Option<NumberKind> {
    Some(match code {
        1 => NumberKind::I8,
        2 => NumberKind::I16,
        3 => NumberKind::I32,
        4 => NumberKind::I64,
        5 => NumberKind::U8,
        6 => NumberKind::U16,
        7 => NumberKind::U32,
        8 => NumberKind::U64,
        9 | 0x19 => NumberKind::F32,
        10 | 0x1a => NumberKind::F64,
        _ => return None,
    })
}

fn width(code: u32) -> Option<usize> {
    match (kind(code), code) {
        (Some(kind), _) => Some(StoredNumber::plain(kind, false).width()),
        (None, 0x21) => Some(1),
        (None, 0x44 | 0x10_000d) => Some(16),
        (None, 0x08_000c) => Some(8),
        _ => None,
    }
}

impl HeaderBytes<'_> {
    fn text(&mut self) -> Option<String> {
        let length = self.u32()? as usize;
        let bytes = self.take(length)?;
        Some(String::from_utf8_lossy(bytes).into_owned())
    }

    fn property(&mut self) -> Option<(String, Property)> {
        let (name, code) = (self.text()?, self.u32()?);
        if code == TEXT {
            return Some((name, Property::Text(self.text()?)));
        }
        let raw = self.take(width(code)?)?;
        let value = kind(code).and_then(|kind| {
            let number = StoredNumber::plain(kind, self.big_endian);
            number.scaled(raw).first().copied()
        });
        Some((name, value.map_or(Property::Other, Property::Number)))
    }
}

#[derive(Clone)]
enum Values {
    /// Type, number and bytes of them: one object's after the other's, or row by row.
    Own(u32, usize, usize),
    Card(Card),
}

/// Where a channel's readings are within a chunk of rows of all a DAQ card's readings.
#[derive(Clone)]
struct Card {
    /// Type of a reading, as LabVIEW numbers it.
    code: u32,
    count: usize,
    /// Which card, and bytes before the reading in a row of it.
    card: usize,
    within: usize,
    rows: Vec<usize>,
}

impl Values {
    fn code(&self) -> u32 {
        match self {
            Self::Own(code, ..) | Self::Card(Card { code, .. }) => *code,
        }
    }
}

impl Card {
    /// The layout after an index's `kind`; `None` if it is not one.
    fn parse(bytes: &mut HeaderBytes<'_>, kind: u32) -> Option<Self> {
        let (_type, _dimension) = (bytes.u32()?, bytes.u32()?);
        let count = bytes.size()?;
        let mut first = None;
        for _ in 0..bytes.u32()? {
            let code = bytes.u32()?;
            let (card, within) = (bytes.u32()? as usize, bytes.u32()? as usize);
            bytes.take(if kind == DIGITAL { 1 } else { 4 })?;
            let _scale = bytes.u32()?;
            let code = match kind {
                ANALOGUE => CARD_TYPES.get(code as usize).copied()?,
                _ => NO_TYPE,
            };
            first = first.or(Some((code, card, within)));
        }
        let (code, card, within) = first?;
        let cards = bytes.u32()?;
        let rows = (0..cards).map(|_| bytes.u32().map(|row| row as usize));
        Some(Self { code, count, card, within, rows: rows.collect::<Option<_>>()? })
    }
}

#[derive(Default)]
struct TdmsWalk {
    objects: IndexMap<String, Option<Values>>,
    /// The last layout of each object so far.
    known: HashMap<String, Option<Values>>,
    groups: Groups,
}

struct Lead {
    flags: u32,
    /// Bytes of metadata and samples, as many as there are if the file was not closed; and of
    /// metadata.
    next: u64,
    metadata: u64,
}

impl Lead {
    fn parse(bytes: &[u8]) -> Option<Self> {
        let mut bytes = HeaderBytes { left: bytes.strip_prefix(b"TDSm")?, big_endian: false };
        let flags = bytes.u32()?;
        bytes.big_endian = flags & BIG_ENDIAN != 0;
        let _version = bytes.u32()?;
        Some(Self { flags, next: bytes.u64()?, metadata: bytes.u64()? })
    }

    fn has(&self, flag: u32) -> bool {
        self.flags & flag != 0
    }
}

/// Where each channel's samples are, by group, from all segments' metadata; and why the file ends
/// before its end, if it does.
fn index(file: &Path) -> Result<(Groups, Option<String>)> {
    let reading = |cause| MeasureError::reading(file, cause);
    let malformed = |detail: String| MeasureError::malformed(file, "TDMS", detail);
    let mut opened = File::open(file).map_err(reading)?;
    let length = opened.metadata().map_err(reading)?.len();
    let (mut walk, mut at, mut seen) = (TdmsWalk::default(), 0, 0_usize);
    let mut cut_short = None;
    while at < length && cut_short.is_none() {
        let lead = read_at(&mut opened, at, LEAD).map_err(reading)?;
        let Some(lead) = Lead::parse(&lead) else {
            cut_short = Some(format!("no segment begins at byte {at}"));
            break;
        };
        let begin = at + LEAD;
        let end = begin.checked_add(lead.next).filter(|end| *end <= length);
        if end.is_none() {
            cut_short = Some(format!("the segment at byte {at} was never completed"));
        }
        let end = end.unwrap_or(length);
        let raw = begin.saturating_add(lead.metadata).min(end);
        if lead.has(METADATA) {
            let size = (raw - begin).min(MOST_METADATA);
            let metadata = read_at(&mut opened, begin, size).map_err(reading)?;
            walk.metadata(&lead, &metadata).ok_or_else(|| {
                malformed(format!("the segment at byte {at} has metadata it cannot have"))
            })?;
        }
        if lead.has(SAMPLES) && end > raw {
            walk.samples(&lead, raw, end);
        }
        seen = seen.saturating_add(walk.objects.len());
        if seen > MOST_OBJECTS {
            return Err(malformed(format!(
                "its segments list more than {MOST_OBJECTS} channels in all; defragment it, or \
                 export parts of it"
            )));
        }
        at = end;
    }
    let mut groups = walk.groups;
    if let (true, Some(detail)) = (groups.is_empty(), &cut_short) {
        return Err(MeasureError::truncated(file_name(file), detail));
    }
    let channels = groups.values_mut();
    channels.for_each(|channels| channels.retain(|_, channel| channel.stored.len() > 0));
    groups.retain(|_, channels| !channels.is_empty());
    Ok((groups, cut_short))
}

fn read_at(opened: &mut File, at: u64, count: u64) -> io::Result<Vec<u8>> {
    opened.seek(SeekFrom::Start(at))?;
    let mut bytes = Vec::new();
    opened.by_ref().take(count).read_to_end(&mut bytes)?;
    Ok(bytes)
}

impl TdmsWalk {
    /// One segment's list of objects; `None` if it is cut short.
    fn metadata(&mut self, lead: &Lead, metadata: &[u8]) -> Option<()> {
        let mut bytes = HeaderBytes { left: metadata, big_endian: lead.has(BIG_ENDIAN) };
        if lead.has(NEW_LIST) {
            self.objects.clear();
        }
        for _ in 0..bytes.u32()? {
            let path = bytes.text()?;
            let values = self.values(&mut bytes, &path)?;
            let mut properties = Vec::new();
            for _ in 0..bytes.u32()? {
                properties.push(bytes.property()?);
            }
            let kind = values.as_ref().and_then(|values| kind(values.code()));
            let number = kind.map(|kind| StoredNumber::plain(kind, bytes.big_endian));
            if let Some(channel) = channel(&mut self.groups, &path, number) {
                channel.properties.extend(properties);
            }
            self.objects.insert(path.clone(), values.clone());
            self.known.insert(path, values);
        }
        Some(())
    }

    /// Where an object's samples are: none, as before, or stated now.
    fn values(&self, bytes: &mut HeaderBytes<'_>, path: &str) -> Option<Option<Values>> {
        Some(match bytes.u32()? {
            u32::MAX => None,
            0 => self.known.get(path).cloned().flatten(),
            kind @ (ANALOGUE | DIGITAL) => Some(Values::Card(Card::parse(bytes, kind)?)),
            _ => {
                let (code, _dimension) = (bytes.u32()?, bytes.u32()?);
                let count = bytes.size()?;
                let size = match code {
                    TEXT => bytes.size()?,
                    _ => count.checked_mul(width(code)?)?,
                };
                Some(Values::Own(code, count, size))
            }
        })
    }

    fn samples(&mut self, lead: &Lead, raw: u64, end: u64) {
        let with = self.objects.iter();
        let with = with.filter_map(|(path, values)| Some((path.as_str(), values.as_ref()?)));
        let with: Vec<(&str, &Values)> = with.collect();
        let (places, chunk_bytes) = match lead.has(CARDS) {
            true => of_cards(&with),
            false => of_objects(&with, lead.has(INTERLEAVED)),
        };
        let room = usize::try_from(end - raw).unwrap_or(usize::MAX);
        for (path, ChunkPlace { begin, count, stride }) in places {
            let channel = channel(&mut self.groups, path, None);
            if let (Some(channel), true) = (channel, count > 0 && chunk_bytes > 0) {
                let offset = raw.saturating_add(begin as u64);
                let chunks = room / chunk_bytes;
                channel.stored.runs.push(SampleRuns { offset, count, stride, chunks, chunk_bytes });
            }
        }
    }
}

/// The channel of a path like `/'group'/'channel'`, if it has numbers; a new one of numbers of this
/// kind. Quotes inside a name are doubled.
fn channel<'a>(
    groups: &'a mut Groups,
    path: &str,
    number: Option<StoredNumber>,
) -> Option<&'a mut TdmsChannel> {
    let inner = path.strip_prefix("/'")?.strip_suffix('\'')?;
    let (group, name) = inner.split_once("'/'")?;
    let group = groups.entry(group.replace("''", "'")).or_default();
    let name = name.replace("''", "'");
    if !group.contains_key(&name) {
        let stored = StoredChannel { number: number?, scales: Vec::new(), runs: Vec::new() };
        group.insert(name.clone(), TdmsChannel { stored, properties: HashMap::new() });
    }
    group.get_mut(&name)
}

struct ChunkPlace {
    begin: usize,
    count: usize,
    stride: usize,
}

/// Places of objects one after the other, or row by row, and the bytes of a chunk.
fn of_objects<'a>(with: &[(&'a str, &Values)], rows: bool) -> (Vec<(&'a str, ChunkPlace)>, usize) {
    let own = with.iter().filter_map(|(path, values)| match values {
        Values::Own(code, count, size) => Some((*path, *code, *count, *size)),
        Values::Card(_) => None,
    });
    let row: usize = own.clone().filter_map(|own| width(own.1)).sum();
    let (mut places, mut begin, mut chunk_bytes) = (Vec::new(), 0_usize, 0_usize);
    for (path, code, count, size) in own {
        let wide = width(code).unwrap_or(0);
        let place = ChunkPlace { begin, count, stride: if rows { row } else { wide } };
        places.push((path, place));
        begin = begin.saturating_add(if rows { wide } else { size });
        chunk_bytes = chunk_bytes.saturating_add(size);
    }
    (places, chunk_bytes)
}

/// Places of channels in the rows of DAQ cards, which come one after the other, and the bytes of a
/// chunk.
fn of_cards<'a>(with: &[(&'a str, &Values)]) -> (Vec<(&'a str, ChunkPlace)>, usize) {
    let own = with.iter().filter_map(|(path, values)| match values {
        Values::Card(layout) => Some((*path, layout)),
        Values::Own(..) => None,
    });
    let rows = own.clone().next().map_or(&[][..], |(_, layout)| &layout.rows);
    let (mut begins, mut end) = (Vec::new(), 0_usize);
    for (card, row) in rows.iter().enumerate() {
        let counts = own.clone().filter(|(_, layout)| layout.card == card);
        let longest = counts.map(|(_, layout)| layout.count).max().unwrap_or(0);
        begins.push(end);
        end = end.saturating_add(longest.saturating_mul(*row));
    }
    let places = own.filter_map(|(path, layout)| Some((path, in_row(layout, &begins)?)));
    (places.collect(), end)
}

/// Place of a channel in its card's rows; none of one that is beyond them.
fn in_row(layout: &Card, begins: &[usize]) -> Option<ChunkPlace> {
    let stride = *layout.rows.get(layout.card)?;
    let end = layout.within.checked_add(width(layout.code)?)?;
    (end <= stride).then_some(ChunkPlace {
        begin: begins.get(layout.card)?.saturating_add(layout.within),
        count: layout.count,
        stride,
    })
}

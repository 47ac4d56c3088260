//! Segments' lead-ins, numbers and texts of metadata, and layouts of DAQ cards.

use crate::records::stream::{Kind, Number};

/// Bytes of a lead-in.
pub(super) const LEAD: usize = 28;

/// In place of an index's length: readings of a DAQ card's inputs, and its lines.
pub(super) const ANALOGUE: u32 = 0x1269;
pub(super) const DIGITAL: u32 = 0x126a;

/// Type of texts.
pub(super) const TEXT: u32 = 0x20;

/// Types of LabVIEW, by their number.
const TYPES: &[(u32, Kind)] = &[
    (1, Kind::I8),
    (2, Kind::I16),
    (3, Kind::I32),
    (4, Kind::I64),
    (5, Kind::U8),
    (6, Kind::U16),
    (7, Kind::U32),
    (8, Kind::U64),
    (9, Kind::F32),
    (10, Kind::F64),
    (0x19, Kind::F32),
    (0x1a, Kind::F64),
];

/// Types of a DAQ card's readings as LabVIEW numbers them elsewhere, by their number here.
const CARD_TYPES: [u32; 10] = [5, 1, 6, 2, 7, 3, 8, 4, 9, 10];

/// A type that is none: lines of a port are no voltages.
const NO_TYPE: u32 = u32::MAX;

/// How a type of numbers is stored.
pub(super) fn kind(code: u32) -> Option<Kind> {
    let row = TYPES.iter().find(|row| row.0 == code);
    row.map(|row| row.1)
}

/// Bytes of a value of any type but text.
pub(super) fn width(code: u32) -> Option<usize> {
    match (kind(code), code) {
        (Some(kind), _) => Some(Number::plain(kind, false).width()),
        (None, 0x21) => Some(1),
        (None, 0x44 | 0x10_000d) => Some(16),
        (None, 0x08_000c) => Some(8),
        _ => None,
    }
}

/// The value of a property, as far as it is of use.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Property {
    Number(f64),
    Text(String),
    Other,
}

/// A reader over metadata in either byte order; `None` beyond its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bytes<'a> {
    pub left: &'a [u8],
    pub big_endian: bool,
}

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, left) = self.left.split_at_checked(count)?;
        self.left = left;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let mut bytes: [u8; N] = self.take(N)?.try_into().ok()?;
        if self.big_endian {
            bytes.reverse();
        }
        Some(bytes)
    }

    pub(super) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    pub(super) fn text(&mut self) -> Option<String> {
        let length = self.u32()? as usize;
        let bytes = self.take(length)?;
        Some(String::from_utf8_lossy(bytes).into_owned())
    }

    /// Name and value.
    pub(super) fn property(&mut self) -> Option<(String, Property)> {
        let name = self.text()?;
        let code = self.u32()?;
        if code == TEXT {
            return Some((name, Property::Text(self.text()?)));
        }
        let raw = self.take(width(code)?)?;
        let value = kind(code).and_then(|kind| {
            let number = Number::plain(kind, self.big_endian);
            number.samples(raw, 0, 1).volts().first().copied()
        });
        Some((name, value.map_or(Property::Other, Property::Number)))
    }
}

/// A segment's lead-in.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lead {
    pub has_metadata: bool,
    /// Whether its list of objects replaces the one before.
    pub has_new_list: bool,
    pub has_samples: bool,
    pub is_interleaved: bool,
    pub is_big_endian: bool,
    /// Whether its samples are in the rows of DAQ cards.
    pub is_of_cards: bool,
    /// Bytes of metadata and samples; as many as there are if the file was not closed.
    pub next: u64,
    /// Bytes of metadata.
    pub raw: u64,
}

impl Lead {
    /// The lead-in in these bytes, if there is one.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        let mut bytes = Bytes {
            left: bytes.strip_prefix(b"TDSm")?,
            big_endian: false,
        };
        let flags = bytes.u32()?;
        let has = |bit: u32| flags & (1 << bit) != 0;
        bytes.big_endian = has(6);
        let _version = bytes.u32()?;
        Some(Self {
            has_metadata: has(1),
            has_new_list: has(2),
            has_samples: has(3),
            is_interleaved: has(5),
            is_big_endian: has(6),
            is_of_cards: has(7),
            next: bytes.u64()?,
            raw: bytes.u64()?,
        })
    }
}

/// Where a channel's readings are within a chunk of rows of all a DAQ card's readings.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layout {
    /// Type of a reading, as LabVIEW numbers it.
    pub code: u32,
    /// Readings a chunk.
    pub count: usize,
    /// Which card.
    pub card: usize,
    /// Bytes before it in a row of its card.
    pub within: usize,
    /// Bytes of a row of every card.
    pub rows: Vec<usize>,
}

impl Layout {
    /// The layout after an index's `kind`; `None` if it is not one.
    pub(super) fn of(bytes: &mut Bytes<'_>, kind: u32) -> Option<Self> {
        let (_type, _dimension) = (bytes.u32()?, bytes.u32()?);
        let count = usize::try_from(bytes.u64()?).ok()?;
        let mut first = None;
        for _ in 0..bytes.u32()? {
            let code = bytes.u32()?;
            let (card, within) = (bytes.u32()? as usize, bytes.u32()? as usize);
            let bitmap = if kind == DIGITAL { 1 } else { 4 };
            bytes.take(bitmap)?;
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
        Some(Self {
            code,
            count,
            card,
            within,
            rows: rows.collect::<Option<_>>()?,
        })
    }
}

/// Bytes from a chunk's beginning to each card's first row, and those of a chunk: cards come one
/// after the other.
pub(super) fn cards(layouts: &[&Layout]) -> (Vec<usize>, usize) {
    let rows = layouts.first().map_or(&[][..], |layout| &layout.rows);
    let (mut begins, mut end) = (Vec::new(), 0_usize);
    for (card, row) in rows.iter().enumerate() {
        let own = layouts.iter().filter(|layout| layout.card == card);
        let longest = own.map(|layout| layout.count).max().unwrap_or(0);
        begins.push(end);
        end = end.saturating_add(longest.saturating_mul(*row));
    }
    (begins, end)
}

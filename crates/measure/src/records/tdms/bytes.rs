//! Numbers and texts of TDMS metadata.

use crate::records::stream::{Kind, Number};

/// A reader over metadata in either byte order; `None` beyond its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bytes<'a> {
    pub left: &'a [u8],
    pub big_endian: bool,
}

/// The value of a property, as far as it is of use.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Property {
    Number(f64),
    Text(String),
    Other,
}

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
/// Type of texts.
pub(super) const TEXT: u32 = 0x20;

/// The kind of number that a type is.
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

impl<'a> Bytes<'a> {
    pub(super) fn take(&mut self, count: usize) -> Option<&'a [u8]> {
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

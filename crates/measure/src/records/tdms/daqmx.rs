//! Raw data as a DAQ card gave them: rows of all its channels' readings, which a
//! segment's metadata lay out.

use super::bytes::Bytes;

/// What stands in place of an index's length for readings of inputs, and for lines.
pub(super) const ANALOGUE: u32 = 0x1269;
pub(super) const DIGITAL: u32 = 0x126a;

/// Types of readings as LabVIEW numbers them elsewhere, by their number here.
const TYPES: [u32; 10] = [5, 1, 6, 2, 7, 3, 8, 4, 9, 10];

/// A type that is none: lines of a port are no voltages.
const NONE: u32 = u32::MAX;

/// Where a channel's readings are within a chunk.
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
            let place = place(bytes, kind)?;
            first = first.or(Some(place));
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

/// Type, card and place in a row of one reading.
fn place(bytes: &mut Bytes<'_>, kind: u32) -> Option<(u32, usize, usize)> {
    let code = bytes.u32()?;
    let card = bytes.u32()? as usize;
    let within = bytes.u32()? as usize;
    let bitmap = if kind == DIGITAL { 1 } else { 4 };
    bytes.take(bitmap)?;
    let _scale = bytes.u32()?;
    let code = match kind {
        ANALOGUE => TYPES.get(code as usize).copied()?,
        _ => NONE,
    };
    Some((code, card, within))
}

/// Bytes from a chunk's beginning to each card's first row, and those of a chunk: cards
/// come one after the other.
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

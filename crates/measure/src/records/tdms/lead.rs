//! What every segment begins with.

use super::bytes::Bytes;

/// Bytes of the lead-in.
pub(super) const LEAD: usize = 28;

/// A segment's lead-in.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lead {
    flags: u32,
    /// Bytes of metadata and samples; as many as there are if the file was not closed.
    pub next: u64,
    /// Bytes of metadata.
    pub raw: u64,
}

impl Lead {
    /// The lead-in in these bytes, if there is one.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        let left = bytes.strip_prefix(b"TDSm")?;
        let mut bytes = Bytes {
            left,
            big_endian: false,
        };
        let flags = bytes.u32()?;
        bytes.big_endian = flags & (1 << 6) != 0;
        let _version = bytes.u32()?;
        Some(Self {
            flags,
            next: bytes.u64()?,
            raw: bytes.u64()?,
        })
    }

    pub(super) fn has_metadata(&self) -> bool {
        self.flags & (1 << 1) != 0
    }

    pub(super) fn has_new_list(&self) -> bool {
        self.flags & (1 << 2) != 0
    }

    pub(super) fn has_samples(&self) -> bool {
        self.flags & (1 << 3) != 0
    }

    pub(super) fn is_interleaved(&self) -> bool {
        self.flags & (1 << 5) != 0
    }

    pub(super) fn is_big_endian(&self) -> bool {
        self.flags & (1 << 6) != 0
    }

    /// Whether its samples are in the rows of DAQ cards.
    pub(super) fn is_of_cards(&self) -> bool {
        self.flags & (1 << 7) != 0
    }
}

//! Numbers as bytes: the raw samples of binary formats.

use crate::records::record::Samples;

/// How a number is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I24,
    I32,
    U32,
    I64,
    U64,
    F16,
    F32,
    F64,
}

/// A stored number and what it means: value = stored · scale + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Number {
    pub kind: Kind,
    pub big_endian: bool,
    pub scale: f64,
    pub offset: f64,
}

impl Number {
    /// A number that means itself.
    pub(super) fn plain(kind: Kind, big_endian: bool) -> Self {
        Self {
            kind,
            big_endian,
            scale: 1.0,
            offset: 0.0,
        }
    }

    /// Bytes of a number.
    pub(super) fn width(&self) -> usize {
        match self.kind {
            Kind::I8 | Kind::U8 => 1,
            Kind::I16 | Kind::U16 | Kind::F16 => 2,
            Kind::I24 => 3,
            Kind::I32 | Kind::U32 | Kind::F32 => 4,
            Kind::I64 | Kind::U64 | Kind::F64 => 8,
        }
    }

    /// Every `every`-th number of `bytes` from number `first` on.
    pub(super) fn samples(&self, bytes: &[u8], first: usize, every: usize) -> Samples {
        if self.kind == Kind::I16 {
            return Samples::Counts {
                counts: self.each(bytes, first, every, i16::from_le_bytes),
                volts_per_count: self.scale,
                offset_v: self.offset,
            };
        }
        let mut values = self.values(bytes, first, every);
        if self.scale != 1.0 || self.offset != 0.0 {
            values
                .iter_mut()
                .for_each(|value| *value = *value * self.scale + self.offset);
        }
        Samples::Volts(values)
    }

    fn values(&self, bytes: &[u8], first: usize, every: usize) -> Vec<f64> {
        match self.kind {
            Kind::I8 => self.each(bytes, first, every, |b| f64::from(i8::from_le_bytes(b))),
            Kind::U8 => self.each(bytes, first, every, |b| f64::from(u8::from_le_bytes(b))),
            Kind::I16 => self.each(bytes, first, every, |b| f64::from(i16::from_le_bytes(b))),
            Kind::U16 => self.each(bytes, first, every, |b| f64::from(u16::from_le_bytes(b))),
            Kind::I24 => self.each(bytes, first, every, |[low, middle, high]: [u8; 3]| {
                f64::from(i32::from_le_bytes([0, low, middle, high]) >> 8)
            }),
            Kind::I32 => self.each(bytes, first, every, |b| f64::from(i32::from_le_bytes(b))),
            Kind::U32 => self.each(bytes, first, every, |b| f64::from(u32::from_le_bytes(b))),
            Kind::I64 => self.each(bytes, first, every, |b| i64::from_le_bytes(b) as f64),
            Kind::U64 => self.each(bytes, first, every, |b| u64::from_le_bytes(b) as f64),
            Kind::F16 => self.each(bytes, first, every, |b| half(u16::from_le_bytes(b))),
            Kind::F32 => self.each(bytes, first, every, |b| f64::from(f32::from_le_bytes(b))),
            Kind::F64 => self.each(bytes, first, every, f64::from_le_bytes),
        }
    }

    fn each<const N: usize, T>(
        &self,
        bytes: &[u8],
        first: usize,
        every: usize,
        value: impl Fn([u8; N]) -> T,
    ) -> Vec<T> {
        let (numbers, _) = bytes.as_chunks::<N>();
        if every == 1 && !self.big_endian {
            // The usual case, as plain as it must be to be vectorised.
            let numbers = numbers.get(first..).unwrap_or_default();
            return numbers.iter().map(|number| value(*number)).collect();
        }
        let numbers = numbers.iter().skip(first).step_by(every.max(1)).copied();
        let turned = |mut number: [u8; N]| {
            if self.big_endian {
                number.reverse();
            }
            value(number)
        };
        numbers.map(turned).collect()
    }
}

/// A number of half precision: a sign, five bits of exponent, ten of fraction (IEEE 754).
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 0 { 1.0 } else { -1.0 };
    let fraction = f64::from(bits & 0x3ff);
    sign * match i32::from(bits >> 10 & 0x1f) {
        0 => fraction * 2.0_f64.powi(-24),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        exponent => (1024.0 + fraction) * 2.0_f64.powi(exponent - 25),
    }
}

#[cfg(test)]
#[path = "tests/numbers.rs"]
mod tests;

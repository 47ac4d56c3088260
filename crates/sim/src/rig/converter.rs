//! The analogue-to-digital converter: voltages to whole numbers.

use hertzchain_experiment::Recorder;

/// A converter of up to 16 bits. Its readings stand at the upper end of 16
/// bits, as DAQ cards deliver them, whatever its own number of bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Converter {
    volts_per_reading: f64,
    /// Counts of a 16-bit reading that one reading of this converter is.
    stride: i32,
    least: f64,
    most: f64,
    offset_v: f64,
}

impl Converter {
    /// Of ± `range_v` with `bits`.
    #[must_use]
    pub fn new(recorder: &Recorder) -> Self {
        let bits = recorder.bits.clamp(2, 16);
        let half = f64::from(1u32 << (bits - 1));
        Self {
            volts_per_reading: recorder.range_v / half,
            stride: 1 << (16 - bits),
            least: -half,
            most: half - 1.0,
            offset_v: recorder.offset_v,
        }
    }

    /// The reading of a signal in V: with the offset, rounded to the nearest,
    /// cut at both ends of the range.
    #[must_use]
    #[inline]
    pub fn reading(&self, signal_v: f64) -> i16 {
        let found = (signal_v + self.offset_v) / self.volts_per_reading;
        let cut = found.round_ties_even().clamp(self.least, self.most);
        // Within 16 bits by the limits; NaN becomes 0.
        (cut as i32 * self.stride) as i16
    }

    /// Volts of a count of the 16-bit reading.
    #[must_use]
    pub fn volts_per_count(&self) -> f64 {
        self.volts_per_reading / f64::from(self.stride)
    }
}

//! Arrays in replies.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::{Serialize, Serializer};

/// Numbers for a picture: single precision, little endian, base64 in JSON, which browsers decode
/// ten times as quickly as a list of decimal numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Array(pub Vec<f32>);

impl Array {
    /// Returns numbers in single precision.
    pub fn of<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> Self {
        Self(numbers.into_iter().map(|number| *number as f32).collect())
    }
}

impl Serialize for Array {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let bytes: Vec<u8> = self.0.iter().flat_map(|number| number.to_le_bytes()).collect();
        serializer.serialize_str(&STANDARD.encode(bytes))
    }
}

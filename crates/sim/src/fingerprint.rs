//! Names of work: a hash of everything that a result follows from.

use sha2::{Digest, Sha256};
use std::fmt::{Debug, Display, Formatter, Result as Formatted};

/// SHA-256 of all inputs of a result. Work of one fingerprint gives one result,
/// wherever it runs; its text is 64 hexadecimal digits.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Fingerprint([u8; 32]);

/// Digits of the short form: 64 bits, enough to distinguish works of one place.
const SHORT: usize = 16;

impl Fingerprint {
    /// The first 16 digits, for names of files.
    pub fn short(&self) -> String {
        self.to_string().chars().take(SHORT).collect()
    }

    /// The fingerprint that 64 hexadecimal digits write.
    pub(crate) fn from_hex(text: &str) -> Option<Self> {
        let digits: Option<Vec<u32>> = text.chars().map(|c| c.to_digit(16)).collect();
        let pairs = digits.as_ref()?.chunks(2);
        let bytes: Vec<u8> =
            pairs.map(|pair| (16 * pair[0] + pair.get(1).unwrap_or(&0)) as u8).collect();
        let whole = text.len() == 64;
        bytes.try_into().ok().filter(|_| whole).map(Self)
    }

    /// Of work of a kind by this build of the program (another may make other bits), from all its
    /// inputs: their `Debug` text has every bit of a number and quotes texts, so that no two lists
    /// of inputs are alike.
    pub fn of(kind: &str, inputs: &dyn Debug) -> Self {
        let build = (env!("CARGO_PKG_VERSION"), commit());
        Self::of_bytes(format!("{kind:?} {build:?} {inputs:?}").as_bytes())
    }

    /// Of the bytes of a result, to see that it is whole.
    pub fn of_bytes(bytes: &[u8]) -> Self {
        Self(Sha256::digest(bytes).into())
    }
}

impl Display for Fingerprint {
    fn fmt(&self, f: &mut Formatter<'_>) -> Formatted {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl Debug for Fingerprint {
    fn fmt(&self, f: &mut Formatter<'_>) -> Formatted {
        write!(f, "Fingerprint({self})")
    }
}

/// The commit that was built and whether its files had been changed; `None`
/// when built outside a checkout.
pub fn commit() -> Option<String> {
    option_env!("HERTZCHAIN_COMMIT").map(str::to_owned)
}

#[cfg(test)]
#[path = "tests/fingerprint.rs"]
mod tests;

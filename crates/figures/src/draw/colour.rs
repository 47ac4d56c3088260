//! Colours, and the palette of series.

use std::fmt;

/// An sRGB colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Colour(
    /// Red, from 0 to 255.
    pub u8,
    /// Green, from 0 to 255.
    pub u8,
    /// Blue, from 0 to 255.
    pub u8,
);

impl Colour {
    /// Black.
    pub const BLACK: Self = Self(0, 0, 0);
    /// White.
    pub const WHITE: Self = Self(255, 255, 255);
    /// Mid grey for reference lines.
    pub const GREY: Self = Self(115, 115, 115);
    /// Blue of the series palette.
    pub const BLUE: Self = Self(0, 96, 166);
    /// Vermilion of the series palette.
    pub const VERMILION: Self = Self(206, 86, 0);
    /// Green of the series palette.
    pub const GREEN: Self = Self(0, 138, 100);
    /// Purple of the series palette.
    pub const PURPLE: Self = Self(178, 92, 148);
    /// Ochre of the series palette.
    pub const OCHRE: Self = Self(206, 142, 0);
    /// Sky blue of the series palette.
    pub const SKY: Self = Self(74, 160, 210);

    /// Series colours distinguished with common colour-vision deficiencies, after
    /// the hues of Okabe and Ito, darkened so that thin lines stay legible.
    pub const PALETTE: [Self; 7] = [
        Self::BLACK,
        Self::BLUE,
        Self::VERMILION,
        Self::GREEN,
        Self::PURPLE,
        Self::OCHRE,
        Self::SKY,
    ];

    /// A grey of the given lightness, 0 black to 255 white.
    #[must_use]
    pub const fn grey(level: u8) -> Self {
        Self(level, level, level)
    }

    /// Mixes with another colour; `share` of the other from 0 to 1.
    #[must_use]
    pub fn mixed(self, other: Self, share: f64) -> Self {
        let mix = |a: u8, b: u8| {
            let value = f64::from(a) + (f64::from(b) - f64::from(a)) * share.clamp(0.0, 1.0);
            value.round() as u8
        };
        Self(
            mix(self.0, other.0),
            mix(self.1, other.1),
            mix(self.2, other.2),
        )
    }

    /// Relative luminance from 0 (black) to 1 (white), as sRGB defines it.
    #[must_use]
    pub fn luminance(self) -> f64 {
        let linear = |c: u8| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 {
                c / 12.92
            } else {
                ((c + 0.055) / 1.055).powf(2.4)
            }
        };
        0.2126 * linear(self.0) + 0.7152 * linear(self.1) + 0.0722 * linear(self.2)
    }
}

impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

#[cfg(test)]
#[path = "tests/colour.rs"]
mod tests;

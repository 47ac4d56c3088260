//! Colours, the palette of series, and colour maps.

use std::f64::consts::PI;
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
    pub(crate) const WHITE: Self = Self(255, 255, 255);
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
    pub(crate) const PALETTE: [Self; 7] = [
        Self::BLACK,
        Self::BLUE,
        Self::VERMILION,
        Self::GREEN,
        Self::PURPLE,
        Self::OCHRE,
        Self::SKY,
    ];

    /// A grey of the given lightness, 0 black to 255 white.
    pub(crate) const fn grey(level: u8) -> Self {
        Self(level, level, level)
    }

    /// Mixes with another colour; `share` of the other from 0 to 1.
    #[must_use]
    pub fn mixed(self, other: Self, share: f64) -> Self {
        let mix = |a: u8, b: u8| {
            let value = f64::from(a) + (f64::from(b) - f64::from(a)) * share.clamp(0.0, 1.0);
            value.round() as u8
        };
        let (red, green, blue) = (mix(self.0, other.0), mix(self.1, other.1), mix(self.2, other.2));
        Self(red, green, blue)
    }
}

impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

/// Colour of a value between 0 and 1: a perceptually uniform map, built in Ottosson's OKLab space
/// where equal steps in lightness look equal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColourMap {
    /// Dark blue through red to pale yellow: for values from nothing to much.
    Sequential,
    /// Blue through white to red: for signed values, white at one half.
    Diverging,
}

impl ColourMap {
    /// The colour at `share`, cut to the interval from 0 to 1; not a number is light grey.
    #[must_use]
    pub fn colour(self, share: f64) -> Colour {
        if share.is_nan() {
            return Colour::grey(200);
        }
        let t = share.clamp(0.0, 1.0);
        match self {
            Self::Sequential => sequential(t),
            Self::Diverging => diverging(t),
        }
    }
}

/// Lightness rises linearly, hue turns from blue over red to yellow, and the
/// chroma bulges in the middle and stays inside what sRGB can show.
fn sequential(t: f64) -> Colour {
    let hue = 270.0 + 190.0 * t;
    let chroma = 0.05 + 0.125 * (PI * t.powf(0.85)).sin();
    oklch(0.18 + 0.79 * t, chroma, hue)
}

fn diverging(t: f64) -> Colour {
    let s = 2.0 * t - 1.0;
    let strength = s.abs();
    let hue = if s < 0.0 { 255.0 } else { 33.0 };
    oklch(0.975 - 0.545 * strength, 0.16 * strength.powf(0.9), hue)
}

/// OKLCH to sRGB. Chroma is lowered until the colour exists.
fn oklch(lightness: f64, chroma: f64, hue_deg: f64) -> Colour {
    let mut chroma = chroma;
    for _ in 0..40 {
        let rgb = linear_rgb(lightness, chroma, hue_deg);
        if rgb.iter().all(|c| (-1e-4..=1.0 + 1e-4).contains(c)) {
            return encode(rgb);
        }
        chroma *= 0.95;
    }
    encode(linear_rgb(lightness, 0.0, hue_deg))
}

fn linear_rgb(lightness: f64, chroma: f64, hue_deg: f64) -> [f64; 3] {
    let (sin, cos) = hue_deg.to_radians().sin_cos();
    let (a, b) = (chroma * cos, chroma * sin);
    let l = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s,
    ]
}

fn encode(linear: [f64; 3]) -> Colour {
    let [r, g, b] = linear.map(|c| {
        let c = c.clamp(0.0, 1.0);
        let s = if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
        (255.0 * s).round() as u8
    });
    Colour(r, g, b)
}

#[cfg(test)]
#[path = "tests/colour.rs"]
mod tests;

#[cfg(test)]
#[path = "tests/colour_map.rs"]
mod map_tests;

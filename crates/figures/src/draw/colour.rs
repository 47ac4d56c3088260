//! Colours, the palette of series, and colour maps.

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
    pub(crate) fn mixed(self, other: Self, share: f64) -> Self {
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

/// Colour of a value between 0 and 1, from anchors of equal steps in the lightness of Ottosson's
/// OKLab space, in which these look equal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColourMap {
    /// Dark blue through red to pale yellow: for values from nothing to much.
    Sequential,
    /// Blue through white to red: for signed values, white at one half.
    Diverging,
    /// White to blue: for what is drawn below lines.
    Blues,
}

#[rustfmt::skip]
const SEQUENTIAL: [(u8, u8, u8); 9] = [
    (9, 15, 39), (46, 22, 90), (97, 26, 117), (151, 37, 120), (199, 64, 107),
    (231, 107, 92), (245, 156, 99), (247, 205, 144), (253, 247, 208),
];
#[rustfmt::skip]
const DIVERGING: [(u8, u8, u8); 9] = [
    (6, 78, 152), (64, 120, 189), (123, 162, 212), (183, 204, 232), (247, 247, 247),
    (230, 192, 183), (207, 140, 125), (179, 87, 69), (145, 32, 7),
];
const BLUES: [(u8, u8, u8); 3] = [(255, 255, 255), (190, 215, 236), (122, 172, 213)];

impl ColourMap {
    /// The colour at `share`, cut to the interval from 0 to 1; not a number is light grey.
    pub fn colour(self, share: f64) -> Colour {
        if share.is_nan() {
            return Colour::grey(200);
        }
        let anchors: &[(u8, u8, u8)] = match self {
            Self::Sequential => &SEQUENTIAL,
            Self::Diverging => &DIVERGING,
            Self::Blues => &BLUES,
        };
        let last = anchors.len() - 1;
        let place = share.clamp(0.0, 1.0) * last as f64;
        let below = (place as usize).min(last - 1);
        let [from, to] =
            [below, below + 1].map(|i| Colour(anchors[i].0, anchors[i].1, anchors[i].2));
        from.mixed(to, place - below as f64)
    }
}

#[cfg(test)]
#[path = "tests/colour.rs"]
mod tests;

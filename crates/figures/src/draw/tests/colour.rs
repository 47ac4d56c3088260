use super::*;

impl Colour {
    /// Relative luminance from 0 (black) to 1 (white), as sRGB defines it.
    pub(crate) fn luminance(self) -> f64 {
        let linear = |c: u8| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * linear(self.0) + 0.7152 * linear(self.1) + 0.0722 * linear(self.2)
    }
}

#[test]
fn every_series_colour_stands_out_from_white_paper() {
    for colour in Colour::PALETTE {
        let contrast = 1.05 / (colour.luminance() + 0.05);
        // 2.7:1 keeps a 0.9 pt line visible in grey print.
        assert!(contrast > 2.7, "{colour}: {contrast}");
    }
}

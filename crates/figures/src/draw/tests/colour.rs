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

#[test]
fn sequential_map_grows_steadily_lighter() {
    let steps: Vec<f64> =
        (0..=64).map(|i| ColourMap::Sequential.colour(f64::from(i) / 64.0).luminance()).collect();
    assert!(steps.windows(2).all(|w| w[1] > w[0]), "{steps:?}");
}

#[test]
fn diverging_map_is_white_in_the_middle_and_equally_dark_at_both_ends() {
    let map = ColourMap::Diverging;
    assert!(map.colour(0.5).luminance() > 0.9);
    let (low, high) = (map.colour(0.0).luminance(), map.colour(1.0).luminance());
    // Equal OKLab lightness leaves a few percent of luminance between blue and red.
    assert!((low - high).abs() < 0.06, "{low} {high}");
}

#[test]
fn not_a_number_has_a_colour_of_its_own() {
    assert_eq!(ColourMap::Sequential.colour(f64::NAN), Colour::grey(200));
}

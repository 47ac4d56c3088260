use super::*;

#[test]
fn every_series_colour_stands_out_from_white_paper() {
    for colour in Colour::PALETTE {
        let contrast = 1.05 / (colour.luminance() + 0.05);
        // 2.7:1 keeps a 0.9 pt line visible in grey print.
        assert!(contrast > 2.7, "{colour}: {contrast}");
    }
}

use super::*;

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

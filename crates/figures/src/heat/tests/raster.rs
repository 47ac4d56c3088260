use super::*;

#[test]
fn a_narrow_pulse_survives_shrinking() {
    let mut values = vec![0.0; 100_000];
    values[54_321] = -3.0;
    let map = HeatMap::new(100_000, 1, &values);
    let scale = Scale { lo: 0.0, hi: 100_000.0, log: false };
    let columns = cells(&scale, map.x_edges, map.columns, 500);
    let found: Vec<f64> = columns.iter().map(|c| map.strongest(c, &(0..1))).collect();
    assert_eq!(found.iter().filter(|v| **v == -3.0).count(), 1);
}

#[test]
fn zero_is_the_middle_of_a_diverging_range() {
    let map = HeatMap { colours: ColourMap::Diverging, ..HeatMap::new(2, 1, &[-1.0, 3.0]) };
    let (lo, hi) = map.range();
    assert_eq!(level(0.0, lo, hi), 127);
    assert_eq!(level(f64::NAN, lo, hi), MISSING);
}

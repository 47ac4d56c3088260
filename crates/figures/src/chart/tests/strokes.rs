use super::*;

fn wave(n: u32) -> Vec<Point> {
    let at = |i: u32| f64::from(i) / f64::from(n);
    (0..n).map(|i| Point::new(200.0 * at(i), (900.0 * at(i)).sin())).collect()
}

#[test]
fn a_million_points_become_a_few_per_pixel_column() {
    let thin = thinned(wave(1_000_000));
    assert!(thin.len() < 4 * (200.0 / COLUMN) as usize + 8, "{}", thin.len());
}

#[test]
fn extremes_survive_thinning() {
    let mut points = wave(100_000);
    points[54_321].y = 7.5;
    points[65_432].y = -9.5;
    let thin = thinned(points);
    assert!(thin.iter().any(|p| p.y == 7.5) && thin.iter().any(|p| p.y == -9.5));
}

#[test]
fn short_lines_are_untouched() {
    assert_eq!(thinned(wave(500)), wave(500));
}

#[test]
fn coinciding_markers_are_drawn_once() {
    let points = vec![Point::new(1.0, 2.0); 50_000];
    assert_eq!(distinct(points).len(), 1);
}

use super::*;

#[test]
fn the_corner_without_data_is_the_freest() {
    let frame = Rect::sized(0.0, 0.0, 100.0, 100.0);
    let mut taken = Occupancy::new(frame);
    taken.mark_line(&[Point::new(0.0, 0.0), Point::new(100.0, 100.0)], 1);
    taken.mark_rect(&Rect::sized(60.0, 0.0, 40.0, 40.0), 1);
    let place = taken.take(&places(&frame, 30.0, 30.0)).expect("there are places");
    assert_eq!((place.x0, place.y0), (0.0, 70.0));
    assert!(taken.cost(&place) > 0, "it is taken now");
}

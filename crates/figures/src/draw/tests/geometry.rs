use super::*;

const FRAME: Rect = Rect { x0: 0.0, y0: 0.0, x1: 10.0, y1: 10.0 };

#[test]
fn segment_through_the_frame_is_cut_at_both_edges() {
    let cut = clip_segment(&FRAME, Point::new(-10.0, 5.0), Point::new(20.0, 5.0));
    assert_eq!(cut, Some((Point::new(0.0, 5.0), Point::new(10.0, 5.0))));
}

#[test]
fn segment_outside_the_frame_vanishes() {
    assert!(clip_segment(&FRAME, Point::new(-1.0, -1.0), Point::new(11.0, -1.0)).is_none());
}

#[test]
fn segment_inside_the_frame_is_unchanged() {
    let (a, b) = (Point::new(1.0, 2.0), Point::new(3.0, 4.0));
    assert_eq!(clip_segment(&FRAME, a, b), Some((a, b)));
}

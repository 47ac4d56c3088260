use super::*;

#[test]
fn the_longer_axis_is_time_unless_told() {
    let told = |shape: &[usize], rows| Axes::of(shape, rows).unwrap();
    assert_eq!(told(&[20, 1000], Rows::Auto).shots, Some(0));
    assert_eq!(told(&[1000, 2], Rows::Auto).channels, Some(1));
    assert_eq!(told(&[2, 1000], Rows::Channels).channels, Some(0));
    assert_eq!(told(&[2, 1000], Rows::Times).time, 0);
    let columns = told(&[1000, 20], Rows::Moments);
    assert_eq!((columns.shots, columns.time), (Some(1), 0));
    assert_eq!(Axes::of(&[1, 1, 1, 1], Rows::Auto), None);
}

use super::rough;

#[test]
fn durations_are_rounded_to_the_largest_unit_that_fits() {
    let times = [0.2, 40.0, 100.0, 6000.0, 200_000.0];
    let words = ["1 s", "40 s", "2 min", "2 h", "2 d"];
    assert_eq!(times.map(rough), words);
}

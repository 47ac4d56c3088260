use super::*;

fn pair(value: f64, error: f64) -> String {
    let (value, error) = with_error(value, error);
    format!("{value} ± {error}")
}

#[test]
fn values_end_where_their_errors_do() {
    assert_eq!(pair(686.612_934, 4.7123), "686.6 ± 4.7");
    assert_eq!(pair(630.841_591_2, 6.31e-4), "630.84159 ± 0.00063");
    assert_eq!(pair(-0.199_999_999_7, 2.62e-10), "-0.19999999970 ± 2.6e-10");
    assert_eq!(pair(686.612_934, 0.0996), "686.61 ± 0.10");
    assert_eq!(pair(686.612_934, 47.4), "687 ± 47");
    assert_eq!(pair(6866.129, 474.0), "6870 ± 470");
}

#[test]
fn r_squared_shows_two_digits_of_what_is_left() {
    assert_eq!(r_squared(0.998_758_344), "0.9988");
    assert_eq!(r_squared(0.87), "0.87");
    assert_eq!(r_squared(1.0 - 2.04e-9), "1 − 2.0e-9");
    assert_eq!(r_squared(1.0 - 1e-15), "1");
}

use super::*;

#[test]
fn zero_has_no_sign() {
    assert_eq!(fixed(-0.0001, 2), "0.00");
    assert_eq!(fixed(-0.5, 1), "−0.5");
}

#[test]
fn small_powers_are_written_out() {
    assert_eq!(plain(5, -2), "0.05");
    assert_eq!(plain(2, 3), "2000");
    assert_eq!(power(1, -5), "$10^{-5}$");
}

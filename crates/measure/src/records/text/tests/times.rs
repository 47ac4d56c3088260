use super::*;

fn printed(times: &[f64], unit_s: f64) -> Vec<Printed> {
    times.iter().map(|s| Printed { s: *s, unit_s }).collect()
}

#[test]
fn jumps_back_and_far_ahead_begin_segments() {
    let of = |times: &[f64]| segments(&printed(times, 1e-3));
    assert_eq!(of(&[0.0, 1.0, 2.0, 0.0, 1.0]), [0..3, 3..5]);
    assert_eq!(of(&[0.0, 1.0, 2.0, 90.0, 91.0]), [0..3, 3..5]);
    assert_eq!(of(&[0.0, 1.0, 2.0]).first(), Some(&(0..3)));
    assert_eq!(of(&[]).first(), Some(&(0..0)));
}

#[test]
fn digits_so_few_that_times_repeat_begin_no_segments() {
    let rounded = |from: i32, to: i32| (from..to).map(|i| (f64::from(i) * 0.1).round());
    let times: Vec<f64> = rounded(-70, 900).chain(rounded(-70, 900)).collect();
    assert_eq!(segments(&printed(&times, 1.0)), [0..970, 970..1940]);
    let ahead: Vec<f64> = rounded(0, 900).chain(rounded(2000, 2900)).collect();
    assert_eq!(segments(&printed(&ahead, 1.0)), [0..900, 900..1800]);
}

#[test]
fn only_what_rose_before_returns() {
    let at = |times: &[f64]| -> Vec<usize> {
        let mut returns = Returns::default();
        let begins = times.iter().enumerate();
        let begins = begins.filter(|(_, time)| returns.begins(**time));
        begins.map(|(at, _)| at).collect()
    };
    assert_eq!(at(&[0.0, 0.0, 1.0, 0.0, 1.0, 2.0, 0.0]), [3, 6]);
    assert_eq!(at(&[0.0, 0.0, 0.0, 0.0]), []);
    assert_eq!(at(&[3.0, 1.0, 4.0, 1.0, 5.0, f64::NAN, 2.0]), []);
    assert_eq!(at(&[f64::NAN, 1.0, 2.0, 0.0]), []);
}

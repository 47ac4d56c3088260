use super::*;

fn each(values: &[f64], sigma: f64) -> Vec<Estimate> {
    values.iter().map(|value| Estimate { value: *value, sigma }).collect()
}

#[test]
fn shots_that_scatter_by_noise_alone_have_their_mean() {
    let all = each(&[1.0, 3.0, 2.0, 2.0], 2.0);
    let found = combined(Estimate { value: -3.0, sigma: 2.0 }, &all);
    // Mean 2, its error 2/√4.
    assert_eq!((found.value, found.sigma), (2.0, 1.0));
}

#[test]
fn shots_that_differ_by_more_than_noise_keep_their_own() {
    // Variance 10⁴·4/3 against noise of 1: the mean has a share of 10⁻⁴.
    let all = each(&[100.0, -100.0, 100.0, -100.0], 1.0);
    let found = combined(all[1], &all);
    assert!((found.value + 100.0).abs() < 0.02, "{found:?}");
    assert!((found.sigma - 1.0).abs() < 1e-3, "{found:?}");
}

#[test]
fn two_shots_do_not_change_each_other() {
    let all = each(&[1.0, 5.0], 2.0);
    assert_eq!(combined(all[0], &all), all[0]);
}

use super::*;

/// Numbers of mean 0 and deviation 1: sums of twelve uniform ones.
fn normals() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    move || (0..12).map(|_| uniform()).sum::<f64>() - 6.0
}

/// Groups of twenty shots with three picks of deviation 1 each, and what scatters besides in
/// both times alike.
fn groups(besides: f64, returns: usize) -> Vec<Pairs> {
    let mut normal = normals();
    let mut shot = || {
        let (passing, wall, back) = (normal(), normal(), normal());
        let both = besides * normal();
        ([wall - passing + both, back - wall + both], -1.0)
    };
    let mut group = || Pairs::new(&(0..returns).map(|_| shot()).collect::<Vec<_>>(), 20);
    (0..1000).map(|_| group()).collect()
}

fn mean(of: impl Iterator<Item = f64>) -> f64 {
    of.sum::<f64>() / 1000.0
}

#[test]
fn means_are_correlated_by_the_share_of_the_walls_pick() {
    let all = groups(0.0, 20);
    assert!(all.iter().all(|pairs| (pairs.picking + 0.05).abs() < 1e-15));
    // Of either mean: 2/20. A covariance of 20 shots scatters by 0.25 of that, 1000 of them by 1 %.
    let error = (2.0_f64 / 20.0).sqrt();
    let plain = mean(all.iter().filter_map(|pairs| pairs.of_means([error; 2], 0.0)));
    assert!((plain + 0.5 * 18.0 / 19.0).abs() < 0.03, "{plain}");
    // Where no more scatters than picks do, nothing is added to what is known of them.
    assert!(all.iter().all(|pairs| pairs.excess(0.0, [0.0; 2]) == 0.0));
}

#[test]
fn what_scatters_in_both_times_correlates_them_the_other_way() {
    let all = groups(3.0, 20);
    // Variance 9/20 of either mean beyond picking, all of it common.
    let excess = mean(all.iter().map(|pairs| pairs.excess(0.0, [0.45; 2])));
    // Clipped at the most that variances allow; the factor of few shots.
    assert!((0.33..0.45).contains(&excess), "{excess}");
    // What speeds account for is none of it.
    let rest = mean(all.iter().map(|pairs| pairs.excess(0.45, [0.45; 2])));
    assert!(rest.abs() < 0.03, "{rest}");
}

#[test]
fn shots_without_a_return_dilute_the_correlation() {
    let all = groups(0.0, 10);
    // −1 of ten pairs over 10 · 20.
    assert!(all.iter().all(|pairs| (pairs.picking + 0.05).abs() < 1e-15));
    let two = groups(0.0, 2);
    assert!(two.iter().all(|pairs| pairs.of_means([0.3; 2], 0.0) == Some(0.0)));
}

use super::*;

#[test]
fn a_value_that_two_of_its_errors_wipe_out_is_not_told() {
    assert!(!is_determined(11.8, 7.3));
    assert!(is_determined(11.8, 5.8));
    assert!(!is_determined(1.0, f64::INFINITY) && !is_determined(1.0, f64::NAN));
}

/// Row's own and dry numbers' errors are independent: variances add.
#[test]
fn errors_of_a_pair_hold_those_of_the_dry_numbers() {
    let pair = Pair {
        ln: [0.0, 2.0_f64.ln()],
        own: [[9e-4, 0.0], [0.0, 25e-4]],
        shared: vec![[0.04, 0.12]],
    };
    let [(k, k_sd), (a, a_sd)] = pair.estimates();
    // Rounding.
    assert!((k - 1.0).abs() < 1e-15 && (k_sd - 0.05).abs() < 1e-15);
    assert!((a - 2.0).abs() < 1e-15 && (a_sd - 2.0 * 0.13).abs() < 1e-15);
    assert!((pair.covariance()[0][1] - 0.04 * 0.12).abs() < 1e-18);
}

#[test]
fn shifts_sum_to_the_covariance() {
    let matrix = vec![vec![4.0, 1.2], vec![1.2, 0.9]];
    let shifts = shifts(&matrix);
    for i in 0..2 {
        for j in 0..2 {
            let sum: f64 = shifts.iter().map(|shift| shift[i] * shift[j]).sum();
            // Rounding.
            assert!((sum - matrix[i][j]).abs() < 1e-15, "{i} {j}");
        }
    }
}

/// A straight line and a bent one that crosses it: sorted by size, the line is the
/// second pair first and the first pair later.
#[test]
fn a_line_is_followed_through_a_crossing() {
    let row = |at: usize| {
        // None of them where both cross.
        let x = 0.1 + at as f64 / 4.0;
        let mut pairs = vec![2.0 - x, 1.0 + (x - 1.0).powi(3)];
        pairs.sort_by(f64::total_cmp);
        (x, pairs)
    };
    let rows: Vec<(f64, Vec<f64>)> = (0..9).map(row).collect();
    let taken = smoothest(&rows);
    for ((x, pairs), chosen) in rows.iter().zip(&taken) {
        // One subtraction, twice the same.
        assert_eq!(pairs[chosen.pair], 2.0 - x, "{taken:?}");
        assert!(chosen.is_clear, "{taken:?}");
    }
    assert_eq!((taken[0].pair, taken[8].pair), (1, 0));
    assert_eq!(smoothest(&rows[..2]), [Chosen::default(); 2]);
    // One bend determines nothing, however much smaller it is.
    assert!(smoothest(&rows[..3]).iter().all(|chosen| !chosen.is_clear));
}

/// At the end of a row of speeds one bend alone determines: a curve that bends toward it looks
/// straighter by a pair that is none, which four bends can't determine.
#[test]
fn an_end_that_bends_is_not_taken_for_straight() {
    let bends = [0.27, 0.17, 0.10, 0.06];
    let mut slope = -0.9;
    let mut ln_a = vec![1.4];
    for bend in [0.0].iter().chain(&bends) {
        slope += bend;
        ln_a.push(ln_a[ln_a.len() - 1] + 0.56 * slope);
    }
    let mut rows: Vec<Row> = (0..6).map(|at| (0.56 * at as f64, vec![ln_a[at]])).collect();
    // A pair of A a fifth smaller straightens the first bend to less than nothing.
    rows[0].1.insert(0, ln_a[0] - 0.2);
    assert!(!smoothest(&rows)[0].is_clear);
    // One five times as large is no way at all.
    rows[0].1[0] = ln_a[0] + 1.6;
    let chosen = smoothest(&rows)[0];
    assert!(chosen.is_clear && chosen.pair == 1, "{chosen:?}");
}

/// Two lines side by side.
#[test]
fn two_ways_as_straight_leave_the_choice_open() {
    let row = |at: usize| (at as f64, vec![0.5 * at as f64, 1.0 + 0.4 * at as f64 + 1e-3]);
    let rows: Vec<Row> = (0..9).map(row).collect();
    let bent = |(at, (x, pairs)): (usize, Row)| {
        let wave = 0.01 * (at as f64).sin();
        (x, pairs.into_iter().map(|a| a + wave).collect())
    };
    let rows: Vec<Row> = rows.into_iter().enumerate().map(bent).collect();
    assert!(smoothest(&rows).iter().all(|chosen| !chosen.is_clear));
}

#[test]
fn errors_of_the_dry_numbers_are_allowed_for_where_no_pair_makes_up_for_them() {
    // No slopes: r = (0, 3), moved by (0, 1): variance 1 + 1.
    let flat = vec![vec![0.0, 0.0], vec![0.0, 0.0]];
    let allowed = allowing(&[0.0, 3.0], &flat, &[vec![0.0, 1.0]]);
    // Rounding.
    assert!((allowed - 9.0 / 2.0).abs() < 1e-12, "{allowed}");
    // A pair that changes by a little as the dry numbers do makes up for them.
    let steep = vec![vec![1e6, 0.0], vec![0.0, 1e6]];
    let rest = allowing(&[0.0, 3.0], &steep, &[vec![0.0, 1.0]]);
    assert!((rest - 9.0).abs() < 1e-6, "{rest}");
    assert!((allowing(&[1.0, 2.0], &flat, &[]) - 5.0).abs() < 1e-12);
}

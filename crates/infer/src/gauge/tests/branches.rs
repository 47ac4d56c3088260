use super::*;

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

use super::*;

#[test]
fn verdicts_differ_in_lightness_for_grey_print() {
    let mut levels = ClaimVerdict::ALL.map(|v| v.colour().luminance());
    levels.sort_by(f64::total_cmp);
    // The two palest are distinguished by their symbols.
    assert!(levels[1] - levels[0] > 0.08 && levels[2] - levels[1] > 0.2, "{levels:?}");
}

#[test]
fn a_table_grows_with_its_rows() {
    let table = |rows: usize| {
        let rows = vec![("claim".into(), vec![ClaimVerdict::Holds]); rows];
        let columns = vec!["a".into(), "b".into()];
        VerdictMatrix { columns, rows, ..VerdictMatrix::default() }.figure().height_mm
    };
    assert!(table(20) > table(10));
}

use super::*;

#[test]
fn cells_that_hold_commas_or_quotes_are_quoted_and_what_is_no_number_is_empty() {
    let cells = [
        Cell::from("a, \"b\""),
        Cell::from(f64::INFINITY),
        Cell::from(Some(1.5e-7)),
        Cell::from(None::<f64>),
        Cell::from(3_usize),
        Cell::from(true),
    ];
    let table = Csv::new(["a", "b"]).with(cells);
    assert_eq!(table.text(), "a,b\n\"a, \"\"b\"\"\",,1.5e-7,,3,true\n");
    let table = Csv::new(["name"]).with([Cell::from("=1+1"), Cell::from(-1.5)]);
    assert_eq!(table.text(), "name\n'=1+1,-1.5\n");
}

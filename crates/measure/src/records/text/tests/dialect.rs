use super::*;

fn found(text: &str) -> (char, bool, Vec<usize>, usize) {
    let dialect = Dialect::of(text).unwrap();
    (dialect.delimiter, dialect.decimal_comma, dialect.columns, dialect.first_row)
}

#[test]
fn delimiters_and_decimal_signs_are_told_apart() {
    assert_eq!(found("0.1,0.2\n0.3,0.4\n"), (',', false, vec![0, 1], 0));
    assert_eq!(found("0,1;0,2\n0,3;0,4\n"), (';', true, vec![0, 1], 0));
    assert_eq!(found("0,1\t0,2\n0,3\t-4\n"), ('\t', true, vec![0, 1], 0));
    assert_eq!(found("a\n1.5  2\n 2.5  3\n3 4\n5 6\n6 7"), (' ', false, vec![0, 1], 1));
    // Marks between thousands are no delimiters, and no decimal signs of others.
    assert_eq!(found("\"1,234.5\",0.5\n\"2,345.5\",1.5\n"), (',', false, vec![0, 1], 0));
    assert_eq!(found("1.234,5;0,5\n2.345,5;1,5"), (';', true, vec![0, 1], 0));
    assert_eq!(found("1,234;0,5\n2,345;1,5"), (';', true, vec![0, 1], 0));
    assert_eq!(found("1,234\n2,345\n"), (',', false, vec![0, 1], 0));
    assert_eq!(found("\"0,1\",\"0,2\"\n\"0,3\",\"1,4\""), (',', true, vec![0, 1], 0));
}

#[test]
fn a_preamble_beside_the_numbers_is_no_column() {
    let mut text = "Record Length,2500,,0.1,0.2\nSample Interval,1e-6,,0.2,0.3\n".to_owned();
    text += &",,,0.3,0.4\n".repeat(20);
    assert_eq!(found(&text), (',', false, vec![3, 4], 0));
}

#[test]
fn text_without_numbers_has_no_dialect() {
    assert_eq!(Dialect::of("alas\npoor Yorick"), None);
    assert_eq!(Dialect::of(""), None);
}

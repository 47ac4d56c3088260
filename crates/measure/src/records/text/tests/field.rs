use super::*;

#[test]
fn quotes_keep_delimiters() {
    assert_eq!(fields("\"0,5\", \"1,5\"", ','), ["0,5", "1,5"]);
    assert_eq!(fields("  1   2\t3 ", ' '), ["1", "2", "3"]);
}

#[test]
fn a_decimal_comma_is_a_point_only_where_it_is_one() {
    assert_eq!(number("-1,5e-3", true), Some(-1.5e-3));
    assert_eq!(number("1.5", true), None);
    assert_eq!(number("1,5", false), None);
    assert!(number("NaN", false).unwrap().is_nan());
    assert_eq!(number("Volt", false), None);
}

#[test]
fn times_of_day_are_seconds() {
    for (text, expected) in [
        ("12:00:00.000001", Some(43_200.000_001)),
        ("12:00:00,000001", Some(43_200.000_001)),
        ("2024-05-02 00:00:01.5", Some(172_801.5)),
        ("2024-05-01T00:01:00Z", Some(86_460.0)),
        ("05/01/2024 00:00:02.5", Some(2.5)),
        ("00:00:03.25+02:00", Some(3.25)),
        ("12:00", None),
        ("25:00:00", None),
        ("12:61:00", None),
        ("a:b:c", None),
        ("yesterday 12:00:00", None),
    ] {
        assert_eq!(number(text, false), expected, "{text}");
    }
    assert!((last_digit("2024-05-01 12:00:00.000001", true) - 1e-6).abs() < 1e-18);
    assert!((last_digit("12:00:00,000001", false) - 1e-6).abs() < 1e-18);
}

#[test]
fn a_last_digit_is_worth_what_its_place_says() {
    for (text, comma, expected) in [
        ("0.00012", false, 1e-5),
        ("-1,5E-03", true, 1e-4),
        ("17", false, 1.0),
        ("2e-6", false, 1e-6),
    ] {
        let worth = last_digit(text, comma);
        // Rounding of a power of ten.
        assert!((worth / expected - 1.0).abs() < 1e-12, "{text}: {worth}");
    }
}

#[test]
fn thousands_may_be_apart_by_what_is_no_decimal_sign() {
    for (text, comma, expected) in [
        ("1,234.5", false, Some(1234.5)),
        ("-12,345,678", false, Some(-12_345_678.0)),
        ("1.234,5", true, Some(1234.5)),
        ("1 234,5e-3", true, Some(1.2345)),
        ("1\u{202f}234.5", false, Some(1234.5)),
        ("1'234.5", false, Some(1234.5)),
        ("0,123.5", false, None),
        ("1,23.5", false, None),
        ("1,2345", false, None),
        ("1,234 567", false, None),
        ("12-345", false, None),
    ] {
        assert_eq!(number(text, comma), expected, "{text}");
    }
}

#[test]
fn cells_without_a_number_are_told_from_other_words() {
    assert_eq!(no_number("OVERLOAD"), Some(f64::INFINITY));
    assert_eq!(no_number("-OL"), Some(f64::NEG_INFINITY));
    assert!(no_number("#N/A").unwrap().is_nan());
    assert!(no_number("").unwrap().is_nan());
    assert_eq!(no_number("what?"), None);
    assert_eq!(no_number("-.-"), None);
}

#[test]
fn a_leading_number_leaves_its_unit() {
    assert_eq!(leading_number("=1.5 MS/s", false), Some((1.5, " MS/s")));
    assert_eq!(leading_number(" 1e-6s", false), Some((1e-6, "s")));
    assert_eq!(leading_number("none", false), None);
}

use super::*;

#[test]
fn numbers_keep_two_decimals_and_lose_trailing_zeros() {
    let written = |v: f64| number(v, 2);
    let cases = [(1.0, "1"), (-0.5, "-0.5"), (2.345, "2.35"), (0.001, "0"), (-3.04, "-3.04")];
    for (value, text) in cases {
        assert_eq!(written(value), text);
    }
    assert_eq!(written(f64::NAN), "0");
}

#[test]
fn markup_characters_are_escaped() {
    assert_eq!(escape("a<b & \"c\"\u{1}"), "a&lt;b &amp; &quot;c&quot; ");
}

use super::*;

#[test]
fn speeds_have_units_or_none() {
    assert_eq!(parse_speed(" 0.5 m/s").unwrap(), 0.5);
    assert_eq!(parse_speed("500 mm/s").unwrap(), 0.5);
    assert!(parse_speed("50 %").unwrap_err().to_string().contains("not a speed"));
    assert_eq!(parse_speeds("0.1, 0.2 m/s,500 mm/s").unwrap(), [0.1, 0.2, 0.5]);
}

#[test]
fn ranges_hold_both_ends() {
    assert_eq!(parse_speeds("0.5:1.5:3").unwrap(), [0.5, 1.0, 1.5]);
    let log = parse_speeds("log:0.01:1:3").unwrap();
    // Rounding of one power.
    assert!(log[0] == 0.01 && (log[1] - 0.1).abs() < 1e-15 && log[2] == 1.0);
    assert_eq!(parse_speeds("2 m/s,1:0.5:2").unwrap(), [2.0, 1.0, 0.5]);
}

#[test]
fn nonsense_is_refused() {
    for (text, part) in [
        ("", "a number with a unit"),
        ("0.1,,0.2", "a number with a unit"),
        ("fast", "a number with a unit"),
        ("3 kg", "not a speed"),
        ("0", "0 m/s is not positive"),
        ("-1", "is not positive"),
        ("nan", "a number with a unit"),
        ("1:2", "is not a range"),
        ("1:2:1", "from 2 to 100000 speeds"),
        ("1:2:1000000000000", "from 2 to 100000 speeds"),
        ("1:2:x", "from 2 to 100000 speeds"),
    ] {
        let error = parse_speeds(text).unwrap_err().to_string();
        assert!(error.contains(part), "{text}: {error}");
    }
}

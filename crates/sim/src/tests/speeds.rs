use super::*;

#[test]
fn speeds_have_units_or_none() {
    assert_eq!(parse_speed(" 0.5 m/s"), Ok(0.5));
    assert_eq!(parse_speed("500 mm/s"), Ok(0.5));
    assert_eq!(
        parse_speeds("0.1, 0.2 m/s,500 mm/s"),
        Ok(vec![0.1, 0.2, 0.5])
    );
}

#[test]
fn ranges_hold_both_ends() {
    assert_eq!(parse_speeds("0.5:1.5:3"), Ok(vec![0.5, 1.0, 1.5]));
    let log = parse_speeds("log:0.01:1:3").unwrap();
    // Rounding of one power.
    assert!(log[0] == 0.01 && (log[1] - 0.1).abs() < 1e-15 && log[2] == 1.0);
    assert_eq!(parse_speeds("2 m/s,1:0.5:2"), Ok(vec![2.0, 1.0, 0.5]));
}

#[test]
fn nonsense_is_refused() {
    let refused = |text: &str| parse_speeds(text).unwrap_err();
    assert!(matches!(refused(""), SpeedError::Unit { .. }));
    assert!(matches!(refused("0.1,,0.2"), SpeedError::Unit { .. }));
    assert!(matches!(refused("fast"), SpeedError::Unit { .. }));
    assert!(matches!(refused("3 kg"), SpeedError::NotASpeed { .. }));
    assert_eq!(refused("0"), SpeedError::NotPositive(0.0));
    assert!(matches!(refused("-1"), SpeedError::NotPositive(_)));
    assert!(matches!(refused("nan"), SpeedError::Unit { .. }));
    assert!(matches!(refused("1:2"), SpeedError::Range(_)));
    assert!(matches!(refused("1:2:1"), SpeedError::Count(_)));
    assert!(matches!(refused("1:2:1000000000000"), SpeedError::Count(_)));
    assert!(matches!(refused("1:2:x"), SpeedError::Count(_)));
}

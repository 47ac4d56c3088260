use super::*;

fn loose(column: [f64; 2], slope: f64) -> Loose {
    Loose { column: column.to_vec(), slope, doubt: 1e-6 }
}

#[test]
fn a_slope_along_what_nothing_determines_is_no_fall() {
    // Two parameters whose columns differ by noise: their difference is open, and a
    // slope along it, of noise times residuals, would look like a fall without end.
    let [one, other] = [[100.0, 50.0], [100.0, 50.0 + 1e-5]];
    let noise = determined_fall(&[loose(one, 1.0), loose(other, -1.0)]).unwrap();
    assert!(noise < 1e-9, "{noise}");
    // A slope that both share is one: ½ (10/√2)²/(2 · 12500)/½.
    let real = determined_fall(&[loose(one, 5.0), loose(other, 5.0)]).unwrap();
    assert!((real - 0.5 * 25.0 / 12500.0).abs() < 1e-9, "{real}");
    // Where all is determined the descent's own word holds.
    let apart = [loose(one, 1.0), loose([50.0, -100.0], -1.0)];
    assert_eq!(determined_fall(&apart), None);
}

#[test]
fn starts_between_bounds_of_both_signs_stay_near_what_matters() {
    let exponent = Parameter { scale: 0.1, ..Parameter::new("k", "", 0.0).within(-5.0, 5.0) };
    let positive = Parameter::new("B", "", 77.0).within(0.0, 1e4);
    let spread = |parameter: &Parameter| {
        let all = starts(std::slice::from_ref(parameter), 100, 0).concat();
        all.into_iter().map(|start| (start - parameter.start).abs()).fold(0.0, f64::max)
    };
    // K v^k of K v^±5 is a thousandfold at the slowest shot of a curve, and endless work.
    let widest = spread(&exponent);
    assert!(widest <= 1.0 && widest > 0.9, "{widest}");
    assert!(spread(&positive) > 9e3);
}

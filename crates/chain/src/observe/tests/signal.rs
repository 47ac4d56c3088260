use super::*;

/// A wave, and a jump in the middle, in stretches much shorter than it.
fn dense(count: usize) -> Signal {
    let length_s = 1.0 / count as f64;
    let value = |time_s: f64| time_s.sin() + f64::from(time_s >= 0.5);
    let stretch = |i: usize| {
        let start_s = i as f64 * length_s;
        let inside = |k: usize| start_s + 0.999_999 * 0.25 * k as f64 * length_s;
        Stretch { start_s, length_s, values: std::array::from_fn(|k| value(inside(k))) }
    };
    Signal {
        largest: 2.0,
        stretches: (0..count).map(stretch).collect(),
        ..Signal::new(Sensor::Contact(0))
    }
}

#[test]
fn a_maximum_that_two_steps_find_is_one_and_two_with_a_dip_are_two() {
    let kept = |values: [f64; 5], heights: [f64; 2]| {
        let stretch = Stretch { start_s: 0.0, length_s: 1.0, values };
        let mut signal = Signal { largest: 1.0, ..Signal::new(Sensor::Contact(0)) };
        let maximum = |(time_s, value): (f64, f64)| Maximum { time_s, value };
        signal.keep_inside(
            &stretch,
            [(0.1, heights[0]), (0.9, heights[1])].map(maximum).into(),
            &[],
        );
        signal.maxima.iter().map(|it| it.time_s).collect::<Vec<_>>()
    };
    assert_eq!(kept([0.0, 0.9, 0.9, 0.95, 0.5], [0.9, 1.0]), [0.9]);
    assert_eq!(kept([0.0, 0.9, 0.8, 0.95, 0.5], [0.9, 1.0]), [0.1, 0.9]);
    // One that falls hardly rises to the second.
    assert_eq!(kept([0.9, 0.8, 0.7, 0.6, 0.5], [0.9, 0.6]), [0.1, 0.9]);
}

#[test]
fn stretches_much_shorter_than_a_pulse_are_joined_and_say_the_same() {
    let (mut joined, whole) = (dense(4096), dense(4096));
    joined.merge();
    // All but those at the jump, which is at a seam.
    assert_eq!(joined.stretches.len(), 2048);
    for i in 0..10_000 {
        let time_s = f64::from(i) / 10_000.0;
        let differs = joined.at(time_s) - whole.at(time_s);
        // What the joining allows.
        assert!(differs.abs() < 2.0 * 2.0 * MERGED, "{time_s}: {differs}");
    }
    let mut other = dense(64);
    other.stretches[1].values[2] += 1e-3;
    other.merge();
    assert_eq!(other.stretches.len(), 2 + 31, "what differs stays as it is");
}

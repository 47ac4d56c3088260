use super::*;

/// Passing, wall, returning at these moments, `incident` apart, and noise by a formula.
fn recording(shots: &[(usize, f64)], samples: usize) -> Vec<f64> {
    let bell = |at: usize, i: usize| (-((i as f64 - at as f64) / 25.0).powi(2)).exp();
    let sample = |i: usize| {
        let noise = 1e-3 * (((i * 7919 + i * i * 31) % 23) as f64 - 11.0) / 11.0;
        let pulses = shots.iter().map(|(at, height)| {
            height * (bell(*at, i) + 1.6 * bell(at + 700, i) + 0.5 * bell(at + 1420, i))
        });
        noise + pulses.sum::<f64>()
    };
    (0..samples).map(sample).collect()
}

fn channels<const N: usize>(volts: [Vec<f64>; N]) -> [Channel; N] {
    volts.map(|volts| Channel { volts, ..Channel::default() })
}

/// One channel.
fn one(shots: &[(usize, f64)]) -> Content {
    content(&channels([recording(shots, 60_000)]))
}

#[test]
fn shots_with_quiet_between_are_plain() {
    let shots = [(1000, 1.0), (21_000, 0.9), (41_000, 1.0)];
    let Content::Plain(ranges) = one(&shots) else { unreachable!("three shots are plain") };
    assert_eq!(ranges.len(), 3);
    for ((from, to), (at, _)) in ranges.iter().zip(shots) {
        assert!(*from + 100 < at && at + 1600 < *to, "{from}..{to} of {at}");
    }
}

#[test]
fn one_shot_is_one_whatever_follows_it() {
    assert_eq!(one(&[(1000, 1.0)]), Content::One);
    // The wave comes back weaker, again and again.
    assert_eq!(one(&[(1000, 1.0), (4000, 0.5), (7000, 0.3)]), Content::One);
    // A second, weak one long after.
    assert_eq!(one(&[(1000, 1.0), (40_000, 0.3)]), Content::One);
    assert_eq!(one(&[]), Content::One);
    assert_eq!(content(&channels([vec![1.0; 5]])), Content::One);
    assert_eq!(content(&[]), Content::One);
}

#[test]
fn spikes_of_one_sample_are_no_shot() {
    let mut volts = recording(&[(1000, 1.0)], 60_000);
    (0..8).for_each(|number| volts[40_000 + 700 * number] = 1.5);
    assert_eq!(content(&channels([volts])), Content::One);
}

#[test]
fn the_walls_channel_counts_too() {
    let bell = |at: usize, i: usize| (-((i as f64 - at as f64) / 25.0).powi(2)).exp();
    let channel = |first: usize| -> Vec<f64> {
        let at = |i| bell(first, i) + bell(first + 30_000, i);
        (0..60_000).map(at).collect()
    };
    let both = channels([channel(1000), channel(1700)]);
    assert!(matches!(content(&both), Content::Plain(ranges) if ranges.len() == 2));
    // One sensor alone: its pulses may be those of one shot.
    assert_eq!(content(&both[..1]), Content::One);
}

#[test]
fn shots_of_very_unlike_heights_are_not_plain() {
    let shots = [(1000, 1.0), (21_000, 0.25), (41_000, 1.0)];
    assert_eq!(one(&shots), Content::Mixed);
}

//! Cutting a recording does not depend on the pieces it comes in.

use super::*;
use proptest::prelude::*;

fn cut(mut cutter: Cutter, recording: &[i16], pieces: &[usize]) -> Vec<Segment> {
    let mut shots = Vec::new();
    let (mut left, mut needed_from) = (recording, 0);
    for piece in pieces.iter().chain(&[recording.len()]) {
        let (now, later) = left.split_at((*piece).min(left.len()));
        for shot in cutter.feed(&now.iter().map(|x| f64::from(*x)).collect::<Vec<_>>()) {
            assert!(shot.0.start >= needed_from, "samples were dropped");
            shots.push(shot);
        }
        left = later;
        needed_from = cutter.needed_from();
    }
    shots.extend(cutter.finish());
    shots
}

/// First sample, the one that fired, and how many.
fn places(shots: &[Segment]) -> Vec<(u64, u64, u64)> {
    let one = |(samples, fired): &Segment| (samples.start, *fired, samples.end - samples.start);
    shots.iter().map(one).collect()
}

/// At a level of 5 above a baseline of 1: a tenth of a shot lies before, and the signal must return
/// to 3.
fn at_five(length: usize) -> Cutter {
    Cutter::new(5.0, 1.0, length).unwrap()
}

#[test]
fn a_level_cuts_one_shot_a_pulse() {
    let mut recording = vec![0_i16; 130];
    recording[30] = 10;
    recording[31] = 9;
    recording[80] = 10;
    let shots = cut(at_five(40), &recording, &[]);
    assert_eq!(places(&shots), [(26, 30, 40), (76, 80, 40)]);
}

#[test]
fn a_signal_that_hangs_about_the_level_fires_once() {
    // Falls to 4 only: within the hysteresis of 2 below the level of 5.
    let mut recording = vec![0_i16; 20];
    recording.extend([6, 4, 6, 4, 6, 4, 6, 4, 6, 4]);
    recording.extend([0; 20]);
    assert_eq!(cut(at_five(4), &recording, &[]).len(), 1);
}

#[test]
fn a_shot_swallows_what_comes_back_within_its_length() {
    let mut recording = vec![0_i16; 120];
    for at in [20, 49, 80] {
        recording[at] = 10;
    }
    let shots = cut(at_five(30), &recording, &[]);
    let fired: Vec<_> = shots.iter().map(|shot| shot.1).collect();
    assert_eq!(fired, [20, 80]);
}

#[test]
fn a_falling_trigger_is_a_rising_one_upside_down() {
    let recording: Vec<i16> = (0..500).map(|i| (i * i * 7 % 41) as i16 - 20).collect();
    let turned: Vec<i16> = recording.iter().map(|x| -x).collect();
    let up = cut(Cutter::new(12.0, 8.0, 9).unwrap(), &recording, &[]);
    let down = cut(Cutter::new(-12.0, -8.0, 9).unwrap(), &turned, &[]);
    assert!(up.len() > 5);
    assert_eq!(up, down);
}

#[test]
fn a_recording_that_ends_in_a_shot_has_what_there_is_of_it() {
    let mut recording = [0; 100];
    recording[20..60].fill(10);
    recording[90..].fill(10);
    let shots = cut(at_five(40), &recording, &[]);
    assert_eq!(places(&shots), [(16, 20, 40), (86, 90, 14)]);
}

#[test]
fn triggers_that_make_no_sense_are_refused() {
    assert!(Cutter::new(f64::NAN, 0.0, 5).is_err());
    assert!(Cutter::new(1.0, 0.0, 0).is_err());
}

proptest! {
    #[test]
    fn shots_do_not_depend_on_how_the_recording_was_divided(
        recording in prop::collection::vec(-20_i16..20, 0..600),
        pieces in prop::collection::vec(0_usize..90, 0..30),
        threshold in -5.0..15.0_f64,
        length in 1_usize..80,
        falling: bool,
    ) {
        let baseline = if falling { threshold + 4.0 } else { threshold - 4.0 };
        let cutter = || Cutter::new(threshold, baseline, length).unwrap();
        let whole = cut(cutter(), &recording, &[]);
        prop_assert_eq!(&whole, &cut(cutter(), &recording, &pieces));
        // Shots come one after the other, each with the sample that fired it.
        let mut free_from = 0;
        for (samples, trigger) in &whole {
            prop_assert!(samples.start >= free_from);
            prop_assert!(samples.contains(trigger));
            let fired = f64::from(recording[*trigger as usize]);
            let sign = if falling { -1.0 } else { 1.0 };
            prop_assert!(sign * fired >= sign * threshold);
            free_from = samples.end;
        }
    }

    #[test]
    fn any_floats_can_be_cut(
        recording in prop::collection::vec(
            prop_oneof![prop::num::f64::ANY, -1.0..1.0_f64], 0..300),
        threshold in -1.0..1.0_f64,
    ) {
        let mut cutter = Cutter::new(threshold, threshold - 0.2, 20).unwrap();
        let shots = cutter.feed(&recording).len() + cutter.finish().iter().len();
        prop_assert!(shots <= 15);
    }
}

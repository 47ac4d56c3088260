//! Cutting a recording does not depend on the pieces it comes in.

use super::*;
use proptest::prelude::*;

fn cut(trigger: LevelTrigger, recording: &[i16], pieces: &[usize]) -> Vec<Segment> {
    let mut shots = Vec::new();
    let mut cutter = Cutter::new(trigger).unwrap();
    let (mut left, mut needed_from) = (recording, 0);
    for piece in pieces.iter().chain(&[recording.len()]) {
        let (now, later) = left.split_at((*piece).min(left.len()));
        for shot in cutter.feed(&now.iter().map(|x| f64::from(*x)).collect::<Vec<_>>()) {
            assert!(shot.samples.start >= needed_from, "samples were dropped");
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
    let one = |shot: &Segment| {
        let count = shot.samples.end - shot.samples.start;
        (shot.samples.start, shot.trigger, count)
    };
    shots.iter().map(one).collect()
}

fn level(level: f64, before: usize, length: usize) -> LevelTrigger {
    LevelTrigger { level, falling: false, hysteresis: 2.0, before, length, hold_off: 0 }
}

#[test]
fn a_level_cuts_one_shot_a_pulse() {
    let mut recording = vec![0_i16; 100];
    recording[30] = 10;
    recording[31] = 9;
    recording[70] = 10;
    let shots = cut(level(5.0, 4, 12), &recording, &[]);
    assert_eq!(places(&shots), [(26, 30, 12), (66, 70, 12)]);
}

#[test]
fn a_signal_that_hangs_about_the_level_fires_once() {
    // Falls to 4 only: within the hysteresis of 2 below the level of 5.
    let mut recording = vec![0_i16; 20];
    recording.extend([6, 4, 6, 4, 6, 4, 6, 4, 6, 4]);
    recording.extend([0; 20]);
    let shots = cut(level(5.0, 2, 4), &recording, &[]);
    assert_eq!(shots.len(), 1);
}

#[test]
fn hold_off_swallows_what_comes_back() {
    let mut recording = vec![0_i16; 100];
    for at in [20, 40, 80] {
        recording[at] = 10;
    }
    let mut trigger = level(5.0, 2, 6);
    trigger.hold_off = 30;
    let shots = cut(trigger, &recording, &[]);
    let fired: Vec<_> = shots.iter().map(|shot| shot.trigger).collect();
    assert_eq!(fired, [20, 80]);
}

#[test]
fn a_falling_trigger_is_a_rising_one_upside_down() {
    let recording: Vec<i16> = (0..500).map(|i| (i * i * 7 % 41) as i16 - 20).collect();
    let turned: Vec<i16> = recording.iter().map(|x| -x).collect();
    let rising = level(12.0, 3, 9);
    let falling = LevelTrigger { level: -12.0, falling: true, ..rising };
    let up = cut(rising, &recording, &[]);
    let down = cut(falling, &turned, &[]);
    assert!(up.len() > 5);
    assert_eq!(up, down);
}

#[test]
fn a_recording_that_ends_in_a_shot_has_what_there_is_of_it() {
    let mut recording = [0; 100];
    recording[20..60].fill(10);
    recording[90..].fill(10);
    let shots = cut(level(5.0, 0, 40), &recording, &[]);
    assert_eq!(places(&shots), [(20, 20, 40), (90, 90, 10)]);
}

#[test]
fn triggers_that_make_no_sense_are_refused() {
    assert!(Cutter::new(level(f64::NAN, 0, 5)).is_err());
    assert!(Cutter::new(level(1.0, 5, 5)).is_err());
}

proptest! {
    #[test]
    fn shots_do_not_depend_on_how_the_recording_was_divided(
        recording in prop::collection::vec(-20_i16..20, 0..600),
        pieces in prop::collection::vec(0_usize..90, 0..30),
        threshold in -5.0..15.0_f64,
        before in 0_usize..20,
        after in 1_usize..60,
        hold_off in 0_u64..200,
        falling: bool,
    ) {
        let trigger = LevelTrigger {
            falling,
            hold_off,
            ..level(threshold, before, before + after)
        };
        let whole = cut(trigger, &recording, &[]);
        prop_assert_eq!(&whole, &cut(trigger, &recording, &pieces));
        // Shots come one after the other, each with the sample that fired it.
        let mut free_from = 0;
        for shot in &whole {
            prop_assert!(shot.samples.start >= free_from);
            prop_assert!(shot.samples.contains(&shot.trigger));
            let fired = f64::from(recording[shot.trigger as usize]);
            let sign = if falling { -1.0 } else { 1.0 };
            prop_assert!(sign * fired >= sign * threshold);
            free_from = shot.samples.end;
        }
    }

    #[test]
    fn any_floats_can_be_cut(
        recording in prop::collection::vec(
            prop_oneof![prop::num::f64::ANY, -1.0..1.0_f64], 0..300),
        threshold in -1.0..1.0_f64,
    ) {
        let trigger = LevelTrigger { hysteresis: 0.1, hold_off: u64::MAX, ..level(threshold, 5, 20) };
        let mut cutter = Cutter::new(trigger).unwrap();
        let shots = cutter.feed(&recording).len() + cutter.finish().iter().len();
        prop_assert!(shots <= 1);
    }
}

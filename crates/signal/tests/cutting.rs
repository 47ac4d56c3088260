//! Cutting a recording does not depend on the pieces it comes in.

use hertzchain_signal::{Cutter, Trigger};
use proptest::prelude::*;

type Shot = (u64, u64, Vec<i16>, bool);

fn cut(trigger: Trigger, recording: &[i16], pieces: &[usize]) -> Vec<Shot> {
    let mut shots = Vec::new();
    let mut cutter = Cutter::new(trigger).unwrap();
    let mut left = recording;
    for piece in pieces.iter().chain(&[recording.len()]) {
        let (now, later) = left.split_at((*piece).min(left.len()));
        cutter.feed(now, |s| {
            shots.push((s.first_sample, s.trigger, s.samples.to_vec(), s.complete));
        });
        left = later;
    }
    cutter.finish(|s| shots.push((s.first_sample, s.trigger, s.samples.to_vec(), s.complete)));
    shots
}

fn level(level: f64, before: usize, length: usize) -> Trigger {
    Trigger {
        level,
        falling: false,
        hysteresis: 2.0,
        before,
        length,
        hold_off: 0,
    }
}

#[test]
fn a_level_cuts_one_shot_a_pulse() {
    let mut recording = vec![0_i16; 100];
    recording[30] = 10;
    recording[31] = 9;
    recording[70] = 10;
    let shots = cut(level(5.0, 4, 12), &recording, &[]);
    let found: Vec<_> = shots.iter().map(|s| (s.0, s.1, s.2.len(), s.3)).collect();
    assert_eq!(found, [(26, 30, 12, true), (66, 70, 12, true)]);
    assert_eq!(shots[0].2[4], 10);
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
    let fired: Vec<_> = shots.iter().map(|s| s.1).collect();
    assert_eq!(fired, [20, 80]);
}

#[test]
fn a_falling_trigger_is_a_rising_one_upside_down() {
    let recording: Vec<i16> = (0..500).map(|i| (i * i * 7 % 41) as i16 - 20).collect();
    let turned: Vec<i16> = recording.iter().map(|x| -x).collect();
    let rising = level(12.0, 3, 9);
    let falling = Trigger {
        level: -12.0,
        falling: true,
        ..rising
    };
    let up = cut(rising, &recording, &[]);
    let down = cut(falling, &turned, &[]);
    assert!(up.len() > 5);
    assert_eq!(up.len(), down.len());
    assert!(up.iter().zip(&down).all(|(a, b)| a.0 == b.0 && a.1 == b.1));
}

#[test]
fn a_recording_that_ends_in_a_shot_says_so() {
    let mut recording = [0; 100];
    recording[20..60].fill(10);
    recording[90..].fill(10);
    let shots = cut(level(5.0, 0, 40), &recording, &[]);
    let found: Vec<_> = shots.iter().map(|s| (s.0, s.2.len(), s.3)).collect();
    assert_eq!(found, [(20, 40, true), (90, 10, false)]);
}

#[test]
fn triggers_that_make_no_sense_are_refused() {
    assert!(Cutter::<i16>::new(level(f64::NAN, 0, 5)).is_err());
    assert!(Cutter::<i16>::new(level(1.0, 5, 5)).is_err());
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
        let trigger = Trigger {
            falling,
            hold_off,
            ..level(threshold, before, before + after)
        };
        let whole = cut(trigger, &recording, &[]);
        prop_assert_eq!(&whole, &cut(trigger, &recording, &pieces));
        // What is handed out is what was recorded.
        for (first, _, samples, _) in &whole {
            let from = *first as usize;
            prop_assert_eq!(samples, &recording[from..from + samples.len()]);
        }
    }
}

//! Series: motion carried from impact to impact.

use super::small::{SAME_SPEED, plan, shots};
use crate::rig::instruments::programmed;
use crate::rig::recorder::Window;
use crate::rig::shot::{Bench, shoot};
use crate::rig::{MeasuredShot, Plan, Purpose, RandomStream};
use hertzchain_chain::observe::Passages;
use hertzchain_chain::settle::State;
use hertzchain_chain::wave::{self, Limits, Method};
use hertzchain_experiment::Experiment;

/// By how much a series' times of flight in s are longer on another rig, shot by shot.
fn longer_s(other: &Plan, series: usize, of: fn(&MeasuredShot) -> f64) -> Vec<f64> {
    let (one, other) = (shots(&plan(&[SAME_SPEED]), series), shots(other, series));
    let pairs = one.iter().zip(&other);
    pairs.map(|(one, other)| of(other) - of(one)).collect()
}

const INCIDENT_S: fn(&MeasuredShot) -> f64 = |fired| fired.shot.incident_s;
const REFLECTED_S: fn(&MeasuredShot) -> f64 = |fired| fired.shot.reflected_s;

/// The series of the slowest and of the fastest dry shots, and of the slowest wet ones.
const SLOW: usize = 0;
const FAST: usize = 2;
const SLOW_WET: usize = 3;

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn largest(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).fold(0.0, f64::max)
}

#[test]
fn every_shot_has_a_pulse_at_both_sensors_and_one_that_returns() {
    let plan = plan(&[]);
    for series in 0..plan.series.len() {
        for fired in shots(&plan, series) {
            let shot = &fired.shot;
            assert!(shot.incident_s > 0.0 && shot.reflected_s > 0.0, "{shot:?}");
            assert!(shot.rest_s > shot.peaks_s[2]);
            assert_eq!(fired.record.samples.len(), 10_000);
            assert!(fired.record.samples.iter().any(|sample| *sample > 100));
        }
    }
}

/// Three times the friction holds other loads on the contacts: slow shots take 0.3 µs longer, in
/// oil 0.7 µs. Twice less and twice more are allowed for, as three shots of one seed scatter.
#[test]
fn friction_makes_slow_shots_later() {
    let other = plan(&[SAME_SPEED, ("friction = 0.05", "friction = 0.15")]);
    for (series, found_s) in [(SLOW, 0.29e-6), (SLOW_WET, 0.68e-6)] {
        let longer_s = mean(&longer_s(&other, series, INCIDENT_S));
        assert!((0.5 * found_s..2.0 * found_s).contains(&longer_s), "{longer_s:e}");
    }
}

/// What seats the chain, other taps or gaps, leaves other loads from shot to shot: slow shots move
/// by some 0.3 µs either way, fast ones, whose own forces are far above, by a tenth of that.
fn seats_otherwise(other: &Plan) {
    let slow_s = longer_s(other, SLOW, INCIDENT_S);
    let largest_s = largest(&slow_s);
    assert!((0.15e-6..0.8e-6).contains(&largest_s), "{slow_s:?}");
    let both_ways = slow_s.iter().any(|s| *s > 0.0) && slow_s.iter().any(|s| *s < 0.0);
    assert!(both_ways, "{slow_s:?}");
    let fast_s = largest(&longer_s(other, FAST, INCIDENT_S));
    assert!((0.01e-6..0.3 * largest_s).contains(&fast_s), "{fast_s:e} {largest_s:e}");
}

#[test]
fn taps_move_slow_shots_either_way_and_fast_ones_less() {
    seats_otherwise(&plan(&[SAME_SPEED, ("taps = 2", "taps = 0")]));
}

#[test]
fn seating_scatter_moves_slow_shots_either_way_and_fast_ones_less() {
    seats_otherwise(&plan(&[SAME_SPEED, ("\"5 um\"", "\"50 um\"")]));
}

/// Beads of other sizes are the same in every shot: radii that spread by 0.1 % make all fast returns
/// of this lot later by 0.55 to 0.65 µs.
#[test]
fn sizes_of_beads_move_all_fast_shots_alike() {
    let other = plan(&[SAME_SPEED, ("radius_spread = 0", "radius_spread = 0.001")]);
    let longer_s = longer_s(&other, FAST, REFLECTED_S);
    let mean_s = mean(&longer_s);
    assert!((0.3e-6..1.0e-6).contains(&mean_s), "{longer_s:?}");
    for one_s in &longer_s {
        assert!((one_s - mean_s).abs() < 0.5 * mean_s, "{longer_s:?}");
    }
}

#[test]
fn a_shot_leaves_what_the_next_one_finds() {
    let push = "[near_end]\npush = \"spring\"\nforce = \"0.24 N\"\nstiffness = \"100 N/m\"";
    let loose = plan(&[
        SAME_SPEED,
        (push, ""),
        ("incline = \"0.2 deg\"", "incline = \"0 deg\""),
        ("taps = 2", "taps = 0"),
    ]);
    let shots = shots(&loose, 2);
    let experiment = &loose.case(&loose.series[2]).experiment;
    for pair in shots.windows(2) {
        let (left, found) = (&pair[0].shot, &pair[1].shot);
        // Positions and velocities, to the bit.
        assert_eq!(left.after, found.before);
        // Another material law of the same chain: rest overlaps are 0 without load.
        assert_eq!(left.gaps_after_m, found.gaps_before_m);
        // Nothing is left of the motion: the next shot waits for rest.
        assert!(left.after.rests(), "{:?}", left.after.velocity_m_s);
        assert_eq!(wave_from(experiment, &found.before, &pair[1]), found.incident_s);
    }
    let after = &shots[0].shot.gaps_after_m;
    assert!(after.iter().any(|gap_m| *gap_m > 1e-6), "{after:?}");
}

/// Incident time of flight in s of the wave that a shot makes in a chain left as it is here.
fn wave_from(experiment: &Experiment, state: &State, fired: &MeasuredShot) -> f64 {
    let (system, _) = experiment.system(Some(fired.speed_m_s)).unwrap();
    let mut state = state.clone();
    state.strike(&system, fired.speed_m_s);
    let shot = system.from_state(&state).unwrap();
    let mut passages = Passages::new(experiment.sensor_bead(), shot.beads(), true);
    // As the rig's own wave, for the same bits.
    let method = Method::dormand_prince(1e-8);
    wave::run(&shot, &method, Limits::until(0.02), &mut [&mut passages]).unwrap();
    let (incident, wall, _) = passages.peaks().unwrap();
    wall.time_s - incident.time_s
}

/// Taps and all: one bench, on which no user puts anything straight between impacts.
#[test]
fn a_series_is_taps_and_shots_on_one_bench() {
    let plan = plan(&[SAME_SPEED]);
    for at in [1, 5] {
        let series = &plan.series[at];
        let experiment = &plan.case(series).experiment;
        let campaign = experiment.campaign();
        let tap_m_s = programmed(&campaign.actuator, campaign.tap_speed_m_s).unwrap();
        let mut laying = RandomStream::new(plan.seed, series.number, Purpose::Assembly);
        let mut bench = Bench::assemble(experiment, &mut laying).unwrap();
        for fired in shots(&plan, at) {
            for _ in 0..campaign.taps {
                bench.tap(tap_m_s).unwrap();
            }
            assert_eq!(*bench.state(), fired.shot.before);
            let recorder = &campaign.recorder;
            let mut trace = Window::new(recorder, 0.0, &mut laying).trace();
            let sensor = experiment.sensor_bead();
            shoot(&mut bench, sensor, fired.speed_m_s, &mut trace).unwrap();
            assert_eq!(*bench.state(), fired.shot.after);
        }
    }
}

/// The actuator's and the gate's chance does not depend on taps.
#[test]
fn the_same_shots_are_fired_whatever_the_number_of_taps() {
    let fired = |taps: &str| -> Vec<(f64, f64)> {
        let shots = shots(&plan(&[("taps = 2", taps)]), 1);
        shots.iter().map(|fired| (fired.speed_m_s, fired.measured_m_s)).collect()
    };
    assert_eq!(fired("taps = 0"), fired("taps = 3"));
}

#[test]
fn series_and_shots_differ_and_a_seed_repeats_them() {
    let plan = plan(&[]);
    let (one, again) = (shots(&plan, 1), shots(&plan, 1));
    for (a, b) in one.iter().zip(&again) {
        assert_eq!(a.record, b.record);
    }
    assert!(one[0].record != one[1].record);
    assert!(one[0].speed_m_s != shots(&plan, 4)[0].speed_m_s);
}

/// Keys of `[campaign.recorder]` beside those of the small campaign.
fn recorder(keys: &str) -> Plan {
    let keys = format!("before = \"1 ms\"\n{keys}");
    let silent = "[campaign.amplifier]\nnoise = \"0 V\"\n\n[campaign.recorder]";
    plan(&[("before = \"1 ms\"", &keys), ("[campaign.recorder]", silent)])
}

#[test]
fn a_level_in_the_file_starts_records_where_the_channel_passes_it() {
    // 50 mV of 10 V over 15 bits.
    let level = (0.05 / 10.0 * 32768.0) as i16;
    for series in [0, 2, 5] {
        for fired in shots(&recorder("trigger = \"level\"\nlevel = \"50 mV\""), series) {
            let record = &fired.record;
            // 1 ms at 500 kHz lies before the trigger.
            assert!(record.samples[..500].iter().all(|sample| *sample <= level));
            assert!(record.samples[500] >= level);
            // The pulse takes a while from the touch to the sensor bead.
            assert!(record.touch_s < 1e-3 - 20e-6, "{}", record.touch_s);
        }
    }
}

/// Its name is reported by the file, the campaign's report and the doubts of a measurement.
#[test]
fn a_level_that_no_shot_passes_is_told_shot_by_shot() {
    let plan = recorder("trigger = \"level\"\nlevel = \"9 V\"");
    assert!(shots(&plan, 0).iter().all(|fired| !fired.record.triggered));
    let plan = recorder("trigger = \"level\"\nlevel = \"50 mV\"");
    assert!(shots(&plan, 0).iter().all(|fired| fired.record.triggered));
}

#[test]
fn separate_channels_add_up_to_the_summed_one() {
    let (summed, separate) = (recorder(""), recorder("channels = \"separate\""));
    for (one, two) in shots(&summed, 1).iter().zip(shots(&separate, 1)) {
        let (sensor, wall) = two.record.samples.split_at(one.record.samples.len());
        assert_eq!(sensor.len(), wall.len());
        let channels = sensor.iter().zip(wall);
        for (sum, (sensor, wall)) in one.record.samples.iter().zip(channels) {
            // Each of the three is rounded to half a count.
            assert!((sum - sensor - wall).abs() <= 1, "{sum} {sensor} {wall}");
        }
        let peak = |samples: &[i16]| {
            let all = samples.iter().enumerate();
            all.max_by_key(|(_, sample)| **sample).unwrap().0
        };
        assert!(peak(sensor) < peak(wall));
    }
}

/// A row that no spring pushes: taps leave gaps, which liquid closes where friction holds the weight alone.
#[test]
fn bridges_close_most_gaps_of_a_steep_smooth_row_without_springs() {
    let bridge = "\"damping_viscoelastic\", { law = \"capillary_bridge\", surface_tension = \"30 mN/m\", \
                  volume = \"0.1 µl\" }]";
    let loose =
        ("[near_end]\npush = \"spring\"\nforce = \"0.24 N\"\nstiffness = \"100 N/m\"\n", "");
    let open = |wet: &str, friction: &str| {
        let steep = ("incline = \"0.2 deg\"", "incline = \"0.5 deg\"");
        let friction = ("friction = 0.05", friction);
        let changes = [loose, steep, friction, ("\"damping_viscoelastic\"]", wet)];
        let all = shots(&plan(&changes), SLOW_WET);
        let gaps = all.iter().flat_map(|fired| &fired.shot.gaps_before_m);
        gaps.filter(|&&gap_m| gap_m > 0.0).count()
    };
    let dry = "\"damping_viscoelastic\"]";
    // Friction of 4.2 and 0.84 mN, of which the weight takes 0.73; pull of 1.2 mN.
    let [held, drawn] = [open(bridge, "friction = 0.05"), open(bridge, "friction = 0.01")];
    let without = open(dry, "friction = 0.01");
    // Of 36, twelve contacts before three shots: 8, 36 and 36.
    assert!(drawn < 15 && held > 30 && without > 30, "{drawn} {held} {without}");
}

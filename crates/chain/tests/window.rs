//! Beads that the wave has not reached cost nothing and change nothing.

use crate::common::*;
use hertzchain_chain::observe::{Maximum, Signal};
use hertzchain_chain::wave::{Limits, Method, Outcome, run};
use hertzchain_chain::*;

fn run_window(chain: &Chain, duration_s: f64, whole_chain: bool) -> Outcome {
    let system = System::new(chain).unwrap();
    let limits = Limits { whole_chain, ..Limits::until(duration_s) };
    run(&system, &Method::dormand_prince(1e-7), limits, &mut []).unwrap()
}

#[test]
fn without_preload_the_window_is_exact_to_the_bit_and_saves_work() {
    let laws = vec![hertz(), viscoelastic(), cubic()];
    let chain = row(200, 0.5, laws);
    let (part, whole) = (run_window(&chain, 2e-3, false), run_window(&chain, 2e-3, true));
    let bits = |o: &Outcome| -> Vec<u64> {
        o.velocity_m_s.iter().chain(&o.displacement_m).map(|x| x.to_bits()).collect()
    };
    assert_eq!(bits(&part), bits(&whole));
    assert!(part.work.bodies_passed * 10 < whole.work.bodies_passed * 7);
}

#[test]
fn under_preload_the_window_changes_nothing_that_matters() {
    let push = Push::Constant { force_n: 5.0 };
    let chain = Chain { push, ..row(200, 0.5, vec![hertz(), viscoelastic()]) };
    let (part, whole) = (run_window(&chain, 1e-3, false), run_window(&chain, 1e-3, true));
    for (a, b) in part.velocity_m_s.iter().zip(&whole.velocity_m_s) {
        assert!((a - b).abs() < 1e-12 * 0.5, "{a} {b}");
    }
    assert!(part.work.bodies_passed < whole.work.bodies_passed);
}

/// The leading pulse of a long Hertz chain keeps the speed and the amplitude
/// that the exact solitary wave of its own amplitude has.
#[test]
fn a_pulse_keeps_speed_and_amplitude_over_a_hundred_thousand_beads() {
    let beads = 100_000;
    let chain = unit_row(beads, 1.0, FarEnd::Free);
    let system = System::new(&chain).unwrap();
    let mut early = Signal::new(Sensor::Velocity(100));
    let mut late = Signal::new(Sensor::Velocity(beads - 20));
    let duration = beads as f64 / 0.840_508_77;
    let method = Method::dormand_prince(3e-11);
    let outcome =
        run(&system, &method, Limits::until(duration), &mut [&mut early, &mut late]).unwrap();
    let (first, last) = (early.maxima()[0], late.maxima()[0]);
    let distance = (beads - 120) as f64;
    close(last.value, first.value, 1e-6);
    // An equal striker's leading pulse, as known to eight digits.
    close(last.value, 0.681_631_55, 1e-6);
    close(distance / (last.time_s - first.time_s), 0.840_508_77, 1e-6);
    // The mean number of beads that a force pass touches does not grow with the chain.
    assert!(outcome.work.bodies_passed / outcome.work.force_passes < 150);
    // Columns of numbers a bead and nothing a step: 30 MB, where the system reports it.
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let peak_kb = peak.and_then(|peak| peak.trim().strip_suffix(" kB")?.parse::<u64>().ok());
    assert!(peak_kb.is_none_or(|kb| kb < 120_000), "{peak_kb:?} kB");
}

/// Sleep where the wave has been, reflected pulse and secondary pulses included.
#[test]
fn beads_asleep_where_the_wave_has_been_change_nothing_that_matters() {
    let laws = vec![hertz(), viscoelastic(), cubic()];
    for laws in [vec![hertz()], laws] {
        let chain = row(700, 0.8, laws);
        // Far enough for the pulse to come back to the middle.
        let duration = 2.6e-2;
        let (part, whole) =
            (run_window(&chain, duration, false), run_window(&chain, duration, true));
        for (i, (a, b)) in part.velocity_m_s.iter().zip(&whole.velocity_m_s).enumerate() {
            // A thousand times the tolerance: both runs are that wrong by then.
            assert!((a - b).abs() < 1e-4 * 0.8, "body {i}: {a} {b}");
        }
    }
}

/// Behind a pulse on its way back, what creeps takes longer steps than the pulse.
#[test]
fn a_second_clock_for_what_creeps_changes_nothing_that_matters_and_saves_work() {
    for laws in [vec![hertz()], vec![hertz(), viscoelastic(), cubic()]] {
        let system = System::new(&row(600, 0.8, laws)).unwrap();
        let fly = |whole_chain: bool| {
            let mut sensor = Signal::new(Sensor::Bead(400));
            let limits = Limits { whole_chain, budget: true, ..Limits::until(1.9e-2) };
            let method = Method::dormand_prince(3e-9);
            let limits = Limits { slow_tolerance: Some(1e-7), ..limits };
            let outcome = run(&system, &method, limits, &mut [&mut sensor]).unwrap();
            let residual = outcome.budget.unwrap().relative_residual();
            // The residual is up to 880 times the tolerance after 1,000 beads.
            assert!(residual.abs() < 3e-6, "{residual:e}");
            (sensor.maxima().to_vec(), outcome.work)
        };
        let ((part, cheap), (whole, dear)) = (fly(false), fly(true));
        let largest = |from_s: f64, maxima: &[Maximum]| {
            let late = maxima.iter().filter(|peak| peak.time_s > from_s).copied();
            late.reduce(|best, peak| if peak.value > best.value { peak } else { best }).unwrap()
        };
        for from_s in [0.0, 1.5e-2] {
            let (one, two) = (largest(from_s, &part), largest(from_s, &whole));
            // Ten times the slow bodies' tolerance: peaks lie in the pulse.
            close(one.time_s, two.time_s, 1e-6);
            close(one.value, two.value, 1e-5);
        }
        assert!(cheap.bodies_passed * 2 < dear.bodies_passed, "{cheap:?} {dear:?}");
    }
}

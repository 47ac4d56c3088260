//! Steps of the ensemble loop allocate nothing.

use crate::common::ensemble::*;
use crate::common::*;
use allocation_counter::{AllocationInfo, measure};
use hertzchain_chain::ensemble::{End, Precision, Settings};
use hertzchain_chain::laws::{DampingPower, law};
use hertzchain_chain::*;

/// What firing alike chains allocates, and how many steps it takes.
fn allocated(
    precision: Precision,
    systems: &[System],
    step: (f64, f64),
    settings: &Settings,
) -> (AllocationInfo, u64) {
    // What is made once for all shots is made before anything is counted.
    let _ = fire_all_in(precision, systems, step, settings);
    let mut steps = 0;
    let info = measure(|| {
        let flown = fire_all_in(precision, systems, step, settings);
        steps = flown[0].as_ref().unwrap().work.steps;
    });
    (info, steps)
}

fn chains() -> Vec<Chain> {
    let power = law(DampingPower { coefficient: 1.0, rate_exponent: 1.3, overlap_exponent: 0.2 });
    let dry = row(20, 0.5, vec![hertz(), viscoelastic(), cubic()]);
    vec![
        dry.clone(),
        row(20, 0.5, vec![hertz(), power]),
        Chain { push: Push::Spring { force_n: 1.0, stiffness_n_m: 1e4 }, ..dry },
    ]
}

fn until_the_end(sensors: Vec<Sensor>) -> Settings {
    Settings { sensors, end: End::Duration, openings: true, ..settings(20) }
}

/// One shot alone and full blocks.
const LANES: [(Precision, usize); 4] = [
    (Precision::Double, 1),
    (Precision::Double, 8),
    (Precision::Single, 1),
    (Precision::Single, 16),
];

#[test]
fn the_number_of_allocations_does_not_depend_on_the_number_of_steps() {
    let settings = until_the_end(vec![]);
    for chain in chains() {
        for (precision, lanes) in LANES {
            let systems = vec![System::new(&chain).unwrap(); lanes];
            let (few, steps) = allocated(precision, &systems, (0.1, 1e-3), &settings);
            let (many, more_steps) = allocated(precision, &systems, (0.05, 4e-3), &settings);
            assert!(more_steps > 6 * steps, "{steps} {more_steps}");
            assert_eq!(few.count_total, many.count_total, "{lanes} lanes");
            assert_eq!(few.bytes_total, many.bytes_total, "{lanes} lanes");
        }
    }
}

#[test]
fn sensors_allocate_before_and_after_the_steps_but_not_within() {
    let settings = until_the_end(watched(20));
    for (precision, lanes) in LANES {
        let systems = vec![System::new(&chains()[0]).unwrap(); lanes];
        let (few, steps) = allocated(precision, &systems, (0.1, 1e-3), &settings);
        let (many, more_steps) = allocated(precision, &systems, (0.05, 4e-3), &settings);
        assert!(more_steps > 6 * steps, "{steps} {more_steps}");
        // What a sensor gives, stretches and maxima, is gathered afterwards in
        // vectors that double: 8 times the steps are 3 doublings of each, one
        // more where they begin just above a power of two.
        let doublings = 2 * (3 + 1) * (2 * lanes as u64);
        let more = many.count_total.saturating_sub(few.count_total);
        assert!(more <= doublings, "{more} > {doublings} for {lanes} lanes");
    }
}

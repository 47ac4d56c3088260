//! What flies through a gap takes neither memory nor steps of the ensemble loop.

use crate::common::ensemble::*;
use crate::common::*;
use allocation_counter::measure;
use hertzchain_chain::ensemble::Settings;
use hertzchain_chain::wave::SolveError;
use hertzchain_chain::*;

/// A row with a gap before a contact.
fn with_gap(gap_m: f64) -> System {
    let gaps = vec![Gap { contact: 3, gap_m }];
    let dry = row(20, 0.5, vec![hertz(), viscoelastic()]);
    System::new(&Chain { gaps, ..dry }).unwrap()
}

#[test]
fn a_flight_through_a_long_gap_is_given_up_for_little_memory() {
    let settings = Settings { openings: true, ..settings(20) };
    let systems: Vec<System> = [10.0, 1e-3, 3.0].map(with_gap).into_iter().collect();
    let took = measure(|| {
        // Twenty seconds: forty million steps.
        let flown = fire_all(&systems, (0.036, 20.0), &settings);
        let Err(SolveError::TooManySteps { time_s, .. }) = flown[0] else {
            unreachable!("a flight of twenty seconds was followed")
        };
        // As soon as it is looked at: 4,096 steps after three beads have let go.
        assert!(time_s < 5e-3, "{time_s} s");
        assert!(flown[1].is_ok(), "a short gap is crossed");
        assert!(flown[2].is_err());
    });
    // Rows for 65,536 steps of eight lanes, reserved at once, and the state of twenty beads.
    assert!(took.bytes_max < 12 << 20, "{} bytes", took.bytes_max);
    // A lane that is given up changes no bit of its neighbours.
    let alone = fire_one(&systems[1], (0.036, 20.0), &settings);
    let beside = fire_all(&systems, (0.036, 20.0), &settings).remove(1);
    assert_eq!(alone.signals[1].maxima(), beside.unwrap().signals[1].maxima());
}

//! Steps of the slow phase allocate nothing.

use crate::common::*;
use allocation_counter::{AllocationInfo, measure};
use hertzchain_chain::settle::{SlowPhase, State, settle};
use hertzchain_chain::*;

/// What a tap allocates, and how many steps it takes.
fn allocated(system: &System, start: &State, step: f64) -> (AllocationInfo, u64) {
    let slow = SlowPhase { step, ..SlowPhase::default() };
    let (mut state, mut steps) = (start.clone(), 0);
    let info = measure(|| {
        let rest = settle(system, &mut state, &slow, &mut |_, _, _| {});
        steps = rest.unwrap().steps;
    });
    (info, steps)
}

#[test]
fn the_number_of_allocations_does_not_depend_on_the_number_of_steps() {
    let chain = Chain {
        push: Push::Constant { force_n: 0.24 },
        ..row(20, 0.18, vec![hertz(), viscoelastic(), cubic()])
    };
    let system = System::new(&chain).unwrap();
    let start = State::start(&system);
    // What is made once for all taps is made before anything is counted.
    let _ = allocated(&system, &start, 0.05);
    let (few, steps) = allocated(&system, &start, 0.05);
    let (many, more_steps) = allocated(&system, &start, 0.005);
    assert!(more_steps > 5 * steps, "{steps} {more_steps}");
    assert_eq!(few.count_total, many.count_total);
    assert_eq!(few.bytes_total, many.bytes_total);
}

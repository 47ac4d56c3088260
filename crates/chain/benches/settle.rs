//! What a tap costs, from impact to rest.
//!
//! `cargo bench -p hertzchain-chain --bench settle`; an item is a force pass.
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on should fail")]

#[path = "../tests/common/mod.rs"]
mod common;

use common::{cubic, hertz, row, viscoelastic};
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use hertzchain_chain::settle::{Rest, SlowPhase, State, settle};
use hertzchain_chain::{Chain, Push, System};

fn main() {
    divan::main();
}

/// One tap of the row at a speed in m/s, set up anew.
fn tap(system: &System, speed_m_s: f64) -> Rest {
    let mut state = State::start(system);
    state.strike(system, speed_m_s);
    settle(system, &mut state, &SlowPhase::default(), &mut |_, _, _| {}).unwrap()
}

/// Pushed by the paper's spring, or free.
fn bench(bencher: Bencher<'_, '_>, push: Push, speed_m_s: f64) {
    let chain = Chain { push, ..row(40, 1.0, vec![hertz(), viscoelastic(), cubic()]) };
    let system = System::new(&chain).unwrap();
    let steps = tap(&system, speed_m_s).steps;
    bencher.counter(ItemsCount::new(steps)).bench(|| black_box(tap(&system, speed_m_s)));
}

#[divan::bench(args = [0.18, 1.0])]
fn until_rest_under_a_push(bencher: Bencher<'_, '_>, speed_m_s: f64) {
    let push = Push::Spring { force_n: 0.24, stiffness_n_m: 100.0 };
    bench(bencher, push, speed_m_s);
}

#[divan::bench(args = [0.18, 1.0])]
fn until_rest_without_a_push(bencher: Bencher<'_, '_>, speed_m_s: f64) {
    bench(bencher, Push::None, speed_m_s);
}

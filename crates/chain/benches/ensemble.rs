//! What a shot costs: by instruction set, by law, alone and in a long chain.
//!
//! `cargo bench -p hertzchain-chain`; an item is a bead's step unless a
//! bench says otherwise.
#![allow(clippy::unwrap_used, reason = "a bench that cannot go on should fail")]

#[path = "../tests/common/mod.rs"]
mod common;

use common::{cubic, hertz, row, viscoelastic};
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use hertzchain_chain::ensemble::{End, Precision, Settings, Shot, fire};
use hertzchain_chain::laws::{DampingPower, Law, law};
use hertzchain_chain::{FarEnd, InstructionSet, Sensor, System};
use std::sync::Arc;

fn main() {
    divan::main();
}

/// The laws of a bench by name; `unfused` is a sum that the loop runs law by law.
fn laws(name: &str) -> Vec<Arc<dyn Law>> {
    let power = DampingPower { coefficient: 1.0, rate_exponent: 1.0, overlap_exponent: 0.5 };
    match name {
        "hertz" => vec![hertz()],
        "viscoelastic" => vec![hertz(), viscoelastic()],
        "dry" => vec![hertz(), viscoelastic(), cubic()],
        "unfused" => vec![viscoelastic(), hertz(), cubic()],
        _ => vec![hertz(), law(power)],
    }
}

fn settings(set: &str, beads: usize) -> Settings {
    Settings {
        sensors: vec![Sensor::Bead(7), Sensor::Contact(beads)],
        end: End::Passed,
        set: InstructionSet::named(set).unwrap_or_default(),
        shapes: false,
        whole_chain: false,
        openings: false,
    }
}

/// As many shots of the paper's row as run side by side. An item is a body
/// that is looked at in a step.
fn block(bencher: Bencher<'_, '_>, precision: Precision, set: &str, name: &str) {
    let system = System::new(&row(40, 0.5, laws(name))).unwrap();
    let shot = Shot { system: &system, step: 0.16, duration_s: 5e-3, precision };
    let settings = settings(set, 40);
    let shots = vec![shot; precision.lanes()];
    let looked_at = fire(&shots, &settings)[0].as_ref().unwrap().bodies_looked_at;
    let items = ItemsCount::new(looked_at as usize * shots.len());
    bencher.counter(items).bench(|| black_box(fire(&shots, &settings)));
}

const SETS: [&str; 3] = ["avx512", "avx2", "sse2"];
const LAWS: [&str; 5] = ["hertz", "viscoelastic", "dry", "unfused", "damping_power"];

#[divan::bench(args = SETS)]
fn dry_shots_in_double_precision(bencher: Bencher<'_, '_>, set: &str) {
    block(bencher, Precision::Double, set, "dry");
}

#[divan::bench(args = SETS)]
fn dry_shots_in_single_precision(bencher: Bencher<'_, '_>, set: &str) {
    block(bencher, Precision::Single, set, "dry");
}

#[divan::bench(args = LAWS)]
fn laws_in_double_precision(bencher: Bencher<'_, '_>, name: &str) {
    block(bencher, Precision::Double, "", name);
}

#[divan::bench(args = LAWS)]
fn laws_in_single_precision(bencher: Bencher<'_, '_>, name: &str) {
    block(bencher, Precision::Single, "", name);
}

/// An item is a shot.
#[divan::bench(args = [Precision::Double, Precision::Single])]
fn one_dry_shot_alone(bencher: Bencher<'_, '_>, precision: Precision) {
    let system = System::new(&row(40, 0.5, laws("dry"))).unwrap();
    let shot = Shot { system: &system, step: 0.16, duration_s: 5e-3, precision };
    let settings = settings("", 40);
    bencher.counter(ItemsCount::new(1_usize)).bench(|| black_box(fire(&[shot], &settings)));
}

/// What memory alone allows: as many numbers read and written as by a step of
/// [`one_long_chain`].
#[divan::bench(args = [100_000, 1_000_000], sample_count = 20, sample_size = 10)]
fn memory_of_one_long_chain(bencher: Bencher<'_, '_>, beads: usize) {
    // Written to, so that every page is there.
    let numbers = || vec![1.0_f64; beads];
    let (mut x, mut v, mut force, mut newest) = (numbers(), numbers(), numbers(), numbers());
    let [a, b, c, d] = std::array::from_fn(|_| numbers());
    bencher.counter(ItemsCount::new(beads)).bench_local(|| {
        for (force, (x, v)) in force.iter_mut().zip(x.iter().zip(&v)) {
            *force = x - v;
        }
        let earlier = a.iter().zip(&b).zip(c.iter().zip(&d));
        let bodies = x.iter_mut().zip(&mut v).zip(&mut newest).zip(&force);
        for ((((x, v), newest), force), ((a, b), (c, d))) in bodies.zip(earlier) {
            *newest = *force;
            *v += (a + b) + (c + d);
            *x += *v;
        }
        black_box((&x, &v));
    });
}

/// All of a long chain, whether it moves or not.
#[divan::bench(args = [40, 4_000, 100_000, 1_000_000], sample_count = 5)]
fn one_long_chain(bencher: Bencher<'_, '_>, beads: usize) {
    let mut chain = row(beads, 0.5, laws("hertz"));
    chain.far = FarEnd::Free;
    let system = System::new(&chain).unwrap();
    // Setting a long chain up costs some ten steps.
    let steps = (10_000_000 / beads).max(200);
    let shot = Shot {
        system: &system,
        step: 0.1,
        duration_s: 0.1 * steps as f64 * system.scales().time_s,
        precision: Precision::Double,
    };
    let settings =
        Settings { sensors: vec![], end: End::Duration, whole_chain: true, ..settings("", beads) };
    bencher.counter(ItemsCount::new(steps * beads)).bench(|| black_box(fire(&[shot], &settings)));
}

//! A shard of a sweep, as `merge` reads it.
#![no_main]

use hertzchain_fuzz::with_file;
use hertzchain_sim::BatchResult;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| with_file(".h5", bytes, |path| drop(BatchResult::read(path))));

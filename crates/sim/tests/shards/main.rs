//! Shards as files: whole or not at all, and the same wherever they are made.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

use hertzchain_experiment::preset;
use hertzchain_sim::{Batch, BatchOptions, BatchResult, Shard};
use std::fs;
use std::path::PathBuf;

/// A folder that goes away in the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("hertzchain-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        Self(path)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Ten shots, one of which has no speed.
fn small(accuracy: f64) -> Batch {
    let hertz = preset("hertz").unwrap();
    let hertz = hertz.set(&[("beads[0].count", 10.0)]).unwrap();
    let mut speeds: Vec<f64> = (1..=10).map(|i| 0.1 * f64::from(i)).collect();
    speeds[4] = -1.0;
    let options = BatchOptions { accuracy, ..BatchOptions::of(&hertz) };
    Batch::new(&hertz, speeds, options).unwrap()
}

fn shards(sweep: &Batch, folder: &Scratch, which: &[usize], of: usize) {
    for number in which {
        let shard = Shard::new(*number, of).unwrap();
        sweep.run_into(&folder.0, shard, &|| {}).unwrap();
    }
}

fn contents(part: &BatchResult) -> (Vec<u64>, Vec<usize>) {
    let values = part.rows.columns.iter().flatten();
    let failed = part.rows.failed.iter().map(|failed| failed.place);
    (values.map(|value| value.to_bits()).collect(), failed.collect())
}

#[test]
fn shards_of_several_folders_are_the_sweep_that_was_never_cut() {
    let sweep = small(1e-6);
    let whole = contents(&sweep.run(Shard::WHOLE, &|| {}));
    let (one, two) = (Scratch::new("one"), Scratch::new("two"));
    shards(&sweep, &one, &[1, 3], 3);
    // One of them twice: that is no harm.
    shards(&sweep, &two, &[2, 3], 3);
    let merged = BatchResult::gather(&[&one.0, &two.0], None).unwrap();
    assert_eq!(contents(&merged), whole);
    // More parts than shots: some are empty.
    let many = Scratch::new("many");
    shards(&sweep, &many, &(1..=12).collect::<Vec<_>>(), 12);
    assert_eq!(contents(&BatchResult::gather(&[&many.0], None).unwrap()), whole);
}

#[test]
fn a_shard_is_the_same_file_anywhere_and_is_not_computed_twice() {
    let sweep = small(1e-6);
    let (here, there) = (Scratch::new("here"), Scratch::new("there"));
    let shard = Shard::new(2, 2).unwrap();
    let computed = std::sync::atomic::AtomicUsize::new(0);
    let count = || {
        computed.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    let first = sweep.run_into(&here.0, shard, &count).unwrap();
    let again = sweep.run_into(&here.0, shard, &count).unwrap();
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let other = one_thread.install(|| sweep.run_into(&there.0, shard, &|| {})).unwrap();
    assert!(!first.stored && again.stored && !other.stored);
    assert_eq!(computed.into_inner(), 5);
    assert_eq!(fs::read(&first.path).unwrap(), fs::read(&other.path).unwrap());
    assert_eq!(contents(&again.result), contents(&first.result));
    assert_eq!(fs::read_dir(&here.0).unwrap().count(), 1, "nothing stays beside it");
}

#[test]
fn a_damaged_shard_counts_as_missing_and_is_made_again() {
    let sweep = small(1e-6);
    let folder = Scratch::new("damaged");
    shards(&sweep, &folder, &[1, 2], 2);
    let shard = Shard::new(1, 2).unwrap();
    let path = folder.0.join(format!("{}.h5", sweep.name(shard)));
    let sound = fs::read(&path).unwrap();
    // Cuts through its numbers; of what lies behind them nothing is reported.
    for place in [3, sound.len() / 3, sound.len() / 2] {
        fs::write(&path, &sound[..place]).unwrap();
        assert!(BatchResult::read(&path).is_err(), "cut at {place}");
        let error = BatchResult::gather(&[&folder.0], None).unwrap_err();
        let text = error.to_string();
        assert!(text.starts_with("1 of 2 shards are missing of "), "{text}");
        assert!(text.contains("--shard 1/2"), "{text}");
        assert_eq!(text.matches("is no whole shard").count(), 1, "{text}");
        assert!(!sweep.run_into(&folder.0, shard, &|| {}).unwrap().stored);
        assert_eq!(fs::read(&path).unwrap(), sound);
    }
}

#[test]
fn a_number_that_is_not_the_one_written_is_found_out() {
    let sweep = small(1e-6);
    let folder = Scratch::new("changed");
    fs::create_dir_all(&folder.0).unwrap();
    let part = sweep.run(Shard::WHOLE, &|| {});
    let path = part.write(&folder.0).unwrap();
    let sound = fs::read(&path).unwrap();
    // Any byte of the file: those that determine something are all covered.
    for place in (0..sound.len()).step_by(97) {
        let mut changed = sound.clone();
        changed[place] ^= 0x10;
        fs::write(&path, &changed).unwrap();
        if let Ok(read) = BatchResult::read(&path) {
            assert_eq!(contents(&read), contents(&part), "byte {place}");
        }
    }
}

#[test]
fn what_is_missing_or_another_runs_is_contents() {
    let folder = Scratch::new("missing");
    shards(&small(1e-6), &folder, &[2, 4, 7], 8);
    let error = BatchResult::gather(&[&folder.0], None).unwrap_err().to_string();
    assert!(error.contains("5 of 8 shards are missing"), "{error}");
    assert!(error.contains("1,3,5-6,8") && error.contains("--shard 1/8"), "{error}");
    shards(&small(1e-5), &folder, &[1], 1);
    let error = BatchResult::gather(&[&folder.0], None).unwrap_err().to_string();
    assert!(error.contains("2 different runs") && error.contains("accuracy 1e-5"), "{error}");
    let empty = Scratch::new("empty");
    fs::create_dir_all(&empty.0).unwrap();
    let error = BatchResult::gather(&[&empty.0], None).unwrap_err().to_string();
    assert!(error.contains("no shards in"), "{error}");
}

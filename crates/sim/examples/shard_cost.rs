//! What a shard costs beside its shots, and how many bytes a shot leaves: the numbers of
//! docs/how-to/many-machines.md. Times are wall time of one thread: run it on a quiet
//! machine, one process a core to see what workers take from each other.

use hertzchain_experiment::preset;
use hertzchain_sim::{Batch, BatchOptions, Shard};
use std::error::Error;
use std::fs;
use std::time::Instant;

/// Repetitions, of which the shortest counts.
const TIMES: usize = 9;

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    pool.install(cost)
}

fn cost() -> Result<(), Box<dyn Error + Send + Sync>> {
    let dry = preset("dry")?;
    let folder = std::env::temp_dir().join(format!("hertzchain-cost-{}", std::process::id()));
    for shots in [0_usize, 100, 1000, 4000] {
        let speeds = (0..shots).map(|i| 0.1 + 1.1 * i as f64 / shots as f64);
        let options = BatchOptions { accuracy: 1e-5, ..BatchOptions::of(&dry) };
        let batch = Batch::new(&dry, speeds.collect(), options)?;
        let (mut all, mut shooting) = (f64::INFINITY, f64::INFINITY);
        let mut bytes = 0;
        let times = if shots > 100 { 1 } else { TIMES };
        for _ in 0..times {
            let begun = Instant::now();
            let part = batch.run(Shard::WHOLE, &|| {});
            shooting = shooting.min(begun.elapsed().as_secs_f64());
            assert_eq!(part.rows.len(), shots);
            let begun = Instant::now();
            let done = batch.run_into(&folder, Shard::WHOLE, &|| {})?;
            all = all.min(begun.elapsed().as_secs_f64());
            bytes = fs::metadata(&done.path)?.len();
            fs::remove_file(&done.path)?;
        }
        println!(
            "{shots} shots: {:.2} ms, of these the shots {:.2} ms; {bytes} bytes",
            1e3 * all,
            1e3 * shooting
        );
    }
    fs::remove_dir_all(&folder)?;
    Ok(())
}

//! Sweeps in parts: what a part is does not depend on how the whole is cut.

use hertzchain_experiment::{Experiment, preset};
use hertzchain_sim::{Batch, BatchOptions, ErrorControl, Rows, Shard, parse_speeds};

/// Forty beads take a while: twelve do.
fn row(name: &str) -> Experiment {
    let experiment = preset(name).unwrap();
    experiment.set(&[("beads[0].count", 12.0)]).unwrap()
}

fn options(experiment: &Experiment, error_control: ErrorControl) -> BatchOptions {
    BatchOptions { error_control, ..BatchOptions::of(experiment) }
}

fn bits(rows: &Rows) -> Vec<u64> {
    let values = rows.columns.iter().flatten();
    values.map(|value| value.to_bits()).collect()
}

fn cut(batch: &Batch, of: usize) -> Rows {
    // The last part first: the order does not matter either.
    let mut parts: Vec<Rows> = Shard::all(of)
        .collect::<Vec<_>>()
        .into_iter()
        .rev()
        .map(|shard| batch.run(shard, &|| {}).rows)
        .collect();
    parts.reverse();
    Rows::dealt(&parts)
}

#[test]
fn shards_have_the_bits_of_the_batch_however_errors_are_controlled() {
    let dry = row("dry");
    let speeds = parse_speeds("log:0.1:1.2:163").unwrap();
    for control in [ErrorControl::PerShot, ErrorControl::Calibrated, ErrorControl::None] {
        let batch = Batch::new(&dry, speeds.clone(), options(&dry, control)).unwrap();
        let whole = batch.run(Shard::WHOLE, &|| {});
        let calibrated = whole.error_control.starts_with("calibrated");
        assert_eq!(calibrated, control == ErrorControl::Calibrated);
        for of in [2, 7] {
            let rows = cut(&batch, of);
            assert_eq!(bits(&rows), bits(&whole.rows), "{control:?} in {of}");
        }
    }
}

#[test]
fn calibration_of_a_shard_is_that_of_the_whole_batch() {
    let dry = row("dry");
    let speeds = parse_speeds("log:0.1:1.2:163").unwrap();
    let options = options(&dry, ErrorControl::Calibrated);
    let batch = Batch::new(&dry, speeds, options).unwrap();
    let [first, last] = [1, 82].map(|number| {
        let part = batch.run(Shard::new(number, 82).unwrap(), &|| {});
        (part.rows.len(), part.error_control)
    });
    // Two shots, and one: too few for calibration shots of their own.
    assert_eq!((first.0, last.0), (2, 1));
    assert_eq!(first.1, last.1);
    assert!(first.1.contains("48 calibration shots"), "{}", first.1);
}

#[test]
fn a_poisoned_shot_is_reported_and_changes_no_other() {
    let dry = row("dry");
    let sound = vec![0.2, 0.4, 0.6, 0.8];
    let poisoned = vec![0.2, f64::NAN, 0.4, -1.0, 0.6, 1e300, 0.8];
    let rows = |speeds: Vec<f64>, control, of| {
        let batch = Batch::new(&dry, speeds, options(&dry, control));
        cut(&batch.unwrap(), of)
    };
    for of in [1, 3] {
        let found = rows(poisoned.clone(), ErrorControl::PerShot, of);
        let places: Vec<usize> = found.failed.iter().map(|failed| failed.place).collect();
        assert_eq!(places, [1, 3, 5]);
        assert!(found.failed.iter().all(|failed| !failed.why.is_empty()));
        assert_eq!(found.flights(), rows(sound.clone(), ErrorControl::PerShot, 1).flights());
        let tuned = [1, 3].map(|of| bits(&rows(poisoned.clone(), ErrorControl::Calibrated, of)));
        assert_eq!(tuned[0], tuned[1]);
    }
}

#[test]
fn numbers_that_differ_from_shot_to_shot_are_those_of_experiments_of_their_own() {
    let dry = row("dry");
    let moduli = [180e9, 200e9, -1.0, 220e9];
    let run = Batch::new(&dry, vec![0.5; 4], BatchOptions::of(&dry)).unwrap();
    let run = run.with_number("young_modulus", moduli.to_vec()).unwrap();
    let rows = cut(&run, 3);
    assert_eq!(rows.failed.len(), 1);
    for (flight, modulus) in rows.flights().into_iter().zip([180e9, 200e9, 220e9]) {
        let own = dry.set(&[("young_modulus", modulus)]).unwrap();
        let own = Batch::new(&own, vec![0.5], BatchOptions::of(&own)).unwrap();
        assert_eq!(vec![flight], own.run(Shard::WHOLE, &|| {}).rows.flights());
    }
    let refused = |path: &str, values: usize| {
        let run = Batch::new(&dry, vec![0.5; 4], BatchOptions::of(&dry)).unwrap();
        run.with_number(path, vec![1.0; values]).unwrap_err().to_string()
    };
    assert!(refused("young_modulus", 3).contains("3 values for 4 shots"));
    assert!(refused("yong_modulus", 4).contains("young_modulus"));
    // These would be in the labels of the shots and nowhere else.
    assert!(refused("speed", 4).contains("give these as its speeds"));
    assert!(refused("solver.accuracy", 4).contains("share the solver"));
    let run = Batch::new(&dry, vec![0.5; 4], BatchOptions::of(&dry)).unwrap();
    let named = run.with_number("young_modulus", moduli.to_vec()).unwrap();
    let again = named.with_number("materials.aisi316.young_modulus", moduli.to_vec());
    assert!(again.unwrap_err().to_string().contains("named twice"));
}

#[test]
fn a_name_follows_from_every_input_and_from_nothing_else() {
    let dry = row("dry");
    let name = |experiment: &Experiment, speeds: &[f64], options: BatchOptions| {
        let run = Batch::new(experiment, speeds.to_vec(), options).unwrap();
        run.name(Shard::new(1, 2).unwrap())
    };
    let plain = name(&dry, &[0.5, 1.0], BatchOptions::of(&dry));
    assert!(plain.starts_with("sweep-") && plain.ends_with("-1-of-2"), "{plain}");
    let moved = Experiment::from_text("/elsewhere/row.toml", dry.text()).unwrap();
    let moved = moved.set(&[("beads[0].count", 12.0)]).unwrap();
    assert_eq!(name(&moved, &[0.5, 1.0], BatchOptions::of(&dry)), plain);
    let how = BatchOptions::of(&dry);
    let others = [
        name(&row("hertz"), &[0.5, 1.0], how),
        name(&dry, &[1.0, 0.5], how),
        name(&dry, &[0.5, 1.0_f64.next_up()], how),
        name(&dry, &[0.5, 1.0], BatchOptions { accuracy: 1e-5, ..how }),
        name(&dry, &[0.5, 1.0], BatchOptions { rebound: true, ..how }),
        name(&dry, &[0.5, 1.0], BatchOptions { checked: true, ..how }),
        name(&dry, &[0.5, 1.0], BatchOptions { duration_s: Some(1e-3), ..how }),
        name(&dry, &[0.5, 1.0], BatchOptions { error_control: ErrorControl::PerShot, ..how }),
    ];
    for (at, other) in others.iter().enumerate() {
        assert_ne!(other, &plain, "{at}");
        assert!(!others[..at].contains(other), "{at}");
    }
    let run = Batch::new(&dry, vec![0.5, 1.0], how).unwrap();
    // It is kept once it was asked for, but not by a run with other numbers.
    assert_eq!(run.fingerprint(), run.clone().fingerprint());
    let numbered = run.clone().with_number("poisson_ratio", vec![0.3, 0.3]).unwrap();
    assert_ne!(numbered.fingerprint(), run.fingerprint());
}

//! Batches with calibrated error control.

use hertzchain_experiment::{Experiment, preset};
use hertzchain_sim::{
    Batch, BatchOptions, BatchResult, Column, ErrorControl, Pick, Shard, parse_speeds,
};

fn batch(experiment: &Experiment, speeds: &str, accuracy: f64, control: ErrorControl) -> Batch {
    let options = BatchOptions { accuracy, error_control: control, ..BatchOptions::of(experiment) };
    Batch::new(experiment, parse_speeds(speeds).unwrap(), options).unwrap()
}

fn run(name: &str, speeds: &str, accuracy: f64) -> BatchResult {
    let batch = batch(&preset(name).unwrap(), speeds, accuracy, ErrorControl::default());
    batch.run(Shard::WHOLE, &|| {})
}

/// Relative errors of the times of flight of each shot, the larger, against shots that are much
/// more right.
fn errors(of: &BatchResult, exact: &BatchResult) -> Vec<f64> {
    let change = |column| {
        let times = of.rows.column(column).iter().zip(exact.rows.column(column));
        times.map(|(one, two)| (one / two - 1.0).abs()).collect::<Vec<f64>>()
    };
    let (incident, reflected) = (change(Column::Incident), change(Column::Reflected));
    incident.into_iter().zip(reflected).map(|(a, b)| a.max(b)).collect()
}

#[test]
fn errors_are_below_the_estimates_and_those_below_the_accuracy_asked() {
    for name in ["hertz", "hertz-viscoelastic", "dry"] {
        let exact = run(name, "log:0.075:1.23:300", 1e-6);
        for accuracy in [1e-3, 1e-4, 1e-5] {
            let found = run(name, "log:0.075:1.23:300", accuracy);
            assert!(
                found.error_control.starts_with("calibrated"),
                "{name}: {}",
                found.error_control
            );
            let reached = found.rows.column(Column::Accuracy);
            for (error, reached) in errors(&found, &exact).into_iter().zip(reached) {
                // What they are compared with is itself right to 1e-6.
                assert!(error <= reached + 1e-6, "{name} at {accuracy:e}: {error:e}, {reached:e}");
                assert!(*reached <= accuracy, "{name}: {reached:e} at {accuracy:e}");
            }
        }
    }
}

/// Between 0.53 and 0.60 m/s errors of this row's reflected times hang on where steps lie.
#[test]
fn narrow_ranges_of_speed_with_larger_errors_are_right() {
    let text = r#"
        materials.m = { young_modulus = "10.314368 GPa", poisson_ratio = 0.15663, density = "1107.65 kg/m^3" }
        striker = { speed = "0.5 m/s" }
        beads = [{ count = 14, radius = "1.3165421 mm", material = "m" }]
        contacts = [{ laws = ["elastic_hertz", { law = "damping_cubic", coefficient = "1.0235 kg s/m^2" }] }]
        far_end = { kind = "plane", material = "m" }
        sensors = { bead = 4 }
    "#;
    let row = Experiment::from_text("narrow.toml", text).unwrap();
    let run = |accuracy, control| {
        batch(&row, "log:0.02:3:2000", accuracy, control).run(Shard::WHOLE, &|| {})
    };
    let (found, exact) = (run(1e-5, ErrorControl::default()), run(1e-8, ErrorControl::PerShot));
    assert!(found.error_control.starts_with("calibrated"), "{}", found.error_control);
    let reached = found.rows.column(Column::Accuracy);
    for (error, reached) in errors(&found, &exact).into_iter().zip(reached) {
        assert!(error <= reached + 1e-8, "{error:e}, stated {reached:e}");
    }
}

/// In three balls a maximum of three quarters of the reflected pulse's height comes before it.
#[test]
fn a_shot_does_not_end_behind_a_lower_maximum_before_the_reflected_pulse() {
    let text = r#"
        materials.m = { young_modulus = "213 GPa", poisson_ratio = 0.3, density = "7960 kg/m^3", shear_viscosity = "3.2 kPa s" }
        striker = { speed = "0.5 m/s" }
        beads = [{ count = 3, radius = "6.35 mm", material = "m" }]
        contacts = [{ laws = ["elastic_hertz", "damping_viscoelastic"] }]
    "#;
    let row = Experiment::from_text("short.toml", text).unwrap();
    let run = |accuracy, control| {
        batch(&row, "log:0.075:1.23:200", accuracy, control).run(Shard::WHOLE, &|| {})
    };
    let (found, exact) = (run(1e-5, ErrorControl::default()), run(1e-7, ErrorControl::PerShot));
    assert!(found.error_control.starts_with("calibrated"), "{}", found.error_control);
    let worst = errors(&found, &exact).into_iter().fold(0.0, f64::max);
    // What they are compared with is itself right to 1e-7.
    assert!(worst <= 1e-5 + 1e-7, "{worst:e}");
}

/// The tenth of bead 1's peak is passed within the first steps.
#[test]
fn flanks_of_the_first_bead_are_timed_in_batches_too() {
    let row = preset("hertz").unwrap().set(&[("sensors.bead", 1.0)]).unwrap();
    let options = BatchOptions { accuracy: 1e-3, pick: Pick::Flank10, ..BatchOptions::of(&row) };
    let found = Batch::new(&row, vec![0.25, 0.5], options).unwrap().run(Shard::WHOLE, &|| {});
    let times = found.rows.column(Column::Incident);
    assert!(times.iter().all(|time_s| time_s.is_finite()), "{times:?}");
}

#[test]
fn wet_rows_whose_reflected_maxima_compete_are_calibrated_and_right() {
    for name in ["pump", "motor", "gear"] {
        let exact = run(name, "log:0.075:1.23:160", 1e-6);
        for accuracy in [1e-4, 1e-5] {
            let found = run(name, "log:0.075:1.23:160", accuracy);
            assert!(found.error_control.contains(", then "), "{name}: {}", found.error_control);
            let worst = errors(&found, &exact).into_iter().fold(0.0, f64::max);
            // What they are compared with is itself right to 1e-6.
            assert!(worst <= accuracy + 1e-6, "{name}: {worst:e} at {accuracy:e}");
        }
    }
}

#[test]
fn two_maxima_that_become_one_are_computed_more_closely() {
    // At these speeds the reflected pulse of this row has a flat top, which small errors move far.
    let pump = preset("pump").unwrap();
    let exact = batch(&pump, "0.185:0.189:200", 1e-7, ErrorControl::PerShot);
    let exact = exact.run(Shard::WHOLE, &|| {});
    for accuracy in [1e-4, 1e-5] {
        let found = run("pump", "0.185:0.189:200", accuracy);
        let worst = errors(&found, &exact).into_iter().fold(0.0, f64::max);
        assert!(worst <= accuracy, "{worst:e} at {accuracy:e}");
    }
}

#[test]
fn more_accuracy_takes_more_force_passes() {
    let dry = preset("dry").unwrap();
    let passes = |accuracy| {
        let batch = batch(&dry, "log:0.1:1:200", accuracy, ErrorControl::default());
        let mut passes = 0;
        batch.run_each(Shard::WHOLE, &|| {}, |it| passes += it.shot.unwrap().work.force_passes);
        passes
    };
    let [coarse, fine] = [1e-3, 1e-6].map(passes);
    assert!(2 * coarse < fine, "{coarse} {fine}");
}

#[test]
fn results_have_the_same_bits_on_any_number_of_threads_and_alone() {
    let dry = preset("dry").unwrap();
    let cell = |of: &BatchResult, at: usize| of.rows.columns.each_ref().map(|c| c[at].to_bits());
    let batch = batch(&dry, "log:0.1:1:170", 1e-4, ErrorControl::default());
    let whole = batch.run(Shard::WHOLE, &|| {});
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let again = pool.build().unwrap().install(|| batch.run(Shard::WHOLE, &|| {}));
        assert_eq!(again.error_control, whole.error_control);
        assert!((0..170).all(|at| cell(&again, at) == cell(&whole, at)), "{threads} threads");
    }
    // A shard of one shot.
    let alone = batch.run(Shard::new(12, 170).unwrap(), &|| {});
    assert_eq!(cell(&alone, 0), cell(&whole, 11));
}

#[test]
fn what_is_not_calibrated_says_why() {
    let dry = preset("dry").unwrap();
    let why = |experiment: &Experiment, speeds, control| {
        let result = batch(experiment, speeds, 1e-3, control).run(Shard::WHOLE, &|| {});
        result.error_control
    };
    let few = why(&dry, "0.3,0.5", ErrorControl::Calibrated);
    assert_eq!(few, "per shot: so few shots are computed sooner so");
    let asked = why(&dry, "0.3,0.5", ErrorControl::PerShot);
    assert_eq!(asked, "per shot: as asked");
    let dimer = why(&preset("dimer-steel-ptfe").unwrap(), "0.3:0.5:160", ErrorControl::Calibrated);
    assert!(dimer.contains("uniform rows"), "{dimer}");
}

#[test]
fn shots_damped_beyond_the_elastic_force_are_controlled_each_alone() {
    let dry = preset("dry").unwrap();
    let cubic = |i| if i % 10 == 0 { 4e4 } else { 77.0 };
    let values: Vec<f64> = (0..200).map(cubic).collect();
    let found = |accuracy, control| {
        let batch = batch(&dry, "log:0.1:1:200", accuracy, control);
        let batch = batch.with_number("damping_cubic.coefficient", values.clone()).unwrap();
        batch.run(Shard::WHOLE, &|| {})
    };
    let (found, exact) =
        (found(1e-5, ErrorControl::Calibrated), found(1e-7, ErrorControl::PerShot));
    assert!(found.error_control.contains("calibration shots"), "{}", found.error_control);
    let reached = found.rows.column(Column::Accuracy);
    for (error, reached) in errors(&found, &exact).into_iter().zip(reached) {
        assert!(error <= reached + 1e-7 && *reached <= 1e-5, "{error:e} {reached:e}");
    }
}

#[test]
fn numbers_that_differ_from_shot_to_shot_are_calibrated_together() {
    let dry = preset("dry").unwrap();
    let values: Vec<f64> = (0..200).map(|i| 40.0 + 0.4 * f64::from(i)).collect();
    let found = |accuracy| {
        let batch = batch(&dry, "log:0.1:1:200", accuracy, ErrorControl::default());
        let batch = batch.with_number("damping_cubic.coefficient", values.clone()).unwrap();
        batch.run(Shard::WHOLE, &|| {})
    };
    let (found, exact) = (found(1e-4), found(1e-6));
    assert!(found.error_control.contains("calibration shots"), "{}", found.error_control);
    assert!(errors(&found, &exact).into_iter().all(|error| error <= 1e-4));
}

//! How well a fit describes its data, and which number does not.

use crate::common::{Noise, Truth, model, problem, speeds_m_s};
use hertzchain_experiment::preset;
use hertzchain_infer::{Fitting, Goodness, fit};

#[test]
fn the_largest_residual_names_the_number_that_is_off() {
    let dry = preset("dry").unwrap();
    let truth = Truth::of(&dry, &speeds_m_s(8));
    let model = model(&dry, &["eta", "B"]);
    for correlation in [0.0, -0.5] {
        let noise = Noise { correlation, ..Noise::of_the_paper() };
        // Named alone, and as the first of both, in twelve data sets.
        let mut named = [0; 2];
        for (seed, (of, name)) in (0..6).flat_map(|seed| TIMES.map(|time| (seed, time))) {
            let mut data = truth.measured_with(noise, seed);
            // The row's speed, known to 0.7 mm/s, moves both of its times by four of their errors,
            // so that the one that is off shows by √(1/2) of these and by its own sum.
            let row = &mut data.rows[3];
            let time = row.values[of].as_mut().unwrap();
            time.value += 30.0 * time.sigma;
            let line = row.line;
            let problem = problem(&model, data);
            let best = fit(&problem, &Fitting::default()).unwrap();
            let found = Goodness::new(&problem, &best).largest.unwrap();
            assert!(found.label.starts_with(&format!("line {line},")), "{found:?}");
            let first = found.label.split(" or ").next().unwrap();
            named[0] += usize::from(found.label.ends_with(name) && first == found.label);
            named[1] += usize::from(first.ends_with(name));
        }
        assert!(named[1] >= 11, "{correlation}: {named:?}");
    }
}

/// Times of flight as labels name them.
const TIMES: [(usize, &str); 2] = [(0, "incident ToF"), (1, "reflected ToF")];

#[test]
fn degrees_of_freedom_count_combinations_that_the_data_determine() {
    let dry = preset("dry").unwrap();
    let model = model(&dry, &["Y", "nu", "eta", "B"]);
    let data = Truth::of(&dry, &speeds_m_s(6)).measured(1);
    let problem = problem(&model, data);
    let best = fit(&problem, &Fitting::default()).unwrap();
    assert_eq!(best.rank, 3);
    let found = Goodness::new(&problem, &best).chi_square.unwrap();
    assert_eq!(found.freedom, 12 - 3);
}

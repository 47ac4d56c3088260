//! Standard errors that come from the scatter of a few shots.

use crate::toys::{Curve, normals, spaced, straight};
use hertzchain_infer::{
    Covariance, Data, Defaults, FEWEST_SHOTS, Fitting, Parameter, Selection, fit, widening,
};
use hertzchain_signal::coverage;

const SHOTS: usize = 20;
const POINTS: usize = 25;
const SETS: u64 = 2000;

type Line = Curve<fn(&[f64], f64) -> f64>;

/// Points whose errors, and the errors' sizes, come from twenty normal numbers each.
fn measured(seed: u64) -> Line {
    let free = vec![Parameter::new("a", "", 1.0), Parameter::new("b", "", 1.0)];
    let x = spaced(0.0, 1.0, POINTS);
    let mut line: Line = Curve::drawn(free, &x, 0.0, &[1.0, 2.0], seed, straight);
    let noise = normals(seed, POINTS * SHOTS);
    for (at, shots) in noise.chunks(SHOTS).enumerate() {
        let count = SHOTS as f64;
        let mean = shots.iter().sum::<f64>() / count;
        let squares: f64 = shots.iter().map(|shot| (shot - mean).powi(2)).sum();
        line.y[at] += mean;
        line.sigma[at] = (squares / (count - 1.0) / count).sqrt();
    }
    line
}

#[test]
fn intervals_hold_the_truth_where_errors_of_twenty_shots_are_widened_and_not_else() {
    let widened = widening(SHOTS as u32).unwrap();
    let pulls = (0..SETS).map(|seed| {
        let line = measured(seed);
        let found = fit(&line, &Fitting::default()).unwrap();
        // All σ by one factor: the same best line, standard errors by that factor.
        (found.point[1] - 2.0) / Covariance::new(&line.parameters, &found).sd[1]
    });
    let pulls: Vec<f64> = pulls.collect();
    for (reach, share) in [(1.0, 0.6827), (1.96, 0.95)] {
        let held = |factor: f64| coverage(&pulls, reach * factor).unwrap().share;
        // Three binomial standard errors; a finite number of points leaves 1 % more.
        let error = 3.0 * (share * (1.0 - share) / SETS as f64).sqrt();
        let off = held(widened) - share;
        assert!(-error < off && off < error + 0.01, "{reach}: {off}");
        // As they are, intervals are too narrow by √(15/19): 62.6 and 91.9 %.
        assert!(held(1.0) < share - error, "{reach}: {}", held(1.0));
    }
}

#[test]
fn errors_of_a_table_are_widened_where_its_shots_are_told() {
    let text =
        "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error\n0.5,1e-3,7e-4,1e-7\n";
    let read = |shots: Option<u32>| {
        let defaults = Defaults {
            shots,
            ..Defaults::default()
        };
        let selection = Selection {
            defaults,
            ..Selection::default()
        };
        let data = Data::parse("a.csv", text, &selection).unwrap();
        let row = &data.rows[0];
        (row.speed_m_s.sigma, row.values[0].unwrap().sigma)
    };
    assert_eq!(read(None), (1e-3, 1e-7));
    let factor = (19.0_f64 / 15.0).sqrt();
    assert_eq!(read(Some(20)), (factor * 1e-3, factor * 1e-7));
    assert_eq!(widening(FEWEST_SHOTS - 1), None);
}

#[test]
fn rows_whose_speeds_have_no_error_are_named() {
    let head = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error\n";
    let text = format!("{head}0.9,0,6e-4,1e-7\n0.5,1e-3,7e-4,1e-7\n0.7,,7e-4,1e-7\n");
    let data = Data::parse("a.csv", &text, &Selection::default()).unwrap();
    assert_eq!(data.lines_of_exact_speeds(), [2, 4]);
}

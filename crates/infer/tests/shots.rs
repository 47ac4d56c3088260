//! Standard errors that come from the scatter of a few shots.

use crate::toys::{Curve, normals, spaced, straight};
use hertzchain_infer::{Covariance, Data, Fitting, InferError, Parameter, Scatter, Selection, fit};
use hertzchain_measure::signal::coverage;

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
    // √(ν/(ν − 4)).
    let widened = (1.0 - 4.0 / (SHOTS - 1) as f64).sqrt().recip();
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

fn read(text: &str, scatter: Scatter) -> Result<Data, InferError> {
    let selection = Selection { scatter, ..Selection::default() };
    Data::parse("a.csv", text, &selection)
}

/// Degrees of freedom of a table's first row: of the speed's error and the incident time's.
fn freedom(text: &str, scatter: Scatter) -> (f64, f64) {
    let row = read(text, scatter).unwrap().rows.remove(0);
    (row.freedom.speed, row.freedom.values[0])
}

#[test]
fn the_shots_of_each_row_are_read_by_themselves() {
    let known = f64::INFINITY;
    let plain =
        "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error\n0.5,1e-3,7e-4,1e-7\n";
    assert_eq!(freedom(plain, Scatter::AsTold), (known, known));
    assert_eq!(freedom(plain, Scatter::Of(20)), (19.0, 19.0));
    let shots = "speed_m_s,speed_error_m_s,shots,tof_incident_s,tof_incident_s_error\n";
    let of_20 = format!("{shots}0.5,1e-3,20,7e-4,1e-7\n0.7,1e-3,8,6e-4,1e-7\n");
    assert_eq!(freedom(&of_20, Scatter::AsTold), (19.0, 19.0));
    assert_eq!(freedom(&of_20, Scatter::Known), (known, known));
    let widened = |scatter| read(&of_20, scatter).unwrap().widened();
    assert_eq!(widened(Scatter::AsTold), Some((2, [7.0, 19.0])));
    assert_eq!(widened(Scatter::Known), None);
    let data = read(&of_20, Scatter::AsTold).unwrap();
    assert_eq!(data.rows[1].freedom.speed, 7.0);
    // An error that the table does not give comes from no shots of its.
    let bare = format!("{shots}0.5,,20,7e-4,1e-7\n");
    assert_eq!(freedom(&bare, Scatter::AsTold), (known, 19.0));
    // One shot has no scatter.
    let one = format!("{shots}0.5,1e-3,1,7e-4,1e-7\n");
    assert_eq!(freedom(&one, Scatter::AsTold), (known, known));
    let few = format!("{shots}0.5,1e-3,4,7e-4,1e-7\n0.7,1e-3,20,6e-4,1e-7\n");
    let data = read(&few, Scatter::AsTold).unwrap();
    assert_eq!(data.lines_of_few_shots(), [2]);
    let wrong = read(&format!("{shots}0.5,1e-3,2.5,7e-4,1e-7\n"), Scatter::AsTold);
    let reported = wrong.unwrap_err().to_string();
    assert_eq!(reported, "a.csv, line 2, shots: 2.5 is no number of shots; expected a whole one");
}

#[test]
fn what_shots_share_does_not_scatter() {
    let text = "speed_m_s,speed_error_m_s,shots,tof_incident_s,tof_incident_s_error,tof_incident_s_count,\
                tof_incident_shared_s,tof_incident_at_mean_speed_s,tof_incident_at_mean_speed_s_error\n\
                0.5,1e-3,20,7e-4,9e-8,17,8e-8,7e-4,1e-7\n";
    let (speed, time) = freedom(text, Scatter::AsTold);
    assert_eq!(speed, 19.0);
    // Nor does an error of measuring speeds.
    let known = text.replace("_m_s,shots", "_m_s,speed_error_shots");
    assert_eq!(freedom(&known.replace(",20,", ",0,"), Scatter::AsTold).0, f64::INFINITY);
    // Of 1e-7 squared (8e-8)² are shared: 16 degrees for the other 0.36 of it.
    assert!((time / (16.0 / 0.36_f64.powi(2)) - 1.0).abs() < 1e-12, "{time}"); // rounding
}

#[test]
fn rows_whose_speeds_have_no_error_are_named() {
    let head = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error\n";
    let text = format!("{head}0.9,0,6e-4,1e-7\n0.5,1e-3,7e-4,1e-7\n0.7,,7e-4,1e-7\n");
    let data = Data::parse("a.csv", &text, &Selection::default()).unwrap();
    assert_eq!(data.lines_of_exact_speeds(), [2, 4]);
}

use super::*;
use hertzchain_measure::MeasureError;
use hertzchain_measure::signal::{Picks, SensorCalibration, Systematic};
use std::path::PathBuf;

fn measured(shots: usize) -> Measurement {
    let picked = Picked {
        time_s: 1e-3,
        sigma_s: 1e-9,
        systematic: Systematic::default(),
        height: 1.0,
        height_sigma: 1e-3,
        width_s: 46e-6,
        signal_to_noise: 100.0,
        misfit: None,
    };
    let at = |time_s| Picked { time_s, ..picked };
    let picks = Picks {
        incident: picked,
        wall: at(1.7e-3),
        reflected: Some(at(2.5e-3)),
        competing: [None; 3],
        calibration: SensorCalibration::default(),
    };
    let shot = Shot {
        source: "long.npy, shot 12345 at 123.4567 s".to_owned(),
        file: PathBuf::from("recordings/long.npy"),
        shot: Some(12_345),
        case: String::new(),
        programmed_speed_m_s: None,
        speed_m_s: None,
        interval_s: 1e-6,
        duration_s: 10e-3,
        flight: Ok(picks.flight()),
        doubts: Vec::new(),
        untriggered: false,
        gaps: None,
        gap_in_pulse: false,
        holds_several: false,
        is_cut: false,
        excluded: false,
        undecided: false,
        samples: [const { None }; 3],
    };
    Measurement {
        shots: vec![shot; shots],
        refused: vec![MeasureError::Shots("short.npz".to_owned(), "has 3 speeds".to_owned())],
        ..Measurement::default()
    }
}

/// Most bytes that were held at once while it was written.
fn held(shots: usize) -> u64 {
    let (measured, curves) = (measured(shots), Curves::default());
    let info = allocation_counter::measure(|| {
        write_json(&measured, &curves, &mut io::sink()).unwrap();
    });
    info.bytes_max
}

#[test]
fn json_of_any_number_of_shots_holds_one_of_them_at_a_time() {
    assert_eq!(held(1000), held(10));
}

#[test]
fn a_shot_without_its_samples_is_some_numbers() {
    // Times, heights, widths, noise ratios and χ² of three pulses with errors and shared ones, other maxima of
    // theirs, speed, its length, and three names; samples about its pulses are held apart, and bounded.
    assert!(size_of::<Shot>() < 960, "{}", size_of::<Shot>());
}

#[test]
fn what_is_written_is_the_value_that_python_gets() {
    let (measured, curves) = (measured(3), Curves::default());
    let mut text = Vec::new();
    write_json(&measured, &curves, &mut text).unwrap();
    let value: Value = serde_json::from_slice(&text).unwrap();
    assert_eq!(value, json(&measured, &curves));
    assert_eq!(value["shots"].as_array().unwrap().len(), 3);
}

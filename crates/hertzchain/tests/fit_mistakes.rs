//! What fit refuses or warns of: data and parameters.

use crate::common::{HEAD, file, folder, refused, run};

#[test]
fn speeds_without_errors_are_warned_of_by_line() {
    let folder = folder("exact");
    let rows = "0.1,0,1.0274e-3,1e-7\n0.4,1e-3,7.9465e-4,1e-7\n1.0,,6.8166e-4,1e-7\n";
    let data = file(&folder, "data.csv", &format!("{HEAD}{rows}"));
    let reported = |more: &[&str]| {
        let fit = ["fit", &data, "-p", "dry", "--free", "eta"];
        let output = run(&[&fit[..], more].concat());
        assert!(output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let warning = reported(&[]);
    assert!(warning.contains("lines 2, 4: speeds without an error"), "{warning}");
    // A cell that is 0 is a cell; one that is empty is filled.
    let warning = reported(&["--speed-error", "1e-3"]);
    assert!(warning.contains("line 2: speeds without an error"), "{warning}");
    assert_eq!(reported(&["--speed-error", "0"]), "");
    let message = refused(&["fit", &data, "--free", "eta", "--error-shots", "4"]);
    assert!(message.contains("expected a whole number from 6"), "{message}");
}

#[test]
fn data_that_can_not_be_fitted_are_told_by_row_and_column() {
    let folder = folder("data");
    for (number, (rows, words)) in [
        ("-0.5,0,7.6e-4,1e-7\n", "line 2, speed_m_s"),
        ("0.5,0,7.6e-4,0\n", "line 2, tof_incident_s_error"),
        ("0.5,0,7.6e-4,\n", "no uncertainty"),
        ("0.5,0,760,1\n", "looks like microseconds"),
        ("0.5,0,7.6e-4,1e-7\n", "1 measured values for 2 free parameters (eta, B)"),
    ]
    .into_iter()
    .enumerate()
    {
        let data = file(&folder, &format!("{number}.csv"), &format!("{HEAD}{rows}"));
        let message = refused(&["fit", &data, "-p", "dry", "--free", "eta,B"]);
        assert!(message.contains(words), "{rows}: {message}");
    }
    assert!(
        refused(&["fit", "nowhere.csv", "--free", "eta"]).contains("nowhere.csv can't be read")
    );
}

#[test]
fn parameters_that_can_not_be_free_are_told_by_name() {
    let folder = folder("free");
    let rows = "0.1,0,1.0274e-3,1e-7\n0.4,0,7.9465e-4,1e-7\n1.0,0,6.8166e-4,1e-7\n";
    let data = file(&folder, "data.csv", &format!("{HEAD}{rows}"));
    for (arguments, words) in [
        (&["--free", "eta,hardness"][..], "hardness"),
        (&["--free", "eta,aisi316.eta"], "are the same number"),
        (&["--free", "friction", "--start", "friction=0.05"], "the wave knows no friction"),
        (&["--free", "eta,wall_gain"], "wall_gain changes no residual near 1.0000e0"),
        (&["--free", "eta", "--bounds", "eta=1e5:1e6"], "outside its bounds"),
        (&["--free", "eta", "--bounds", "eta=1e6:1e5"], "leave nothing between them"),
        (&["--free", "eta", "--prior", "eta=1e3+-10"], "start nearer, or widen the prior"),
        (&["--free", "eta", "--prior", "eta=1e3+-0"], "is no distribution"),
        (&["--free", "eta", "--start", "B=3"], "nothing of this name is free; free are eta"),
        (&["--free", "eta", "--start", "eta=3 mm"], "another dimension"),
        (&["--free", "nu", "--start", "nu=0.3", "--scale", "nu=-1"], "expected a positive number"),
    ] {
        let fit = ["fit", &data, "-p", "dry"];
        let message = refused(&[&fit[..], arguments].concat());
        assert!(message.contains(words), "{arguments:?}: {message}");
    }
}

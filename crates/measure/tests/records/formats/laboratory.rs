//! MATLAB's files, groups of HDF5, and binary files of instruments that are not read.

use super::{WAVE, all, assert_wave};
use crate::common::{folder, python};
use hertzchain_measure::records::{ReadOptions, read};
use rust_hdf5::{H5File, VarLenUnicode};
use std::fs;
use std::io::Write;
use std::path::Path;

#[test]
fn matlabs_files_of_all_versions_are_read() {
    let folder = folder("matlab");
    let program = WAVE.to_owned()
        + r#"
import h5py, scipy.io
one = {"A": wave(0).reshape(-1, 1), "Tinterval": 1e-6, "Tstart": -1e-3, "Length": 200.0}
scipy.io.savemat("four.mat", one, format="4")
scipy.io.savemat("five.mat", {**one, "A": one["A"].astype("f4"), "note": "steel"})
scipy.io.savemat("counts.mat", {"a": (wave(0) * 128).astype("i2"), "fs": 1e6}, do_compression=True)
apart = {"bead": wave(0).reshape(-1, 1), "wall": wave(1).reshape(-1, 1), "dt": 1e-6}
scipy.io.savemat("apart.mat", apart, do_compression=True)
scipy.io.savemat("columns.mat", {"x": numpy.array([wave(0), wave(1)]).T, "fs": [[1e6]]})
with h5py.File("seven.mat", "w", userblock_size=512) as file:
    file["x"], file["fs"] = numpy.array([wave(0), wave(1)]), [[1e6]]
    file["note"] = numpy.array([[115], [116]], "u2")
    file["note"].attrs["MATLAB_class"] = numpy.bytes_("char")
with open("seven.mat", "r+b") as file:
    file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64")
"#;
    if python(&folder, &program).is_none() {
        return;
    }
    for (name, scale) in [("four.mat", 1.0), ("five.mat", 1.0), ("counts.mat", 1.0 / 128.0)] {
        let records = all(&folder.join(name), &ReadOptions::default());
        assert_eq!((records.len(), records[0].interval_s), (1, 1e-6), "{name}");
        assert_wave(&records[0], 0, 0, scale);
    }
    for name in ["apart.mat", "columns.mat", "seven.mat"] {
        let records = all(&folder.join(name), &ReadOptions::default());
        assert_eq!((records.len(), records[0].channels.len()), (1, 2), "{name}");
        assert_wave(&records[0], 1, 1, 1.0);
    }
    let whole = fs::read(folder.join("five.mat")).unwrap();
    fs::write(folder.join("cut.mat"), &whole[..whole.len() / 2]).unwrap();
    let error = refusal(&folder.join("cut.mat"));
    assert!(error.contains("ends too early"), "{error}");
}

#[test]
fn cells_and_structs_of_matlab_are_read_as_what_they_hold() {
    let folder = folder("matlab-cells");
    let program = WAVE.to_owned()
        + r#"
import scipy.io
def cells(*values, shape=(1, -1)):
    made = numpy.empty(len(values), object)
    made[:] = values
    return made.reshape(shape)
shots = cells(*(wave(shot) for shot in range(12)))
table = cells(*(wave(n) for n in (0, 1, 1, 2, 2, 3)), shape=(3, 2))
one = {"signal": wave(0), "fs": 1e6, "by": "a text"}
many = numpy.array([(wave(n), 1e6) for n in range(3)], [("signal", object), ("fs", object)])
for packed in (False, True):
    for name, all in {
        "cells": {"shots": shots, "fs": 1e6},
        "table": {"shots": table, "Ts": 1e-6},
        "one": {"data": one},
        "many": {"data": many},
        "within": {"runs": cells({"signal": wave(0), "Ts": 1e-6}, {"signal": wave(1), "Ts": 1e-6})},
    }.items():
        scipy.io.savemat(f"{name}-{packed}.mat", all, do_compression=packed)
scipy.io.savemat("empty.mat", {"shots": cells("one text", "another"), "fs": 1e6})
"#;
    if python(&folder, &program).is_none() {
        return;
    }
    for (name, shots, channels) in
        [("cells", 12, 1), ("table", 3, 2), ("one", 1, 1), ("many", 3, 1), ("within", 2, 1)]
    {
        for packed in ["False", "True"] {
            let records =
                all(&folder.join(format!("{name}-{packed}.mat")), &ReadOptions::default());
            let sizes = (records.len(), records[0].channels.len(), records[0].interval_s);
            assert_eq!(sizes, (shots, channels, 1e-6), "{name}");
            for (shot, record) in records.iter().enumerate() {
                for channel in 0..channels {
                    assert_wave(record, channel, shot + channel, 1.0);
                }
            }
        }
    }
    let both = ["shots{1}", "shots{2}"].map(str::to_owned).to_vec();
    let both = ReadOptions { channels: both, ..ReadOptions::default() };
    assert_wave(&all(&folder.join("cells-True.mat"), &both)[0], 1, 1, 1.0);
    let error = refusal(&folder.join("empty.mat"));
    assert!(error.contains("holds no samples, only fs"), "{error}");
}

/// A file as MATLAB writes version 7.3, but for its user block: datasets of waves in `#refs#`, their
/// number the wave's, and objects that refer to them.
fn referring(file: &Path, waves: usize) -> H5File {
    let open = H5File::options().userblock(512).create(file).unwrap();
    let rate = open.new_dataset::<f64>().shape([1, 1]).create("fs").unwrap();
    rate.write_raw(&[1e6]).unwrap();
    let internal = open.create_group("#refs#").unwrap();
    for number in 0..waves {
        let volts: Vec<f64> = (0..200).map(|i| super::wave(number, i)).collect();
        let data = internal.new_dataset::<f64>().shape([1, 200]).create(&format!("w{number}"));
        data.unwrap().write_raw(&volts).unwrap();
    }
    open
}

fn refer(open: &H5File, name: &str, shape: [usize; 2], targets: &[&str], class: &str) {
    let cells = open.new_dataset::<u64>().object_references().shape(shape).create(name).unwrap();
    cells.write_object_references(targets).unwrap();
    let attribute = cells.new_attr::<VarLenUnicode>().shape(()).create("MATLAB_class").unwrap();
    attribute.write_string(class).unwrap();
}

fn ended(open: H5File, file: &Path) {
    open.close().unwrap();
    let mut file = fs::OpenOptions::new().write(true).open(file).unwrap();
    file.write_all(b"MATLAB 7.3 MAT-file, Platform: GLNXA64").unwrap();
}

#[test]
fn cells_of_version_7_3_hold_shots_as_those_of_version_5() {
    let folder = folder("matlab-references");
    let [cells, table, within] = ["cells", "table", "within"].map(|name| folder.join(name));
    let open = referring(&cells, 2);
    refer(&open, "shots", [2, 1], &["/#refs#/w0", "/#refs#/w1"], "cell");
    ended(open, &cells);
    // MATLAB's columns are HDF5's rows: a row of the table is a shot.
    let open = referring(&table, 4);
    let of_columns = ["/#refs#/w0", "/#refs#/w1", "/#refs#/w2", "/#refs#/w1", "/#refs#/w2"];
    refer(&open, "shots", [2, 3], &[&of_columns[..], &["/#refs#/w3"]].concat(), "cell");
    ended(open, &table);
    let open = referring(&within, 2);
    refer(&open, "#refs#/first", [1, 1], &["/#refs#/w0"], "cell");
    refer(&open, "#refs#/other", [1, 1], &["/#refs#/w1"], "cell");
    refer(&open, "runs", [2, 1], &["/#refs#/first", "/#refs#/other"], "cell");
    ended(open, &within);
    for (file, shots, channels) in [(cells, 2, 1), (table, 3, 2), (within, 2, 1)] {
        let records = all(&file, &ReadOptions::default());
        assert_eq!((records.len(), records[0].channels.len()), (shots, channels), "{file:?}");
        for (shot, record) in records.iter().enumerate() {
            (0..channels).for_each(|channel| assert_wave(record, channel, shot + channel, 1.0));
        }
    }
}

#[test]
fn cells_of_version_7_3_that_refer_to_themselves_hold_nothing() {
    let file = folder("matlab-circle").join("circle.mat");
    let open = referring(&file, 0);
    refer(&open, "circle", [2, 1], &["/fs", "/fs"], "cell");
    let circle = open.new_dataset::<u64>().object_references().shape([9, 9]).create("shots");
    circle.unwrap().write_object_references(&["/shots"; 81]).unwrap();
    ended(open, &file);
    let error = refusal(&file);
    assert!(error.contains("holds no samples, only fs") && error.contains("as arrays"), "{error}");
}

fn refusal(file: &Path) -> String {
    let mut records = read(file, &ReadOptions::default());
    records.next().unwrap().unwrap_err().to_string()
}

/// A group of HDF5 for each shot, with the rate as an attribute of the group.
fn shots(file: &Path, names: &[&str], rates: &[f64]) {
    let open = H5File::options().userblock(512).create(file).unwrap();
    for (shot, name) in names.iter().enumerate() {
        let group = open.create_group(name).unwrap();
        for (channel, name) in ["bead", "wall"].into_iter().enumerate() {
            let volts: Vec<f64> = (0..200).map(|i| super::wave(shot + channel, i)).collect();
            let data = group.new_dataset::<f64>().shape([200]).create(name).unwrap();
            data.write_raw(&volts).unwrap();
        }
        group.set_attr_numeric("sample_rate", &rates[shot]).unwrap();
    }
    open.close().unwrap();
}

#[test]
fn a_group_a_shot_is_read_in_the_order_of_numbers() {
    let file = folder("groups").join("shots.h5");
    shots(&file, &["shot_2", "shot_10", "shot_1"], &[5e5; 3]);
    let records = all(&file, &ReadOptions::default());
    let numbers: Vec<_> = records.iter().map(|record| record.shot).collect();
    assert_eq!((numbers, records[0].interval_s), (vec![Some(1), Some(2), Some(3)], 2e-6));
    assert_wave(&records[0], 0, 2, 1.0);
    assert_wave(&records[2], 1, 2, 1.0);
    let walls = ReadOptions { channels: vec!["wall".to_owned()], ..ReadOptions::default() };
    assert_wave(&all(&file, &walls)[1], 0, 1, 1.0);
}

#[test]
fn groups_alike_are_shots_whatever_their_names_unless_these_are_channels() {
    let folder = folder("named-groups");
    let times = ["2026-11-25T10:00:59", "2026-11-25T10:01:00", "2026-11-25T09:59:58"];
    for (number, (names, order)) in
        [(["alpha", "gamma", "beta"], [0, 2, 1]), (times, [2, 0, 1])].into_iter().enumerate()
    {
        let file = folder.join(format!("{number}.h5"));
        shots(&file, &names, &[5e5; 3]);
        let records = all(&file, &ReadOptions::default());
        assert_eq!(records.len(), 3);
        for (record, shot) in records.iter().zip(order) {
            assert_wave(record, 0, shot, 1.0);
            assert_wave(record, 1, shot + 1, 1.0);
            assert!(record.notes[0].contains("taken for a shot"), "{:?}", record.notes);
        }
        let paths = [0, 1].map(|group| format!("{}/wall", names[group])).to_vec();
        let whole = ReadOptions { channels: paths, ..ReadOptions::default() };
        let channels = all(&file, &whole);
        assert_eq!((channels.len(), channels[0].channels.len()), (1, 2));
    }
    for names in [["ch1", "ch2"], ["Channel 1", "Channel 2"], ["sensor", "wall"], ["A", "B"]] {
        let file = folder.join("channels.h5");
        shots(&file, &names, &[5e5; 2]);
        let error = refusal(&file);
        assert!(error.contains("4 channels"), "{names:?}: {error}");
    }
}

#[test]
fn rates_are_known_by_their_names_in_any_case() {
    let file = folder("rate-cases").join("acquisition.h5");
    let open = H5File::create(&file).unwrap();
    let group = open.create_group("acquisition").unwrap();
    let data = group.new_dataset::<f64>().shape([200]).create("voltage").unwrap();
    data.write_raw(&(0..200).map(|i| super::wave(0, i)).collect::<Vec<f64>>()).unwrap();
    group.set_attr_numeric("sample_rate_Hz", &5e5).unwrap();
    open.close().unwrap();
    assert_eq!(all(&file, &ReadOptions::default())[0].interval_s, 2e-6);
}

#[test]
fn rates_that_contradict_each_other_are_none() {
    let file = folder("rates").join("shots.h5");
    shots(&file, &["1", "2"], &[5e5, 1e6]);
    let error = refusal(&file);
    assert!(error.contains("--rate"), "{error}");
}

#[test]
fn binary_files_of_instruments_are_named_with_a_remedy() {
    let folder = folder("binary");
    for (name, bytes, whose) in [
        ("a.wfm", &b"\x0f\x0f:WFM#003\x00\x01"[..], "Tektronix"),
        ("a.isf", b":WFMPRE:BYT_NR 2;\x00\x01", "Tektronix"),
        ("a.trc", b"#9000015346WAVEDESC\x00", "LeCroy"),
        ("a.bin", b"AG10\x00\x01", "Keysight"),
        ("b.bin", b"RG01\x00\x01", "Rigol"),
        ("b.wfm", b"\xa5\xa5\x26\x00", "Rigol"),
        ("a.psdata", b"\x00\x01\x02", "PicoScope"),
    ] {
        fs::write(folder.join(name), bytes).unwrap();
        let error = refusal(&folder.join(name));
        assert!(error.contains(whose) && error.contains("CSV"), "{error}");
    }
}

#[test]
fn texts_of_loggers_without_times_state_their_rate() {
    let folder = folder("loggers");
    let wave = |i| super::wave(0, i);
    let rows = |row: &dyn Fn(f64) -> String| (0..200).map(|i| row(wave(i))).collect::<String>();
    let comma = |volt: f64| format!("\t{volt:.7}\n").replace('.', ",");
    for (name, text) in [
        (
            "hresolution.csv",
            format!("\"HResolution\",1.0E-06\n\"HUnit\",\"s\"\n{}", rows(&|v| format!(",{v}\n"))),
        ),
        ("clock.txt", format!("#CLOCK=1.000MHz\n{}", rows(&|v| format!("{v}\n")))),
        ("comma.lvm", format!("Delta_X\t1,0E-6\t\nX_Value\tVoltage\tComment\n{}", rows(&comma))),
    ] {
        fs::write(folder.join(name), text).unwrap();
        let records = all(&folder.join(name), &ReadOptions::default());
        assert!((records[0].interval_s - 1e-6).abs() < 1e-18, "{name}");
        assert_wave(&records[0], 0, 0, 1.0);
    }
}

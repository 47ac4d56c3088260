//! Arrays, one in a file or several.

use super::{WAVE, all, assert_wave, at_1_mhz};
use crate::common::{folder, python};
use hertzchain_measure::MeasureError;
use hertzchain_measure::records::{Parts, ReadOptions, Rows, read};
use std::path::Path;

#[test]
fn arrays_of_numpy_are_read_in_every_type_order_and_shape() {
    let folder = folder("numpy");
    let program = WAVE.to_owned()
        + r#"
shots = numpy.array([wave(shot) for shot in range(3)])
for name in ["<f8", ">f8", "<f4", ">f4", "<f2", ">f2"]:
    numpy.save(f"shots{ord(name[0])}{name[1:]}.npy", shots.astype(name))
for name in ["<i2", ">i2", "<i4", ">i4", "<i8", "|i1"]:
    numpy.save(f"shots{ord(name[0])}{name[1:]}.npy", (shots * 128).astype(name))
numpy.save("fortran.npy", numpy.asfortranarray(shots))
numpy.save("columns.npy", shots[:2].T.copy())
numpy.save("columns_fortran.npy", shots[:2].T)
numpy.save("one.npy", shots[0])
numpy.save("cube.npy", numpy.array([[wave(0), wave(1)], [wave(2), wave(3)]]))
numpy.savez("shots.npz", samples=shots, dt=1e-6, speeds=[0.1, 0.2, 0.3])
numpy.savez_compressed("packed.npz", samples=(shots * 128).astype("i2"), fs=1e6)
numpy.savez("channels.npz", bead=wave(0), wall=wave(1), time=numpy.arange(200) * 1e-6)
numpy.savez("positional.npz", wave(0), wave(1), wave(2))
numpy.save("long.npy", shots.astype(numpy.longdouble))
"#;
    if python(&folder, &program).is_none() {
        return;
    }
    for (name, scale) in [
        ("60f8", 1.0),
        ("62f8", 1.0),
        ("60f4", 1.0),
        ("62f4", 1.0),
        ("60f2", 1.0),
        ("62f2", 1.0),
        ("60i2", 1.0 / 128.0),
        ("62i2", 1.0 / 128.0),
        ("60i4", 1.0 / 128.0),
        ("62i4", 1.0 / 128.0),
        ("60i8", 1.0 / 128.0),
        ("124i1", 1.0 / 128.0),
    ] {
        let records = all(&folder.join(format!("shots{name}.npy")), &at_1_mhz());
        assert_eq!(records.len(), 3, "{name}");
        for (shot, record) in records.iter().enumerate() {
            assert_wave(record, 0, shot, scale);
        }
    }
    for name in ["fortran.npy", "positional.npz"] {
        let records = all(&folder.join(name), &at_1_mhz());
        assert_eq!(records.len(), 3, "{name}");
        for (shot, record) in records.iter().enumerate() {
            assert_wave(record, 0, shot, 1.0);
        }
    }
    for name in ["columns.npy", "columns_fortran.npy"] {
        let records = all(&folder.join(name), &at_1_mhz());
        assert_eq!((records.len(), records[0].channels.len()), (1, 2), "{name}");
        assert_wave(&records[0], 1, 1, 1.0);
    }
    let cube = all(&folder.join("cube.npy"), &at_1_mhz());
    assert_wave(&cube[1], 1, 3, 1.0);
    assert_wave(&all(&folder.join("one.npy"), &at_1_mhz())[0], 0, 0, 1.0);
    npz(&folder);
    let long = read(&folder.join("long.npy"), &at_1_mhz()).next().unwrap();
    match long {
        // Where the compiler has no longer numbers, these are doubles.
        Ok(record) => assert_wave(&record, 0, 0, 1.0),
        Err(error) => assert!(error.to_string().contains("float64"), "{error}"),
    }
}

fn npz(folder: &Path) {
    let open = ReadOptions::default();
    let shots = all(&folder.join("shots.npz"), &open);
    assert_eq!((shots[2].interval_s, shots[2].speed_m_s), (1e-6, Some(0.3)));
    assert_wave(&shots[2], 0, 2, 1.0);
    let packed = all(&folder.join("packed.npz"), &open);
    assert!(packed[1].channels[0].range_v.is_some());
    assert_wave(&packed[1], 0, 1, 1.0 / 128.0);
    let channels = all(&folder.join("channels.npz"), &open);
    assert_eq!((channels.len(), channels[0].channels.len()), (1, 2));
    let names = channels[0].channels.iter().map(|channel| channel.name.as_str());
    assert_eq!(names.collect::<Vec<_>>(), ["bead", "wall"]);
    assert_wave(&channels[0], 1, 1, 1.0);
}

#[test]
fn rows_are_channels_if_told() {
    let folder = folder("rows");
    let program = WAVE.to_owned() + "numpy.save('a.npy', numpy.array([wave(0), wave(1)]))\n";
    if python(&folder, &program).is_none() {
        return;
    }
    // A channel that is chosen says so, too.
    for rows in [Rows::Channels, Rows::Auto] {
        let options = ReadOptions { rows, channels: vec!["2".to_owned()], ..at_1_mhz() };
        let records = all(&folder.join("a.npy"), &options);
        assert_eq!(records.len(), 1);
        assert_wave(&records[0], 0, 1, 1.0);
    }
    for (rows, channel) in [(Rows::Auto, "3"), (Rows::Shots, "2")] {
        let options = ReadOptions { rows, channels: vec![channel.to_owned()], ..at_1_mhz() };
        let error = read(&folder.join("a.npy"), &options).find_map(Result::err).unwrap();
        assert!(error.to_string().contains("has no channel"), "{error}");
    }
}

#[test]
fn two_intervals_of_one_file_are_noted() {
    let folder = folder("two-intervals");
    let program = WAVE.to_owned() + "numpy.savez('a.npz', samples=wave(0), fs=1e6, dt=2e-6)\n";
    if python(&folder, &program).is_none() {
        return;
    }
    let records = all(&folder.join("a.npz"), &ReadOptions::default());
    assert_eq!(records[0].interval_s, 2e-6);
    assert!(records[0].notes.iter().any(|note| note.contains("of 1 µs and one of 2 µs")));
}

#[test]
fn tables_are_cut_into_shots_too() {
    let folder = folder("cut");
    let program = WAVE.to_owned()
        + r#"
import h5py
rows = numpy.array([numpy.concatenate([wave(0), wave(1)]), numpy.concatenate([wave(2), wave(3)])])
numpy.save("rows.npy", rows)
numpy.save("fortran.npy", numpy.asfortranarray(rows))
with h5py.File("rows.h5", "w") as file:
    file["rows"] = rows
"#;
    if python(&folder, &program).is_none() {
        return;
    }
    let cut = ReadOptions { parts: Parts::Shots(200), ..at_1_mhz() };
    for name in ["rows.npy", "fortran.npy", "rows.h5"] {
        let records = all(&folder.join(name), &cut);
        assert_eq!(records.len(), 4, "{name}");
        for (shot, record) in records.iter().enumerate() {
            assert_eq!(record.shot, Some(shot as u64 + 1), "{name}");
            assert_wave(record, 0, shot, 1.0);
        }
    }
    let channels = ReadOptions { rows: Rows::Channels, ..cut.clone() };
    let records = all(&folder.join("rows.npy"), &channels);
    assert_eq!((records.len(), records[1].channels.len()), (2, 2));
    assert_wave(&records[1], 1, 3, 1.0);
    let uneven = ReadOptions { parts: Parts::Shots(300), ..cut };
    let results: Vec<_> = read(&folder.join("rows.npy"), &uneven).collect();
    let error = results[1].as_ref().unwrap_err().to_string();
    assert!(error.contains("what cutting left over"), "{error}");
}

#[test]
fn two_tables_of_one_archive_are_channels_only_if_told() {
    let folder = folder("tables");
    let program = WAVE.to_owned()
        + r#"
shots = numpy.array([wave(shot) for shot in range(3)])
numpy.savez("tables.npz", dry=shots, gear=shots[::-1], fs=1e6)
numpy.savez("uneven.npz", bead=shots, wall=shots[:2], fs=1e6)
"#;
    if python(&folder, &program).is_none() {
        return;
    }
    let results: Vec<_> = read(&folder.join("tables.npz"), &ReadOptions::default()).collect();
    assert!(matches!(results[0], Err(MeasureError::Channels(..))));
    let both = |a: &str, b: &str| ReadOptions {
        channels: vec![a.to_owned(), b.to_owned()],
        ..ReadOptions::default()
    };
    let records = all(&folder.join("tables.npz"), &both("dry", "gear"));
    assert_eq!(records.len(), 3);
    assert_wave(&records[0], 1, 2, 1.0);
    let uneven: Vec<_> = read(&folder.join("uneven.npz"), &both("bead", "wall")).collect();
    assert!(uneven[1].is_ok() && uneven[2].is_err(), "{uneven:?}");
}

//! Every format as another program writes it.

use crate::common::{folder, kept, python};
use hertzchain_records::{Parts, ReadOptions, Record, RecordError, Rows, Samples, read};
use std::path::Path;

/// Files that do not tell their rate.
pub fn at_1_mhz() -> ReadOptions {
    ReadOptions {
        rate_hz: Some(1e6),
        ..ReadOptions::default()
    }
}

fn all(path: &Path, options: &ReadOptions) -> Vec<Record> {
    read(path, options).map(|record| record.unwrap()).collect()
}

/// The signal that the scripts write: a wave that no two samples share.
fn wave(shot: usize, i: usize) -> f64 {
    ((i * 37 + shot * 11) % 101) as f64 / 128.0 - 0.25
}

/// The scripts' beginning.
const WAVE: &str = "
import numpy
def wave(shot, count=200):
    return ((numpy.arange(count) * 37 + shot * 11) % 101) / 128 - 0.25
";

fn assert_wave(record: &Record, channel: usize, shot: usize, scale: f64) {
    let volts = record.channels[channel].samples.volts();
    assert_eq!(volts.len(), 200, "{}", record.source);
    for (i, volt) in volts.iter().enumerate() {
        // All values are multiples of 1/128: exact in every format.
        assert_eq!(
            *volt * scale,
            wave(shot, i),
            "{}, sample {i}",
            record.source
        );
    }
}

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
    assert!(matches!(
        packed[1].channels[0].samples,
        Samples::Counts { .. }
    ));
    assert_wave(&packed[1], 0, 1, 1.0 / 128.0);
    let channels = all(&folder.join("channels.npz"), &open);
    assert_eq!((channels.len(), channels[0].channels.len()), (1, 2));
    let names = channels[0]
        .channels
        .iter()
        .map(|channel| channel.name.as_str());
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
    let options = ReadOptions {
        rows: Rows::Channels,
        channels: vec!["2".to_owned()],
        ..at_1_mhz()
    };
    let records = all(&folder.join("a.npy"), &options);
    assert_eq!(records.len(), 1);
    assert_wave(&records[0], 0, 1, 1.0);
}

#[test]
fn waves_of_scipy_are_read_in_every_type() {
    let folder = folder("wav");
    let program = WAVE.to_owned()
        + r#"
from scipy.io import wavfile
both = numpy.array([wave(0), wave(1)]).T
wavfile.write("i2.wav", 1000000, (both * 32768).astype("int16"))
wavfile.write("i4.wav", 1000000, (both * 2**31).astype("int32"))
wavfile.write("f4.wav", 1000000, both.astype("float32"))
wavfile.write("f8.wav", 1000000, both)
wavfile.write("u1.wav", 1000000, (wave(0) * 128 + 128).astype("uint8"))
long = numpy.concatenate([wave(shot) for shot in range(3)])
wavfile.write("long.wav", 500000, (long * 32768).astype("int16"))
"#;
    if python(&folder, &program).is_none() {
        return;
    }
    for name in ["i2", "i4", "f4"] {
        let records = all(&folder.join(format!("{name}.wav")), &ReadOptions::default());
        assert_eq!((records.len(), records[0].interval_s), (1, 1e-6), "{name}");
        assert_wave(&records[0], 0, 0, 1.0);
        assert_wave(&records[0], 1, 1, 1.0);
    }
    let wide = read(&folder.join("f8.wav"), &ReadOptions::default());
    let told: Vec<String> = wide.map(|record| record.unwrap_err().to_string()).collect();
    assert!(told.len() == 1 && told[0].contains("float32"), "{told:?}");
    assert_wave(&all(&folder.join("u1.wav"), &at_1_mhz())[0], 0, 0, 1.0);
    let cut = ReadOptions {
        parts: Parts::Shots(200),
        ..ReadOptions::default()
    };
    let records = all(&folder.join("long.wav"), &cut);
    assert_eq!((records.len(), records[2].interval_s), (3, 2e-6));
    assert_wave(&records[2], 0, 2, 1.0);
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
    let cut = ReadOptions {
        parts: Parts::Shots(200),
        ..at_1_mhz()
    };
    for name in ["rows.npy", "fortran.npy", "rows.h5"] {
        let records = all(&folder.join(name), &cut);
        assert_eq!(records.len(), 4, "{name}");
        for (shot, record) in records.iter().enumerate() {
            assert_eq!(record.shot, Some(shot as u64 + 1), "{name}");
            assert_wave(record, 0, shot, 1.0);
        }
    }
    let channels = ReadOptions {
        rows: Rows::Channels,
        ..cut.clone()
    };
    let records = all(&folder.join("rows.npy"), &channels);
    assert_eq!((records.len(), records[1].channels.len()), (2, 2));
    assert_wave(&records[1], 1, 3, 1.0);
    let uneven = ReadOptions {
        parts: Parts::Shots(300),
        ..cut
    };
    let results: Vec<_> = read(&folder.join("rows.npy"), &uneven).collect();
    let error = results[1].as_ref().unwrap_err().to_string();
    assert!(error.contains("what cutting left over"), "{error}");
}

#[test]
fn pieces_of_a_recording_follow_each_other() {
    let folder = folder("pieces");
    let program = WAVE.to_owned()
        + r#"
import h5py
long = numpy.concatenate([wave(shot) for shot in range(3)])
rows = numpy.array([long, long])
numpy.save("long.npy", long)
numpy.save("rows.npy", rows)
numpy.save("fortran.npy", numpy.asfortranarray(rows))
numpy.savez("rows.npz", samples=rows, speeds=[0.1, 0.2])
numpy.savez_compressed("cube.npz", samples=numpy.array([[long, long], [-long, long]]))
numpy.save("cube.npy", numpy.array([[long, long], [-long, long]]))
with h5py.File("rows.h5", "w") as file:
    file["rows"], file["speeds"] = rows, [0.1, 0.2]
with h5py.File("cube.h5", "w") as file:
    file["cube"] = numpy.array([rows, rows])
numpy.savetxt("long.csv", numpy.array([numpy.arange(600) * 1e-6, long]).T, delimiter=",",
              header="time_s,sum", comments="")
"#;
    if python(&folder, &program).is_none() {
        return;
    }
    let pieces = ReadOptions {
        parts: Parts::Pieces(250),
        ..at_1_mhz()
    };
    for (name, expected) in [
        ("long.npy", vec![0, 250, 500]),
        ("long.csv", vec![0, 250, 500]),
        ("rows.npy", vec![0, 250, 500, 0, 250, 500]),
        ("fortran.npy", vec![0, 250, 500, 0, 250, 500]),
        ("rows.npz", vec![0, 250, 500, 0, 250, 500]),
        ("rows.h5", vec![0, 250, 500, 0, 250, 500]),
        ("cube.h5", vec![0, 250, 500, 0, 250, 500]),
    ] {
        let records = all(&folder.join(name), &pieces);
        for (at, record) in records.iter().enumerate().filter(|_| expected.len() > 3) {
            assert_eq!(record.shot, Some(at as u64 / 3 + 1), "{name}");
        }
        let first: Vec<u64> = records.iter().map(|record| record.first_sample).collect();
        assert_eq!(first, expected, "{name}");
        let whole: Vec<f64> = records
            .iter()
            .take(3)
            .flat_map(|record| record.channels[0].samples.volts())
            .collect();
        let expected: Vec<f64> = (0..600).map(|i| wave(i / 200, i % 200)).collect();
        assert_eq!(whole, expected, "{name}");
        assert!(
            records
                .iter()
                .all(|record| record.interval_s == records[0].interval_s)
        );
    }
    for name in ["rows.npz", "rows.h5"] {
        let records = all(&folder.join(name), &pieces);
        let speeds: Vec<_> = records
            .iter()
            .filter_map(|record| record.speed_m_s)
            .collect();
        assert_eq!(speeds, [0.1, 0.1, 0.1, 0.2, 0.2, 0.2], "{name}");
    }
    for name in ["cube.npy", "cube.npz"] {
        let records = all(&folder.join(name), &pieces);
        assert_eq!(records.len(), 6, "{name}");
        for (at, record) in records.iter().enumerate() {
            let volt = |channel: usize| record.channels[channel].samples.volts()[0];
            let sign = if at < 3 { 1.0 } else { -1.0 };
            let own = (record.first_sample, volt(0) * sign);
            let start = 250 * (at % 3);
            let expected = wave(start / 200, start % 200);
            assert_eq!(
                (own, volt(1)),
                ((start as u64, expected), expected),
                "{name}"
            );
        }
    }
}

#[test]
fn datasets_of_h5py_are_read() {
    let folder = folder("h5py");
    let program = WAVE.to_owned()
        + r#"
import h5py
shots = numpy.array([wave(shot) for shot in range(3)])
with h5py.File("one.h5", "w") as file:
    data = file.create_dataset("run/adc", data=(shots * 128).astype("i2"), chunks=(1, 50),
                               compression="gzip", shuffle=True)
    data.attrs["sampling_rate"] = 5e5
with h5py.File("channels.h5", "w") as file:
    file["bead"], file["wall"] = wave(0), wave(1).astype("f4")
    file["time"] = numpy.arange(200) * 1e-6
    file["note"] = "no numbers"
with h5py.File("big-endian.h5", "w") as file:
    file["a"], file["speeds"] = shots.astype(">f8"), [0.1, 0.2, 0.3]
    file["b"] = (shots * 128).astype(">i4")
    file["c"] = numpy.array([[wave(0), wave(1)], [wave(2), wave(3)]])
with h5py.File("numbers.h5", "w") as file:
    file["volts"], file["dt"], file["speed"], file["temperature"] = shots, 1e-6, 0.5, 293
numpy.savez("numbers.npz", volts=shots, dt=1e-6, speed=0.5, temperature=293)
with h5py.File("columns.h5", "w") as file:
    file["x"] = shots[:2].T
with h5py.File("text.h5", "w") as file:
    file["note"] = "no numbers"
"#;
    if python(&folder, &program).is_none() {
        return;
    }
    let open = ReadOptions::default();
    let one = all(&folder.join("one.h5"), &open);
    assert_eq!((one.len(), one[2].interval_s), (3, 2e-6));
    assert_wave(&one[2], 0, 2, 1.0 / 128.0);
    let both = all(&folder.join("channels.h5"), &open);
    assert_eq!((both.len(), both[0].channels[1].name.as_str()), (1, "wall"));
    assert_wave(&both[0], 1, 1, 1.0);
    assert_eq!(both[0].notes.len(), 2, "{:?}", both[0].notes);
    let told = |channels: &[&str]| ReadOptions {
        channels: channels.iter().map(|name| (*name).to_owned()).collect(),
        ..at_1_mhz()
    };
    for name in ["numbers.h5", "numbers.npz"] {
        let records = all(&folder.join(name), &open);
        let told = (records[2].interval_s, records[2].speed_m_s);
        assert_eq!((records.len(), told), (3, (1e-6, Some(0.5))), "{name}");
        assert_wave(&records[2], 0, 2, 1.0);
    }
    let several = folder.join("big-endian.h5");
    let a = all(&several, &told(&["a"]));
    assert_eq!(a[1].speed_m_s, Some(0.2));
    assert_wave(&a[1], 0, 1, 1.0);
    assert_wave(&all(&several, &told(&["b"]))[2], 0, 2, 1.0 / 128.0);
    assert_wave(&all(&several, &told(&["b", "a"]))[2], 1, 2, 1.0);
    let results: Vec<_> = read(&several, &at_1_mhz()).collect();
    let error = results[0].as_ref().unwrap_err().to_string();
    assert!(
        error.contains("(a, b, c)") && error.contains("--channel"),
        "{error}"
    );
    assert_wave(&all(&folder.join("columns.h5"), &at_1_mhz())[0], 1, 1, 1.0);
    let empty: Vec<_> = read(&folder.join("text.h5"), &open).collect();
    assert!(matches!(empty[0], Err(RecordError::Empty { .. })));
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
    assert!(matches!(results[0], Err(RecordError::WhichChannel { .. })));
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

#[test]
fn tdms_of_another_writer_is_read_segment_by_segment() {
    let folder = folder("tdms");
    let program = WAVE.to_owned()
        + r#"
from nptdms import TdmsWriter, ChannelObject, GroupObject, RootObject
with TdmsWriter("plain.tdms") as writer:
    for half in (slice(0, 80), slice(80, 200)):
        writer.write_segment([
            ChannelObject("rig", "bead", wave(0)[half], properties={"wf_increment": 1e-6}),
            ChannelObject("rig", "it's the wall", (wave(1)[half] * 128).astype("int16")),
        ])
with TdmsWriter("groups.tdms") as writer:
    for shot in range(3):
        writer.write_segment([
            RootObject(properties={"title": "rig"}),
            GroupObject(f"shot {shot}"),
            ChannelObject(f"shot {shot}", "sum", wave(shot), properties={"wf_increment": 2e-6}),
        ])
"#;
    if python(&folder, &program).is_none() {
        return;
    }
    let plain = all(&folder.join("plain.tdms"), &ReadOptions::default());
    assert_eq!((plain.len(), plain[0].interval_s), (1, 1e-6));
    assert_eq!(plain[0].channels[1].name, "it's the wall");
    assert_wave(&plain[0], 0, 0, 1.0);
    assert_wave(&plain[0], 1, 1, 1.0 / 128.0);
    let groups = all(&folder.join("groups.tdms"), &ReadOptions::default());
    assert_eq!((groups.len(), groups[2].shot), (3, Some(3)));
    assert_wave(&groups[2], 0, 2, 1.0);
    let cut = std::fs::read(folder.join("groups.tdms")).unwrap();
    let short = folder.join("short.tdms");
    std::fs::write(&short, &cut[..cut.len() - 100]).unwrap();
    let records: Vec<_> = read(&short, &ReadOptions::default()).collect();
    assert!(records[0].is_ok() && records[1].is_ok());
    let last = records.last().unwrap();
    assert!(
        matches!(last, Err(RecordError::Truncated { .. })),
        "{last:?}"
    );
}

#[test]
fn text_of_numpy_and_of_pythons_csv_is_read() {
    let folder = folder("csv");
    let program = WAVE.to_owned()
        + r#"
import csv
time = numpy.arange(200) * 1e-6
numpy.savetxt("spaces.txt", numpy.array([time, wave(0), wave(1)]).T)
numpy.savetxt("comma.csv", numpy.array([time * 1e3, wave(0)]).T, delimiter=",",
              header="Time (ms),Sum (V)", comments="")
with open("excel.csv", "w", newline="", encoding="utf-8-sig") as file:
    writer = csv.writer(file, delimiter=";")
    writer.writerow(["Zeit [s]", "Kugel [V]", "Wand [V]"])
    for row in zip(time, wave(0), wave(1)):
        writer.writerow([repr(float(x)).replace(".", ",") for x in row])
"#;
    if python(&folder, &program).is_none() {
        return;
    }
    for (name, channels) in [("spaces.txt", 2), ("comma.csv", 1), ("excel.csv", 2)] {
        let records = all(&folder.join(name), &ReadOptions::default());
        assert_eq!(
            (records.len(), records[0].channels.len()),
            (1, channels),
            "{name}"
        );
        // The sum of 199 steps of 1e-6 as the file's digits give it.
        assert!((records[0].interval_s - 1e-6).abs() < 1e-18, "{name}");
        for shot in 0..channels {
            assert_wave(&records[0], shot, shot, 1.0);
        }
    }
}

#[test]
fn kept_files_of_other_programs_are_read_where_there_is_no_python() {
    for (name, options) in [
        ("shots.npy", at_1_mhz()),
        ("shots.npz", ReadOptions::default()),
        ("shots.tdms", ReadOptions::default()),
    ] {
        let records = all(&kept(name), &options);
        assert_eq!(records.len(), 3, "{name}");
        for (shot, record) in records.iter().enumerate() {
            assert_eq!(record.interval_s, 1e-6, "{name}");
            assert_wave(record, 0, shot, 1.0 / 128.0);
        }
    }
    let waves = all(&kept("both.wav"), &ReadOptions::default());
    assert_wave(&waves[0], 1, 1, 1.0);
    for name in ["oscilloscope.csv", "decimal-comma.csv", "segments.csv"] {
        let records = all(&kept(name), &ReadOptions::default());
        assert_wave(&records[0], 0, 0, 1.0);
        assert!((records[0].interval_s - 1e-6).abs() < 1e-18, "{name}");
    }
    let segments = all(&kept("segments.csv"), &ReadOptions::default());
    assert_eq!(segments.len(), 2);
    assert_wave(&segments[1], 0, 1, 1.0);
}

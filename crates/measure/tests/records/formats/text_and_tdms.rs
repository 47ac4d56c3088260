//! Text, TDMS, and files kept from other programs.

use super::{WAVE, all, assert_wave, at_1_mhz};
use crate::common::{folder, kept, python};
use hertzchain_measure::MeasureError;
use hertzchain_measure::records::{ReadOptions, read};

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
    assert!(matches!(last, Err(MeasureError::Truncated(..))), "{last:?}");
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
        assert_eq!((records.len(), records[0].channels.len()), (1, channels), "{name}");
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

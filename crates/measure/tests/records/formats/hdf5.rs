//! HDF5 of other programs.

use super::{WAVE, all, assert_wave, at_1_mhz};
use crate::common::{folder, python};
use hertzchain_measure::MeasureError;
use hertzchain_measure::records::{ReadOptions, read};

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
    let reported = |channels: &[&str]| ReadOptions {
        channels: channels.iter().map(|name| (*name).to_owned()).collect(),
        ..at_1_mhz()
    };
    for name in ["numbers.h5", "numbers.npz"] {
        let records = all(&folder.join(name), &open);
        let reported = (records[2].interval_s, records[2].speed_m_s);
        assert_eq!((records.len(), reported), (3, (1e-6, Some(0.5))), "{name}");
        assert_wave(&records[2], 0, 2, 1.0);
    }
    let several = folder.join("big-endian.h5");
    let a = all(&several, &reported(&["a"]));
    assert_eq!(a[1].speed_m_s, Some(0.2));
    assert_wave(&a[1], 0, 1, 1.0);
    assert_wave(&all(&several, &reported(&["b"]))[2], 0, 2, 1.0 / 128.0);
    assert_wave(&all(&several, &reported(&["b", "a"]))[2], 1, 2, 1.0);
    let results: Vec<_> = read(&several, &at_1_mhz()).collect();
    let error = results[0].as_ref().unwrap_err().to_string();
    assert!(error.contains("(a, b, c)") && error.contains("--channel"), "{error}");
    assert_wave(&all(&folder.join("columns.h5"), &at_1_mhz())[0], 1, 1, 1.0);
    let empty: Vec<_> = read(&folder.join("text.h5"), &open).collect();
    assert!(matches!(&empty[0], Err(MeasureError::Samples(_, why)) if why == "holds no samples"));
}

#[test]
fn each_shot_has_the_interval_that_its_own_group_states() {
    let folder = folder("h5py-intervals");
    let program = WAVE.to_owned()
        + r#"
import h5py
with h5py.File("times.h5", "w") as file:
    for at, step in ((1, 1e-6), (2, 2e-6)):
        file[f"shot{at}/v"], file[f"shot{at}/time"] = wave(at), numpy.arange(200) * step
        file[f"shot{at}/time"].attrs["units"] = "s"
with h5py.File("attributes.h5", "w") as file:
    for at, step in ((1, 1e-6), (2, 2e-6)):
        file[f"shot{at}"] = wave(at)
        file[f"shot{at}"].attrs["dt"] = step
with h5py.File("shared.h5", "w") as file:
    file["dt"], file["shot1/v"], file["shot2/v"] = 3e-6, wave(1), wave(2)
with h5py.File("channels.h5", "w") as file:
    for name, step in (("ch1", 1e-6), ("ch2", 2e-6)):
        file[name] = wave(1)
        file[name].attrs["dt"] = step
with h5py.File("contradicted.h5", "w") as file:
    file["v"], file["time_s"], file["dt"] = wave(1), numpy.arange(200) * 1e-6, 2e-6
with h5py.File("others.h5", "w") as file:
    file["ch1"], file["dt"], file["time_s"] = wave(1), 1e-6, numpy.arange(200) * 1e-6
    file["temperature/time"] = numpy.arange(20.0)
    file["trigger/volts"], file["trigger/fs"] = wave(2), 1e3
with h5py.File("jitter.h5", "w") as file:
    file["v"], file["dt"] = wave(1), 1e-6 * (1 + 1e-3 * numpy.sin(numpy.arange(200)))
with h5py.File("attributes-contradicted.h5", "w") as file:
    file["v"] = wave(1)
    file["v"].attrs["dt"], file["v"].attrs["fs"] = 2e-6, 1e6
"#;
    if python(&folder, &program).is_none() {
        return;
    }
    let steps = |name: &str| -> Vec<f64> {
        let records = all(&folder.join(name), &ReadOptions::default());
        records.iter().map(|record| 1e6 * record.interval_s).collect()
    };
    for name in ["times.h5", "attributes.h5"] {
        let found = steps(name);
        assert!((found[0] - 1.0).abs() < 1e-9 && (found[1] - 2.0).abs() < 1e-9, "{found:?}");
    }
    assert_eq!(steps("shared.h5"), [3.0, 3.0]);
    let unlike = read(&folder.join("channels.h5"), &ReadOptions::default()).next().unwrap();
    let error = unlike.unwrap_err().to_string();
    assert!(error.contains("intervals between samples of 1 and of 2 µs"), "{error}");
    let ch1 = ReadOptions { channels: vec!["ch1".to_owned()], ..ReadOptions::default() };
    let ch1 = all(&folder.join("others.h5"), &ch1);
    assert_eq!((ch1[0].interval_s, ch1[0].notes.len()), (1e-6, 0), "{:?}", ch1[0].notes);
    assert!((steps("jitter.h5")[0] - 1.0).abs() < 1e-4);
    for name in ["contradicted.h5", "attributes-contradicted.h5"] {
        let taken = &all(&folder.join(name), &ReadOptions::default())[0];
        assert_eq!(taken.interval_s, 2e-6);
        let noted = taken.notes.iter().any(|note| note.contains("of 1 µs and one of 2 µs"));
        assert!(noted, "{:?}", taken.notes);
    }
}

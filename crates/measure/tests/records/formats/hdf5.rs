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

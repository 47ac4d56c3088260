//! WAV, and recordings in pieces.

use super::{WAVE, all, assert_wave, at_1_mhz, wave};
use crate::common::{folder, python};
use hertzchain_measure::records::{Parts, ReadOptions, read};

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
    let reported: Vec<String> = wide.map(|record| record.unwrap_err().to_string()).collect();
    assert!(reported.len() == 1 && reported[0].contains("float32"), "{reported:?}");
    assert_wave(&all(&folder.join("u1.wav"), &at_1_mhz())[0], 0, 0, 1.0);
    let cut = ReadOptions { parts: Parts::Shots(200), ..ReadOptions::default() };
    let records = all(&folder.join("long.wav"), &cut);
    assert_eq!((records.len(), records[2].interval_s), (3, 2e-6));
    assert_wave(&records[2], 0, 2, 1.0);
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
    let pieces = ReadOptions { parts: Parts::Pieces(250), ..at_1_mhz() };
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
        let whole: Vec<f64> =
            records.iter().take(3).flat_map(|record| record.channels[0].volts.clone()).collect();
        let expected: Vec<f64> = (0..600).map(|i| wave(i / 200, i % 200)).collect();
        assert_eq!(whole, expected, "{name}");
        assert!(records.iter().all(|record| record.interval_s == records[0].interval_s));
    }
    for name in ["rows.npz", "rows.h5"] {
        let records = all(&folder.join(name), &pieces);
        let speeds: Vec<_> = records.iter().filter_map(|record| record.speed_m_s).collect();
        assert_eq!(speeds, [0.1, 0.1, 0.1, 0.2, 0.2, 0.2], "{name}");
    }
    for name in ["cube.npy", "cube.npz"] {
        let records = all(&folder.join(name), &pieces);
        assert_eq!(records.len(), 6, "{name}");
        for (at, record) in records.iter().enumerate() {
            let volt = |channel: usize| record.channels[channel].volts[0];
            let sign = if at < 3 { 1.0 } else { -1.0 };
            let own = (record.first_sample, volt(0) * sign);
            let start = 250 * (at % 3);
            let expected = wave(start / 200, start % 200);
            assert_eq!((own, volt(1)), ((start as u64, expected), expected), "{name}");
        }
    }
}

#[test]
fn chunks_of_odd_length_are_passed_over_with_the_byte_that_follows() {
    let folder = folder("odd-chunk");
    let chunk = |name: &[u8], bytes: &[u8]| {
        let padding = &[0][..bytes.len() % 2];
        [name, &(bytes.len() as u32).to_le_bytes(), bytes, padding].concat()
    };
    let format = [1_u16, 1, 16_960, 15, 33_920, 30, 2, 16].map(u16::to_le_bytes).concat();
    let samples: Vec<u8> =
        (0..200_i32).flat_map(|i| (i * i % 251 * 100).to_le_bytes()[..2].to_vec()).collect();
    let parts = [chunk(b"junk", b"12345"), chunk(b"fmt ", &format), chunk(b"LIST", &[7; 17])];
    let data = chunk(b"data", &samples);
    let padded = [b"WAVE".to_vec(), parts.concat(), data.clone()].concat();
    let bare = [b"WAVE", &parts[1][..], &parts[0][..13], &data].concat();
    for (name, body) in [("padded.wav", padded), ("bare.wav", bare)] {
        let path = folder.join(name);
        std::fs::write(&path, chunk(b"RIFF", &body)).unwrap();
        let records = all(&path, &ReadOptions::default());
        assert_eq!((records.len(), records[0].interval_s), (1, 1e-6));
        let volts = &records[0].channels[0].volts;
        assert_eq!((volts.len(), volts[9]), (200, 8100.0 / 32_768.0));
    }
}

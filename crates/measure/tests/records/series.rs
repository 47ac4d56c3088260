//! Series of ours: written whole or not at all, read back bit for bit.

use crate::common::{folder, python};
use hertzchain_measure::MeasureError;
use hertzchain_measure::records::{
    ReadOptions, Record, SeriesChannels, SeriesInfo, SeriesWriter, ShotRow, read, truth,
    untriggered, verify,
};
use std::fs;
use std::path::Path;

fn info(samples_per_shot: usize) -> SeriesInfo {
    SeriesInfo {
        channels: SeriesChannels::Summed,
        interval_s: 1e-6,
        volts_per_count: 10.0 / 32_768.0,
        offset_v: 0.25,
        pretrigger: 100,
        samples_per_shot,
        series: 7,
        case: "dry".to_owned(),
        seed: 42,
        experiment: "# An experiment\n[chain]\nbeads = 40\n".to_owned(),
        long_names: &[],
        more: vec![("measured_speed_error_m_s".to_owned(), "0.003".to_owned())],
    }
}

/// Noise and a pulse, by a formula.
fn samples(shot: u64, count: usize) -> Vec<i16> {
    let noise = |i: u64| ((i * 7919 + shot * 104_729) % 13) as i16 - 6;
    let pulse = |i: u64| (9000.0 * (-((i as f64 - 300.0) / 40.0).powi(2)).exp()) as i16;
    (0..count as u64).map(|i| noise(i) + pulse(i)).collect()
}

fn write(path: &Path, shots: u64, count: usize) -> Result<(), MeasureError> {
    let mut writer = SeriesWriter::create(path, &info(count))?;
    for shot in 0..shots {
        writer.push(&ShotRow {
            shot,
            programmed_speed_m_s: 0.5,
            measured_speed_m_s: 0.5 + 1e-3 * shot as f64,
            triggered: shot != 1,
            contacts: &[("overlap_before_m", &[1e-6 * shot as f64, -1e-6])],
            samples: &samples(shot, count),
            truth: &[("tof_incident_s", 6e-4), ("speed_m_s", 0.4999)],
        })?;
    }
    writer.finish().map(|_| ())
}

fn all(path: &Path) -> Vec<Record> {
    let records = read(path, &ReadOptions::default());
    records.map(|record| record.unwrap()).collect()
}

#[test]
fn a_series_reads_back_as_it_was_written() {
    let path = folder("back").join("series.h5");
    write(&path, 5, 1000).unwrap();
    let records = all(&path);
    assert_eq!(records.len(), 5);
    for (shot, record) in records.iter().enumerate() {
        assert_eq!(record.shot, Some(shot as u64));
        assert_eq!(record.interval_s, 1e-6);
        assert_eq!(record.speed_m_s, Some(0.5 + 1e-3 * shot as f64));
        assert_eq!(record.speed_error_m_s, Some(0.003));
        assert_eq!(record.case.as_deref(), Some("dry"));
        assert_eq!(record.pretrigger, Some(100));
        assert_eq!(record.triggered, Some(shot != 1));
        let counts = samples(shot as u64, 1000).into_iter();
        let expected = counts.map(|count| f64::from(count) * (10.0 / 32_768.0) + 0.25);
        assert_eq!(record.channels[0].volts, expected.collect::<Vec<_>>());
        let (low_v, high_v) = record.channels[0].range_v.unwrap();
        // Rounding; one step below the end.
        assert!((low_v + 9.75).abs() < 1e-12 && (high_v - 10.25 + 10.0 / 32_768.0).abs() < 1e-12);
    }
    assert_eq!(untriggered(&path).unwrap(), 1);
}

#[test]
fn the_highest_count_of_a_converter_of_fewer_bits_is_less() {
    let path = folder("bits").join("series.h5");
    let mut writer = SeriesWriter::create(&path, &info(1000)).unwrap();
    let samples: Vec<i16> = samples(0, 1000).iter().map(|count| count & !15).collect();
    let row = ShotRow {
        shot: 0,
        programmed_speed_m_s: 0.5,
        measured_speed_m_s: 0.5,
        triggered: true,
        contacts: &[("overlap_before_m", &[0.0, 0.0])],
        samples: &samples,
        truth: &[("tof_incident_s", 6e-4), ("speed_m_s", 0.4999)],
    };
    writer.push(&row).unwrap();
    writer.finish().unwrap();
    let (_, high_v) = all(&path)[0].channels[0].range_v.unwrap();
    // 2047 of 2048 steps of 12 bits; rounding.
    assert!((high_v - 10.25 + 10.0 / 2048.0).abs() < 1e-12, "{high_v}");
}

#[test]
fn true_values_of_contacts_come_shot_after_shot() {
    let path = folder("contacts").join("series.h5");
    write(&path, 3, 100).unwrap();
    let reported = truth(&path).unwrap();
    let names: Vec<&str> = reported.iter().map(|(name, _)| &**name).collect();
    assert!(!names.contains(&"contact"), "{names:?}");
    let overlaps = reported.iter().find(|(name, _)| name == "overlap_before_m");
    assert_eq!(overlaps.unwrap().1, [0.0, -1e-6, 1e-6, -1e-6, 2e-6, -1e-6]);
}

#[test]
fn shots_longer_than_a_chunk_read_back() {
    let path = folder("long").join("series.h5");
    let count = (1 << 19) + 12_345;
    write(&path, 2, count).unwrap();
    for (shot, record) in all(&path).iter().enumerate() {
        let counts = samples(shot as u64, count).into_iter();
        let expected = counts.map(|count| f64::from(count) * (10.0 / 32_768.0) + 0.25);
        assert!(record.channels[0].volts.iter().copied().eq(expected));
    }
}

#[test]
fn the_same_series_is_the_same_bytes() {
    let folder = folder("same");
    let (a, b) = (folder.join("a.h5"), folder.join("other-name.h5"));
    write(&a, 4, 2000).unwrap();
    write(&b, 4, 2000).unwrap();
    assert!(fs::read(a).unwrap() == fs::read(b).unwrap());
}

#[test]
fn a_series_has_its_name_only_when_it_is_complete() {
    let folder = folder("complete");
    let path = folder.join("series.h5");
    let mut writer = SeriesWriter::create(&path, &info(50)).unwrap();
    let row = ShotRow {
        shot: 0,
        programmed_speed_m_s: 1.0,
        measured_speed_m_s: 1.0,
        triggered: true,
        contacts: &[],
        samples: &[1; 50],
        truth: &[],
    };
    writer.push(&row).unwrap();
    assert!(!path.exists());
    drop(writer);
    // Nothing stays of a writer that gave up.
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn writers_of_one_series_at_a_time_do_not_meet() {
    let folder = folder("together");
    let path = folder.join("series.h5");
    let mut writers = [0, 1].map(|_| SeriesWriter::create(&path, &info(100)).unwrap());
    for shot in 0..3 {
        for writer in &mut writers {
            let samples = &samples(shot, 100);
            let row = ShotRow {
                shot,
                programmed_speed_m_s: 0.5,
                measured_speed_m_s: 0.5,
                triggered: true,
                contacts: &[],
                samples,
                truth: &[],
            };
            writer.push(&row).unwrap();
        }
    }
    for writer in writers {
        writer.finish().unwrap();
        assert_eq!(all(&path).len(), 3);
    }
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
}

#[test]
fn shots_that_do_not_fit_their_series_are_refused() {
    let path = folder("misfit").join("series.h5");
    let mut writer = SeriesWriter::create(&path, &info(50)).unwrap();
    let row = |samples, truth| ShotRow {
        shot: 3,
        programmed_speed_m_s: 1.0,
        measured_speed_m_s: 1.0,
        triggered: true,
        contacts: &[],
        samples,
        truth,
    };
    writer.push(&row(&[1; 50], &[("a_s", 1.0)])).unwrap();
    for bad in [row(&[1; 49], &[("a_s", 1.0)]), row(&[1; 50], &[("b_s", 1.0)]), row(&[1; 50], &[])]
    {
        let error = writer.push(&bad).unwrap_err();
        assert!(error.to_string().contains("shot 3 does not fit"), "{error}");
    }
    // What was refused has left no trace.
    writer.push(&row(&[2; 50], &[("a_s", 2.0)])).unwrap();
    writer.finish().unwrap();
    assert_eq!(truth(&path).unwrap(), [("a_s".to_owned(), vec![1.0, 2.0])]);
}

#[test]
fn a_place_that_cannot_be_written_is_told_and_leaves_finished_files() {
    let folder = folder("unwritable");
    let done = folder.join("done.h5");
    write(&done, 1, 100).unwrap();
    let before = fs::read(&done).unwrap();
    for place in [folder.join("missing/series.h5"), done.join("series.h5")] {
        let error = write(&place, 1, 100).unwrap_err();
        assert!(matches!(error, MeasureError::Unwritable(..)), "{error}");
        assert!(error.to_string().contains("intact"), "{error}");
    }
    assert_eq!(fs::read(&done).unwrap(), before);
}

#[test]
fn records_are_the_same_whatever_the_truth_says() {
    let folder = folder("truth");
    let (a, b) = (folder.join("a.h5"), folder.join("b.h5"));
    for (path, value) in [(&a, 1.0), (&b, f64::NAN)] {
        let mut writer = SeriesWriter::create(path, &info(50)).unwrap();
        let row = ShotRow {
            shot: 0,
            programmed_speed_m_s: 1.0,
            measured_speed_m_s: 1.0,
            triggered: true,
            contacts: &[],
            samples: &samples(0, 50),
            truth: &[("tof_incident_s", value)],
        };
        writer.push(&row).unwrap();
        writer.finish().unwrap();
    }
    let strip = |path: &Path| all(path).remove(0).channels;
    assert_eq!(strip(&a), strip(&b));
    let peek =
        ReadOptions { channels: vec!["truth/tof_incident_s".to_owned()], ..ReadOptions::default() };
    let peeked: Vec<_> = read(&a, &peek).collect();
    assert!(peeked.iter().all(Result::is_err), "{peeked:?}");
}

#[test]
fn h5py_and_xarray_read_a_series() {
    let folder = folder("python");
    write(&folder.join("series.h5"), 3, 1000).unwrap();
    let printed = python(
        &folder,
        r#"
import h5py, xarray
with h5py.File("series.h5") as file:
    samples = file["samples"]
    assert samples.dtype == "int16" and samples.shape == (3, 1000), samples
    assert samples.chunks == (1, 1000) and samples.compression == "gzip" and samples.shuffle
    assert samples.attrs["sampling_interval_s"] == 1e-6
    assert samples.attrs["volts_per_count"] == 10 / 32768 and samples.attrs["offset_v"] == 0.25
    assert samples.attrs["pretrigger_samples"] == 100 and samples.attrs["units"] == "V"
    assert file.attrs["seed"] == 42 and file.attrs["case"] == "dry"
    assert "beads = 40" in file.attrs["experiment"]
    assert list(file["shot"][:]) == [0, 1, 2]
    assert file["measured_speed"].attrs["units"] == "m s-1"
    assert file["truth/tof_incident_s"].attrs["units"] == "s"
    counts = samples[1]
    with h5py.File("untold.h5", "w") as other:
        for name in ("samples", "shot", "programmed_speed", "measured_speed"):
            file.copy(name, other)
        for name in ("format", "case"):
            other.attrs[name] = file.attrs[name]
    print(int(counts.astype("int64").sum()))
with xarray.open_dataset("series.h5", engine="h5netcdf") as data:
    assert data.samples.dims == ("shot", "sample"), data
    assert data.measured_speed.dims == ("shot",), data
    assert abs(float(data.samples[1, 5]) - (counts[5] * 10 / 32768 + 0.25)) < 1e-6
    assert "tof_incident_s" not in data
    assert data.triggered.dims == ("shot",) and list(data.triggered) == [1, 0, 1], data
with xarray.open_dataset("series.h5", engine="h5netcdf", group="truth") as data:
    assert data.tof_incident_s.dims == ("shot",), data
    assert data.overlap_before_m.dims == ("shot", "contact"), data
    assert list(data.contact) == [1, 2] and list(data.overlap_before_m[2]) == [2e-6, -1e-6], data
"#,
    );
    let Some(printed) = printed else { return };
    // A file that determines nothing of triggers is read all the same.
    assert_eq!(all(&folder.join("untold.h5"))[2].triggered, None);
    let sum: i64 = samples(1, 1000).iter().map(|count| i64::from(*count)).sum();
    assert_eq!(printed.trim(), sum.to_string());
}

#[test]
fn a_finished_series_with_any_flipped_bit_is_not_taken_for_finished() {
    let path = folder("flipped").join("series.h5");
    write(&path, 3, 400).unwrap();
    verify(&path, &info(400), 3, 0.5).unwrap();
    let whole = fs::read(&path).unwrap();
    // A bit of every eleventh byte, which falls on all parts of the file.
    for at in (0..whole.len()).step_by(11) {
        let mut flipped = whole.clone();
        flipped[at] ^= 1 << (at % 8);
        fs::write(&path, flipped).unwrap();
        let found = verify(&path, &info(400), 3, 0.5);
        assert!(found.is_err(), "byte {at} of {}", whole.len());
    }
    fs::write(&path, &whole[..whole.len() - 1]).unwrap();
    assert!(verify(&path, &info(400), 3, 0.5).is_err());
}

//! Files that are longer, or say that they are, than anything sensible: refused with a reason, for
//! little memory, and no other file with them.

use crate::common::{folder, python};
use crate::formats::at_1_mhz;
use allocation_counter::measure;
use hertzchain_measure::MeasureError;
use hertzchain_measure::records::{ReadOptions, Rows, read, remove_copies, seekable, text};
use std::fs;
use std::path::Path;

/// The only thing that a file gives.
fn refusal(file: &Path) -> MeasureError {
    let mut given = read(file, &at_1_mhz());
    let error = given.next().unwrap().unwrap_err();
    assert!(given.next().is_none(), "{error}");
    error
}

/// An NPY file of that version, with a header that claims a length.
fn npy(version: u8, claims: &[u8], header: &str) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY".to_vec();
    bytes.extend([version, 0]);
    bytes.extend(claims);
    bytes.extend(header.bytes());
    bytes
}

#[test]
fn a_header_that_claims_gigabytes_gets_none() {
    let file = folder("lying-header").join("a.npy");
    for (version, claims) in [(2, 4_000_000_000_u32), (3, u32::MAX), (2, 70_000)] {
        fs::write(&file, npy(version, &claims.to_le_bytes(), "")).unwrap();
        let took = measure(|| {
            let error = refusal(&file);
            assert!(error.to_string().contains("header claims"), "{error}");
        });
        // Buffers of 64 KiB.
        assert!(took.bytes_max < 1 << 20, "{} bytes", took.bytes_max);
    }
}

#[test]
fn brackets_without_end_in_a_header_are_refused() {
    let file = folder("brackets").join("a.npy");
    let header = "(".repeat(9000);
    fs::write(&file, npy(1, &9000_u16.to_le_bytes(), &header)).unwrap();
    let error = refusal(&file);
    assert!(error.to_string().contains("not a dictionary"), "{error}");
}

#[test]
fn a_line_without_end_is_refused_and_takes_little_more_than_its_limit() {
    let file = folder("long-line").join("a.csv");
    let mut bytes = b"0.1,0.2\n0.3,0.4\n".repeat(100);
    bytes.extend(b"1,".repeat(20 << 20));
    fs::write(&file, bytes).unwrap();
    let took = measure(|| {
        let given: Vec<_> = read(&file, &at_1_mhz()).collect();
        let errors = given.iter().filter_map(|record| record.as_ref().err());
        let why: Vec<String> = errors.map(ToString::to_string).collect();
        assert!(why.iter().any(|why| why.contains("16 MiB")), "{why:?}");
    });
    // The line as far as it is read, twice as its place grows, and as text.
    assert!(took.bytes_max < 4 << 24, "{} bytes", took.bytes_max);
}

#[test]
fn millions_of_short_rows_are_no_shots() {
    let file = folder("rows").join("a.npy");
    let header = "{'descr': '|i1', 'fortran_order': False, 'shape': (10000000, 2), }\n";
    let length = u16::try_from(header.len()).unwrap().to_le_bytes();
    fs::write(&file, npy(1, &length, header)).unwrap();
    let opened = fs::OpenOptions::new().append(true).open(&file).unwrap();
    opened.set_len(10 + header.len() as u64 + 20_000_000).unwrap();
    let as_shots = ReadOptions { rows: Rows::Shots, ..at_1_mhz() };
    let (mut count, mut last) = (0, None);
    for record in read(&file, &as_shots) {
        (count, last) = (count + 1, record.err());
    }
    assert_eq!(count, 100_001);
    let why = last.unwrap().to_string();
    assert!(why.contains("more than 100000 records"), "{why}");
}

#[test]
fn an_interval_that_no_recorder_has_is_refused() {
    let file = folder("interval").join("a.csv");
    fs::write(&file, "0.1,0.2\n".repeat(50)).unwrap();
    for rate_hz in [1e300, 1e-300, 1e13, 1e-4] {
        let options = ReadOptions { rate_hz: Some(rate_hz), ..ReadOptions::default() };
        let error = read(&file, &options).next().unwrap().unwrap_err();
        assert!(error.to_string().contains("impossible"), "{error}");
        assert!(error.to_string().len() < 200, "{error}");
    }
}

#[test]
fn a_table_without_end_is_refused() {
    let folder = folder("table");
    let file = folder.join("shots.csv");
    fs::write(&file, "file,speed\n").unwrap();
    assert_eq!(text(&file).unwrap(), "file,speed\n");
    fs::write(&file, vec![b'"'; (16 << 20) + 1]).unwrap();
    let took = measure(|| {
        let why = text(&file).unwrap_err().to_string();
        assert!(why.contains("16 MiB"), "{why}");
    });
    assert!(took.bytes_max < 4 << 24, "{} bytes", took.bytes_max);
}

#[cfg(unix)]
#[test]
fn a_pipe_is_read_once_and_its_copy_as_often_as_need_be() {
    let folder = folder("pipe");
    let pipe = folder.join("shots.csv");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    let content = "0.1\n0.25\n".repeat(5000);
    std::thread::scope(|scope| {
        scope.spawn(|| fs::write(&pipe, &content).unwrap());
        let copy = seekable(&pipe).unwrap();
        for _ in 0..2 {
            assert_eq!(fs::read_to_string(&copy).unwrap(), content);
            let record = read(&copy, &at_1_mhz()).next().unwrap().unwrap();
            assert_eq!(record.len(), 10_000);
            assert!(record.source.ends_with("shots.csv"), "{}", record.source);
        }
    });
    remove_copies();
    // A file is itself.
    let file = folder.join("file.csv");
    fs::write(&file, &content).unwrap();
    assert_eq!(seekable(&file).unwrap(), file);
}

/// Files whose numbers are in another file of the machine, in the three ways that HDF5 knows.
#[test]
fn hdf5_that_points_to_other_files_is_refused() {
    let folder = folder("elsewhere");
    let program = "
import h5py, numpy
secret = numpy.arange(400.0) % 7
secret.tofile('secret.bin')
with h5py.File('source.h5', 'w') as file:
    file['a'] = secret
with h5py.File('external.h5', 'w') as file:
    file.create_dataset('a', (400,), 'f8', external=[('secret.bin', 0, 3200)])
with h5py.File('virtual.h5', 'w') as file:
    layout = h5py.VirtualLayout((400,), 'f8')
    layout[:] = h5py.VirtualSource('source.h5', 'a', (400,))
    file.create_virtual_dataset('a', layout)
with h5py.File('link.h5', 'w') as file:
    file['a'] = h5py.ExternalLink('source.h5', '/a')
";
    if python(&folder, program).is_none() {
        return;
    }
    assert!(read(&folder.join("source.h5"), &at_1_mhz()).all(|record| record.is_ok()));
    for name in ["external.h5", "virtual.h5", "link.h5"] {
        let error = refusal(&folder.join(name)).to_string();
        let why = ["in other files", "without samples", "no datasets", "empty", "no samples"];
        assert!(why.iter().any(|why| error.contains(why)), "{name}: {error}");
    }
}

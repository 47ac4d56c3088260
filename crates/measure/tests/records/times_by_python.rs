//! Times beside samples as Python's programs write them.

use crate::common::{folder, python};
use hertzchain_measure::records::{ReadOptions, Record, read};
use std::path::Path;

/// Time, in s, and a signal that is none.
const PROGRAM: &str = r##"
import numpy
t = (numpy.arange(800) - 100) * 2e-6
v = ((numpy.arange(800) * 37) % 101) / 128
both = numpy.column_stack([t, v])
numpy.savetxt("plain.txt", both, header="t v")
numpy.savetxt("comma.csv", both, header="time (s),volts", delimiter=",", fmt="%.7f")
numpy.savetxt("bare.csv", both, header="time,volts", delimiter=",", comments="")
numpy.savetxt("words.txt", both, header="recorded on a Monday\nt v")
numpy.savetxt("short.txt", both, header="t v", fmt="%.3e")
numpy.savetxt("semi.csv", both * [1e6, 1], header="t_us;v", delimiter=";", fmt="%.1f;%.7f")
numpy.savetxt("percent.txt", both, header="t v", comments="% ")
numpy.savetxt("utf16.txt", both, header="t v", encoding="utf-16")
numpy.save("columns.npy", both)
numpy.save("single.npy", both.astype("f4"))
numpy.save("fortran.npy", numpy.asfortranarray(both))
numpy.save("rows.npy", both.T.copy())
numpy.savez("columns.npz", both)
import h5py
with h5py.File("columns.h5", "w") as file:
    file["scope"] = both
from nptdms import TdmsWriter, ChannelObject
with TdmsWriter("times.tdms") as writer:
    writer.write_segment([ChannelObject("rig", "Time", t), ChannelObject("rig", "sum", v)])
"##;

fn only(path: &Path) -> Record {
    let mut records: Vec<Record> = read(path, &ReadOptions::default())
        .map(|record| record.unwrap_or_else(|error| panic!("{error}")))
        .collect();
    assert_eq!(records.len(), 1, "{}", path.display());
    records.remove(0)
}

#[test]
fn times_are_taken_for_times_in_every_format_and_with_any_header() {
    let folder = folder("python-times");
    if python(&folder, PROGRAM).is_none() {
        return;
    }
    for name in [
        "plain.txt",
        "comma.csv",
        "bare.csv",
        "words.txt",
        "short.txt",
        "semi.csv",
        "percent.txt",
        "utf16.txt",
        "columns.npy",
        "single.npy",
        "fortran.npy",
        "rows.npy",
        "columns.npz",
        "columns.h5",
        "times.tdms",
    ] {
        let record = only(&folder.join(name));
        assert_eq!(record.channels.len(), 1, "{name}");
        // What single precision and four digits leave of it.
        assert!((record.interval_s - 2e-6).abs() < 2e-12, "{name}: {:e}", record.interval_s);
        let volts = record.channels[0].volts.clone();
        assert_eq!(volts.len(), 800, "{name}");
        for (i, volt) in volts.iter().enumerate() {
            let expected = ((i * 37) % 101) as f64 / 128.0;
            // Four digits.
            assert!((volt - expected).abs() < 5e-4, "{name}, {i}: {volt}");
        }
    }
}

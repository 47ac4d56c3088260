//! Files that are no experiments at all.

use super::DRY;
use crate::{Experiment, OpenError};
use std::fs;
use std::path::{Path, PathBuf};

fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("hertzchain-files-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    fs::write(&path, bytes).unwrap();
    path
}

fn unreadable(path: &Path) -> String {
    let error = Experiment::open(path).unwrap_err();
    assert!(matches!(error, OpenError::Unreadable { .. }), "{error}");
    error.to_string()
}

fn only(path: &Path) -> String {
    match Experiment::open(path).unwrap_err() {
        OpenError::Mistakes(mistakes) => {
            assert_eq!(mistakes.findings().len(), 1, "{mistakes}");
            mistakes.to_string()
        }
        error @ OpenError::Unreadable { .. } => panic!("{error}"),
    }
}

#[test]
fn an_empty_file_is_one_report() {
    for (name, text) in [("empty", ""), ("blank", "\n \n"), ("comment", "# nothing\n")] {
        let report = only(&file(name, text.as_bytes()));
        assert!(report.contains("hertzchain presets dry"), "{report}");
    }
}

#[test]
fn a_byte_order_mark_and_windows_line_ends_are_read() {
    let windows = DRY.replace('\n', "\r\n");
    for (name, text) in [("bom", format!("\u{feff}{DRY}")), ("crlf", windows)] {
        let experiment = Experiment::open(file(name, text.as_bytes()));
        assert_eq!(experiment.unwrap().beads(), 40, "{name}");
    }
}

#[test]
fn a_mistake_after_a_byte_order_mark_and_windows_line_ends_is_at_its_line() {
    let windows = DRY.replace("6.35 mm\"\n", "6.35 kg\"\n").replace('\n', "\r\n");
    let path = file("marked", format!("\u{feff}{windows}").as_bytes());
    let OpenError::Mistakes(mistakes) = Experiment::open(&path).unwrap_err() else {
        panic!("it can be read");
    };
    let finding = &mistakes.findings()[0];
    let line = 1 + DRY.lines().position(|l| l.starts_with("radius")).unwrap();
    assert_eq!((finding.line(), finding.text()), (line, "\"6.35 kg\""));
}

#[test]
fn other_encodings_and_binaries_are_named() {
    let wide: Vec<u8> =
        (std::iter::once(0xFEFF).chain(DRY.encode_utf16())).flat_map(u16::to_le_bytes).collect();
    assert!(unreadable(&file("wide", &wide)).contains("UTF-16"));
    let latin = b"title = \"x\"\n# caf\xe9\n";
    assert!(unreadable(&file("latin", latin)).contains("line 2 is not written in UTF-8"));
    assert!(unreadable(&file("binary", b"\x7fELF\x00\xff")).contains("no text"));
}

#[test]
fn a_folder_and_a_huge_file_are_refused() {
    let folder = std::env::temp_dir();
    assert!(unreadable(&folder).contains("it is a folder"));
    // A hole takes no room on the disk.
    let path = file("huge", b"#");
    let huge = fs::OpenOptions::new().write(true).open(&path).unwrap();
    huge.set_len((16 << 20) + 1).unwrap();
    assert!(unreadable(&path).contains("at most 16 MiB"));
    fs::remove_file(path).unwrap();
}

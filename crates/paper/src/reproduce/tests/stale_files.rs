use super::*;
use std::path::PathBuf;

/// A new folder with a provenance and some files.
fn folder(name: &str, provenance: &str) -> PathBuf {
    let name = format!("hertzchain-{name}-{}", std::process::id());
    let folder = std::env::temp_dir().join(name);
    fs::create_dir_all(folder.join("inside")).unwrap();
    fs::write(folder.join(PROVENANCE), provenance).unwrap();
    for file in ["tof.csv", "readings.md", "mine.txt", "inside/deep.csv"] {
        fs::write(folder.join(file), "").unwrap();
    }
    folder
}

/// Which of the files are still there.
fn left(folder: &Path) -> [bool; 4] {
    let files = ["tof.csv", "readings.md", "mine.txt", "inside/deep.csv"];
    let left = files.map(|file| folder.join(file).exists());
    fs::remove_dir_all(folder).unwrap();
    left
}

#[test]
fn only_what_an_earlier_run_listed_and_this_one_did_not_write_is_removed() {
    let listed = r#"{"program": "hertzchain", "files": ["tof.csv", "readings.md", "gone.svg"]}"#;
    let folder = folder("stale_files", listed);
    remove_stale_files(&folder, &["tof.csv"]).unwrap();
    assert_eq!(left(&folder), [true, false, true, true]);
}

#[test]
fn nothing_outside_the_folder_or_below_it_is_removed() {
    let listed =
        r#"{"program": "hertzchain", "files": ["inside/deep.csv", "inside", "..", "", 7]}"#;
    let folder = folder("outside", listed);
    let beside = folder.with_extension("beside");
    fs::write(&beside, "").unwrap();
    let name = beside.file_name().unwrap().to_str().unwrap();
    let listed = listed.replace("..", &format!("../{name}"));
    fs::write(folder.join(PROVENANCE), listed).unwrap();
    remove_stale_files(&folder, &[]).unwrap();
    let stays = beside.exists();
    fs::remove_file(&beside).unwrap();
    assert!(stays);
    assert_eq!(left(&folder), [true; 4]);
}

#[test]
fn a_provenance_of_something_else_removes_nothing() {
    for other in [
        r#"{"program": "another", "files": ["tof.csv"]}"#,
        r#"{"program": "hertzchain"}"#,
        "no JSON",
    ] {
        let folder = folder("other", other);
        remove_stale_files(&folder, &[]).unwrap();
        assert_eq!(left(&folder), [true; 4], "{other}");
    }
}

//! Files are there whole or not at all, whatever else writes into the folder.

use crate::common::folder;
use hertzchain_measure::records::{Files, remove_left_behind, write_whole};
use std::fs;
use std::io;
use std::path::Path;

fn put(path: &Path, content: &[u8]) {
    write_whole(path, |file| file.write_all(content)).unwrap();
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn an_existing_file_is_replaced_whole() {
    let folder = folder("replaced");
    let path = folder.join("tof.csv");
    put(&path, b"a long first content");
    put(&path, b"short");
    assert_eq!(fs::read(&path).unwrap(), b"short");
    assert_eq!(names(&folder), ["tof.csv"]);
}

#[test]
fn a_file_that_cannot_be_written_or_renamed_leaves_nothing_behind() {
    let folder = folder("in-the-way");
    let path = folder.join("tof.csv");
    fs::create_dir_all(path.join("a folder of that name")).unwrap();
    assert!(write_whole(&path, |file| file.write_all(b"case")).is_err());
    let full = |_: &mut dyn io::Write| Err(io::Error::from(io::ErrorKind::StorageFull));
    assert!(write_whole(&folder.join("other.csv"), full).is_err());
    assert_eq!(names(&folder), ["tof.csv"]);
}

#[test]
fn writers_of_one_name_leave_the_bytes_of_one_of_them() {
    let folder = folder("many-writers");
    let path = folder.join("tof.csv");
    let content = |of: u8| vec![of; 1 << 16];
    std::thread::scope(|scope| {
        for of in 0..8 {
            let (path, folder) = (&path, &folder);
            scope.spawn(move || {
                for _ in 0..10 {
                    put(path, &content(of));
                    // What another program does when it begins.
                    remove_left_behind(folder, |_| true);
                }
            });
        }
    });
    let found = fs::read(&path).unwrap();
    assert_eq!(found, content(found[0]));
    assert_eq!(names(&folder), ["tof.csv"]);
}

#[test]
fn files_of_a_run_appear_together_or_not_at_all() {
    let folder = folder("together");
    put(&folder.join("tof.csv"), b"old");
    let mut files = Files::within(&folder).unwrap();
    files.write("tof.csv", |file| file.write_all(b"new")).unwrap();
    let full = |_: &mut dyn io::Write| Err(io::Error::from(io::ErrorKind::StorageFull));
    assert!(files.write("fit.png", full).is_err());
    drop(files);
    assert_eq!(fs::read(folder.join("tof.csv")).unwrap(), b"old");
    assert_eq!(names(&folder), ["tof.csv"]);
    let mut files = Files::within(&folder).unwrap();
    for name in ["tof.csv", "fit.png"] {
        files.write(name, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read(folder.join("tof.csv")).unwrap(), b"old");
    }
    // Another program that begins here leaves them alone.
    Files::within(&folder).unwrap();
    assert_eq!(files.names().collect::<Vec<_>>(), ["tof.csv", "fit.png"]);
    files.finish().unwrap();
    assert_eq!(fs::read(folder.join("tof.csv")).unwrap(), b"new");
    assert_eq!(names(&folder), ["fit.png", "tof.csv"]);
}

#[test]
fn leftovers_of_killed_runs_are_removed_and_nothing_else() {
    let folder = folder("leftovers");
    let of_a_killed_run = ".tof.csv.hertzchain-aBcDeFgH1234.part";
    let others = [".tof.csv.part", ".tof.csv.hertzchain-short.part", "tof.csv"];
    for name in others.into_iter().chain([of_a_killed_run]) {
        fs::write(folder.join(name), b"half").unwrap();
    }
    Files::within(&folder).unwrap();
    let mut left = others.map(str::to_owned);
    left.sort();
    assert_eq!(names(&folder), left);
}

#[cfg(unix)]
#[test]
fn no_link_is_followed_and_the_umask_decides_who_reads() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = folder("links");
    let (elsewhere, path) = (folder.join("elsewhere"), folder.join("tof.csv"));
    fs::write(&elsewhere, b"another's").unwrap();
    symlink(&elsewhere, &path).unwrap();
    // A name as a part may have, prepared by another user.
    let prepared = folder.join(".tof.csv.hertzchain-aBcDeFgH1234.part");
    symlink(&elsewhere, &prepared).unwrap();
    Files::within(&folder).unwrap();
    put(&path, b"ours");
    assert_eq!(fs::read(&elsewhere).unwrap(), b"another's");
    assert!(prepared.is_symlink() && !path.is_symlink());
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&path), mode(&elsewhere));
}

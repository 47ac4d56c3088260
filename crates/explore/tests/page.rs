//! What the page's files may be.

use std::fs::{read_dir, read_to_string};
use std::path::PathBuf;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/page");

/// What the static site has instead or in addition.
const WEB: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/web");

fn files(folder: &str) -> Vec<PathBuf> {
    let files = read_dir(folder).unwrap();
    files.map(|file| file.unwrap().path()).collect()
}

fn all() -> Vec<PathBuf> {
    [files(PAGE), files(WEB)].concat()
}

#[test]
fn the_page_is_small() {
    let bytes: u64 = all().iter().map(|file| file.metadata().unwrap().len()).sum();
    assert!(bytes <= 400_000, "{bytes}");
}

#[test]
fn nothing_is_loaded_from_elsewhere_and_no_text_becomes_markup() {
    for file in all() {
        let text = read_to_string(&file).unwrap();
        // Names of XML are no addresses that are opened.
        let text = text.replace("http://www.w3.org/", "");
        let absent = [
            "http://",
            "https://",
            "innerHTML",
            "outerHTML",
            "insertAdjacentHTML",
            "eval(",
            "document.write",
            "new Function",
        ];
        for absent in absent {
            assert!(!text.contains(absent), "{}: {absent}", file.display());
        }
    }
}

#[test]
fn every_file_of_the_page_is_served() {
    let assets = concat!(env!("CARGO_MANIFEST_DIR"), "/src/server/assets.rs");
    let assets = read_to_string(assets).unwrap();
    for file in files(PAGE) {
        let name = file.file_name().unwrap().to_str().unwrap();
        assert!(assets.contains(&format!("{name}\"")), "{name}");
    }
}

//! Notes the commit that is built, for the provenance of results.

use std::process::Command;

/// What git prints, trimmed; `None` without git or outside a checkout.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // Only a checkout of this very source counts, not one that it lies in.
    let tracked = git(&["ls-files", "--error-unmatch", "build.rs"]).is_some();
    let Some(commit) = git(&["rev-parse", "HEAD"]).filter(|_| tracked) else {
        return;
    };
    if let Some(folder) = git(&["rev-parse", "--absolute-git-dir"]) {
        println!("cargo::rerun-if-changed={folder}/logs/HEAD");
        println!("cargo::rerun-if-changed={folder}/index");
    }
    let changed = git(&["status", "--porcelain", "--untracked-files=no"]);
    let dirty = if changed.is_some_and(|files| files.is_empty()) { "" } else { ", changed since" };
    println!("cargo::rustc-env=HERTZCHAIN_COMMIT={commit}{dirty}");
}

use super::*;
use crate::options::parsed;

fn arguments(out: &Path, more: &[&str]) -> Arguments {
    let begin = ["data.csv", "--free=eta", "--method=posterior"].map(str::to_owned);
    let more = more.iter().map(|word| (*word).to_owned());
    let out = format!("--out={}", out.display());
    let words: Vec<String> = begin.into_iter().chain(more).chain([out]).collect();
    parsed("fit", &words).unwrap()
}

#[test]
fn a_run_goes_on_with_its_own_options_alone() {
    let out = std::env::temp_dir().join(format!("hertzchain-options-{}", std::process::id()));
    begin(&out, &arguments(&out, &["--seed=3", "--steps=100"])).unwrap();
    check_options(&arguments(&out, &["--seed=3", "--steps=900", "--resume"])).unwrap();
    let other = arguments(&out, &["--seed=4", "--robust", "--steps=100", "--resume"]);
    let Err(Failure::User(why)) = check_options(&other) else {
        unreachable!("a run went on with another's options")
    };
    let expected = ["seed was 3, now 4", "robust was false, now true"];
    assert!(expected.iter().all(|word| why.contains(word)), "{why}");
    assert!(!why.contains("steps"), "{why}");
    // Anew, anything goes, and the walkers of the run before do not.
    fs::write(out.join(CHAIN), b"walkers").unwrap();
    let anew = arguments(&out, &["--seed=4"]);
    check_options(&anew).unwrap();
    assert!(out.join(CHAIN).exists(), "nothing is lost before the new run has its own");
    begin(&out, &anew).unwrap();
    assert!(!out.join(CHAIN).exists());
    // Walkers whose options are not known, or not all of them, belong to none.
    fs::write(out.join(CHAIN), b"walkers").unwrap();
    fs::write(out.join(OPTIONS), b"{}").unwrap();
    check_options(&arguments(&out, &["--seed=4", "--resume"])).unwrap_err();
    fs::remove_file(out.join(OPTIONS)).unwrap();
    check_options(&arguments(&out, &["--seed=4", "--resume"])).unwrap_err();
    fs::remove_file(out.join(CHAIN)).unwrap();
    check_options(&arguments(&out, &["--seed=4", "--resume"])).unwrap();
    finished(&out);
    assert!(!out.join(OPTIONS).exists());
    let _ = fs::remove_dir_all(out);
}

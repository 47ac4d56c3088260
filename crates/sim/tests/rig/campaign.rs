//! Campaigns: files that depend on nothing but their inputs.

use super::small::{TEXT, experiment, plan};
use crate::Shard;
use crate::rig::{Plan, Progress, RigError, campaign};
use hertzchain_experiment::Experiment;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// A folder that is gone at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path =
            std::env::temp_dir().join(format!("hertzchain-rig-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        Self(path)
    }

    /// All recordings by name.
    fn recordings(&self) -> BTreeMap<String, Vec<u8>> {
        let entries = std::fs::read_dir(&self.0).unwrap().map(|entry| entry.unwrap().path());
        let recordings = entries.filter(|path| path.extension().is_some_and(|end| end == "h5"));
        let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
        recordings.map(|path| (name(&path), std::fs::read(&path).unwrap())).collect()
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn shard(text: &str) -> Shard {
    text.parse().unwrap()
}

fn quiet(_: Progress) {}

fn with_threads(threads: usize, plan: &Plan, out: &Scratch) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| campaign(plan, &out.0, Shard::WHOLE, &quiet)).unwrap();
}

#[test]
fn one_seed_gives_one_campaign_whatever_the_threads_and_another_seed_another() {
    let plan = plan(&[]);
    let (one, three, other) = (Scratch::new("one"), Scratch::new("three"), Scratch::new("other"));
    with_threads(1, &plan, &one);
    with_threads(3, &plan, &three);
    assert_eq!(one.recordings().len(), 6);
    assert!(one.recordings() == three.recordings());
    with_threads(2, &Plan::new(&experiment(&[]), Some(8)).unwrap(), &other);
    for (name, bytes) in one.recordings() {
        assert!(other.recordings()[&name] != bytes, "{name}");
    }
}

#[test]
fn parts_dealt_out_equal_the_whole() {
    let plan = plan(&[]);
    let (whole, dealt) = (Scratch::new("whole"), Scratch::new("dealt"));
    campaign(&plan, &whole.0, Shard::WHOLE, &quiet).unwrap();
    let mut series = 0;
    for part in ["2/4", "1/4", "4/4", "3/4"] {
        series += campaign(&plan, &dealt.0, shard(part), &quiet).unwrap().run;
    }
    assert_eq!(series, plan.series.len());
    assert!(whole.recordings() == dealt.recordings());
}

#[test]
fn parts_that_do_not_exist_are_refused() {
    for text in ["0/4", "5/4", "1/0", "1", "a/b", "", "1/4/2", "-1/4"] {
        assert!(text.parse::<Shard>().is_err(), "{text}");
    }
}

#[test]
fn what_is_finished_is_kept_and_what_is_missing_is_made_again() {
    let plan = plan(&[]);
    let out = Scratch::new("kept");
    campaign(&plan, &out.0, Shard::WHOLE, &quiet).unwrap();
    let before = out.recordings();
    let lost = before.keys().nth(2).unwrap();
    std::fs::remove_file(out.0.join(lost)).unwrap();
    // Of a killed run, of one that is still at work, and of a caller else.
    let part = |name: &str| out.0.join(format!(".{name}.hertzchain-aBcDeFgH1234.part"));
    let (killed, alive, other) = (part(lost), part("dry-01-0.1000.h5"), part("mine.h5"));
    for path in [&killed, &alive, &other] {
        std::fs::write(path, b"half a file").unwrap();
    }
    let at_work = std::fs::File::open(&alive).unwrap();
    at_work.lock().unwrap();
    let done = campaign(&plan, &out.0, Shard::WHOLE, &quiet).unwrap();
    assert!(!killed.exists() && alive.exists() && other.exists());
    assert_eq!((done.kept, done.run, done.shots), (5, 1, 3));
    assert!(out.recordings() == before);
    assert_eq!(done.bytes, before.values().map(|bytes| bytes.len() as u64).sum::<u64>());
}

/// A file of that name that is not what this campaign would make of it.
fn refused(name: &str, plan: &Plan, spoil: impl Fn(&Scratch, &Path)) -> String {
    let out = Scratch::new(name);
    campaign(plan, &out.0, Shard::WHOLE, &quiet).unwrap();
    spoil(&out, &out.0.join(format!("{}.h5", plan.series[1].name)));
    let before = out.recordings();
    let error = campaign(plan, &out.0, Shard::WHOLE, &quiet).unwrap_err();
    assert!(matches!(error, RigError::NotOurs(_)), "{error}");
    // Nothing is taken away from the user.
    assert!(out.recordings() == before);
    error.to_string()
}

#[test]
fn a_finished_file_is_not_believed_by_its_name() {
    let plan = plan(&[]);
    let name = |at: usize| format!("{}.h5", plan.series[at].name);
    let copy = |at: usize| {
        let name = name(at);
        move |out: &Scratch, path: &Path| {
            std::fs::copy(out.0.join(&name), path).unwrap();
        }
    };
    let speed = refused("copied", &plan, copy(2));
    assert!(speed.contains("another programmed speed"), "{speed}");
    let case = refused("copied", &plan, copy(4));
    assert!(case.contains("its `case` is another"), "{case}");
    assert!(case.contains("move it away"), "{case}");
    let seed = refused("copied", &plan, |_, path| {
        let elsewhere = Scratch::new("elsewhere");
        let other = Plan::new(&experiment(&[]), Some(8)).unwrap();
        campaign(&other, &elsewhere.0, Shard::WHOLE, &quiet).unwrap();
        std::fs::copy(elsewhere.0.join(name(1)), path).unwrap();
    });
    assert!(seed.contains("its `inputs` is another"), "{seed}");
}

#[test]
fn a_finished_file_that_is_cut_short_or_no_recording_is_told() {
    let plan = plan(&[]);
    for keep in [0, 100, 5_000, 40_000] {
        let cut = refused("cut", &plan, |_, path| {
            let bytes = std::fs::read(path).unwrap();
            assert!(bytes.len() > keep);
            std::fs::write(path, &bytes[..keep]).unwrap();
        });
        assert!(cut.contains("damaged"), "{keep}: {cut}");
    }
    refused("cut", &plan, |_, path| std::fs::write(path, TEXT).unwrap());
}

#[test]
fn recordings_of_two_campaigns_do_not_mix() {
    let out = Scratch::new("mixed");
    campaign(&plan(&[]), &out.0, shard("1/6"), &quiet).unwrap();
    let other = plan(&[("friction = 0.05", "friction = 0.06")]);
    let error = campaign(&other, &out.0, Shard::WHOLE, &quiet).unwrap_err();
    assert!(matches!(error, RigError::AnotherCampaign(_)), "{error}");
    let set = experiment(&[]).set(&[("track.friction", 0.06)]).unwrap();
    let set = Plan::new(&set, None).unwrap();
    assert!(campaign(&set, &out.0, Shard::WHOLE, &quiet).is_err());
    std::fs::remove_file(out.0.join("campaign.toml")).unwrap();
    let error = campaign(&plan(&[]), &out.0, Shard::WHOLE, &quiet).unwrap_err();
    assert!(error.to_string().contains("no campaign.toml"), "{error}");
}

/// Parts may be run on several machines, with the file in several places.
#[test]
fn a_campaign_is_the_same_wherever_its_file_lies() {
    let elsewhere = Experiment::from_text("/some/where/small.toml", TEXT).unwrap();
    let elsewhere = Plan::new(&elsewhere, None).unwrap();
    let (here, there) = (Scratch::new("here"), Scratch::new("there"));
    campaign(&plan(&[]), &here.0, shard("1/6"), &quiet).unwrap();
    campaign(&elsewhere, &there.0, shard("1/6"), &quiet).unwrap();
    assert!(here.recordings() == there.recordings());
    campaign(&elsewhere, &here.0, shard("1/6"), &quiet).unwrap();
}

#[test]
fn progress_counts_every_shot_once() {
    let out = Scratch::new("progress");
    let seen = Mutex::new(Vec::new());
    let watch = |progress: Progress| seen.lock().unwrap().push(progress);
    campaign(&plan(&[]), &out.0, shard("1/2"), &watch).unwrap();
    let mut fired: Vec<u64> = seen.into_inner().unwrap().iter().map(|p| p.fired).collect();
    fired.sort_unstable();
    assert_eq!(fired, (0..=9).collect::<Vec<u64>>());
}

#[test]
fn a_folder_that_is_a_file_is_a_clear_error() {
    let out = Scratch::new("file");
    std::fs::write(&out.0, b"").unwrap();
    let error = campaign(&plan(&[]), &out.0, Shard::WHOLE, &quiet).unwrap_err();
    assert!(error.to_string().contains("cannot write into"), "{error}");
    std::fs::remove_file(&out.0).unwrap();
}

#[test]
fn a_campaign_of_what_no_rig_can_do_says_why() {
    let refused = |name: &str| {
        let preset = hertzchain_experiment::preset(name).unwrap();
        Plan::new(&preset, None).unwrap_err().to_string()
    };
    assert!(refused("tapered").contains("wall"));
    assert!(Plan::new(&hertzchain_experiment::preset("dry").unwrap(), None).is_ok());
}

/// Records carry the speed, true values stay in a group of their own.
#[test]
fn a_recording_is_read_back_with_its_speeds_and_its_true_values_apart() {
    let out = Scratch::new("read");
    let plan = plan(&[]);
    campaign(&plan, &out.0, shard("1/6"), &quiet).unwrap();
    let path = out.0.join(format!("{}.h5", plan.series[0].name));
    let truth = hertzchain_measure::records::truth(&path).unwrap();
    let column = |name: &str| truth.iter().find(|(found, _)| found == name).unwrap().1.clone();
    assert_eq!(column("speed_m_s").len(), 3);
    assert!(column("incident_tof_s").iter().all(|tof_s| *tof_s > 0.0));
}

//! `hertzchain campaign`: what a rig does alone, on a virtual rig.

use crate::campaign::PreparedCampaign;
use crate::input;
use crate::options::CampaignOptions as Arguments;
use crate::program::print::print;
use crate::program::{Counter, Failure, print};
use hertzchain_paper::reproduce::ReproduceProgress;
use hertzchain_sim::rig::{Done, Plan, Progress};
use indicatif::HumanBytes;
use std::time::{Duration, Instant};

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if !input::is_named(&arguments.input) {
        let text = "which campaign? Name an experiment file, or --preset paper";
        return Err(Failure::User(text.to_owned()));
    }
    let experiment = input::open(&arguments.input)?;
    let prepared = PreparedCampaign::new(&experiment, arguments)?;
    print::warn(&prepared.warnings);
    let counter = Counter::new("shots", 0);
    let begun = Instant::now();
    let done = prepared.run(&|Progress { fired, shots }| match fired {
        0 => counter.begin("shots", shots),
        _ => counter.advance(),
    });
    counter.finish();
    let done = done?;
    print(&summary(&prepared.plan, &done, begun.elapsed(), arguments))?;
    evaluate(&done)
}

/// Series that can't be computed are reported, after all the others were.
fn evaluate(done: &Done) -> Result<(), Failure> {
    print::warn(&done.failed);
    print::warn(untriggered(done));
    match done.failed.len() {
        0 => Ok(()),
        n => Err(Failure::User(format!(
            "{n} series can't be computed{}",
            match done.run + done.kept {
                0 => "",
                _ => "; the others are finished",
            }
        ))),
    }
}

const NAMED: usize = 3;

fn untriggered(done: &Done) -> Option<String> {
    let series = &done.untriggered;
    let shots: usize = series.iter().map(|(_, shots)| shots).sum();
    let mut names: Vec<&str> = series.iter().map(|(name, _)| &**name).take(NAMED).collect();
    if series.len() > NAMED {
        names.push("others");
    }
    (shots > 0).then(|| {
        format!(
            "{shots} shots never passed the trigger's level and were recorded from the touch on, which \
             their files report in `triggered`: {}; lower `level` in [campaign.recorder], or trigger = \
             \"photogate\"",
            names.join(", ")
        )
    })
}

fn summary(plan: &Plan, done: &Done, elapsed: Duration, arguments: &Arguments) -> String {
    let campaign = plan.experiment.campaign();
    let recorder = &campaign.recorder;
    let samples = done.shots as f64 * (recorder.samples() * recorder.channels.count()) as f64;
    let took_s = elapsed.as_secs_f64();
    let kept = match done.kept {
        0 => String::new(),
        kept => format!(" {kept} more series were there already."),
    };
    format!(
        "{} series, {} shots, {} taps, {samples:.3e} samples in {took_s:.1} s ({:.1} shots a second).{kept}\n\
         {} of recordings in {}; seed {}.",
        done.run,
        done.shots,
        done.shots * campaign.taps as u64,
        done.shots as f64 / took_s.max(1e-9),
        HumanBytes(done.bytes),
        arguments.out.display(),
        plan.seed,
    )
}

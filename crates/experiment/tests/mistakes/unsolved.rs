//! What shows only while a shot runs still has a place in the file.

use super::{DRY, check, line_of};
use crate::{Experiment, Finding};
use hertzchain_chain::wave::SolveError;

fn only(experiment: &Experiment, error: &SolveError) -> Finding {
    experiment.unsolved(error).findings()[0].clone()
}

#[test]
fn a_motion_that_ends_is_told_at_the_laws_of_its_contact() {
    let text = format!(
        "{}\n[[contacts]]\nfrom = 21\nlaws = [\"elastic_hertz\"]\n",
        DRY.replace("[[contacts]]\n", "[[contacts]]\nto = 20\n")
    );
    let experiment = Experiment::from_text("test.toml", &text).unwrap();
    for (contact, part) in
        [(20, "laws = [\n"), (21, "[\"elastic_hertz\"]"), (99, "[\"elastic_hertz\"]")]
    {
        let error = SolveError::NotFinite { time_s: 1e-3, body: contact, contact, step_s: None };
        let finding = only(&experiment, &error);
        let line = 1 + text[..text.find(part).unwrap()].matches('\n').count();
        assert_eq!(finding.line(), line, "{}", finding.one_line());
        assert!(finding.one_line().contains("not finite"), "{}", finding.one_line());
    }
}

#[test]
fn settings_out_of_reach_are_told_at_the_solver() {
    let text = format!("{DRY}\n[solver]\naccuracy = 1e-13\n");
    let experiment = Experiment::from_text("test.toml", &text).unwrap();
    let error = SolveError::TooTight { tolerance: 1e-20, least: 1e-15 };
    let line = 1 + text.lines().position(|l| l == "[solver]").unwrap();
    check(&only(&experiment, &error), line, "[solver]", &["1e-20"]);
    let mistakes = experiment.unreached("no such accuracy");
    assert_eq!(mistakes.findings()[0].line(), line);
    let silent = Experiment::from_text("test.toml", DRY).unwrap();
    let mistakes = silent.unreached("no such accuracy");
    assert_eq!(mistakes.findings()[0].line(), line_of("laws = ["));
}

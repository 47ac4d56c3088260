//! One slip of the pen is one report.

use crate::Experiment;

#[test]
fn a_misspelt_law_parameter_is_not_missed_as_well() {
    let dry = include_str!("../../../experiments/dry.toml");
    assert!(dry.contains("coefficient ="));
    let text = dry.replacen("coefficient =", "coeficient =", 1);
    let mistakes = Experiment::from_text("test.toml", &text).unwrap_err();
    assert_eq!(mistakes.findings().len(), 1, "{mistakes}");
    let line = mistakes.findings()[0].one_line();
    assert!(line.contains("did you mean `coefficient`"), "{line}");
}

use super::*;

#[test]
fn what_is_used_already_is_not_advised() {
    let speeds = ["0.0759".to_owned()];
    assert!(unknown(&speeds, false).contains("--use incident,reflected,returning-ratio"));
    let told = unknown(&speeds, true);
    assert!(
        told.contains("smaller errors") && !told.contains("--use"),
        "{told}"
    );
}

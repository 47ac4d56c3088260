use super::{BIBLIOGRAPHY, Publication};
use hertzchain_chain::laws::LAWS;

fn keys() -> Vec<&'static str> {
    let heads = BIBLIOGRAPHY.lines().filter(|line| line.starts_with('@'));
    let key = |head: &'static str| head.split(['{', ',']).nth(1);
    heads.filter_map(key).collect()
}

#[test]
fn every_entry_reads_without_a_trace_of_latex() {
    assert!(!keys().is_empty());
    for key in keys() {
        let work = Publication::of_key(key);
        assert!(work.is_some(), "{key}");
        let text = work.map(|work| work.lines().join("\n")).unwrap_or_default();
        assert!(!text.contains(['\\', '{', '}', '$', '~', '`']), "{text}");
    }
}

#[test]
fn names_and_pages_are_written_as_they_are_read() {
    let work = Publication::of_key("Brilliantov1996");
    let lines = work.map(|work| work.lines());
    let expected = [
        "Brilliantov, N. V.; Spahn, F.; Hertzsch, J.-M.; Pöschel, T.",
        "Model for collisions in granular gases",
        "Physical Review E 53, 5382–5392 (1996)",
    ];
    assert_eq!(lines, Some(expected.map(str::to_owned)));
}

#[test]
fn a_work_outside_journals_tells_where_it_is() {
    let place = |key| Publication::of_key(key).map(|work| work.lines()[2].clone());
    assert_eq!(place("Nesterenko2001"), Some("Springer (2001)".to_owned()));
    assert!(place("Labbe2017").is_some_and(|place| place.contains("Santiago")));
}

#[test]
fn every_law_has_its_source() {
    for row in LAWS {
        assert!(Publication::of_key(row.info.reference).is_some(), "{}", row.info.name);
    }
    assert_eq!(Publication::of_key("no user1900"), None);
}

//! What a file says of a rig's campaign.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::units::parse_quantity;
use crate::{Experiment, Finding, LowPass, Trigger, campaigns, preset, schema};

const PAPER: &str = include_str!("../../../experiments/paper.toml");

fn opened(text: &str) -> Experiment {
    Experiment::from_text("test.toml", text).unwrap()
}

/// The only mistake after a replacement.
fn after(from: &str, to: &str) -> Finding {
    assert!(PAPER.contains(from), "{from}");
    let mistakes = Experiment::from_text("test.toml", &PAPER.replacen(from, to, 1)).unwrap_err();
    assert_eq!(mistakes.findings().len(), 1, "{mistakes}");
    mistakes.findings()[0].clone()
}

#[test]
fn the_paper_s_campaign_is_of_the_paper_s_size() {
    let paper = preset("paper").unwrap();
    let campaign = paper.campaign();
    assert_eq!(paper.cases(), ["dry", "pump", "gear", "motor"]);
    assert_eq!(campaign.speeds_m_s.len(), 60);
    assert_eq!((campaign.shots, campaign.taps), (20, 40));
    assert_eq!(campaign.tap_speed_m_s, 0.18);
    assert_eq!(campaign.recorder.samples(), 100_000);
    assert_eq!(campaign.speeds_m_s[0], 0.075);
    // A power of a ratio, rounded.
    assert!((campaign.speeds_m_s[59] - 1.23).abs() < 1e-14);
}

#[test]
fn a_case_has_its_own_contacts_and_those_of_its_preset() {
    for (case, speed) in [("dry", 0.5), ("pump", 0.2), ("gear", 1.1), ("motor", 0.09)] {
        let sections = |experiment: &Experiment| {
            let (chain, _) = experiment.chain(Some(speed)).unwrap();
            format!("{:?}", chain.sections)
        };
        let of_the_campaign = preset("paper").unwrap().case(case).unwrap().unwrap();
        assert_eq!(sections(&of_the_campaign), sections(&preset(case).unwrap()), "{case}");
        let liquid = of_the_campaign.liquid().map(|liquid| liquid.name.clone());
        let alone = preset(case).unwrap();
        assert_eq!(liquid, alone.liquid().map(|liquid| liquid.name.clone()));
    }
    assert!(preset("paper").unwrap().case("water").is_none());
}

#[test]
fn campaigns_have_no_warnings_in_any_case() {
    for file in campaigns() {
        let experiment = preset(file.name).unwrap();
        assert_eq!(experiment.title(), file.title());
        assert!(experiment.chain(None).unwrap().1.is_empty(), "{}", file.name);
        for case in experiment.cases() {
            let case = experiment.case(case).unwrap().unwrap();
            assert!(case.chain(Some(0.5)).unwrap().1.is_empty());
        }
    }
}

#[test]
fn a_file_without_a_campaign_has_the_paper_s_protocol_at_its_own_speed() {
    let dry = preset("dry").unwrap();
    let campaign = dry.campaign();
    assert!(dry.cases().is_empty());
    assert_eq!(campaign.speeds_m_s, [0.5]);
    assert_eq!((campaign.shots, campaign.taps), (20, 40));
    assert_eq!(campaign.actuator.resolution_m_s, 1.5e-4);
    assert_eq!(campaign.actuator.spread_m_s, 0.003);
    assert_eq!(campaign.amplifier.order, LowPass::Second);
    assert_eq!(campaign.recorder.trigger, Trigger::Photogate);
    assert_eq!(dry.friction_coefficient(), 0.05);
}

#[test]
fn speeds_are_a_list_or_a_range_but_not_both_and_not_half_a_range() {
    let range =
        "slowest = \"0.075 m/s\"\nfastest = \"1.23 m/s\"\nspeed_count = 60 # in equal ratios";
    let list = "speeds = [\"0.2 m/s\", \"0.1 m/s\"]";
    let listed = opened(&PAPER.replace(range, list));
    assert_eq!(listed.campaign().speeds_m_s, [0.2, 0.1]);
    let twice = after(range, &format!("{list}\n{range}"));
    assert_eq!(twice.to_string(), "the speeds are given twice");
    let half = after("fastest = \"1.23 m/s\"\n", "");
    assert!(half.one_line().contains("`fastest`"), "{half:?}");
    let negative = after(range, "speeds = [\"-0.2 m/s\"]");
    assert!(negative.to_string().contains("not positive"), "{negative:?}");
}

#[test]
fn mistakes_in_a_campaign_are_told_at_their_place() {
    let unit = after("gain = \"1 mV/pC\"", "gain = \"1 mV/N\"");
    assert_eq!(unit.text(), "\"1 mV/N\"");
    let long = after("record = \"0.1 s\"", "record = \"1 h\"");
    assert_eq!(long.text(), "\"1 h\"");
    let before = after("before = \"2 ms\"", "before = \"0.2 s\"");
    assert_eq!(before.text(), "\"0.2 s\"");
    let offset = after("offset = \"0 V\"", "offset = \"12 V\"");
    assert_eq!(offset.text(), "\"12 V\"");
    assert!(offset.to_string().contains("range of ± 10 V"), "{offset:?}");
    let never = "trigger = \"level\"\nlevel = \"30 V\"";
    let level = after("trigger = \"photogate\"", never);
    assert_eq!(level.text(), "\"30 V\"");
    assert!(level.to_string().contains("never passed"), "{level:?}");
    let name = after("name = \"pump\"", "name = \"pump/oil\"");
    assert_eq!(name.text(), "\"pump/oil\"");
    let again = after("name = \"pump\"", "name = \"dry\"");
    assert!(again.to_string().contains("two cases"), "{again:?}");
    let material = after("material = \"pump-oil\"", "material = \"pumpoil\"");
    assert_eq!(material.text(), "\"pumpoil\"");
    let bits = after("bits = 16", "bits = 24");
    assert_eq!(bits.text(), "24");
}

#[test]
fn voltages_and_charges_are_units() {
    let value = |text: &str| parse_quantity(text).unwrap().value;
    assert_eq!(value("10 pC/N"), 1e-11);
    assert_eq!(value("1 mV/pC"), 1e9);
    assert_eq!(value("3 A s"), 3.0);
    let same = |one: &str, two: &str| {
        let dimension = |text: &str| parse_quantity(text).unwrap().dimension;
        dimension(one).agrees_with(&dimension(two))
    };
    assert!(same("1 V", "1 W/A"));
    assert!(same("1 C", "1 J/V"));
    assert!(!same("1 V", "1 W"));
}

#[test]
fn the_schema_knows_the_campaign() {
    let campaign = &schema()["else"]["properties"]["campaign"]["properties"];
    assert!(campaign["cases"]["items"]["properties"]["contacts"].is_object());
    assert!(campaign["amplifier"]["properties"]["gain"].is_object());
}

#[test]
fn a_case_stays_itself_when_its_numbers_are_set() {
    let pump = preset("paper").unwrap().case("pump").unwrap().unwrap();
    let softer = pump.set(&[("pump-oil.young_modulus", 200e9)]).unwrap();
    let wet = |found: &Experiment| -> Vec<bool> {
        found.sections().iter().map(|section| section.wet).collect()
    };
    assert_eq!(wet(&softer), wet(&pump));
    assert_eq!(wet(&softer), [false, true]);
    let stiffness = "contacts[1].laws.elastic_hertz.stiffness";
    let known = pump.set(&[(stiffness, 9e9)]).unwrap();
    assert_eq!(known.get(stiffness).unwrap(), 9e9);
    assert_eq!(wet(&known), wet(&pump));
}

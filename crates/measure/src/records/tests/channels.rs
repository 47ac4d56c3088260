use super::*;

fn names() -> Vec<String> {
    ["Time", "Ch A", "Ch B"].map(str::to_owned).to_vec()
}

fn asking(channel: &str) -> ReadOptions {
    ReadOptions { channels: vec![channel.to_owned()], ..ReadOptions::default() }
}

#[test]
fn a_channel_is_found_by_name_in_any_letters_or_by_number() {
    for wanted in ["Ch B", "ch b", "3"] {
        let found = chosen(Path::new("x"), &names(), &asking(wanted));
        assert_eq!(found.unwrap(), [2], "{wanted}");
    }
    let error = chosen(Path::new("x"), &names(), &asking("4")).unwrap_err();
    assert!(error.to_string().contains("Time, Ch A, Ch B"), "{error}");
}

#[test]
fn channels_that_are_called_after_wall_and_bead_are_these_in_whatever_order() {
    let asked = |names: &[&str]| {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        chosen(Path::new("x"), &names, &ReadOptions::default())
    };
    assert_eq!(asked(&["wall", "bead"]).unwrap(), [1, 0]);
    assert_eq!(asked(&["Sensor_7", "Wall (V)"]).unwrap(), [0, 1]);
    assert_eq!(asked(&["wall sensor", "CH2"]).unwrap(), [1, 0]);
    assert_eq!(asked(&["trigger", "wall", "bead 7"]).unwrap(), [2, 1]);
    // Nothing is reported by these.
    assert_eq!(asked(&["CH1", "CH2"]).unwrap(), [0, 1]);
    assert_eq!(asked(&["sensor 1", "sensor 2"]).unwrap(), [0, 1]);
    assert!(asked(&["wall", "CH1", "CH2"]).is_err());
}

#[test]
fn three_channels_need_a_choice() {
    let error = chosen(Path::new("x"), &names(), &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("--channel"), "{error}");
}

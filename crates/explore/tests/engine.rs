//! Replies say what the library says.

use crate::common::{Echo, refusal, reply, text};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use hertzchain_experiment::{examples, presets};
use hertzchain_explore::{Refusal, Request, answer, respond};
use hertzchain_sim::{Plan, Stop, shoot_estimated};
use serde_json::{Value, json};

#[test]
fn times_of_flight_of_all_presets_are_those_of_the_library_to_the_bit() {
    for preset in presets().iter().chain(examples()) {
        let shot = reply(json!({ "verb": "shot", "text": preset.text }));
        let experiment = hertzchain_experiment::preset(preset.name).unwrap();
        let (plan, _) = Plan::from_experiment(&experiment, None).unwrap();
        let flight = shoot_estimated(&plan.with_budget()).unwrap().flight;
        assert_eq!(shot["tof_incident_s"].as_f64(), flight.map(|flight| flight.incident_s));
        assert_eq!(shot["tof_reflected_s"].as_f64(), flight.and_then(|flight| flight.reflected_s));
    }
}

#[test]
fn the_slope_of_a_hertz_row_is_a_fifth() {
    let speeds = json!({ "from_m_s": 0.05, "to_m_s": 2.5, "count": 60 });
    let curve = reply(json!({ "verb": "batch", "text": text("hertz"), "speeds": speeds }));
    let slope = curve["power_law_incident"]["exponent"].as_f64().unwrap();
    // Times are computed to 1e-6 of themselves.
    assert!((slope + 0.2).abs() < 1e-6, "{slope}");
}

#[test]
fn shards_of_a_curve_join_to_the_whole_to_the_bit() {
    let curve = |shard: Value| {
        let speeds = json!({ "from_m_s": 0.05, "to_m_s": 2.5, "count": 11 });
        let request =
            json!({ "verb": "batch", "text": text("dry"), "speeds": speeds, "shard": shard });
        reply(request)
    };
    let shards: Vec<Value> = (1..=3).map(|number| curve(json!([number, 3]))).collect();
    assert_eq!(shards[2]["speed_m_s"].as_array().unwrap().len(), 3);
    let joined = reply(json!({ "verb": "join", "shards": shards }));
    assert_eq!(joined, curve(Value::Null));
    let none = json!({ "from_m_s": 0.1, "to_m_s": 1.0, "count": 2 });
    let request = json!({ "verb": "batch", "text": text("dry"), "speeds": none, "shard": [3, 2] });
    assert!(matches!(refusal(request), Refusal::Error(_)));
}

#[test]
fn a_request_on_a_stream_is_answered_as_elsewhere() {
    let streamed = |request: &str| -> Value {
        let mut output = Vec::new();
        respond(&Echo, request.as_bytes(), &mut output).unwrap();
        serde_json::from_slice(&output).unwrap()
    };
    let request = json!({ "verb": "shot", "text": text("dry"), "draft": true });
    assert_eq!(streamed(&request.to_string()), json!({ "reply": reply(request) }));
    let refused = streamed("{")["refused"]["error"].to_string();
    assert!(refused.contains("not understood"), "{refused}");
}

#[test]
fn parts_of_the_energy_add_up_to_what_was_put_in() {
    let shot = reply(json!({ "verb": "shot", "text": text("dry"), "samples": 400 }));
    let energy = &shot["energy"];
    let parts = energy["parts"].as_array().unwrap();
    let curves: Vec<Vec<f32>> = parts.iter().map(|part| numbers(&part[1])).collect();
    let input = energy["input_j"].as_f64().unwrap();
    for at in 0..numbers(&energy["time_s"]).len() {
        let sum: f64 = curves.iter().map(|curve| f64::from(curve[at])).sum();
        // Parts below a millionth are left out, numbers are in single precision.
        assert!((sum / input - 1.0).abs() < 1e-5, "{at}: {}", sum / input);
    }
}

#[test]
fn motion_has_every_body_and_contact_and_sees_the_picked_peaks() {
    let shot = reply(json!({ "verb": "shot", "text": text("dry"), "samples": 1500 }));
    let motion = &shot["motion"];
    let samples = motion["samples"].as_u64().unwrap() as usize;
    let bodies = shot["bodies"].as_array().unwrap();
    assert_eq!(bodies.len(), 42);
    assert_eq!(bodies[7]["sensor"], true);
    assert_eq!(numbers(&motion["displacement_m"]).len(), 42 * samples);
    assert_eq!(numbers(&motion["force_n"]).len(), 41 * samples);
    let highest = numbers(&motion["sensor_n"]).into_iter().fold(0.0, f32::max);
    let picked = shot["incident"]["value_n"].as_f64().unwrap();
    // Fifteen samples a pulse miss its top by that much at most.
    assert!((f64::from(highest) / picked - 1.0).abs() < 0.02);
}

fn numbers(base64: &Value) -> Vec<f32> {
    let bytes = STANDARD.decode(base64.as_str().unwrap()).unwrap();
    let words = bytes.chunks_exact(4);
    words.map(|word| f32::from_le_bytes(word.try_into().unwrap())).collect()
}

#[test]
fn a_mistake_has_the_path_of_its_value() {
    let wrong = text("dry").replace("213 GPa", "213 mm");
    let checked = reply(json!({ "verb": "check", "text": wrong }));
    let mistake = &checked["mistakes"][0];
    assert_eq!(mistake["path"], json!(["materials", "aisi316", "young_modulus"]));
    assert_eq!(mistake["message"], "`young_modulus` is a length");
    assert_eq!(checked["outline"], Value::Null);
    let wrong = text("dry").replace("77 kg s/m^2", "77 kg");
    let checked = reply(json!({ "verb": "check", "text": wrong }));
    let path = json!(["contacts", 0, "laws", 2, "coefficient"]);
    assert_eq!(checked["mistakes"][0]["path"], path);
}

#[test]
fn an_edit_changes_its_value_and_keeps_comments() {
    let edit = |path: Value, value: Value| {
        let edits = json!([{ "path": path, "value": value }]);
        reply(json!({ "verb": "check", "text": text("dry"), "edits": edits }))
    };
    let edited = edit(json!(["beads", 0, "radius"]), json!("7 mm"));
    let expected = text("dry").replace("radius = \"6.35 mm\"", "radius = \"7 mm\"");
    assert_eq!(edited["text"], expected);
    let edited = edit(json!(["contacts", 0, "laws", 2, "coefficient"]), json!("80 kg s/m^2"));
    assert_eq!(
        edited["text"],
        text("dry").replace("coefficient = \"77 kg", "coefficient = \"80 kg")
    );
    let gap = json!([{ "contact": 20, "gap": "10 um" }]);
    assert_eq!(edit(json!(["gaps"]), gap)["mistakes"], json!([]));
    let push = json!({ "push": "constant", "force": "30 N" });
    let edited = edit(json!(["near_end"]), push);
    assert_eq!(edited["mistakes"], json!([]));
    assert_eq!(edited["tree"]["near_end"]["force"], "30 N");
    let without = edit(json!(["contacts", 0, "laws", 2]), Value::Null);
    assert_eq!(without["tree"]["contacts"][0]["laws"].as_array().unwrap().len(), 2);
}

#[test]
fn a_shot_of_edits_is_that_of_the_edited_text() {
    let edits = json!([{ "path": ["striker", "speed"], "value": "0.8 m/s" }]);
    let request = json!({ "verb": "shot", "text": text("dry"), "edits": edits, "draft": true });
    let edited = text("dry").replace("speed = \"0.5 m/s\"", "speed = \"0.8 m/s\"");
    assert_eq!(reply(request), reply(json!({ "verb": "shot", "text": edited, "draft": true })));
}

#[test]
fn an_edit_without_a_place_is_refused() {
    let edits = json!([{ "path": ["beads", 7, "radius"], "value": "7 mm" }]);
    let refused = refusal(json!({ "verb": "check", "text": text("dry"), "edits": edits }));
    assert_eq!(refused, Refusal::Error("no value at beads[7].radius".to_owned()));
    let deep = json!([{ "path": vec!["a"; 60_000], "value": 1 }]);
    let refused = refusal(json!({ "verb": "check", "text": text("dry"), "edits": deep }));
    assert_eq!(refused, Refusal::Error("a path of 60000 keys: expected at most 32".to_owned()));
}

#[test]
fn what_would_run_for_hours_is_refused_at_once() {
    let long = text("dry").replace("count = 40", "count = 2000000");
    assert!(matches!(refusal(json!({ "verb": "shot", "text": long })), Refusal::Error(_)));
    let long = text("dry") + "\n[solver]\nmethod = \"rk4\"\nstep = \"1 ns\"\nduration = \"1 s\"\n";
    assert!(matches!(
        refusal(json!({ "verb": "shot", "text": long })),
        Refusal::Error(_) | Refusal::Mistakes(_)
    ));
    let speeds = json!({ "from_m_s": 0.1, "to_m_s": 1.0, "count": 1_000_000 });
    let refused = refusal(json!({ "verb": "batch", "text": text("dry"), "speeds": speeds }));
    assert!(matches!(refused, Refusal::Error(_)));
    let long = "#".repeat(300_000);
    assert!(matches!(refusal(json!({ "verb": "check", "text": long })), Refusal::Error(_)));
}

#[test]
fn what_was_asked_to_stop_stops() {
    let stop = Stop::default();
    stop.ask();
    let request = json!({ "verb": "shot", "text": text("dry") });
    let request: Request = serde_json::from_value(request).unwrap();
    assert_eq!(answer(&request, &Echo, &stop).unwrap_err(), Refusal::Stopped);
}

#[test]
fn markup_in_an_experiment_stays_text() {
    let title = "<img src=x onerror=alert(1)>";
    let marked = text("dry").replace("Dry chain of 40 AISI 316 beads", title);
    let checked = reply(json!({ "verb": "check", "text": marked }));
    assert_eq!(checked["outline"]["title"], title);
}

#[test]
fn recordings_come_whole_and_refusals_in_the_program_s_words() {
    let asked = |bytes: &[u8]| json!({ "verb": "measure", "name": "shot.csv", "bytes": STANDARD.encode(bytes), "options": {} });
    assert_eq!(reply(asked(b"1,2\n"))["bytes"], 4);
    assert_eq!(refusal(asked(b"")), Refusal::Error("shot.csv is empty".to_owned()));
}

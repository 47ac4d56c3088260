//! What is understood of an experiment, against numbers computed by hand.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use hertzchain_chain::{Chain, System};
use hertzchain_experiment::{Experiment, examples, film_presets, preset, presets};
use hertzchain_sim::{Group, Plan, Value, describe, describe_theory, shoot};
use std::f64::consts::{PI, TAU};

fn described(experiment: &Experiment) -> Vec<Group> {
    let (chain, _) = experiment.chain(None).unwrap();
    describe(experiment, &chain).unwrap()
}

/// The number of the first row whose name begins so, in a group whose title does.
fn number(groups: &[Group], title: &str, name: &str) -> f64 {
    let group = groups.iter().find(|group| group.title.starts_with(title)).unwrap();
    let row = group.rows.iter().find(|row| row.name.trim().starts_with(name));
    match row.map(|row| &row.value) {
        Some(Value::Number(number)) => *number,
        other => panic!("{title}, {name}: {other:?}"),
    }
}

fn assert_close(found: f64, expected: f64, allowed: f64) {
    assert!((found / expected - 1.0).abs() < allowed, "{found} for {expected}");
}

#[test]
fn the_paper_s_balls_have_the_paper_s_constants() {
    let groups = described(&preset("dry").unwrap());
    // Eleven digits are published.
    assert_close(number(&groups, "Contacts 0 to 40", "stiffness"), 8.7926303796e9, 1e-10);
    assert_close(number(&groups, "Contacts 0 to 40", "relaxation_time"), 3.3852895149e-7, 1e-10);
    assert_close(number(&groups, "Contacts 0 to 40", "coefficient"), 77.0, 1e-15);
}

#[test]
fn a_loaded_chain_has_its_overlap_sound_speed_and_cutoff() {
    let precompressed = preset("precompressed").unwrap();
    let groups = described(&precompressed);
    let (chain, _) = precompressed.chain(None).unwrap();
    let stiffness = number(&groups, "Contacts", "stiffness");
    let force = number(&groups, "At rest", "static force of contact 1");
    let overlap = (force / stiffness).powf(2.0 / 3.0);
    // Rounding of a few powers.
    assert_close(number(&groups, "At rest", "static overlap of contact 1"), overlap, 1e-13);
    let sound = (1.5 * stiffness * overlap.sqrt() / chain.beads[0].mass_kg).sqrt();
    // The stiffness under load is a central difference, right to 1e-10.
    let small = "Small waves under the static load";
    assert_close(number(&groups, small, "sound speed at contact 1"), sound, 1e-9);
    let cutoff = sound / std::f64::consts::PI;
    assert_close(number(&groups, small, "cutoff frequency at contact 1"), cutoff, 1e-9);
}

#[test]
fn the_expected_time_of_flight_is_that_of_the_hertz_chain_to_two_percent() {
    let hertz = preset("hertz").unwrap();
    let (chain, _) = hertz.chain(Some(1.0)).unwrap();
    let groups = describe(&hertz, &chain).unwrap();
    // The wall's peak comes later than a passing pulse's would: half a bead's
    // time of 33.5.
    let found = number(&groups, "Expected", "incident time of flight");
    assert_close(found, 630.841591e-6, 0.02);
}

#[test]
fn a_unit_cell_is_recognised() {
    let groups = described(&preset("dimer-steel-ptfe").unwrap());
    let beads = groups.iter().find(|group| group.title == "Beads").unwrap();
    let value = |name: &str| {
        let row = beads.rows.iter().find(|row| row.name == name);
        row.unwrap().value.clone()
    };
    assert_eq!(value("beads in a unit cell"), Value::Count(2));
    assert_eq!(value("unit cells"), Value::Count(20));
}

#[test]
fn a_loaded_dimer_has_a_band_gap_between_its_two_masses() {
    let text = r#"
        title = "loaded dimer"
        units = "dimensionless"
        [striker]
        speed = 0.001
        [near_end]
        push = "constant"
        force = 1
        [[beads]]
        repeat = 10
        cell = [{ mass = 1 }, { mass = 4 }]
    "#;
    let groups = described(&Experiment::from_text("dimer.toml", text).unwrap());
    let small = "Small waves under the static load";
    let edge = |mass: f64| {
        // κ = 1.5 K^{2/3} F^{1/3} = 1.5 on both sides of a bead.
        (2.0 * 1.5 / mass).sqrt() / std::f64::consts::TAU
    };
    // The stiffness under load is a central difference, right to 1e-10.
    assert_close(number(&groups, small, "band gap from"), edge(4.0), 1e-9);
    assert_close(number(&groups, small, "band gap to"), edge(1.0), 1e-9);
}

fn finite(value: &Value) -> bool {
    match value {
        Value::Number(number) => number.is_finite(),
        Value::Range(least, most) => least.is_finite() && most > least,
        Value::Count(_) | Value::Text(_) => true,
        Value::Parts(parts) => parts.iter().all(|part| finite(&part.value)),
    }
}

#[test]
fn every_preset_and_example_can_be_described_without_nonsense() {
    for file in presets().iter().chain(film_presets()).chain(examples()) {
        let experiment = preset(file.name).unwrap();
        let (chain, _) = experiment.chain(None).unwrap();
        let theory = describe_theory(&experiment, &chain).unwrap();
        for row in described(&experiment).iter().chain(&theory).flat_map(|group| &group.rows) {
            assert!(finite(&row.value), "{}: {row:?}", file.name);
        }
    }
}

#[test]
fn rows_of_a_theory_have_names_of_their_own() {
    for file in presets().iter().chain(film_presets()).chain(examples()) {
        let experiment = preset(file.name).unwrap();
        let (chain, _) = experiment.chain(None).unwrap();
        for group in describe_theory(&experiment, &chain).unwrap() {
            let mut names: Vec<&str> = group.rows.iter().map(|row| row.name.as_str()).collect();
            names.sort_unstable();
            let count = names.len();
            names.dedup();
            assert_eq!(names.len(), count, "{}: {}", file.name, group.title);
        }
    }
}

fn theory(name: &str) -> Vec<Group> {
    let experiment = preset(name).unwrap();
    let (chain, _) = experiment.chain(None).unwrap();
    describe_theory(&experiment, &chain).unwrap()
}

#[test]
fn theory_prints_the_wave_of_an_unloaded_row_of_equal_beads_for_such_rows_only() {
    let has = |name: &str, title: &str| theory(name).iter().any(|g| g.title.starts_with(title));
    let exact = "Exact solitary wave of a long, unloaded row";
    for name in ["hertz", "dry", "motor"] {
        assert!(has(name, exact), "{name}");
    }
    for (name, instead) in [
        ("precompressed", "Solitary wave on the static load"),
        ("vertical-on-specimen", "Solitary wave on the static load"),
        ("dimer-steel-ptfe", "Solitary wave of a long, unloaded row of two kinds"),
        ("tapered", "Solitary waves"),
    ] {
        assert!(!has(name, exact) && !has(name, "Long-wave theory"), "{name}");
        assert!(has(name, instead), "{name}");
    }
}

#[test]
fn a_row_with_another_exponent_on_the_way_has_no_expected_time() {
    let expected = |name: &str| theory(name).iter().any(|g| g.title.starts_with("Expected"));
    assert!(expected("hertz") && expected("motor"));
    assert!(!expected("exponent-section"));
}

#[test]
fn small_waves_on_a_load_run_at_the_speed_of_sound_and_large_ones_faster() {
    let groups = theory("precompressed");
    let title = "Solitary wave on the static load";
    let sound = number(&groups, "Small waves under", "sound speed at contact 1");
    let speeds = [0.1, 1.0, 10.0]
        .map(|excess| number(&groups, title, &format!("speed, dynamic peak force {excess} times")));
    assert!(sound < speeds[0] && speeds[0] < speeds[1] && speeds[1] < speeds[2]);
    // To first order V = c (1 + excess of the overlap (n − 1)/6), overlap growing by 2/3 of 0.1.
    assert_close(speeds[0], sound * (1.0 + 0.1 * (2.0 / 3.0) / 12.0), 1e-3);
}

#[test]
fn parts_of_the_rig_are_listed_with_their_numbers_and_as_not_computed_with() {
    let rig = |name: &str| {
        let groups = described(&preset(name).unwrap());
        groups.into_iter().find(|group| group.title.starts_with("Rig"))
    };
    let found = rig("dry").unwrap();
    assert!(found.title.contains("nothing is computed"));
    let part = |name: &str, part: &str| {
        let row = found.rows.iter().find(|row| row.name == name).unwrap();
        let Value::Parts(parts) = &row.value else {
            panic!("{row:?}");
        };
        let found = parts.iter().find(|found| found.name == part).unwrap();
        (found.value.clone(), found.unit.clone())
    };
    let number = |value: f64, unit: &str| (Value::Number(value), unit.to_owned());
    let bar = Value::Text("bar against noise".to_owned());
    assert_eq!(part("bar", "name").0, bar);
    assert_eq!(part("bar", "mass"), number(6.0, "kg"));
    assert_eq!(part("springs", "force"), number(0.24, "N"));
    assert_eq!(rig("hertz"), None);
}

#[test]
fn a_dimer_s_speed_names_its_force_and_the_striker_s_own_pulse_is_near_the_computed_one() {
    let groups = theory("dimer-steel-ptfe");
    let title = "Solitary wave of a long, unloaded row of two kinds";
    let unit = number(&groups, title, "speed at a peak contact force of 1 N");
    let force = number(&groups, title, "peak contact force of one pulse");
    let speed = number(&groups, title, "speed of that pulse");
    // F^{1/6}, and rounding.
    assert_close(speed, unit * force.powf(1.0 / 6.0), 1e-12);
    let (plan, _) = Plan::from_experiment(&preset("dimer-steel-ptfe").unwrap(), None).unwrap();
    let computed = shoot(&plan).unwrap().pulse_speed_beads_s.unwrap();
    // The steel striker's energy goes to more than one pulse, which makes the
    // first weaker; the speed feels a sixth of that.
    assert_close(speed, computed, 0.04);
}

#[test]
fn normal_modes_of_a_long_loaded_row_are_said_to_be_missing() {
    let long = preset("precompressed").unwrap();
    let long = long.set(&[("beads[0].count", 201.0)]).unwrap();
    let (chain, _) = long.chain(None).unwrap();
    let groups = describe_theory(&long, &chain).unwrap();
    let modes = groups.iter().find(|group| group.title.starts_with("Normal modes"));
    let row = &modes.unwrap().rows[0];
    assert!(matches!(&row.value, Value::Text(why) if why.contains("200 beads")), "{row:?}");
}

/// What theory expects of the preset `hertz` with a part of its file replaced.
fn expected_of(from: &str, to: &str) -> Option<Group> {
    let file = presets().iter().find(|file| file.name == "hertz").unwrap();
    assert!(file.text.contains(from));
    let experiment = Experiment::from_text("row.toml", &file.text.replace(from, to)).unwrap();
    let groups = described(&experiment);
    groups.into_iter().find(|group| group.title.starts_with("Expected of theory"))
}

#[test]
fn theory_expects_a_time_of_flight_only_where_one_pulse_runs_down_a_touching_row() {
    let group = expected_of("0.5 m/s", "0.4 m/s").unwrap();
    assert!(matches!(group.rows[0].value, Value::Number(_)), "{group:?}");
    for contact in [10, 40] {
        let gap = format!("[[gaps]]\ncontact = {contact}\ngap = \"1 mm\"\n[sensors]");
        assert_eq!(expected_of("[sensors]", &gap), None, "contact {contact}");
    }
    for mass in ["1 g", "80 g"] {
        let striker = format!("[striker]\nmass = \"{mass}\"\nradius = \"6.35 mm\"");
        let group = expected_of("[striker]", &striker).unwrap();
        let said = &group.rows[0].value;
        assert!(matches!(said, Value::Text(why) if why.starts_with("not estimated")), "{group:?}");
    }
}

/// What theory says of one loaded bead between two ends.
fn of_one_bead(ends: &str) -> (Vec<Group>, Chain) {
    let text = format!(
        "materials.steel = {{ young_modulus = \"210 GPa\", poisson_ratio = 0.3, density = \"7850 kg/m^3\" }}\n\
         striker = {{ speed = \"0.1 m/s\" }}\n\
         beads = [{{ count = 1, radius = \"5 mm\", material = \"steel\" }}]\n\
         contacts = [{{ laws = [\"elastic_hertz\"] }}]\nsensors = {{ bead = 1 }}\n{ends}"
    );
    let experiment = Experiment::from_text("one.toml", &text).unwrap();
    let (chain, _) = experiment.chain(None).unwrap();
    (describe_theory(&experiment, &chain).unwrap(), chain)
}

#[test]
fn modes_know_a_stop_of_finite_mass_and_a_spring_that_pushes() {
    let title = "Normal modes of the chain under its static load";
    let push = "near_end = { push = \"constant\", force = \"10 N\" }";
    let stop = format!("{push}\nfar_end = {{ kind = \"stop\", mass = \"30 g\" }}");
    let (groups, chain) = of_one_bead(&stop);
    let contact_n_m = System::new(&chain).unwrap().static_contact(1).stiffness_n_m;
    let bead_kg = chain.beads[0].mass_kg;
    let two_bodies = (contact_n_m * (1.0 / bead_kg + 1.0 / 0.03)).sqrt() / TAU;
    assert_close(number(&groups, title, "mode 2 of 2"), two_bodies, 1e-9);
    let (groups, _) =
        of_one_bead(&push.replace("\"constant\"", "\"spring\", stiffness = \"10 MN/m\""));
    let between_springs = ((contact_n_m + 1e7) / bead_kg).sqrt() / TAU;
    assert_close(number(&groups, title, "mode 1 of 1"), between_springs, 1e-9);
}

/// Theory of a file.
fn theory_of(text: &str) -> Vec<Group> {
    let experiment = Experiment::from_text("row", text).unwrap();
    describe_theory(&experiment, &experiment.chain(None).unwrap().0).unwrap()
}

/// A row of steel balls of 5 mm with these contacts and other lines.
fn steel(count: usize, laws: &str, more: &str) -> Vec<Group> {
    theory_of(&format!(
        r#"
        materials.a = {{ young_modulus = "213 GPa", poisson_ratio = 0.3, density = "7960 kg/m^3", shear_viscosity = "32 kPa s" }}
        beads = [{{ count = {count}, radius = "5 mm", material = "a" }}]
        contacts = [{{ laws = [{laws}] }}]
        {more}
        "#
    ))
}

const RESTITUTION: &str = "Restitution of the striker";

#[test]
fn the_viscoelastic_series_is_of_hertz_contacts_alone() {
    let striker = r#"striker = { speed = "0.3 m/s" }"#;
    let linear =
        r#"{ law = "elastic_power", exponent = 1, stiffness = "1e7 N/m" }, "damping_viscoelastic""#;
    let groups = steel(10, linear, striker);
    // An independent integration of the pair.
    assert_close(number(&groups, RESTITUTION, "with all"), 0.9474126, 1e-6);
    let group = groups.iter().find(|group| group.title.starts_with(RESTITUTION)).unwrap();
    assert_eq!(group.rows.len(), 1);
    let clipped = format!("tension = \"clipped\"\n{striker}");
    let groups = steel(10, r#""elastic_hertz", "damping_viscoelastic""#, &clipped);
    let whole = number(&groups, RESTITUTION, "with all");
    // The accuracy of the shot of the pair.
    assert_close(
        number(&groups, RESTITUTION, "elastic and viscoelastic terms, exact"),
        whole,
        1e-7,
    );
}

#[test]
fn a_bridge_is_stretched_until_it_ruptures_before_balls_have_parted() {
    let laws = r#""elastic_hertz", { law = "capillary_bridge", surface_tension = "0.07 N/m", volume = "1e-11 m^3", contact_angle = "0.3 rad" }"#;
    let at = |speed: f64| {
        steel(
            2,
            laws,
            &format!(
                "striker = {{ speed = \"{speed} m/s\", radius = \"3 mm\" }}\nfar_end = {{ kind = \"free\" }}"
            ),
        )
    };
    // What the bridge takes is the same at any speed: m v² (1 − e²) is.
    let lost = |speed: f64| {
        let restitution = number(&at(speed), RESTITUTION, "with all");
        speed * speed * (1.0 - restitution * restitution)
    };
    // The accuracy of both shots in what is lost, some thousandths of the energy.
    assert_close(lost(0.05), lost(0.2), 1e-4);
    let slow = at(0.002);
    let group = slow.iter().find(|group| group.title.starts_with(RESTITUTION)).unwrap();
    assert!(matches!(&group.rows[0].value, Value::Text(text) if text.contains("still act across")));
}

#[test]
fn a_stiff_law_s_sensor_has_its_peak_off_the_wave_s_centre() {
    let cubic = r#"{ law = "elastic_power", exponent = 3, stiffness = "1e18 N/m^3" }"#;
    let groups = steel(40, cubic, r#"striker = { speed = "0.3 m/s" }"#);
    let title = "Exact solitary wave";
    let contact = number(&groups, title, "peak contact force");
    // Each of a bead's contacts is at its peak once; a shot's sensor bead has 42.084 N.
    assert_close(number(&groups, title, "peak of a bead sensor"), 42.084, 1e-3);
    assert!(number(&groups, title, "peak of a bead sensor") > 0.5 * contact);
}

#[test]
fn small_waves_of_unlike_beads_are_as_fast_in_either_direction() {
    let row = |first: &str, last: &str| {
        theory_of(&format!(
            r#"
            materials.a = {{ young_modulus = "213 GPa", poisson_ratio = 0.3, density = "7960 kg/m^3" }}
            beads = [{first}, {{ count = 6, radius = "4 mm", material = "a" }}, {last}]
            contacts = [{{ laws = ["elastic_hertz"] }}]
            near_end = {{ push = "constant", force = "10 N" }}
            striker = {{ speed = "0.3 m/s" }}
            "#
        ))
    };
    let [small, large] = ["2 mm", "7 mm"]
        .map(|radius| format!("{{ count = 3, radius = \"{radius}\", material = \"a\" }}"));
    let speed = |groups: &[Group]| number(groups, "Small waves", "sound speed, by mean");
    let (forth, back) = (speed(&row(&small, &large)), speed(&row(&large, &small)));
    // Rounding of sums in another order, and of the equilibrium.
    assert_close(forth, back, 1e-9);
}

#[test]
fn threads_add_their_swing_to_the_modes() {
    let laws = r#""elastic_hertz", { law = "capillary_bridge", surface_tension = "70 mN/m", volume = "1e-11 m^3" }"#;
    let of = |more: &str| {
        steel(
            4,
            laws,
            &format!(
                "far_end = {{ kind = \"free\" }}\ninitial = [{{ bead = 1, velocity = \"0.1 m/s\" }}]\n{more}"
            ),
        )
    };
    let title = "Normal modes";
    let hung = of("suspension = { length = \"1 mm\" }");
    let swing = (9.80665_f64 / 1e-3).sqrt() / TAU;
    // Rounding.
    assert_close(number(&hung, title, "mode 1"), swing, 1e-12);
    let free = of("");
    let expected = number(&free, title, "mode 2").hypot(swing);
    assert_close(number(&hung, title, "mode 2"), expected, 1e-12);
}

#[test]
fn small_waves_see_how_a_yielded_contact_unloads() {
    let text = "materials.steel = { young_modulus = \"213 GPa\", poisson_ratio = 0.3, density = \"7960 kg/m^3\" }\n\
         beads = [{ count = 1, radius = \"6.35 mm\", material = \"steel\" }]\n\
         contacts = [{ laws = [{ law = \"elastic_plastic_thornton\", yield_pressure = \"1 GPa\" }] }]\n\
         near_end = { push = \"constant\", force = \"30 N\" }\n\
         initial = [{ bead = 1, velocity = \"1 mm/s\" }]\n";
    let (_, system, _) =
        Experiment::from_text("row.toml", text).unwrap().chain_and_system(None).unwrap();
    // Thornton's unloading, F = (4/3) E* √R_p (δ − δ_p)^{3/2}, has the slope 2E* √(R_p (δ − δ_p)).
    let (modulus, radius) = (0.5 * 213e9_f64 / (1.0 - 0.09), 3.175e-3_f64);
    let (pressure, force) = (1e9_f64, 30.0_f64);
    let yield_overlap = radius * (PI * pressure / (2.0 * modulus)).powi(2);
    let yield_force = 4.0 / 3.0 * modulus * radius.sqrt() * yield_overlap.powf(1.5);
    let flatter = 4.0 * modulus / (3.0 * force)
        * ((2.0 * force + yield_force) / (2.0 * PI * pressure)).powf(1.5);
    let slope = 2.0 * modulus * (0.75 * force * flatter / modulus).cbrt();
    // A difference of 1e-5 of the overlap.
    assert!((system.static_contact(1).stiffness_n_m / slope - 1.0).abs() < 1e-6, "{slope}");
}

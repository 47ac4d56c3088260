//! One arrival whatever the tolerance, the loop and the duration; shots long enough to
//! see it; what is not there or was not waited for.

use hertzchain_chain::Sensor;
use hertzchain_chain::observe::{PassageError, Pulse};
use hertzchain_experiment::Experiment;
use hertzchain_sim::{
    Control, InstructionSet, Method, Plan, Shot, run_plans, shoot, shoot_estimated,
};

fn plan(text: &str) -> Plan {
    let experiment = Experiment::from_text("row.toml", text).unwrap();
    Plan::from_experiment(&experiment, None).unwrap().0
}

/// Equal Hertz beads of mass 1 behind a striker.
fn row(beads: usize, striker_kg: f64) -> Plan {
    plan(&format!(
        "units = \"dimensionless\"\n[striker]\nspeed = 1\nmass = {striker_kg:?}\n[[beads]]\ncount = {beads}\n\
         [[contacts]]\nlaws = [\"elastic_hertz\"]\n[sensors]\nbead = 7\n[far_end]\nkind = \"half-bead\"\n"
    ))
}

fn swept(plan: &Plan) -> Shot {
    let plans = [plan.clone().for_flights()];
    let mut shots =
        run_plans(&plans, Control::PerShot { checked: false }, InstructionSet::default(), &|| {});
    shots.remove(0).unwrap()
}

/// The shot at several accuracies, by both loops and with several durations that cover
/// the search.
fn in_every_way(plan: &Plan) -> Vec<Shot> {
    let accuracies = [1e-4, 1e-5, 1e-7];
    let at = |accuracy: f64| plan.clone().with_accuracy(accuracy);
    let mut shots: Vec<Shot> = accuracies.map(|a| shoot(&at(a)).unwrap()).into();
    shots.extend(accuracies.map(|a| swept(&at(a))));
    let searched_s = shots[1].passage.as_ref().unwrap().search_ends_s;
    shots.extend([1.001, 1.7, 6.0].map(|times| {
        let duration_s = Some(times * searched_s);
        shoot(&Plan { duration_s, ..at(1e-5) }).unwrap()
    }));
    shots
}

#[test]
fn a_heavy_strikers_shot_has_one_arrival_that_is_called_ambiguous() {
    for striker_kg in [300.0, 1000.0] {
        let shots = in_every_way(&row(20, striker_kg));
        let first = shots[0].flight.unwrap();
        for shot in &shots {
            // Errors of peaks in a train of many, at an accuracy of 1e-4.
            let change = first.change(&shot.flight.unwrap());
            assert!(change < 2e-3, "{striker_kg}: {change:e} {:?}", shot.solver);
            let passage = shot.passage.as_ref().unwrap();
            let at_wall = |other: &&_| {
                matches!(other, &&hertzchain_chain::observe::Competing { pulse: Pulse::Wall, .. })
            };
            assert!(passage.competing.iter().filter(at_wall).count() > 0);
            let highest = passage.wall_maxima.iter().map(|peak| peak.value);
            assert_eq!(highest.reduce(f64::max), Some(passage.wall.value));
        }
    }
}

#[test]
fn light_strikers_pulses_are_waited_for() {
    for (beads, striker_kg) in [(100, 5e-3), (40, 1e-3), (15, 1e-3)] {
        let row = row(beads, striker_kg);
        // Bead 1 has the momentum before bead 2 has moved; an equal striker of its
        // speed sends a pulse at 0.84050877 v^{1/5} beads per second.
        let speed = 2.0 * striker_kg / (1.0 + striker_kg);
        let expected = (beads as f64 - 6.5) / (0.840_508_77 * speed.powf(0.2));
        for shot in [shoot(&row).unwrap(), swept(&row.with_accuracy(1e-4))] {
            let flight = shot.flight.unwrap();
            // The wall's peak is later than a bead's would be, by about half a bead.
            let off = flight.incident_s / expected - 1.0;
            assert!(off.abs() < 0.6 / (beads as f64 - 6.5), "{beads}: {off}");
            let back = flight.reflected_s.unwrap() / flight.incident_s - 1.0;
            assert!(back.abs() < 0.1, "{beads}: {back}");
        }
    }
}

#[test]
fn a_return_that_was_not_waited_for_is_not_called_absent() {
    let row = row(20, 1.0);
    let whole = shoot(&row).unwrap();
    assert!(whole.notes.is_empty(), "{:?}", whole.notes);
    let duration_s = Some(1.2 * whole.passage.unwrap().wall.time_s);
    let cut = shoot(&Plan { duration_s, ..row }).unwrap();
    assert_eq!(cut.flight.unwrap().reflected_s, None);
    let reported = cut.notes.iter().any(|note| note.contains("`duration` goes on"));
    assert!(reported, "{:?}", cut.notes);
}

/// Damping as δ^{1/4}: the sensor's force starts with an infinite slope, and rises
/// until after the wall's peak.
const NO_INCIDENT: &str = r#"
[materials.a]
young_modulus = "13.07 MPa"
poisson_ratio = 0.402
[materials.b]
young_modulus = "111.5 MPa"
poisson_ratio = 0.1443
[striker]
speed = "0.292 m/s"
radius = "32.54 mm"
mass = "242.2 g"
material = "a"
[[beads]]
radius = "18.07 mm"
mass = "41.46 g"
material = "a"
[[beads]]
radius = "13.36 mm"
mass = "16.76 g"
material = "b"
[[beads]]
radius = "25.96 mm"
mass = "122.9 g"
material = "b"
[[contacts]]
laws = ["elastic_hertz", { law = "damping_tsuji", damping_ratio = 0.0459 }]
[far_end]
kind = "plane"
[near_end]
push = "spring"
force = "0.0514 N"
stiffness = "100 N/m"
[sensors]
bead = 1
"#;

#[test]
fn an_infinite_slope_at_touch_leaves_no_maximum() {
    for accuracy in [1e-3, 1e-5, 1e-6, 1e-7, 1e-9] {
        let shot = shoot(&plan(NO_INCIDENT).with_accuracy(accuracy)).unwrap();
        let missing = matches!(shot.passage, Err(PassageError::NoIncidentPulse { .. }));
        assert!(missing, "{accuracy:e}: {:?}", shot.passage);
        assert!(shot.wall().is_some_and(|wall| wall.value > 0.0), "the wall's peak alone");
    }
}

#[test]
fn an_elastic_pair_separates_at_any_speed() {
    for at in 0..40 {
        let speed = 0.05 * 1.1_f64.powi(at);
        let text = format!(
            "units = \"dimensionless\"\n[striker]\nspeed = {speed:?}\nmass = 1.7\n[[beads]]\ncount = 1\n\
             [[contacts]]\nlaws = [\"elastic_hertz\"]\n[far_end]\nkind = \"free\"\n"
        );
        let shot = shoot(&plan(&text)).unwrap();
        let (_, velocity) = shot.rebound.unwrap().first.unwrap();
        // Elastic collision, to the accuracy of 1e-6.
        let expected = speed * (1.7 - 1.0) / (1.7 + 1.0);
        assert!((velocity / expected - 1.0).abs() < 1e-5, "{speed}: {velocity}");
    }
}

#[test]
fn a_trace_has_its_last_sample() {
    for samples in [7_u32, 10, 30, 100, 333] {
        let interval_s = 0.1;
        let row = Plan { duration_s: Some(f64::from(samples) * interval_s), ..row(8, 1.0) };
        let trace = shoot(&row.watching(vec![Sensor::Bead(7)], Some(interval_s)));
        let times = trace.unwrap().trace.unwrap().time_s;
        assert_eq!(times.len() as u32, samples + 1);
    }
}

const INCLINED: &str = r#"
[striker]
speed = "0.3 m/s"
radius = "6.35 mm"
mass = "8.54 g"
[[beads]]
count = 6
radius = "6.35 mm"
mass = "8.54 g"
[[contacts]]
laws = ["elastic_hertz", "damping_viscoelastic"]
[far_end]
kind = "stop"
mass = "50 g"
[track]
incline = "20 deg"
[sensors]
bead = 2
velocities = [0, 7]
"#;

#[test]
fn a_rebound_on_an_incline_belongs_to_its_time() {
    let text = format!(
        "[materials.steel]\nyoung_modulus = \"213 GPa\"\npoisson_ratio = 0.3\nshear_viscosity = \"32 kPa s\"\n{}",
        INCLINED.replace("\"8.54 g\"\n", "\"8.54 g\"\nmaterial = \"steel\"\n")
    );
    let interval_s = 1e-6;
    let watched = vec![Sensor::Velocity(0), Sensor::Velocity(7)];
    let shot = shoot(&plan(&text).watching(watched, Some(interval_s))).unwrap();
    let (trace, rebound) = (shot.trace.unwrap(), shot.rebound.unwrap());
    let end_s = rebound.end_s.unwrap();
    let after = trace.time_s.iter().take_while(|time| **time <= end_s).count();
    // Weight alone acts between the reported time and the sample.
    let since_s = end_s - trace.time_s[after];
    let expected = trace.columns[0][after] + 9.80665 * 20_f64.to_radians().sin() * since_s;
    let off = (rebound.end_m_s.unwrap() - expected).abs();
    assert!(off < 1e-9, "{off:e}");
    // The stop, pushed by the beads, moves off.
    assert!(trace.columns[1].iter().any(|speed| *speed > 1e-3));
}

#[test]
fn the_strikers_last_separation_hangs_on_no_accuracy() {
    let text = "units = \"dimensionless\"\nstriker = { speed = 0.6 }\nbeads = [{ count = 5 }]\n\
                contacts = [{ laws = [\"elastic_hertz\", { law = \"damping_linear\", coefficient = 0.05 }] }]\n\
                far_end = { kind = \"stop\", mass = 46 }\n";
    let of = |accuracy| {
        let rebound = shoot(&plan(text).with_accuracy(accuracy)).unwrap().rebound.unwrap();
        (rebound.end_s.unwrap(), rebound.end_m_s.unwrap())
    };
    let (exact_s, exact_m_s) = of(1e-9);
    for accuracy in [1e-4, 1e-5, 1e-6, 1e-7] {
        let (time_s, velocity_m_s) = of(accuracy);
        assert!((time_s / exact_s - 1.0).abs() < 10.0 * accuracy, "{time_s} {exact_s}");
        assert!((velocity_m_s / exact_m_s - 1.0).abs() < 30.0 * accuracy, "{velocity_m_s}");
    }
}

/// Soft and stiff beads by turns behind a heavy soft striker, before a light stop.
fn light_stop() -> Plan {
    let bead = |soft: bool| match soft {
        true => {
            "radius = \"3.37776006683925 mm\"\nmass = \"0.5103314706397167 g\"\nmaterial = \"a\""
        }
        false => {
            "radius = \"2.0266560401035498 mm\"\nmass = \"0.11023159765817877 g\"\nmaterial = \"b\""
        }
    };
    let beads: String =
        (0..60).map(|i| format!("[[beads]]\ncount = 1\n{}\n", bead(i % 2 == 0))).collect();
    plan(&format!(
        "[materials.a]\nyoung_modulus = \"16112853.397792958 Pa\"\npoisson_ratio = 0.05741919740751395\n\
         shear_viscosity = \"1.8625106312219641 Pa s\"\n\
         [materials.b]\nyoung_modulus = \"705868590.0032899 Pa\"\npoisson_ratio = 0.22637807056088377\n\
         shear_viscosity = \"84.37186070091057 Pa s\"\n\
         [striker]\nspeed = \"1.1493016801900247 m/s\"\nradius = \"6.7555201336785 mm\"\n\
         mass = \"4.082651765117734 g\"\nmaterial = \"a\"\n{beads}\
         [[contacts]]\nfrom = 0\nlaws = [\"elastic_hertz\", {{ law = \"damping_linear\", \
         coefficient = \"0.04203654434674536 N s/m\" }}]\n\
         [far_end]\nkind = \"stop\"\nmass = \"0.30540512543732044 g\"\n\
         [track]\nincline = \"5 deg\"\ngravity = \"9.80665 m/s^2\"\n[sensors]\nbead = 7\n"
    ))
}

#[test]
fn a_maximum_that_hardly_rises_is_found_or_called_uncertain_at_any_accuracy() {
    let plan = light_stop();
    // By an 80-bit integration, and here at 1e-8.
    let right_s = 221.162_5e-6;
    let flights = plan.clone().for_flights();
    for accuracy in [1e-3, 1e-5] {
        let at = |plan: &Plan| [plan.clone().with_accuracy(accuracy)];
        let estimated = shoot_estimated(&at(&plan)[0].clone().with_budget());
        let fit =
            run_plans(&at(&flights), Control::None, InstructionSet::default(), &|| {}).remove(0);
        for shot in [estimated, Ok(swept(&at(&flights)[0])), fit] {
            let shot = shot.unwrap();
            let back_s = shot.flight.unwrap().reflected_s.unwrap();
            let off = (back_s / right_s - 1.0).abs();
            // The maximum is there at any accuracy; a loose shot may call it uncertain.
            assert!(off <= accuracy, "{accuracy:e}: {off:e}");
            let stated = shot.accuracy_reached.unwrap_or(accuracy).max(1e-6);
            assert!(off <= stated, "{accuracy:e}: {off:e} over {stated:e}");
        }
    }
}

#[test]
fn a_batch_reports_no_return_as_absent_that_the_wave_loop_sees() {
    // The sensor's signal rises by a thousandth of its peak as a light stop is hit again.
    let plan = plan(
        "[materials.m]\nyoung_modulus = \"127.383668807 GPa\"\npoisson_ratio = 0.36411644724938247\n\
         shear_viscosity = \"13129.845297158148 Pa s\"\n\
         [striker]\nspeed = \"1.1361404009369593 m/s\"\nradius = \"27.92990137736891 mm\"\n\
         mass = \"0.735737224526673 kg\"\nmaterial = \"m\"\n\
         [[beads]]\ncount = 1\nradius = \"27.92990137736891 mm\"\nmass = \"0.735737224526673 kg\"\n\
         material = \"m\"\n[[contacts]]\nlaws = [\"elastic_hertz\", \"damping_brilliantov_1996\", \
         \"damping_viscoelastic\"]\n[[gaps]]\ncontact = 1\ngap = \"23.77508402514868 um\"\n\
         [far_end]\nkind = \"stop\"\nmass = \"44.564641465958586 g\"\n[sensors]\nbead = 1\n",
    );
    let flights = plan.clone().for_flights();
    let right = shoot(&plan.with_accuracy(1e-9)).unwrap().flight.unwrap();
    for accuracy in [1e-3, 1e-5] {
        let plans = [flights.clone().with_accuracy(accuracy)];
        let fit = run_plans(&plans, Control::None, InstructionSet::default(), &|| {}).remove(0);
        for shot in [swept(&plans[0]), fit.unwrap()] {
            let change = shot.flight.unwrap().change(&right);
            assert!(change <= accuracy, "{accuracy:e}: {change:e}");
        }
    }
}

#[test]
fn a_fixed_step_is_estimated_too() {
    let plan = row(20, 1.0);
    let right = shoot(&plan.clone().with_accuracy(1e-9)).unwrap().flight.unwrap();
    for step_s in [0.02, 0.1] {
        let step_s = Some(step_s);
        for method in [Method::Rk4, Method::Verlet] {
            let plan = Plan { method, step_s, ..plan.clone() };
            let shot = shoot_estimated(&plan).unwrap();
            let off = shot.flight.unwrap().change(&right);
            let reached = shot.accuracy_reached.unwrap();
            assert!(off <= reached, "{method:?}: {off:e} over {reached:e}");
        }
    }
}

const STEEL: &str = "materials.steel = { young_modulus = \"213 GPa\", poisson_ratio = 0.3, density = \"7960 kg/m^3\" }\n";

#[test]
fn a_damped_contact_with_a_driven_end_has_its_peak_where_the_force_turns() {
    // An independent integration (DOP853, relative tolerance 1e-12) of the pulses.
    let table = "motion = \"table\", times = [\"0 us\", \"5 us\", \"10 us\", \"15 us\", \"25 us\"], \
                 positions = [\"0 um\", \"1.5 um\", \"3.5 um\", \"4 um\", \"4 um\"]";
    let pulse = "motion = \"pulse\", amplitude = \"4 um\", duration = \"25 us\"";
    for (beads, drag, force_n, time_s) in [(2, 5, 28.9103, 11.8545e-6), (4, 20, 29.23, 11.19e-6)] {
        for motion in [pulse, table] {
            let plan = plan(&format!(
                "{STEEL}beads = [{{ count = {beads}, radius = \"5 mm\", material = \"steel\" }}]\n\
                 contacts = [{{ laws = [\"elastic_hertz\", {{ law = \"damping_linear\", coefficient = \"{drag} N s/m\" }}] }}]\n\
                 driven = {{ {motion} }}\nsensors = {{ bead = 1 }}\nsolver = {{ duration = \"300 us\" }}\n"
            ));
            let sampled = plan.clone().watching(vec![Sensor::Bead(1)], Some(1e-8));
            let shot = shoot(&sampled.with_accuracy(1e-9)).unwrap();
            let found = shot.sensor_maxima[0];
            // The highest sample of a trace every 10 ns is lower by its curvature alone.
            let column = &shot.trace.unwrap().columns[0];
            let highest = column.iter().copied().fold(0.0, f64::max);
            let own = shot.sensor_maxima.iter().map(|peak| peak.value).fold(0.0, f64::max);
            assert!((own / highest - 1.0).abs() < 1e-5, "{motion}: {own} {highest}");
            if motion == pulse {
                // As many digits as are known.
                assert!((found.value / force_n - 1.0).abs() < 2e-4, "{found:?}");
                assert!((found.time_s / time_s - 1.0).abs() < 5e-4, "{found:?}");
            }
        }
    }
}

#[test]
fn bodies_part_where_their_overlap_ends_though_the_force_has_ended_before() {
    let plan = plan(&format!(
        "{STEEL}striker = {{ speed = \"0.5 m/s\" }}\n\
         beads = [{{ count = 1, radius = \"6.35 mm\", material = \"steel\" }}]\n\
         contacts = [{{ laws = [{{ law = \"elastic_plastic_thornton\", yield_pressure = \"1 GPa\" }}] }}]\n\
         far_end = {{ kind = \"free\" }}\n"
    ));
    // An independent integration; the steps' tolerance moves the time.
    for accuracy in [1e-4, 1e-6, 1e-8] {
        let shot = shoot(&plan.clone().with_accuracy(accuracy)).unwrap();
        let (time_s, _) = shot.rebound.unwrap().first.unwrap();
        assert!(
            (time_s / 79.16741e-6 - 1.0).abs() < 1e-3 * (accuracy / 1e-4_f64).sqrt(),
            "{time_s}"
        );
    }
}

#[test]
fn oil_between_near_bodies_flattens_them_from_the_start() {
    let plan = plan(&format!(
        "{STEEL}striker = {{ speed = \"0.5 m/s\" }}\n\
         beads = [{{ count = 1, radius = \"6.35 mm\", material = \"steel\" }}]\n\
         contacts = [{{ laws = [\"elastic_hertz\", {{ law = \"film_drained\", viscosity = \"0.1 Pa s\" }}] }}]\n\
         gaps = [{{ contact = 0, gap = \"2 um\" }}]\nfar_end = {{ kind = \"free\" }}\n\
         solver = {{ duration = \"100 us\" }}\n"
    ));
    // An independent integration that flattens them from a hundredth of the gap on; with a first step as
    // of rigid bodies it is 0.015779333 m/s, whatever the accuracy.
    let shot = shoot(&plan.with_accuracy(1e-8)).unwrap();
    let (_, velocity_m_s) = shot.rebound.unwrap().first.unwrap();
    assert!((velocity_m_s / 0.015_792_944_4 - 1.0).abs() < 1e-6, "{velocity_m_s}");
}

//! Shots of the paper's chain.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::CASES;
use hertzchain_chain::wave::Budget;
use hertzchain_chain::{Gap, Sensor};
use hertzchain_experiment::{Experiment, preset};
use hertzchain_sim::{
    Flight, Method, Pick, Plan, Shot, StudyError, shoot, shoot_checked, shoot_estimated,
};

const PICKS: [Pick; 3] = [Pick::Flank10, Pick::Flank50, Pick::CrossCorrelation];

fn plan(name: &str, speed_m_s: f64) -> Plan {
    let experiment = preset(name).unwrap();
    Plan::from_experiment(&experiment, Some(speed_m_s)).unwrap().0
}

fn flight(plan: &Plan) -> Flight {
    shoot(plan).unwrap().flight.unwrap()
}

/// Times of flight in µs, incident and reflected, computed by two
/// independent integrators.
const REFERENCE: [(&str, f64, f64, f64); 4] = [
    ("hertz", 1.0, 630.841591, 632.265715),
    ("hertz-viscoelastic", 0.5, 751.270959, 783.036376),
    ("dry", 0.075, 1086.942704, 1120.470790),
    ("dry", 1.23, 660.261248, 699.493431),
];

fn assert_reference(method: Method, accuracy: f64, allowed: f64) {
    for (name, speed_m_s, incident_us, reflected_us) in REFERENCE {
        let plan = Plan { method, ..plan(name, speed_m_s).with_accuracy(accuracy) };
        let flight = flight(&plan);
        let deviations = [
            flight.incident_s * 1e6 / incident_us - 1.0,
            flight.reflected_s.unwrap() * 1e6 / reflected_us - 1.0,
        ];
        for deviation in deviations {
            assert!(deviation.abs() < allowed, "{name} at {speed_m_s} m/s: {deviation:e}");
        }
    }
}

#[test]
fn adaptive_shots_give_the_reference_times() {
    // The reference has ten digits: half a unit of the last is 5e-10 of the
    // smallest time; the shot is asked for a hundredth of 1e-7.
    assert_reference(Method::Adaptive, 1e-9, 1.5e-9);
}

#[test]
fn the_asked_accuracy_is_reached() {
    for accuracy in [1e-4, 1e-6, 1e-8] {
        // The reference is far more accurate than what is asked.
        assert_reference(Method::Adaptive, accuracy, accuracy);
    }
}

#[test]
fn fixed_steps_are_halved_until_the_asked_accuracy() {
    // The last change bounds the error only up to the order of convergence,
    // which at impact may be as low as 1: change = error.
    assert_reference(Method::Rk4, 1e-5, 2e-5);
    assert_reference(Method::Verlet, 1e-4, 2e-4);
}

fn checked(plan: &Plan) -> Shot {
    shoot_checked(plan).unwrap()
}

#[test]
fn a_checked_shot_knows_what_it_reached() {
    let shot = checked(&plan("dry", 0.5).with_accuracy(1e-7));
    let reached = shot.accuracy_reached.unwrap();
    assert!(reached > 0.0 && reached < 1e-7, "{reached:e}");
    assert!(shot.notes.is_empty(), "{:?}", shot.notes);
}

#[test]
fn accuracy_beyond_double_precision_is_said_to_be_so() {
    let shot = checked(&plan("hertz", 1.0).with_accuracy(1e-13));
    assert!(shot.notes.iter().any(|note| note.contains("beyond double precision")));
    // Rounding, summed over 20,000 steps, leaves about 1e-11.
    assert!(shot.accuracy_reached.unwrap() < 5e-11, "{:?}", shot.accuracy_reached);
}

#[test]
fn energy_is_balanced_to_the_asked_accuracy() {
    for name in CASES {
        for accuracy in [1e-6, 1e-9] {
            let shot = shoot(&plan(name, 0.5).with_accuracy(accuracy).with_budget()).unwrap();
            let residual = shot.budget.as_ref().map(Budget::relative_residual).unwrap();
            assert!(residual.abs() < accuracy, "{name}: {residual:e} at {accuracy:e}");
        }
    }
}

#[test]
fn hertz_pulses_keep_their_time_whatever_the_pick() {
    let peak = flight(&plan("hertz", 1.0));
    for pick in PICKS {
        let other = flight(&Plan { pick, ..plan("hertz", 1.0) });
        // The wall's pulse is higher and wider than the bead's: picks differ
        // by a fraction of its width, 30 µs of 631 µs.
        let change = other.change(&peak);
        assert!(change > 1e-6 && change < 0.05, "{pick:?}: {change:e}");
    }
}

#[test]
fn two_maxima_as_high_as_can_be_told_are_told_of() {
    // A heavy striker's train: 13.2407 and 22.6862 after the wall's peak, as high
    // as each other to 4e-6.
    let text = "units = \"dimensionless\"\n[striker]\nspeed = 1\nmass = 74.2\n[[beads]]\ncount = 24\n\
                [[contacts]]\nlaws = [\"elastic_hertz\"]\n[sensors]\nbead = 7\n[far_end]\nkind = \"half-bead\"\n";
    let experiment = Experiment::from_text("train.toml", text).unwrap();
    let (train, _) = Plan::from_experiment(&experiment, None).unwrap();
    let reported = |plan: &Plan| {
        let notes = shoot(plan).unwrap().notes;
        notes.iter().any(|note| note.contains("two maxima"))
    };
    assert!(reported(&train.clone().with_accuracy(1e-4)));
    assert!(!reported(&train.with_accuracy(1e-9)));
    assert!(!reported(&plan("dry", 0.5)));
}

#[test]
fn one_shot_can_be_timed_in_every_way() {
    let all = shoot(&plan("gear", 0.2).comparing_picks()).unwrap();
    let flights = std::iter::once(all.flight).chain(all.compared);
    for (pick, flight) in std::iter::once(Pick::Peak).chain(PICKS).zip(flights) {
        let alone = shoot(&Plan { pick, ..plan("gear", 0.2) });
        assert_eq!(flight, alone.unwrap().flight, "{pick:?}");
    }
}

#[test]
fn correlated_times_do_not_depend_on_the_accuracy_beyond_it() {
    let at = |accuracy| {
        flight(&Plan { pick: Pick::CrossCorrelation, ..plan("dry", 0.5).with_accuracy(accuracy) })
    };
    assert!(at(1e-6).change(&at(1e-9)) < 1e-6);
}

#[test]
fn a_pulse_that_does_not_arrive_is_a_result_not_an_error() {
    let shot = shoot(&Plan { duration_s: Some(50e-6), ..plan("dry", 0.5) }).unwrap();
    assert!(shot.flight.is_none());
    let reason = shot.passage.unwrap_err().to_string();
    assert!(reason.contains("no pulse reached the wall"), "{reason}");
}

#[test]
fn nonsense_is_refused() {
    let refused = |change: fn(&mut Plan)| {
        let mut plan = plan("dry", 0.5);
        change(&mut plan);
        shoot(&plan).unwrap_err()
    };
    let step = |p: &mut Plan| p.step_s = Some(0.0);
    type Case = (fn(&mut Plan), &'static str);
    let cases: [Case; 5] = [
        (|p| p.accuracy = 0.0, "an accuracy of 0 "),
        (|p| p.accuracy = f64::NAN, "an accuracy of NaN "),
        (|p| p.sensor_bead = 41, "sensor bead 41 is outside"),
        (|p| p.duration_s = Some(-1.0), "the duration = -1 s"),
        (step, "the step = 0 s"),
    ];
    for (change, part) in cases {
        let text = refused(change).to_string();
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn a_trace_that_would_fill_the_memory_is_refused_before_it_does() {
    for (method, step_s) in [(Method::Adaptive, None), (Method::Rk4, Some(1e-7))] {
        let sensors = vec![Sensor::Bead(7), Sensor::Contact(40)];
        let plan = plan("dry", 0.5).watching(sensors, Some(1e-18));
        let plan = Plan { method, step_s, ..plan };
        let text = shoot(&plan).unwrap_err().to_string();
        let part = "a trace with 2 sensors, a sample every 1e-18 s,";
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn a_fixed_step_that_would_take_too_long_is_refused_up_front_with_its_steps() {
    for method in [Method::Rk4, Method::Verlet] {
        let plan = Plan { method, ..plan("dry", 0.5).with_accuracy(1e-10) };
        let error = shoot(&plan).unwrap_err();
        assert!(matches!(error, StudyError::NotConverged(_)), "{error}");
        let text = error.to_string();
        let number = |before: &str| -> f64 {
            let rest = text.split(before).nth(1).unwrap();
            let end = rest.find([' ', ',']).unwrap();
            rest[..end].parse().unwrap()
        };
        let (steps, order) = (number("would take about "), number("divides the error only by 2^"));
        // The cubic term acts at once on impact, which leaves every method an order
        // between 1 and 2: from 7e-7 at 2e4 steps it is a thousandfold to go.
        assert!((1.0..2.0).contains(&order), "{method:?}: {order}");
        assert!(steps > 1e7, "{method:?}: {steps:e}");
        assert!(
            text.contains("does not reach an accuracy of 1e-10") && text.contains(" steps of ")
        );
    }
}

#[test]
fn a_checked_shot_is_refined_until_it_keeps_the_asked_accuracy() {
    // Behind wet contacts errors grow most: in steps of order 5, as rows with gaps take, at first by 6e-8.
    let mut asked = plan("gear", 0.28).with_accuracy(1e-8);
    asked.chain.gaps.push(Gap { contact: 1, gap_m: 0.0 });
    let shot = checked(&asked);
    let reached = shot.accuracy_reached.unwrap();
    assert!(reached <= 1e-8, "{reached:e}");
    assert!(shot.notes.is_empty(), "{:?}", shot.notes);
    assert!(shot.tolerance < shoot(&asked).unwrap().tolerance);
    let tight = flight(&asked.with_accuracy(1e-11));
    // The rerun that determines is itself wrong by a fraction of that.
    assert!(shot.flight.unwrap().change(&tight) < 1.5e-8);
}

#[test]
fn a_plain_shot_knows_its_error_in_harsh_short_rows() {
    // One ball against a fixed half-bead: its flight lasts a tenth of the contact, so
    // that errors of peaks count many times; and forces begin with an infinite slope.
    for law in [
        r#"{ law = "damping_tsuji", damping_ratio = 0.13 }"#,
        r#"{ law = "damping_kuwabara_kono", coefficient = "3000 N s/m^1.5" }"#,
        r#"{ law = "damping_linear", coefficient = "5 N s/m" }"#,
    ] {
        let text = format!(
            "[materials.a]\nyoung_modulus = \"200 GPa\"\npoisson_ratio = 0.3\n[striker]\n\
             speed = \"1 m/s\"\nmass = \"3 g\"\n[[beads]]\ncount = 2\nradius = \"5 mm\"\nmass = \"4 g\"\n\
             material = \"a\"\n[[contacts]]\nlaws = [\"elastic_hertz\", {law}]\n[sensors]\nbead = 2"
        );
        let experiment = Experiment::from_text("short.toml", &text).unwrap();
        let plan = Plan::from_experiment(&experiment, None).unwrap().0;
        let exact = flight(&plan.clone().with_accuracy(1e-11));
        for accuracy in [1e-4, 1e-6] {
            let asked = plan.clone().with_accuracy(accuracy).with_budget();
            let shot = shoot_estimated(&asked).unwrap();
            let (error, reached) = (shot.flight.unwrap().change(&exact), shot.accuracy_reached);
            assert!(error <= reached.unwrap(), "{law}, {accuracy:e}: {error:e} {reached:?}");
            assert!(reached.unwrap() <= accuracy, "{law}, {accuracy:e}: {reached:?}");
        }
    }
}

#[test]
fn a_plain_shot_of_the_papers_rows_keeps_its_bits() {
    for name in CASES {
        let plan = plan(name, 0.3).with_budget();
        assert_eq!(shoot_estimated(&plan).unwrap().flight, shoot(&plan).unwrap().flight);
    }
}

#[test]
fn a_ring_has_no_wall_and_so_no_time_of_flight() {
    let text = r#"
        title = "ring"
        units = "dimensionless"
        [[beads]]
        count = 12
        [[initial]]
        bead = 3
        velocity = 1
        [far_end]
        kind = "periodic"
        force = 0.1
    "#;
    let ring = Experiment::from_text("ring.toml", text).unwrap();
    let shot = shoot(&Plan::from_experiment(&ring, None).unwrap().0).unwrap();
    assert!(shot.flight.is_none() && shot.passage.is_err() && shot.rebound.is_none());
    assert!(!shot.sensor_maxima.is_empty());
}

/// Two beads whose losses let the striker be overtaken, and hit again, long after it seemed away.
const HIT_AGAIN: &str = r#"
materials.soft = { young_modulus = "19.0012 GPa", poisson_ratio = 0.163, density = "4599.5 kg/m^3" }
materials.wall = { young_modulus = "8.05603 GPa", poisson_ratio = 0.34, density = "7367.5 kg/m^3" }
beads = [{ count = 2, material = "soft", radius = "3.2545 mm" }]
contacts = [
    { from = 0, to = 0, laws = ["elastic_hertz", { law = "damping_kuwabara_kono", coefficient = "124.3 N s/m^1.5" }] },
    { from = 1, to = 1, laws = [
        { law = "elastic_power", exponent = 2.06, stiffness = "3.7926e+12 N/m^2.06" },
        { law = "damping_cubic", coefficient = "2.4652 kg s/m^2" },
    ] },
    { from = 2, laws = [{ law = "elastic_plastic_thornton", yield_pressure = "1.186 GPa" }] },
]
far_end = { kind = "half-bead", material = "wall", radius = "7.483 mm" }
sensors = { bead = 1 }
striker = { mass = "0.41104 g", speed = "1.91018 m/s" }
tension = "clipped"
"#;

#[test]
fn a_striker_that_is_hit_again_has_the_velocity_of_its_last_separation() {
    let experiment = Experiment::from_text("again.toml", HIT_AGAIN).unwrap();
    let mut plan = Plan::from_experiment(&experiment, None).unwrap().0;
    plan.rebound = true;
    let early = shoot(&plan).unwrap().rebound.unwrap();
    plan.duration_s = Some(8e-3);
    let shot = shoot(&plan).unwrap();
    let rebound = shot.rebound.unwrap();
    assert!(rebound.end_s.unwrap() > early.end_s.unwrap(), "{early:?} {rebound:?}");
    // Nothing acts on it afterwards.
    assert_eq!(rebound.end_m_s, Some(shot.velocity_m_s[0]));
    assert_ne!(rebound.end_m_s, early.end_m_s);
}

//! Chains that no striker hits: driven ends, initial states, rings, gaps.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that cannot go on should fail")]

use crate::{Experiment, Method};
use hertzchain_chain::{FarEnd, Gap, Motion, Push, Sensor, Start};

const BEADS: &str = "
[materials.steel]
young_modulus = \"200 GPa\"
poisson_ratio = 0.3
[[beads]]
count = 10
radius = \"5 mm\"
mass = \"4 g\"
material = \"steel\"
[[contacts]]
laws = [\"elastic_hertz\"]
";

fn read(more: &str) -> Experiment {
    Experiment::from_text("starts.toml", &format!("{BEADS}{more}")).unwrap()
}

fn mistake(more: &str) -> String {
    Experiment::from_text("starts.toml", &format!("{BEADS}{more}")).unwrap_err().to_string()
}

fn motion(more: &str) -> Motion {
    match read(more).chain(None).unwrap().0.start {
        Start::Driven { motion, bead } => {
            assert_eq!(bead.radius_m, 0.005);
            motion
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_driven_end_follows_a_sine_a_pulse_or_a_table() {
    let sine = motion("[driven]\nmotion = \"sine\"\namplitude = \"2 um\"\nfrequency = \"5 kHz\"");
    assert_eq!(sine, Motion::Sine { amplitude_m: 2e-6, frequency_hz: 5e3 });
    let pulse = motion("[driven]\nmotion = \"pulse\"\namplitude = \"2 um\"\nduration = \"40 us\"");
    assert_eq!(pulse, Motion::Pulse { amplitude_m: 2e-6, duration_s: 4e-5 });
    let table = motion(
        "[driven]\nmotion = \"table\"\ntimes = [\"0 s\", \"1 ms\"]\npositions = [\"0 m\", \"1 um\"]",
    );
    assert_eq!(table, Motion::Table { times_s: vec![0.0, 1e-3], positions_m: vec![0.0, 1e-6] });
}

#[test]
fn a_driven_body_presses_and_takes_no_spring() {
    let driven = "[driven]\nmotion = \"sine\"\namplitude = \"2 um\"\nfrequency = \"5 kHz\"\n[near_end]\nforce = \"1 N\"\n";
    let constant = format!("{driven}push = \"constant\"");
    assert_eq!(read(&constant).chain(None).unwrap().0.push, Push::Constant { force_n: 1.0 });
    let spring = mistake(&format!("{driven}push = \"spring\"\nstiffness = \"1 kN/m\""));
    assert!(spring.contains("carries the load itself"), "{spring}");
}

#[test]
fn a_table_may_stand_in_a_csv_file_beside_the_experiment() {
    let folder = std::env::temp_dir().join(format!("hertzchain-motion-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("motion.csv"), "time_s,position_m\n0,0\n1e-3, 2e-6\n\n").unwrap();
    std::fs::write(folder.join("bad.csv"), "time_s,position_m\n0,0\n1e-3;2e-6\n").unwrap();
    let text = |file: &str| format!("{BEADS}[driven]\nmotion = \"table\"\nfile = \"{file}\"\n");
    let path = folder.join("chain.toml");
    std::fs::write(&path, text("motion.csv")).unwrap();
    let (chain, _) = Experiment::open(&path).unwrap().chain(None).unwrap();
    let expected = Motion::Table { times_s: vec![0.0, 1e-3], positions_m: vec![0.0, 2e-6] };
    assert!(matches!(chain.start, Start::Driven { motion, .. } if motion == expected));
    std::fs::write(&path, text("bad.csv")).unwrap();
    let error = Experiment::open(&path).unwrap_err().to_string();
    assert!(error.contains("bad.csv:3: `1e-3;2e-6` is not two numbers"), "{error}");
    std::fs::write(&path, text("none.csv")).unwrap();
    assert!(Experiment::open(&path).unwrap_err().to_string().contains("can't be read"));
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(Experiment::open(&path).is_err());
}

#[test]
fn a_table_s_times_increase_and_have_positions() {
    let table = |times: &str, positions: &str| {
        mistake(&format!("[driven]\nmotion = \"table\"\ntimes = {times}\npositions = {positions}"))
    };
    assert!(table("[\"1 s\", \"1 s\"]", "[\"0 m\", \"1 m\"]").contains("do not increase"));
    assert!(table("[\"1 s\", \"2 s\"]", "[\"0 m\"]").contains("as many positions"));
    assert!(table("[\"1 s\"]", "[\"0 m\"]").contains("two points"));
    assert!(table("[\"1 m\"]", "[\"0 m\"]").contains("`times` is a length"));
}

#[test]
fn initial_states_start_a_ring_or_an_open_chain() {
    let ring = read(
        "[far_end]\nkind = \"periodic\"\nforce = \"2 N\"\n[[initial]]\nbead = 3\nvelocity = \"0.1 m/s\"\n",
    );
    let (chain, _) = ring.chain(None).unwrap();
    assert_eq!((chain.start, chain.far), (Start::Free, FarEnd::Periodic { force_n: 2.0 }));
    assert_eq!((chain.initial[0].bead, chain.initial[0].velocity_m_s), (3, 0.1));
    assert_eq!(ring.speed_m_s(), None);
    assert_eq!(ring.sensors(), [Sensor::Bead(7)]);
    assert!(ring.chain(Some(1.0)).unwrap_err().to_string().contains("there is no striker"));
    assert!(
        mistake("[[initial]]\nbead = 11\nvelocity = \"1 m/s\"\n")
            .contains("bead 11 is outside the chain of 10")
    );
    assert!(
        mistake(&"[[initial]]\nbead = 1\nvelocity = \"1 m/s\"\n".repeat(2))
            .contains("a second time")
    );
}

#[test]
fn gaps_pushes_and_solvers_are_read() {
    let experiment = read(
        "[striker]\nspeed = \"1 m/s\"\n[[gaps]]\ncontact = 4\ngap = \"10 um\"\n\
         [near_end]\npush = \"spring\"\nforce = \"1 N\"\nstiffness = \"2 N/mm\"\n\
         [solver]\nmethod = \"rk4\"\nstep = \"1 us\"\naccuracy = 1e-8\nduration = \"2 ms\"\n\
         [sensors]\nbead = 2\nbeads = [2, 5]\npositions = [0]\nvelocities = [10]\nchannel = true\n",
    );
    let (chain, _) = experiment.chain(None).unwrap();
    assert_eq!(chain.gaps, [Gap { contact: 4, gap_m: 1e-5 }]);
    assert_eq!(chain.push, Push::Spring { force_n: 1.0, stiffness_n_m: 2000.0 });
    let solver = experiment.solver();
    assert_eq!((solver.method, solver.step_s), (Method::Rk4, Some(1e-6)));
    assert_eq!((solver.accuracy, solver.duration_s), (1e-8, Some(2e-3)));
    let expected = [
        Sensor::Bead(2),
        Sensor::Contact(10),
        Sensor::BeadPlusWall(2),
        Sensor::Bead(5),
        Sensor::Position(0),
        Sensor::Velocity(10),
    ];
    assert_eq!(experiment.sensors(), expected);
    assert!(
        mistake("[striker]\nspeed = \"1 m/s\"\n[[gaps]]\ncontact = 11\ngap = \"1 um\"\n")
            .contains("contact 11")
    );
}

#[test]
fn a_chain_of_100_000_beads_is_a_count_in_a_file() {
    let file = "units = \"dimensionless\"\n[striker]\nspeed = 1\n[[beads]]\ncount = 100_000\n";
    let (chain, _) = Experiment::from_text("long.toml", file).unwrap().chain(None).unwrap();
    assert_eq!(chain.beads.len(), 100_000);
    assert_eq!(chain.sections[0].contacts, 0..=100_000);
}

#[test]
fn gaps_of_a_range_stand_in_every_contact_of_it() {
    let gaps = |text: &str| format!("[striker]\nspeed = \"1 m/s\"\n[[gaps]]\n{text}\n");
    let contacts = |text: &str| {
        let (chain, _) = read(&gaps(&format!("{text}\ngap = \"1 um\""))).chain(None).unwrap();
        chain.gaps.iter().map(|gap| gap.contact).collect::<Vec<_>>()
    };
    assert_eq!(contacts("from = 3\nto = 5"), [3, 4, 5]);
    assert_eq!(contacts("from = 8"), [8, 9, 10]);
    assert_eq!(contacts("to = 1"), [0, 1]);
    let wrong = |text: &str| mistake(&gaps(&format!("{text}\ngap = \"1 um\"")));
    assert!(wrong("").contains("this gap has no contact"));
    assert!(wrong("contact = 1\nto = 2").contains("both a contact and a range"));
    assert!(wrong("from = 5\nto = 4").contains("no contact is from 5 to 4"));
    assert!(wrong("from = 9\nto = 11").contains("contact 11 is outside the chain of 10"));
    let twice = "from = 3\nto = 5\ngap = \"1 um\"\n[[gaps]]\ncontact = 4";
    assert!(wrong(twice).contains("contact 4 stands here a second time"));
}

//! A campaign small enough for tests: 12 beads, two cases, three speeds.

use hertzchain_experiment::Experiment;
use hertzchain_rig::{Fired, Plan, run};

pub const TEXT: &str = r#"
title = "A small campaign"

[materials.steel]
young_modulus = "213 GPa"
poisson_ratio = 0.3
shear_viscosity = "3.2e4 Pa s"

[materials.oil]
young_modulus = "200 GPa"
poisson_ratio = { prefactor = 0.36, exponent = -0.165 }
shear_viscosity = { prefactor = "66177.1 Pa s", exponent = -0.206 }

[striker]
speed = "0.5 m/s"

[[beads]]
count = 12
radius = "6.35 mm"
mass = "8.54 g"
material = "steel"

[[contacts]]
laws = ["elastic_hertz", "damping_viscoelastic"]

[near_end]
push = "spring"
force = "0.24 N"
stiffness = "100 N/m"

[track]
incline = "0.2 deg"
friction = 0.05

[far_end]
kind = "stop"
mass = "4.5 kg"

[sensors]
bead = 4

[campaign]
seed = 7
speeds = ["0.1 m/s", "0.3 m/s", "0.9 m/s"]
shots = 3
taps = 2

[campaign.laying]
gap_scatter = "5 um"
radius_spread = 0

[campaign.recorder]
sampling = "500 kHz"
record = "20 ms"
before = "1 ms"

[[campaign.cases]]
name = "dry"

[[campaign.cases]]
name = "wet"

[[campaign.cases.contacts]]
to = 3
laws = ["elastic_hertz", "damping_viscoelastic"]

[[campaign.cases.contacts]]
from = 4
laws = ["elastic_hertz", "damping_viscoelastic"]
material = "oil"
wet = true
"#;

/// The campaign with parts of its text replaced.
pub fn experiment(changes: &[(&str, &str)]) -> Experiment {
    let mut text = TEXT.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    Experiment::from_text("small.toml", &text).unwrap()
}

pub fn plan(changes: &[(&str, &str)]) -> Plan {
    Plan::new(&experiment(changes), None).unwrap()
}

/// All shots of one series.
pub fn shots(plan: &Plan, series: usize) -> Vec<Fired> {
    let mut shots = Vec::new();
    run(plan, &plan.series[series], &mut |fired| {
        shots.push(fired);
        Ok(())
    })
    .unwrap();
    shots
}

/// What is needed for the spread of shots that differ in nothing but the chain.
pub const SAME_SPEED: (&str, &str) = (
    "[campaign.laying]",
    "[campaign.actuator]\nspread = \"0 m/s\"\n\n[campaign.laying]",
);

//! A picture of the gaps in a row before and after taps, on the virtual rig:
//! `cargo run --release --example gaps -p hertzchain -- docs/images`.

use hertzchain_experiment::Experiment;
use hertzchain_figures::{Chart, Colour, Figure, Marker, Series};
use hertzchain_rig::{Bench, Chance, Plan, Purpose, Window, shoot};
use std::error::Error;
use std::path::PathBuf;

const PAPER: &str = include_str!("../../../experiments/paper.toml");

/// Strong shots that loosen the row, and their speed in m/s.
const SHOTS: usize = 3;
const SPEED_M_S: f64 = 1.0;

/// Two rigs on which gaps are left: a title and what changes in the file.
const RIGS: [(&str, &[(&str, &str)]); 2] = [
    (
        "push 0.1 N, friction 0.2",
        &[
            ("force = \"0.24 N\"", "force = \"0.1 N\""),
            ("friction = 0.05", "friction = 0.2"),
        ],
    ),
    (
        "no push, 0.5°, friction 0.05",
        &[
            ("force = \"0.24 N\"", "force = \"0 N\""),
            ("stiffness = \"100 N/m\"", "stiffness = \"0 N/m\""),
        ],
    ),
];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(
        std::env::args()
            .nth(1)
            .ok_or("name a folder to write into")?,
    );
    let mut figure = Figure::double_column(60.0).columns(2).letters();
    for (title, changes) in RIGS {
        figure = figure.panel(chart(title, changes)?);
    }
    std::fs::write(folder.join("gaps.svg"), figure.svg())?;
    std::fs::write(folder.join("gaps.png"), figure.png(300.0)?)?;
    Ok(())
}

/// Gaps of a rig as it is laid, after strong shots without taps, and after taps.
fn chart(title: &str, changes: &[(&str, &str)]) -> Result<Chart, Box<dyn Error>> {
    let mut text = PAPER.to_owned();
    for (from, to) in changes {
        text = text.replace(from, to);
    }
    let experiment = Experiment::from_text("paper.toml", &text)?;
    let plan = Plan::new(&experiment, None)?;
    let campaign = experiment.campaign();
    let chance = |purpose| Chance::new(plan.seed, 0, purpose);
    let mut bench = Bench::lay(&experiment, &mut chance(Purpose::Laying))?;
    let mut seen = vec![("as laid".to_owned(), bench.gaps_m())];
    for _ in 0..SHOTS {
        let mut tape = Window::new(&campaign.recorder, 0.0, &mut chance(Purpose::Shot(0))).tape();
        shoot(&mut bench, experiment.sensor_bead(), SPEED_M_S, &mut tape)?;
    }
    seen.push((format!("after {SHOTS} shots"), bench.gaps_m()));
    for _ in 0..campaign.taps {
        bench.tap(campaign.tap_speed_m_s)?;
    }
    seen.push((format!("then {} taps", campaign.taps), bench.gaps_m()));
    Ok(drawn(title, &seen))
}

fn drawn(title: &str, seen: &[(String, Vec<f64>)]) -> Chart {
    let looks = [
        (Colour::GREY, Marker::OpenCircle),
        (Colour::VERMILION, Marker::Triangle),
        (Colour::BLUE, Marker::Square),
    ];
    let mut chart = Chart::new("contact", "gap (µm)").title(title);
    for ((name, gaps_m), (colour, marker)) in seen.iter().zip(looks) {
        let contact: Vec<f64> = (1..=gaps_m.len()).map(|contact| contact as f64).collect();
        let gap_um: Vec<f64> = gaps_m.iter().map(|gap_m| 1e6 * gap_m).collect();
        let name = format!("{name}: {:.0} µm in all", gap_um.iter().sum::<f64>());
        let points = Series::points(&name, &contact, &gap_um);
        chart = chart.with(points.colour(colour).marker(marker));
    }
    chart
}

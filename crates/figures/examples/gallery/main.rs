//! Draws every kind of picture from made-up data, to be looked at.
//!
//! `cargo run --release -p hertzchain-figures --example gallery -- OUTPUT_FOLDER`

mod inference;

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use hertzchain_figures::{
    Animation, Chart, ClaimVerdict, Colour, ColourMap, Dash, Figure, HeatMap, Marker, RigDrawing,
    RigEnd, Series, VerdictMatrix,
};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "gallery".into()));
    fs::create_dir_all(&folder)?;
    let pictures = [
        ("signals", signals()),
        ("tof", tof()),
        ("ratios", ratios()),
        ("space_time", space_time()),
        ("energy", energy()),
        ("residuals", residuals()),
        ("panels", panels()),
        ("verdicts", verdicts()),
        ("corner", inference::corner()),
        ("profiles", inference::profiles()),
        ("singular_values", inference::singular_values()),
        ("verdicts_many", verdicts_many()),
        ("rig", paper_rig().figure()),
        (
            "rig_dry_long",
            RigDrawing {
                beads: 1000,
                sensor_bead: Some(500),
                wet_contacts: None,
                springs: String::new(),
                incline_deg: 0.0,
                end_structure: String::new(),
                stop: String::new(),
                ..paper_rig()
            }
            .figure(),
        ),
        (
            "rig_bare",
            RigDrawing { beads: 6, bead_label: "$R$ = 5 mm".into(), ..RigDrawing::default() }
                .figure(),
        ),
    ];
    for (name, figure) in pictures {
        write(&folder, name, &figure)?;
    }
    fs::write(folder.join("animation.html"), animation().html())?;
    Ok(())
}

fn write(folder: &Path, name: &str, figure: &Figure) -> Result<(), Box<dyn Error>> {
    fs::write(folder.join(format!("{name}.svg")), figure.svg())?;
    fs::write(folder.join(format!("{name}.png")), figure.png(300.0)?)?;
    Ok(())
}

fn grid(from: f64, to: f64, count: u32) -> Vec<f64> {
    let share = |i: u32| f64::from(i) / f64::from(count - 1);
    (0..count).map(|i| from + (to - from) * share(i)).collect()
}

fn log_grid(from: f64, to: f64, count: u32) -> Vec<f64> {
    grid(from.ln(), to.ln(), count).into_iter().map(f64::exp).collect()
}

fn map(x: &[f64], f: impl Fn(f64) -> f64) -> Vec<f64> {
    x.iter().map(|v| f(*v)).collect()
}

/// Three pulses in one channel.
fn signal(t_us: f64, scale_n: f64, split: f64) -> f64 {
    let pulse = |at: f64, width: f64, height: f64| height / ((t_us - at) / width).cosh().powi(4);
    scale_n
        * (pulse(150.0, 28.0, 1.0)
            + pulse(780.0, 28.0, 1.7)
            + pulse(1450.0, 30.0, 0.45)
            + split * pulse(1560.0, 34.0, 0.5))
}

fn signals() -> Figure {
    let t = grid(0.0, 1800.0, 4000);
    let cases = [
        ("dry, $v_0$ = 0.1368 m/s", 4.6, 0.0),
        ("pump oil, $v_0$ = 1.1520 m/s", 62.0, 0.2),
        ("gear oil, $v_0$ = 0.1396 m/s", 4.4, 0.1),
        ("motor oil, $v_0$ = 0.3993 m/s", 16.0, 0.8),
    ];
    let panels = cases.map(|(name, scale, split)| {
        let data = map(&t, |t| signal(t, scale, split) + 0.004 * scale * (t * 1.7).sin());
        let model = map(&t, |t| signal(t, scale, split));
        Chart::new("Time (µs)", "Force (N)")
            .title(name)
            .with(Series::line("virtual rig", &t, &data).colour(Colour::GREY).width(0.7))
            .with(Series::line("model", &t, &model).colour(Colour::VERMILION).dash(Dash::Dashed))
    });
    let empty = Figure::double_column(105.0).columns(2).letters().share_x();
    panels.into_iter().fold(empty, Figure::panel)
}

fn tof() -> Figure {
    let v = log_grid(0.075, 1.23, 18);
    let fine = log_grid(0.07, 1.3, 100);
    let incident = |v: f64| 660.0 * (v / 1.23).powf(-0.178);
    let reflected = |v: f64| 699.0 * (v / 1.23).powf(-0.169);
    let hertz = |v: f64| 640.0 * (v / 1.23).powf(-0.2);
    let scatter = |f: fn(f64, f64) -> f64, k: f64| map(&v, |x| f(x, (x * k).sin()));
    let y_in = scatter(|v, s| 660.0 * (v / 1.23).powf(-0.178) + 6.0 * s, 91.0);
    let y_re = scatter(|v, s| 699.0 * (v / 1.23).powf(-0.169) + 9.0 * s, 47.0);
    let e_in = map(&v, |v| 4.0 / v.sqrt());
    let e_re = map(&v, |v| 9.0 / v.sqrt());
    let add = |chart: Chart| {
        chart
            .with(
                Series::line("Hertz + viscoelastic", &fine, &map(&fine, hertz))
                    .colour(Colour::GREY)
                    .dash(Dash::Dashed),
            )
            .with(Series::line("full model", &fine, &map(&fine, incident)).colour(Colour::BLACK))
            .with(Series::line("", &fine, &map(&fine, reflected)).colour(Colour::BLACK))
            .with(
                Series::points("incident", &v, &y_in)
                    .marker(Marker::Circle)
                    .colour(Colour::BLUE)
                    .y_error(&e_in),
            )
            .with(
                Series::points("reflected", &v, &y_re)
                    .marker(Marker::OpenSquare)
                    .colour(Colour::VERMILION)
                    .y_error(&e_re),
            )
    };
    let x_label = "Impact speed $v_0$ (m/s)";
    let empty = Chart::new(x_label, "Time of flight (µs)");
    let log = add(empty.clone().x_log().y_log());
    Figure::single_column(125.0).letters().panel(add(empty)).panel(log)
}

fn ratios() -> Figure {
    let v = log_grid(0.075, 1.23, 20);
    let set = |name: &str, marker, colour, f: fn(f64) -> f64| {
        let y = map(&v, f);
        let e = map(&v, |v| 0.004 / v.sqrt());
        Series::line(name, &v, &y).marker(marker).colour(colour).width(0.6).y_error(&e)
    };
    let chart = Chart::new(
        "Impact speed $v_0$ (m/s)",
        r"$\mathrm{ToF}_{\mathrm{wet}} / \mathrm{ToF}_{\mathrm{dry}}$",
    )
    .x_log()
    .with(set("pump, DS19", Marker::Triangle, Colour::GREEN, |v| {
        1.0 + 0.035 * (v / 1.1).ln() / 2.7
    }))
    .with(set("gear, EP 80W-90", Marker::Square, Colour::BLUE, |v| 0.985 + 0.008 * (v * 5.0).sin()))
    .with(set("motor, SAE 0W-30", Marker::Circle, Colour::VERMILION, |v| {
        1.025 + 0.02 * v.ln() / 2.6
    }))
    .h_line(1.0, "as dry")
    .v_line(1.1, "paper's crossing");
    Figure::single_column(64.0).panel(chart)
}

fn velocity(bead: f64, t_us: f64) -> f64 {
    let front = (bead - t_us / 16.0) / 1.1;
    let back = (bead - (82.0 - t_us / 16.0)) / 1.1;
    0.68 / front.cosh().powi(2) - 0.5 / back.cosh().powi(2)
        + 0.004 * (bead * 1.3 + t_us / 30.0).sin()
}

fn space_time() -> Figure {
    let (beads, times) = (41_u32, 1200_u32);
    let value = |i: u32| velocity(f64::from(i / times), f64::from(i % times));
    let values: Vec<f64> = (0..beads * times).map(value).collect();
    let heat = |colours, label: &str| HeatMap {
        x_edges: (0.0, 1200.0),
        y_edges: (-0.5, 40.5),
        colours,
        label: label.into(),
        ..HeatMap::new(times as usize, beads as usize, &values)
    };
    let theory = Series::line("exact solitary wave", &[0.0, 640.0], &[0.0, 40.0])
        .colour(Colour::BLACK)
        .dash(Dash::Dashed)
        .width(0.7);
    let signed = Chart::new("Time (µs)", "Bead")
        .title("dry")
        .heat(heat(ColourMap::Diverging, "Velocity (m/s)"))
        .with(theory);
    let positive = Chart::new("Time (µs)", "Bead")
        .title("pump oil")
        .heat(heat(ColourMap::Sequential, "Velocity (m/s)"));
    Figure::double_column(62.0).columns(2).letters().panel(signed).panel(positive)
}

fn energy() -> Figure {
    let t = grid(0.0, 1500.0, 600);
    let lost = map(&t, |t| 0.12 * (1.0 - (-t / 900.0).exp()));
    let elastic = map(&t, |t| lost_at(t) + 0.3 + 0.1 * (t / 20.0).sin().powi(2));
    let total = map(&t, |_| 1.0);
    let zero = map(&t, |_| 0.0);
    let chart = Chart::new("Time (µs)", "Share of the initial energy")
        .with(Series::band("dissipated", &t, &zero, &lost).colour(Colour::VERMILION))
        .with(Series::band("elastic", &t, &lost, &elastic).colour(Colour::BLUE))
        .with(Series::band("kinetic", &t, &elastic, &total).colour(Colour::GREY));
    let residual = Chart::new("Time (µs)", "Residual").y_log().with(Series::line(
        "",
        &t,
        &map(&t, |t| 1e-13 * (1.0 + t) * (1.5 + (t / 7.0).sin())),
    ));
    Figure::single_column(95.0).letters().share_x().panel(chart).panel(residual)
}

fn lost_at(t: f64) -> f64 {
    0.12 * (1.0 - (-t / 900.0).exp())
}

/// Awkward data: gaps, infinities, large numbers, a million points.
fn residuals() -> Figure {
    let n = 1_000_000;
    let x = grid(0.0, 3.2e8, n);
    let y: Vec<f64> = x
        .iter()
        .enumerate()
        .map(|(i, x)| {
            if i % 100_000 < 9_000 {
                f64::NAN
            } else {
                -3e-5 * (x / 3e7).sin() + 4e-6 * (i as f64 * 0.7).sin()
            }
        })
        .collect();
    let few = log_grid(1e-6, 1e7, 14);
    let decades = Chart::new("Frequency (Hz)", "Amplitude $A_n$")
        .x_log()
        .y_log()
        .with(Series::points("measured", &few, &map(&few, |f| 1e3 / (1.0 + f * f))))
        .with(Series::line("Lorentz", &few, &map(&few, |f| 1e3 / (1.0 + f * f))))
        .with(Series::line("steeper", &few, &map(&few, |f| 3e2 / (1.0 + f * f * f))))
        .with(Series::line("flat", &few, &map(&few, |_| 1e-6)));
    let long = Chart::new("Sample", "Signal (V)").with(Series::line("a million samples", &x, &y));
    Figure::double_column(60.0).columns(2).letters().panel(long).panel(decades)
}

const CLAIMS: [&str; 8] = [
    "The time of flight falls strictly with the impact speed",
    "Dry incident ToF follows a power law: $R^2$ of the log–log fit",
    "The reflected ToF is longer than the incident one at every speed",
    "Pump oil shortens the ToF below 1.1 m/s and lengthens it above",
    "Gear oil always shortens the ToF",
    "Motor oil always lengthens the ToF",
    "The returning pulse in motor oil at 0.3993 m/s is split",
    "Model and signals overlap at the peaks",
];

fn verdict(i: usize) -> ClaimVerdict {
    match (i * i + i / 3) % 7 {
        0 | 1 | 4 => ClaimVerdict::Holds,
        2 => ClaimVerdict::InPart,
        3 => ClaimVerdict::NotDecidable,
        _ => ClaimVerdict::Fails,
    }
}

fn verdicts() -> Figure {
    let columns = [
        "default",
        "preload 0.24 N",
        "incline 1°",
        "contact 6 dry",
        "all contacts wet",
        "clipped",
        "stop 4.5 kg",
    ];
    claims_table(&columns)
}

fn verdicts_many() -> Figure {
    let names: Vec<String> = (1..=28).map(|i| format!("reading {i}, as bounded at 1/2")).collect();
    let columns: Vec<&str> = names.iter().map(String::as_str).collect();
    claims_table(&columns)
}

fn claims_table(columns: &[&str]) -> Figure {
    let row = |(i, claim): (usize, &&str)| {
        ((*claim).into(), (0..columns.len()).map(|c| verdict(i + 3 * c)).collect())
    };
    let columns: Vec<String> = columns.iter().map(|name| (*name).into()).collect();
    let rows = CLAIMS.iter().enumerate().map(row).collect();
    VerdictMatrix { columns, rows, ..VerdictMatrix::default() }.figure()
}

fn paper_rig() -> RigDrawing {
    RigDrawing {
        beads: 40,
        bead_label: "AISI 316, $R$ = 6.35 mm".into(),
        striker_ratio: Some(1.0),
        striker_label: "speed $v_0$".into(),
        sensor_bead: Some(7),
        sensor_label: "piezo disc".into(),
        wet_contacts: Some((7, 40)),
        liquid: "motor oil".into(),
        incline_deg: 0.5,
        far_end: RigEnd::HalfBead,
        wall_sensor: true,
        actuator: "voice-coil actuator".into(),
        repositioner: "ball repositioner".into(),
        photogate: "photogate".into(),
        springs: "springs, $F$ = 0.24 N".into(),
        recorder: "charge amplifiers, summed; 16-bit ADC".into(),
        stop: "steel stop".into(),
        end_structure: "end structure, 4.5 kg".into(),
        bar: "bar, 6 kg".into(),
    }
}

/// Forty beads with a pulse running down and back.
fn animation() -> Animation {
    let (beads, radius_m) = (41_u32, 6.35e-3);
    let times_s = grid(0.0, 1.3e-3, 1500);
    let slid = |bead: f64, t_us: f64| {
        let down = 1.0 + ((t_us / 16.0 - bead) / 1.1).tanh();
        let back = 1.0 + ((t_us / 16.0 + bead - 82.0) / 1.1).tanh();
        12e-6 * down - 9e-6 * back
    };
    let path = |i: u32| {
        let bead = f64::from(i);
        map(&times_s, |t| 2.0 * radius_m * bead + slid(bead, t * 1e6))
    };
    let force = |i: u32| {
        let contact = f64::from(i) + 0.5;
        map(&times_s, |t| 90.0 * velocity(contact, t * 1e6).abs())
    };
    let positions_m: Vec<Vec<f64>> = (0..beads).map(path).collect();
    let forces_n: Vec<Vec<f64>> = (0..beads).map(force).collect();
    Animation {
        title: "Pump oil, 1 m/s".into(),
        marks: vec![(0, "striker".into()), (7, "sensor bead 7".into())],
        wet_contacts: Some((7, 40)),
        ..Animation::new(&times_s, &positions_m, &forces_n, &[radius_m])
    }
}

/// Six small panels with shared axes.
fn panels() -> Figure {
    let v = log_grid(0.075, 1.23, 12);
    let empty = Figure::double_column(88.0).columns(3).letters().share_x();
    let names = [
        "pump, incident",
        "gear, incident",
        "motor, incident",
        "pump, reflected",
        "gear, reflected",
        "motor, reflected",
    ];
    let panel = |(i, name): (usize, &&str)| {
        let tilt = 0.01 * (i as f64 - 2.5);
        let ratio = map(&v, |v| 1.0 + tilt * (v / 0.4).ln());
        let (low, high) = (map(&ratio, |r| r - 0.006), map(&ratio, |r| r + 0.006));
        Chart::new("Impact speed $v_0$ (m/s)", "ToF ratio wet / dry")
            .title(name)
            .x_log()
            .with(Series::band("rounding", &v, &low, &high).colour(Colour::BLUE))
            .with(Series::line("model", &v, &ratio).colour(Colour::BLUE))
            .h_line(1.0, "")
            .note(&format!("slope {tilt:.3}"))
    };
    names.iter().enumerate().map(panel).fold(empty, Figure::panel)
}

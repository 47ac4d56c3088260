//! The paper's figures and those of the claims about its rig.

pub(crate) mod rig;
mod verdicts;

pub use verdicts::rig_figures;

use crate::claims::{Curve, Evidence, SHOTS_PER_POINT, SPEED_SCATTER_M_S, TofBranch};
use crate::oil_films::{OilFilms, SPEEDS_M_S, incident};
use crate::reproduce::{Film, OILS, ReproduceError, Reproduction, SignalShot};
use hertzchain_chain::wave::Budget;
use hertzchain_figures::{
    Chart, Colour, ColourMap, Dash, Figure, HeatMap, Marker, Series, case_look,
};

/// All figures of a reproduction with their names.
///
/// # Errors
/// A chain that can't be set up.
pub fn figures(of: &Reproduction) -> Result<Vec<(&'static str, Figure)>, ReproduceError> {
    let mut figures = vec![
        ("figure1", rig::figure(&of.cases)?),
        ("figure2", signals(&of.signals)),
        ("figure3", times(&of.evidence)),
        ("figure4", ratios(&of.evidence)),
        ("space_time", space_time(&of.films)),
        ("energy", energy(&of.films)),
    ];
    if let Some(scan) = &of.scan {
        figures.push(("readings", verdicts::readings(scan)));
    }
    Ok(figures)
}

/// Titles and captions of figures as Markdown.
pub fn captions(figures: &[(&str, Figure)]) -> String {
    figures.iter().fold(String::from("# Captions\n"), |text, (name, figure)| {
        text + &format!("\n## {name}\n{}\n", figure.caption_text())
    })
}

fn label(case: &str) -> &str {
    match case {
        "pump" => "pump oil DS19",
        "gear" => "gear oil EP 80W-90",
        "motor" => "motor oil SAE 0W-30",
        "hertz" => "Hertz",
        "hertz-viscoelastic" => "Hertz + viscoelastic",
        other => other,
    }
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| value * factor).collect()
}

const US: f64 = 1e6;

const PULSES: [(&str, Marker, Colour); 3] = [
    ("bead 7, incident", Marker::Circle, Colour::BLUE),
    ("wall", Marker::Square, Colour::VERMILION),
    ("bead 7, reflected", Marker::Triangle, Colour::GREEN),
];

/// Shown beyond the returning peak, as a share of the time between the peaks.
const AFTER: f64 = 0.55;

/// Paper above the highest and below the lowest force, as shares of the highest.
const HEADROOM: f64 = 0.1;
const FOOTROOM: f64 = 0.04;

/// A panel a shot: force in the common channel against time.
fn signals(signals: &[SignalShot]) -> Figure {
    let empty = Figure::single_column(172.0).letters();
    let panels = signals.iter().enumerate();
    let full = panels.fold(empty, |figure, (i, signal)| figure.panel(signal_panel(signal, i == 0)));
    full.title("Signals of bead 7 and wall in one channel").caption(
        "Dynamic force of bead 7 and of the wall, added into one channel, against the time \
             since the striker's impact: the computed shots that the paper's Fig. 2 shows. Symbols \
             mark the peaks between which times of flight are taken.",
    )
}

fn signal_panel(signal: &SignalShot, legend: bool) -> Chart {
    let time = scaled(&signal.time_s, US);
    let title = format!("{}, $v_0$ = {:.4} m/s", label(&signal.case), signal.speed_m_s);
    let mut chart = Chart::new("Time (µs)", "Force (N)")
        .title(&title)
        .with(Series::line("", &time, &signal.channel_n).colour(Colour::BLACK).width(0.8));
    for ((time, force), (name, marker, colour)) in signal.peaks.iter().zip(PULSES) {
        let peak = Series::points(name, &[time * US], &[*force]);
        chart = chart.with(peak.marker(marker).colour(colour));
    }
    if let [(first, _), .., (last, _)] = signal.peaks[..] {
        // From the impact on: before it, nothing moves.
        chart = chart.x_range(0.0, (last + AFTER * (last - first)) * US);
    }
    let highest = signal.channel_n.iter().copied().fold(0.0, f64::max);
    let lowest = signal.channel_n.iter().copied().fold(0.0, f64::min);
    chart = chart.y_range(lowest - FOOTROOM * highest, (1.0 + HEADROOM) * highest);
    chart.legend(legend)
}

/// Incident and reflected ToF, with even and with logarithmic axes.
fn times(evidence: &Evidence) -> Figure {
    let speed = "Striker speed $v_0$ (m/s)";
    let empty = Chart::new(speed, "Time of flight (µs)");
    let log = curves(evidence, empty.clone().x_log().y_log()).legend(false);
    let chart = curves(evidence, empty);
    let chart = chart
        .with(line(DASHED, &[], &[], Colour::BLACK))
        .note(&format!("error bars: $v_0$ ± {SPEED_SCATTER_M_S} m/s"));
    Figure::single_column(130.0)
        .letters()
        .panel(chart)
        .panel(log)
        .title("Time of flight in the dry chain against the striker's speed")
        .caption(&times_caption())
}

fn times_caption() -> String {
    format!(
        "(a) Times of flight of the dry chain between bead 7 and the wall (incident, filled circles) \
         and back (reflected, open squares) against the striker's speed, computed with the full \
         dry law (symbols, full lines) and without its cubic term ({DASHED}, dashed lines in the \
         same colours). Error bars: what the paper's scatter of ±{SPEED_SCATTER_M_S} m/s in the \
         striker's speed (standard deviation over {SHOTS_PER_POINT} shots) does to the time of \
         flight of one shot, |dT/dv| times the scatter; where none is seen it is smaller than \
         the symbol. (b) The same with logarithmic axes."
    )
}

/// Law of the dashed curves of both colours.
const DASHED: &str = "Hertz + viscoelastic";

fn curves(evidence: &Evidence, chart: Chart) -> Chart {
    let looks = [
        (TofBranch::Reflected, Marker::OpenSquare, Colour::VERMILION),
        (TofBranch::Incident, Marker::Circle, Colour::BLUE),
    ];
    let mut chart = chart;
    for (branch, marker, colour) in looks {
        let dashed = evidence.curve("hertz-viscoelastic").into_iter();
        let full = evidence.curve("dry").into_iter();
        let dashed = dashed.map(|curve| viscoelastic(curve, branch, colour));
        let full = full.map(|curve| dry(curve, branch, marker, colour));
        chart = dashed.chain(full).fold(chart, Chart::with);
    }
    chart
}

/// Without a name: a sample in black stands for both colours in the legend.
fn viscoelastic(curve: &Curve, branch: TofBranch, colour: Colour) -> Series {
    let times = scaled(&curve.tofs_s(branch), US);
    line("", &curve.speeds_m_s(), &times, colour)
}

fn line(name: &str, speeds_m_s: &[f64], times_us: &[f64], colour: Colour) -> Series {
    Series::line(name, speeds_m_s, times_us).colour(colour).dash(Dash::Dashed).width(0.8)
}

/// Error bars: the scatter of the speed from shot to shot, carried through dT/dv.
fn dry(curve: &Curve, branch: TofBranch, marker: Marker, colour: Colour) -> Series {
    let errors: Vec<f64> = curve
        .slopes_s2_m(branch)
        .iter()
        .map(|slope| slope.abs() * SPEED_SCATTER_M_S * US)
        .collect();
    let name = format!("{}, dry law", branch.name());
    Series::line(&name, &curve.speeds_m_s(), &scaled(&curve.tofs_s(branch), US))
        .marker(marker)
        .colour(colour)
        .dash(Dash::Solid)
        .width(0.8)
        .y_error(&errors)
}

fn ratios(evidence: &Evidence) -> Figure {
    let ratio = r"$\mathrm{ToF}_{\mathrm{wet}} / \mathrm{ToF}_{\mathrm{dry}}$, incident";
    let empty = Chart::new("Striker speed $v_0$ (m/s)", ratio).h_line(1.0, "");
    let chart = OILS.iter().fold(empty, |chart, case| chart.with(ratio_series(evidence, case)));
    Figure::single_column(68.0)
        .panel(chart)
        .title("Ratio of wet to dry time of flight against the striker's speed")
        .caption(
            "Incident time of flight of the chain with oil on the contacts from bead 7 to the \
             wall over that of the dry chain at the same speed of the striker. Symbols: computed \
             shots, one after the other joined by lines. Dashed line: oil makes no difference.",
        )
}

fn ratio_series(evidence: &Evidence, case: &str) -> Series {
    let ratios = evidence.ratios(case);
    let speeds: Vec<f64> = ratios.iter().map(|r| r.speed_m_s).collect();
    let values: Vec<f64> = ratios.iter().map(|r| r.incident).collect();
    let (colour, marker) = case_look(case, &[]);
    Series::line(label(case), &speeds, &values)
        .marker(marker)
        .colour(colour)
        .dash(Dash::Solid)
        .width(0.6)
}

/// One map a shot, the wave running from below to the wall above and back.
fn space_time(films: &[Film]) -> Figure {
    let empty = Figure::single_column(124.0).letters();
    // The striker is faster than any bead and would pale the wave.
    let largest = films.iter().flat_map(|film| film.velocity_m_s.iter().skip(1).flatten());
    let largest = largest.fold(0.0_f64, |most, v| most.max(v.abs()));
    films
        .iter()
        .fold(empty, |figure, film| figure.panel(velocity_map(film, largest)))
        .title("Bead velocity over time and place")
        .caption(
            "Velocity of every bead against time, positive towards the wall above bead 40. The \
             striker (row 0) is faster than any bead until it has hit; its colour is that of the \
             end of the scale.",
        )
}

fn velocity_map(film: &Film, largest: f64) -> Chart {
    let (columns, rows) = (film.time_s.len(), film.velocity_m_s.len());
    let values: Vec<f64> = film.velocity_m_s.iter().flatten().copied().collect();
    let end = film.time_s.last().copied().unwrap_or(1.0) * US;
    let map = HeatMap {
        x_edges: (0.0, end),
        y_edges: (-0.5, rows as f64 - 0.5),
        limits: Some((-largest, largest)),
        colours: ColourMap::Diverging,
        label: "Velocity (m/s)".into(),
        ..HeatMap::new(columns, rows, &values)
    };
    let title = format!("{}, $v_0$ = {:.4} m/s", label(&film.case), film.speed_m_s);
    Chart::new("Time (µs)", "Bead (0: striker)").title(&title).heat(map)
}

/// A panel of stacked shares for each shot, and what the budgets miss.
fn energy(films: &[Film]) -> Figure {
    let empty = Figure::single_column(150.0).letters();
    let shares = films.iter().enumerate();
    let shares = shares.map(|(i, film)| shares_of(film, i == 0));
    let full = shares.fold(empty, Figure::panel).panel(residuals(films));
    full.title("Energy budget over time").caption(
        "(a, b) Where the striker's energy is, as stacked shares: in motion, in overlaps, and lost \
         to each dissipative term of the contact law. (c) What the budgets miss of the initial \
         energy, the error of the computation.",
    )
}

fn times_us(film: &Film) -> Vec<f64> {
    film.budgets.iter().map(|budget| budget.time_s * US).collect()
}

/// Stacked shares: kinetic lowest, then elastic, then one band a lossy law.
fn shares_of(film: &Film, legend: bool) -> Chart {
    let time = times_us(film);
    let title = format!("{}, $v_0$ = {:.4} m/s", label(&film.case), film.speed_m_s);
    let empty = Chart::new("Time (µs)", "Share of initial energy").title(&title);
    let mut chart = empty.y_range(0.0, 1.0).legend(legend);
    let mut below = vec![0.0; time.len()];
    for (name, colour, part) in parts(&film.budgets) {
        let share = film.budgets.iter().zip(&part).map(|(b, part)| part / b.start_j);
        let above: Vec<f64> = below.iter().zip(share).map(|(low, share)| low + share).collect();
        chart = chart.with(Series::band(&name, &time, &below, &above).colour(colour));
        below = above;
    }
    chart
}

/// Name, colour and energy in J over time of each part.
fn parts(budgets: &[Budget]) -> Vec<(String, Colour, Vec<f64>)> {
    let column = |of: &dyn Fn(&Budget) -> f64| budgets.iter().map(of).collect::<Vec<f64>>();
    let mut parts = vec![
        ("kinetic".to_owned(), Colour::SKY, column(&|b| b.kinetic_j)),
        ("elastic".to_owned(), Colour::GREEN, column(&|b| b.elastic_j)),
    ];
    let colours = [Colour::OCHRE, Colour::VERMILION, Colour::PURPLE];
    let laws = budgets.first().map_or(&[][..], |first| &first.dissipated);
    for (i, law) in laws.iter().enumerate() {
        let lost = column(&|b| b.dissipated.get(i).map_or(0.0, |line| line.energy_j));
        let kind = law.law.trim_start_matches("damping_").replace('_', " ");
        let colour = colours.get(i % colours.len()).copied().unwrap_or(Colour::GREY);
        parts.push((format!("lost, {kind}"), colour, lost));
    }
    parts
}

fn residuals(films: &[Film]) -> Chart {
    let looks = [
        (Colour::BLACK, Dash::Solid),
        (Colour::VERMILION, Dash::Dashed),
        (Colour::BLUE, Dash::DashDotted),
    ];
    let empty =
        Chart::new("Time (µs)", "Share of initial energy").title("Residual of the budgets").y_log();
    let looks = looks.into_iter().cycle();
    films.iter().zip(looks).fold(empty, |chart, (film, look)| {
        let missing = film.budgets.iter().map(|b| b.relative_residual().abs());
        let missing: Vec<f64> =
            missing.map(|share| if share > 0.0 { share } else { f64::NAN }).collect();
        let line = Series::line(label(&film.case), &times_us(film), &missing);
        chart.with(line.colour(look.0).dash(look.1).width(0.8))
    })
}

/// Wet over dry incident times of films and of the paper's materials, a panel an oil.
pub fn oil_film_figure(of: &OilFilms) -> Figure {
    let [film, _, scaled, paper] = of.models.each_ref().map(|model| incident(&model.evidence));
    let count = SPEEDS_M_S.len();
    let panel = |(at, case): (usize, &&str)| {
        let (colour, marker) = case_look(case, &[]);
        let [film, scaled, paper] = [&film, &scaled, &paper]
            .map(|all| all.get(at * count..(at + 1) * count).unwrap_or(&[]));
        let range = of.ranges.get(at).map_or(&[][..], Vec::as_slice);
        let ends = [0, 1].map(|end| range.iter().map(|own| own[end]).collect::<Vec<f64>>());
        let line = |name: &str, ratios| Series::line(name, &SPEEDS_M_S, ratios).colour(colour);
        let ratio = r"$\mathrm{ToF}_{\mathrm{wet}} / \mathrm{ToF}_{\mathrm{dry}}$";
        Chart::new("Striker speed $v_0$ (m/s)", ratio)
            .title(label(case))
            .x_log()
            .y_range(0.86, 1.06)
            .h_line(1.0, "")
            .with(Series::band("", &SPEEDS_M_S, &ends[0], &ends[1]).colour(colour))
            .with(line("film", film).marker(marker).dash(Dash::Solid))
            .with(line("with one factor", scaled).dash(Dash::Dashed).width(0.8))
            .with(line("the paper's model", paper).dash(Dash::DashDotted).width(0.8))
            .legend(at == 0)
    };
    let panels = OILS.iter().enumerate().map(panel);
    panels
        .fold(Figure::single_column(170.0).letters(), Figure::panel)
        .title("Ratio of wet to dry time of flight with films of oil")
        .caption(&format!(
            "Incident time of flight with a film of oil on contacts 7 to 40 over that of the dry chain, both pushed by \
             0.24 N. Symbols: by each oil's own properties at 25 °C. Bands: 20 to 40 °C, the range of \
             pressure–viscosity coefficients of its class, rounding of what the paper prints. Dashed: all viscosities \
             times {:.3}, the factor whose ratios are nearest to the paper's model. Dash-dotted: the paper's effective \
             materials, without a push.",
            of.factor
        ))
}

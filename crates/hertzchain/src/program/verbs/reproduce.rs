//! `hertzchain reproduce`: everything in the paper.

use crate::program::arguments::Reproduce;
use crate::program::print::print;
use crate::program::{Counter, Failure, Folder};
use comfy_table::{ContentArrangement, Table, presets};
use hertzchain_experiment::preset;
use hertzchain_paper::claims::{ClaimVerdict, EvaluatedClaim, MEANING, computed_text};
use hertzchain_paper::figures::{captions, figures, oil_film_figure, rig_figures};
use hertzchain_paper::oil_films::OilFilms;
use hertzchain_paper::readings::ReadingScan;
use hertzchain_paper::reproduce::{
    PROVENANCE, ReproduceError, ReproduceOptions, Reproduction, remove_stale_files, reproduce,
};
use hertzchain_paper::rig_claims::{self, RigClaims, RigDesign, observe, series_csv};
use std::fmt::Write as _;
use std::path::Path;
use terminal_size::terminal_size_of;

/// Files that every reproduction writes.
const NAMES: [&str; 8] = [
    "claims.md",
    "claims.json",
    "captions.md",
    "tof.csv",
    "ratios.csv",
    "oils.csv",
    "power_laws.csv",
    "power_law_residuals.csv",
];

pub(crate) fn run(arguments: &Reproduce) -> Result<(), Failure> {
    // There is one paper: a folder of an earlier reproduction, which its provenance shows, gets the new one.
    let replace = arguments.force || arguments.out.join(PROVENANCE).exists();
    // Whether it can be written to, before anything is computed for it.
    let mut folder = Folder::open(&arguments.out, &NAMES, replace)?;
    let options = match arguments.readings {
        true => ReproduceOptions::default().with_readings(),
        false => ReproduceOptions::default(),
    };
    let counter = Counter::new("", 0);
    let computed = reproduce(&options, &counter);
    let computed = computed.map_err(|error| failure(&error))?;
    write(&computed, &mut folder)?;
    let mut text = summary(&computed, folder.path());
    if arguments.rig {
        text.push_str(&run_rigs(&mut folder, &counter)?);
    }
    if arguments.film {
        text.push_str(&run_films(&mut folder, &counter)?);
    }
    counter.finish();
    let names: Vec<&str> = folder.names().into_iter().chain([PROVENANCE]).collect();
    let provenance = computed.provenance_json(&names);
    remove_stale_files(folder.path(), &names).map_err(|error| failure(&error))?;
    folder.write(PROVENANCE, provenance.as_bytes())?;
    folder.finish()?;
    print(&text)
}

fn write(computed: &Reproduction, folder: &mut Folder) -> Result<(), Failure> {
    for (name, table) in computed.tables().map_err(|error| failure(&error))? {
        folder.write(name, table.as_bytes())?;
    }
    let figures = figures(computed).map_err(|error| failure(&error))?;
    for (name, figure) in &figures {
        folder.figure(name, figure)?;
        folder.write(&format!("{name}.pdf"), &figure.pdf())?;
    }
    folder.write("captions.md", captions(&figures).as_bytes())
}

/// The paper's chains come with the program: nothing here is the user's fault.
fn failure(error: &ReproduceError) -> Failure {
    Failure::Ours(error.to_string())
}

fn summary(computed: &Reproduction, folder: &Path) -> String {
    let verdicts = verdicts(&computed.evaluated);
    let mut text = format!("{}\n\n{MEANING}\n\n{verdicts}\n", times(computed));
    if let Some(scan) = &computed.scan {
        text.push_str(&closest(scan));
    }
    let provenance = &computed.provenance;
    let _ = write!(
        text,
        "\nRead as: {}. Times of flight asked to {:.0e}, reached {:.1e} at worst; computed in {:.0} s.\n\
         Pictures: figure1 to figure4, space_time and energy (.svg, .png, .pdf) in {}\n\
         Verdicts one by one: {}\n",
        computed.reading,
        provenance.accuracy_asked,
        provenance.accuracy_reached,
        provenance.wall_time_s,
        folder.display(),
        folder.join("claims.md").display(),
    );
    text
}

const SHOWN_M_S: [f64; 4] = [0.075, 0.25, 0.5, 1.0];

/// Incident and reflected ToF of each case at a few speeds.
fn times(computed: &Reproduction) -> Table {
    let mut table = plain();
    let speeds = SHOWN_M_S.map(|speed| format!("{speed} m/s"));
    let title = "ToF in µs, incident / reflected".to_owned();
    table.set_header([title].into_iter().chain(speeds));
    for curve in &computed.evidence.curves {
        let times = SHOWN_M_S.map(|speed| {
            curve.at(speed).map_or(String::new(), |p| {
                format!("{:.2} / {:.2}", 1e6 * p.tof_incident_s, 1e6 * p.tof_reflected_s)
            })
        });
        table.add_row([curve.case.clone()].into_iter().chain(times));
    }
    table
}

fn verdicts(evaluated: &[EvaluatedClaim]) -> String {
    let mut table = plain();
    table.set_header(["claim of the paper", "verdict", "computed"]);
    for evaluated in evaluated {
        let row = [
            evaluated.claim.statement.clone(),
            evaluated.verdict.to_string(),
            computed_text(evaluated),
        ];
        table.add_row(row);
    }
    let count = |verdict| evaluated.iter().filter(|j| j.verdict == verdict).count();
    let counts = ClaimVerdict::ALL.map(|verdict| format!("{} {verdict}", count(verdict)));
    format!("{table}\n{} claims: {}", evaluated.len(), counts.join(", "))
}

/// Width of tables where the terminal does not determine its own.
const WIDTH: u16 = 110;

fn plain() -> Table {
    let mut table = Table::new();
    table.load_style(presets::NOTHING);
    table.set_content_arrangement(ContentArrangement::Dynamic);
    let terminal = terminal_size_of(std::io::stdout());
    table.set_width(terminal.map_or(WIDTH, |(width, _)| width.0));
    table
}

fn closest(scan: &ReadingScan) -> String {
    let (closest, claims) = (scan.closest(), scan.claims.len());
    format!(
        "\nOf {} readings, closest to the paper: {}.\nWith the constants as printed it scores {} of {claims}, the default reading {}; \
         without what their rounding leaves open, {} and {}.\nWhat it loses is in readings.md, all verdicts in readings.svg.\n",
        scan.rows().count(),
        closest.reading,
        closest.score(),
        scan.default.score(),
        closest.score_without(&scan.flipped_in_closest),
        scan.default.score_without(&scan.flipped_by_rounding),
    )
}

/// Runs the campaigns and writes verdicts, table and pictures; returns what was found, for people.
fn run_rigs(into: &mut Folder, counter: &Counter) -> Result<String, Failure> {
    let ours = |error: &dyn std::error::Error| Failure::Ours(error.to_string());
    let paper = preset("paper").map_err(|error| ours(&error))?;
    let design = RigDesign::about(paper);
    let evidence = observe(&design, counter).map_err(|error| ours(&error))?;
    let claims = RigClaims::evaluate(&design, &evidence).map_err(|error| ours(&error))?;
    let json = format!("{:#}\n", claims.json());
    into.write("rig-claims.json", json.as_bytes())?;
    into.write("rig-claims.md", claims.markdown().as_bytes())?;
    into.write("rig-series.csv", series_csv(&evidence).as_bytes())?;
    for (name, figure) in rig_figures(&evidence, &claims) {
        into.figure(name, &figure)?;
    }
    Ok(format!(
        "\nOn {} dry virtual rigs. {}\n\n{}\nRig by rig: {}; pictures rig_verdicts, rig_spreads, rig_rebounds, rig_gaps\n",
        claims.dry_rigs,
        rig_claims::MEANING,
        verdicts(&claims.evaluated),
        into.path().join("rig-claims.md").display(),
    ))
}

/// Relative accuracy of times of flight: a hundredth of what oils do.
const ACCURACY: f64 = 1e-4;

/// Shoots the rows and writes tables and picture; returns what was found, for people.
fn run_films(into: &mut Folder, counter: &Counter) -> Result<String, Failure> {
    let films = OilFilms::compute(ACCURACY, counter).map_err(|error| failure(&error))?;
    let figure = oil_film_figure(&films);
    let caption = figure.caption_text();
    let page = format!("{}\n## Picture oil_films\n\n{caption}\n", films.markdown());
    into.write("oil-films.md", page.as_bytes())?;
    into.write("oil-films.csv", films.csv().as_bytes())?;
    into.write("oil-films.json", format!("{:#}\n", films.json()).as_bytes())?;
    into.figure("oil_films", &figure)?;
    into.write("oil_films.pdf", &figure.pdf())?;
    Ok(format!("\n{page}"))
}

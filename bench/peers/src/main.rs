//! The same shots by hertzchain and by general tools, side by side, on one
//! core. See README.md beside Cargo.toml.

mod case;
mod contest;
mod converged;
mod differential;
mod diffsol_peer;
mod motion;
mod ode_solvers_peer;
mod ours;
mod picture;
mod python;
mod scan;
#[cfg(test)]
mod small;
mod table;
mod tool;
mod watch;

use case::{Case, speeds_m_s};
use contest::{Outcome, Question, Ratio, median};
use converged::Converged;
use python::Worker;
use scan::{Patience, Point, candidates, scan};
use std::path::Path;
use table::Row;
use tool::{FRONTS, TOOLS, Tool, measured};

/// The accuracies asked for, the measure first.
const ACCURACIES: [f64; 3] = [1e-5, 1e-3, 1e-7];

/// Our own line of the picture.
const OUR_ACCURACIES: [f64; 8] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9];

/// Beads of the long chains.
const LONG: [usize; 4] = [40, 4_000, 100_000, 1_000_000];

/// `hertzchain-peers PYTHON FOLDER [quick] [CASES]`, FOLDER being bench/peers; all cases when none is named.
fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, python, folder, rest @ ..] = arguments.as_slice() else {
        anyhow::bail!("usage: hertzchain-peers PYTHON FOLDER [quick] [CASES]");
    };
    let folder = Path::new(folder);
    let quick = rest.iter().any(|word| word == "quick");
    let reference = std::fs::read_to_string(folder.join("../reference/numbers.json"))?;
    converged::check(&reference)?;
    let script = folder.join("python/worker.py");
    let worker = Worker::start(python, &script.to_string_lossy())?;
    let mut session =
        Session { worker, quick, rows: Vec::new(), our_speeds: Vec::new(), lines: Vec::new() };
    let named = |case: &Case| rest.iter().any(|word| word == case.name());
    let any = Case::ALL.iter().any(named);
    for case in Case::ALL.into_iter().filter(|case| !any || named(case)) {
        session.run(case)?;
    }
    session.write(&folder.join("results"))
}

/// What is added to a tool's name where its tolerance is the accuracy asked.
const USUAL: &str = ", tolerance as asked";

/// What a user of a tool would begin with: its first method, the accuracy as its tolerance.
fn usual(tool: &Tool, points: &[Point], accuracy: f64) -> Option<Point> {
    let method = *tool.methods.first()?;
    let near = |point: &&Point| (point.setting / accuracy).ln().abs();
    let of_method = points.iter().filter(|point| point.method == method);
    let nearest = of_method.min_by(|a, b| near(a).total_cmp(&near(b)))?;
    (tool.setting == "tolerance").then_some(Point { setting: accuracy, ..*nearest })
}

struct Session {
    worker: Worker,
    quick: bool,
    rows: Vec<Row>,
    /// What our shots per second were beside each peer.
    our_speeds: Vec<(Case, f64, f64)>,
    lines: Vec<(String, Vec<Point>)>,
}

impl Session {
    fn run(&mut self, case: Case) -> anyhow::Result<()> {
        let converged = Converged::new(case);
        if case == Case::Dry {
            self.our_line(&converged);
        }
        for tool in TOOLS.iter().filter(|tool| tool.can(case)) {
            let points = scan(tool, &self.worker, case, &converged, self.patience(tool, case));
            for accuracy in ACCURACIES {
                let best = candidates(&points, accuracy, tool.ladder.1);
                self.contest(tool, tool.name, (case, accuracy), &best, &converged)?;
                let usual: Vec<Point> = usual(tool, &points, accuracy).into_iter().collect();
                let name = format!("{}{USUAL}", tool.name);
                self.contest(tool, &name, (case, accuracy), &usual, &converged)?;
            }
            if case == Case::Dry {
                self.lines.push((tool.name.into(), points));
            }
        }
        for (tool, accuracy) in FRONTS.iter().flat_map(|tool| ACCURACIES.map(|a| (tool, a))) {
            let point = self.tried(tool, case, accuracy);
            self.contest(tool, tool.name, (case, accuracy), &[point], &converged)?;
        }
        self.settle_ours();
        Ok(())
    }

    /// A front with an accuracy, and about how quick it is.
    fn tried(&self, tool: &Tool, case: Case, accuracy: f64) -> Point {
        let (speeds, method) = (speeds_m_s(20), tool.methods[0]);
        let seconds = tool.run(&self.worker, method, case, accuracy, &speeds).seconds;
        let shots_per_s = speeds.len() as f64 / seconds;
        Point { method, setting: accuracy, error: f64::NAN, shots_per_s }
    }

    fn patience(&self, tool: &Tool, case: Case) -> Patience {
        let seconds = if self.quick { 0.02 } else { 0.06 };
        let most_s = if case == Case::Dry { 2.0 } else { 1.0 };
        // A box of LAMMPS takes as long as many shots of others.
        let most_s = if tool.shares_steps() { 2.5 } else { most_s };
        Patience { seconds, most_s }
    }

    fn question(&self, case: Case, accuracy: f64) -> Question {
        let measure = case == Case::Dry && accuracy == 1e-5;
        match (self.quick, measure) {
            (true, _) => {
                Question { case, accuracy, rounds: 1, seconds: 0.05, fewest_fast: 20, tuned_on: 20 }
            }
            (_, true) => Question {
                case,
                accuracy,
                rounds: 7,
                seconds: 0.5,
                fewest_fast: 1000,
                tuned_on: 1000,
            },
            _ => Question {
                case,
                accuracy,
                rounds: 3,
                seconds: 0.15,
                fewest_fast: 200,
                tuned_on: 1000,
            },
        }
    }

    /// Our rows tell the median of what was measured beside all peers.
    fn settle_ours(&mut self) {
        for row in self.rows.iter_mut().filter(|row| row.answer.setting == 0.0) {
            let beside = self.our_speeds.iter();
            let beside = beside.filter(|(case, accuracy, _)| row.is_ours(*case, *accuracy));
            row.answer.shots_per_s = median(beside.map(|(.., speed)| *speed).collect());
        }
    }

    fn contest(
        &mut self,
        tool: &Tool,
        name: &str,
        (case, accuracy): (Case, f64),
        candidates: &[Point],
        converged: &Converged,
    ) -> anyhow::Result<()> {
        let question = self.question(case, accuracy);
        let answers = question.ask(tool, &self.worker, candidates, converged);
        let Some(Outcome { of_us, of_them, ratio }) = answers else {
            return Ok(());
        };
        self.our_speeds.push((case, accuracy, of_us.shots_per_s));
        println!(
            "{} {accuracy:e}: {name} {:.1}/s ({} {:.2e}, error {:.1e} {:.1e}), ours {:.1}/s, {:.1} times",
            case.name(),
            of_them.shots_per_s,
            of_them.method,
            of_them.setting,
            of_them.errors.0,
            of_them.errors.1,
            of_us.shots_per_s,
            ratio.median,
        );
        let row = |name: &str, version, answer, ratio, setting: &str, instruction_set| Row {
            tool: name.into(),
            version,
            case,
            accuracy,
            answer,
            ratio,
            setting: setting.into(),
            instruction_set,
        };
        if !self.rows.iter().any(|r| r.is_ours(case, accuracy)) {
            let set = ours::instruction_set();
            let version = env!("CARGO_PKG_VERSION").into();
            let setting = question.our_setting(converged).to_string();
            self.rows.push(row("hertzchain, bare loop", version, of_us, Ratio::ONE, &setting, set));
        }
        let version = tool.version(&self.worker)?;
        self.rows.push(row(name, version, of_them, ratio, tool.setting, tool.runs_on()));
        Ok(())
    }

    /// Ours by accuracy asked, for the picture.
    fn our_line(&mut self, converged: &Converged) {
        let mut points = Vec::new();
        for accuracy in OUR_ACCURACIES {
            let speeds = speeds_m_s(if self.quick { 20 } else { 100 });
            let setting = ours::tune(Case::Dry, accuracy, &speeds, converged);
            let timed = measured(|| ours::ours(Case::Dry, &speeds, setting));
            let (incident, reflected) =
                converged::errors(&timed.tofs_s, &converged.tofs_s(&speeds));
            let shots_per_s = speeds.len() as f64 / timed.seconds;
            let error = incident.max(reflected);
            points.push(Point { method: "", setting: accuracy, error, shots_per_s });
        }
        self.lines.push(("hertzchain".into(), points));
    }

    fn write(&self, results: &Path) -> anyhow::Result<()> {
        std::fs::create_dir_all(results)?;
        let long = if self.quick { &LONG[..2] } else { &LONG[..] };
        let scale: Vec<_> = long
            .iter()
            .map(|beads| {
                let lammps = self.worker.scale(*beads);
                (*beads, ours::ns_per_bead_and_step(*beads), lammps.ok())
            })
            .collect();
        let machine = format!(
            "One pinned core, native builds use {}; medians of processor time. Settings are the \
             cheapest tried that meet the accuracy for every speed that was timed.",
            table::native()
        );
        std::fs::write(results.join("table.csv"), table::csv(&self.rows))?;
        std::fs::write(results.join("table.md"), table::markdown(&self.rows, &scale, &machine))?;
        picture::write(&self.lines, results)
    }
}

//! How often the pairs of K and A that the gauge lists hold the true one: a table of
//! `docs/explanation/inference.md`.
//!
//! ```sh
//! cargo run --release -p hertzchain-infer --example pairs -- 50          # data sets an oil
//! cargo run --release -p hertzchain-infer --example pairs -- 50 6        # at so many speeds
//! cargo run --release -p hertzchain-infer --example pairs -- 50 6 ratio  # with ratios alone, or `times`
//! ```
//!
//! Dry and wet curves of the paper's oils at the paper's noise: 20 shots a speed, speeds
//! ±0.003 m/s, times ±0.5 µs; with incident and reflected times, and with the returning over
//! the passing peak beside them, to half a percent. The dry chain's numbers are fitted, as in
//! any gauge.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Noise, Truth, speeds_m_s};
use hertzchain_experiment::{Experiment, preset};
use hertzchain_infer::Data;
use hertzchain_infer::gauge::{Branch, Chains, Contact, Gauge, Oil, Pair, WetRow, known_oils};
use rayon::prelude::*;
use std::error::Error;

const OILS: [&str; 3] = ["motor", "gear", "pump"];

/// Relative error of a mean ratio of peaks.
const RATIO: f64 = 0.005;

/// Standard errors of K and of A within which a pair is the true one.
const NEAR: f64 = 3.0;

/// Standard errors beyond which it is another: between them, the true one with an error that
/// is too small.
const FAR: f64 = 5.0;

/// What was counted over rows.
#[derive(Clone, Copy, Default)]
struct Counts {
    /// Rows.
    rows: usize,
    /// Rows that no pair is said to give.
    none: usize,
    /// True pair among those listed.
    listed: usize,
    /// Rows of a pair reported first.
    reported: usize,
    /// True pair reported first.
    right: usize,
    /// Pairs reported first that are beside the true one.
    beside: usize,
    /// Rows whose branch is not known.
    unknown: usize,
    /// Wrong pairs reported first, by whether neighbours chose.
    wrong_only: usize,
    wrong_smooth: usize,
}

impl Counts {
    fn and(mut self, row: &Self) -> Self {
        self.rows += row.rows;
        self.none += row.none;
        self.listed += row.listed;
        self.reported += row.reported;
        self.right += row.right;
        self.beside += row.beside;
        self.unknown += row.unknown;
        self.wrong_only += row.wrong_only;
        self.wrong_smooth += row.wrong_smooth;
        self
    }

    fn of(row: &WetRow, exact: [f64; 2]) -> Self {
        let mut counts = Self { rows: 1, ..Self::default() };
        match &row.contact {
            Err(_) => counts.none = 1,
            Ok(contact) => counts.count(contact, exact),
        }
        counts
    }

    fn count(&mut self, contact: &Contact, exact: [f64; 2]) {
        let off = |pair: &Pair| pulls(pair, exact).map(f64::abs).into_iter().fold(0.0, f64::max);
        let is_true = |pair: &Pair| off(pair) < NEAR;
        let first = off(&contact.first);
        self.listed = usize::from(contact.pairs().into_iter().any(is_true));
        match contact.branch {
            Branch::Unknown => self.unknown = 1,
            branch => {
                self.reported = 1;
                self.right = usize::from(first < NEAR);
                self.beside = usize::from((NEAR..FAR).contains(&first));
                let wrong = usize::from(first >= FAR);
                match branch {
                    Branch::Smooth => self.wrong_smooth = wrong,
                    _ => self.wrong_only = wrong,
                }
            }
        }
    }
}

/// How far ln K and ln A are from the true ones, in the pair's own errors.
fn pulls(pair: &Pair, exact: [f64; 2]) -> [f64; 2] {
    let covariance = pair.covariance;
    [0, 1].map(|of| (pair.ln[of] - exact[of].ln()) / covariance[of][of].sqrt())
}

/// The wet chain of an oil, its curve and that of the dry one.
struct Case {
    oil: Oil,
    wet_model: Experiment,
    wet: Truth,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut number = |usual: usize| arguments.next().map_or(Ok(usual), |text| text.parse());
    let (sets, speeds) = (number(50)?, speeds_m_s(number(6)?));
    let asked = arguments.next();
    let dry_model = preset("dry")?;
    let dry = Truth::of(&dry_model, &speeds);
    println!(
        "| oil, data | rows | no pair | true one listed | reported first | within 3 errors | 3 to 5 off | wrong, no other listed | wrong, by neighbours | branch open |"
    );
    for (name, oil) in OILS.into_iter().zip(known_oils()?) {
        let wet_model = preset(name)?;
        let wet = Truth::of(&wet_model, &speeds);
        let case = Case { oil, wet_model, wet };
        for (what, ratios) in [("times", false), ("ratio", true)] {
            if asked.as_ref().is_some_and(|asked| asked != what) {
                continue;
            }
            let of = |seed: usize| counted(&case, (&dry_model, &dry), ratios, seed as u64);
            let all: Result<Vec<Counts>, String> = (1..=sets).into_par_iter().map(of).collect();
            let sum = all?.iter().fold(Counts::default(), Counts::and);
            print(name, ratios, &sum);
        }
    }
    Ok(())
}

/// One data set.
fn counted(
    case: &Case,
    (dry_model, dry): (&Experiment, &Truth),
    ratios: bool,
    seed: u64,
) -> Result<Counts, String> {
    let noise = Noise::of_the_paper();
    let wet_seed = seed + 10_000;
    let wet: Data = match ratios {
        true => case.wet.measured_with_ratios(noise, RATIO, wet_seed),
        false => case.wet.measured_with(noise, wet_seed),
    };
    let free = ["aisi316.eta".to_owned(), "dry.B".to_owned()];
    let chains = Chains {
        film: &[],
        dry: dry_model,
        wet: &case.wet_model,
        free: &free,
        own: &[],
        systematic: &[],
        accuracy: 1e-5,
    };
    let gauge = Gauge::new(&chains, dry.measured_with(noise, seed), wet);
    let gauge = gauge.map_err(|error| format!("seed {seed}: {error}"))?;
    let rows = gauge.rows();
    let of = |row: &WetRow| {
        let (k, a) = case.oil.contact(gauge.radius_m, row.speed_m_s);
        let counts = Counts::of(row, [k, a]);
        if counts.beside + counts.wrong_only + counts.wrong_smooth + counts.none > 0 {
            eprintln!(
                "{} seed {seed} {:.4} m/s: {}",
                case.oil.name,
                row.speed_m_s,
                words(row, [k, a])
            );
        }
        counts
    };
    let all = rows.iter().map(of);
    Ok(all.fold(Counts::default(), |sum, row| sum.and(&row)))
}

/// What a row determines that is not the truth.
fn words(row: &WetRow, exact: [f64; 2]) -> String {
    match &row.contact {
        Err(why) => why.clone(),
        Ok(contact) => {
            let pairs = std::iter::once(&contact.first).chain(&contact.others);
            let pairs = pairs.map(|pair| {
                let [(k, _), (a, a_sd)] = pair.estimates();
                let [k_pull, a_pull] = pulls(pair, exact);
                format!("K {:.4e}, A {a:.4e} ± {a_sd:.1e} (off by {k_pull:.1}, {a_pull:.1})", k)
            });
            let pairs: Vec<String> = pairs.collect();
            format!(
                "{:?}: {}; true K {:.4e}, A {:.4e}",
                contact.branch,
                pairs.join("; "),
                exact[0],
                exact[1]
            )
        }
    }
}

fn print(name: &str, ratios: bool, of: &Counts) {
    let data = match ratios {
        true => "both times and ratio",
        false => "both times",
    };
    println!(
        "| {name}, {data} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
        of.rows,
        of.none,
        of.listed,
        of.reported,
        of.right,
        of.beside,
        of.wrong_only,
        of.wrong_smooth,
        of.unknown
    );
}

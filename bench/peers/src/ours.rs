//! hertzchain itself: the one place to change when its fastest way changes.

use crate::case::{BEADS, Case, SENSOR};
use crate::converged::{Converged, errors};
use crate::watch::{FALLEN, SOONEST};
use cpu_time::ProcessTime;
use hertzchain_chain::ensemble::{self, Precision};
use hertzchain_chain::laws::{DampingCubic, DampingViscoelastic, ElasticHertz, Law, law};
use hertzchain_chain::observe::{Maximum, Passages};
use hertzchain_chain::wave::{Flow, Limits, Method, Observer, Piece, run};
use hertzchain_chain::{
    Bead, Chain, FarEnd, InstructionSet, Material, Push, Section, Sensor, Start, System, Tension,
};
use std::sync::{Arc, Mutex};

/// A way of the ensemble loop: precision, a step in contact times and whether
/// openings are mended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    precision: Precision,
    step: f64,
    openings: bool,
}

/// How the rows of the tables call it.
impl std::fmt::Display for Setting {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let precision = match self.precision {
            Precision::Single => "single",
            Precision::Double => "double",
        };
        let openings = if self.openings {
            ", openings mended"
        } else {
            ""
        };
        write!(
            f,
            "ensemble, {precision} precision, step {}{openings}",
            self.step
        )
    }
}

/// Settings to choose from, the cheapest first. Steps of single precision are
/// in thousandths of a contact time.
fn settings() -> impl Iterator<Item = Setting> {
    let single = (100..=400_u32).rev().step_by(5).map(|step| Setting {
        precision: Precision::Single,
        step: f64::from(step) / 1000.0,
        openings: false,
    });
    let double = |openings: bool, steps: &'static [f64]| {
        steps.iter().map(move |&step| Setting {
            precision: Precision::Double,
            step,
            openings,
        })
    };
    let mended = &[
        0.12, 0.11, 0.1, 0.09, 0.08, 0.07, 0.065, 0.06, 0.055, 0.05, 0.045, 0.04, 0.035, 0.03,
        0.025, 0.02, 0.015, 0.01, 0.005,
    ];
    let plain = double(false, &[0.2, 0.185, 0.17, 0.15, 0.135, 0.12]);
    single.chain(plain).chain(double(true, mended))
}

/// The cheapest setting that meets an accuracy at all of some speeds; found once.
pub fn tune(case: Case, accuracy: f64, speeds_m_s: &[f64], converged: &Converged) -> Setting {
    static FOUND: Mutex<Vec<((&str, u64, usize), Setting)>> = Mutex::new(Vec::new());
    let key = (case.name(), accuracy.to_bits(), speeds_m_s.len());
    let mut found = FOUND.lock().expect("no panic while it is held");
    if let Some((_, setting)) = found.iter().find(|(known, _)| *known == key) {
        return *setting;
    }
    let meets = |setting: &Setting, speeds_m_s: &[f64]| {
        let tofs_s = ours(case, speeds_m_s, *setting);
        let (incident, reflected) = errors(&tofs_s, &converged.tofs_s(speeds_m_s));
        incident <= accuracy && reflected <= accuracy
    };
    // Most fail at a few speeds already.
    let few: Vec<f64> = speeds_m_s.iter().copied().step_by(25).collect();
    let tightest = settings().last().expect("there are some");
    let setting = settings().find(|setting| meets(setting, &few) && meets(setting, speeds_m_s));
    let setting = setting.unwrap_or(tightest);
    found.push((key, setting));
    setting
}

/// Incident and reflected ToF in s, one pair per speed, by the ensemble loop;
/// chains are set up anew for every call.
pub fn ours(case: Case, speeds_m_s: &[f64], setting: Setting) -> Vec<(f64, f64)> {
    let Setting {
        precision,
        step,
        openings,
    } = setting;
    let systems = systems(case, speeds_m_s);
    let shots: Vec<ensemble::Shot<'_>> = systems
        .iter()
        .map(|system| ensemble::Shot {
            system,
            step,
            duration_s: 400.0 * system.scales().time_s,
            precision,
        })
        .collect();
    let settings = ensemble::Settings {
        sensors: vec![Sensor::Bead(SENSOR), Sensor::Contact(BEADS)],
        end: ensemble::End::Passed,
        set: InstructionSet::default(),
        shapes: false,
        whole_chain: false,
        openings,
    };
    ensemble::fire(&shots, &settings)
        .into_iter()
        .map(|flown| flown.ok().and_then(tofs).unwrap_or((f64::NAN, f64::NAN)))
        .collect()
}

/// Chains at all speeds; where laws do not depend on the speed the chain is
/// set up once.
fn systems(case: Case, speeds_m_s: &[f64]) -> Vec<System> {
    let system = |speed: f64| System::new(&chain(case, speed)).expect("the measure's own chain");
    let first = system(speeds_m_s.first().copied().unwrap_or(0.5));
    speeds_m_s
        .iter()
        .map(|&speed| match case.oil(speed) {
            Some(_) => system(speed),
            None => first.at_speed(speed).expect("a positive speed"),
        })
        .collect()
}

fn tofs(flown: ensemble::LaneResult) -> Option<(f64, f64)> {
    let [sensor, wall] = <[_; 2]>::try_from(flown.signals).ok()?;
    let passages = Passages::from_signals(sensor, wall, flown.time_s);
    let (incident, wall, reflected) = passages.peaks().ok()?;
    let back_s = reflected?.time_s - wall.time_s;
    Some((wall.time_s - incident.time_s, back_s))
}

/// ns per bead and step of one long chain with all contacts closed.
pub fn ns_per_bead_and_step(beads: usize) -> Option<f64> {
    let mut ring = chain(Case::Hertz, 0.5);
    ring.beads = vec![BALL; beads];
    ring.sections[0].contacts = 0..=beads;
    // Pressed, so that nothing sleeps.
    ring.push = Push::Constant { force_n: 1.0 };
    let system = System::new(&ring).ok()?;
    let step = 0.05;
    let settings = ensemble::Settings {
        sensors: vec![],
        end: ensemble::End::Duration,
        set: InstructionSet::default(),
        shapes: false,
        whole_chain: true,
        openings: false,
    };
    let steps = (4e7 / beads as f64).clamp(100.0, 20_000.0);
    let time = |steps: f64| {
        let duration_s = steps * step * system.scales().time_s;
        let shot = ensemble::Shot {
            system: &system,
            step,
            duration_s,
            precision: Precision::Double,
        };
        let begin = ProcessTime::now();
        let made = ensemble::fire(&[shot], &settings)[0]
            .as_ref()
            .ok()?
            .work
            .steps;
        Some((begin.elapsed().as_secs_f64(), made))
    };
    // The set-up is the same in both.
    let (few_s, few) = time(steps)?;
    let (many_s, many) = time(3.0 * steps)?;
    Some((many_s - few_s) / (many - few) as f64 / beads as f64 * 1e9)
}

/// Instruction set that `ours` runs on.
pub fn instruction_set() -> String {
    InstructionSet::default().name().to_owned()
}

/// When a shot ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// As soon as the reflected pulse has passed the sensor bead.
    WhenPassed,
    /// After the whole window in which the reflected peak is looked for.
    WholeWindow,
}

/// One shot by the one-step loop; NaN where it fails or sees no pulse.
pub fn shot(case: Case, speed_m_s: f64, tolerance: f64, end: End) -> (f64, f64) {
    let nothing = (f64::NAN, f64::NAN);
    let Ok(system) = System::new(&chain(case, speed_m_s)) else {
        return nothing;
    };
    let mut passed = Passed {
        passages: Passages::new(SENSOR, BEADS, true),
        end,
    };
    let method = Method::dormand_prince(tolerance);
    if run(&system, &method, Limits::until(1.0), &mut [&mut passed]).is_err() {
        return nothing;
    }
    match passed.passages.passage() {
        Ok(passage) => (
            passage.tof_incident_s(),
            passage.tof_reflected_s().unwrap_or(f64::NAN),
        ),
        Err(_) => nothing,
    }
}

/// Ends a shot as that of every other tool.
struct Passed {
    passages: Passages,
    end: End,
}

impl Observer for Passed {
    fn step(&mut self, piece: &Piece<'_>) -> Flow {
        let flow = self.passages.step(piece);
        match self.end == End::WhenPassed && self.has_passed(piece) {
            true => Flow::Finished,
            false => flow,
        }
    }
}

impl Passed {
    fn has_passed(&self, piece: &Piece<'_>) -> bool {
        let largest = |peaks: &mut dyn Iterator<Item = Maximum>| {
            peaks.reduce(|a, b| if b.value > a.value { b } else { a })
        };
        let at_bead = || self.passages.sensor().maxima().iter().copied();
        let mut at_wall = self.passages.wall().maxima().iter().copied();
        let Some(wall) = largest(&mut at_wall) else {
            return false;
        };
        let mut before = at_bead().filter(|peak| peak.time_s < wall.time_s);
        let mut after = at_bead().filter(|peak| peak.time_s > wall.time_s);
        let (Some(incident), Some(reflected)) = (largest(&mut before), largest(&mut after)) else {
            return false;
        };
        let soonest_s = wall.time_s + SOONEST * (wall.time_s - incident.time_s);
        let now = piece.signal(Sensor::Bead(SENSOR), 1.0);
        reflected.time_s > soonest_s && now < FALLEN * reflected.value
    }
}

const STEEL: Material = Material {
    young_modulus_pa: 213e9,
    poisson_ratio: 0.3,
    shear_viscosity_pa_s: 3.2e4,
    bulk_viscosity_pa_s: 3.2e4,
    yield_strength_pa: None,
};

const BALL: Bead = Bead {
    radius_m: 6.35e-3,
    mass_kg: 8.54e-3,
    material: STEEL,
};

fn chain(case: Case, speed_m_s: f64) -> Chain {
    Chain {
        beads: vec![BALL; BEADS],
        start: Start::Striker {
            bead: BALL,
            speed_m_s,
        },
        initial: vec![],
        push: Push::None,
        far: FarEnd::HalfBead {
            radius_m: BALL.radius_m,
            material: STEEL,
        },
        sections: sections(case, speed_m_s),
        gaps: vec![],
        incline_rad: 0.0,
        gravity_m_s2: 9.80665,
        suspension_m: None,
        tension: Tension::Allowed,
    }
}

fn sections(case: Case, speed_m_s: f64) -> Vec<Section> {
    let hertz = || law(ElasticHertz { stiffness: None });
    let viscoelastic = || {
        law(DampingViscoelastic {
            relaxation_time_s: None,
            stiffness: None,
        })
    };
    let cubic = || {
        law(DampingCubic {
            coefficient_kg_s_m2: 77.0,
        })
    };
    let section = |contacts, laws: Vec<Arc<dyn Law>>, material| Section {
        contacts,
        laws,
        material,
    };
    let dry = || vec![hertz(), viscoelastic(), cubic()];
    match (case, case.oil(speed_m_s)) {
        (_, Some((young_modulus_pa, eta, poisson_ratio))) => {
            let oil = Material {
                young_modulus_pa,
                poisson_ratio,
                shear_viscosity_pa_s: eta,
                bulk_viscosity_pa_s: eta,
                yield_strength_pa: None,
            };
            vec![
                section(0..=SENSOR - 1, dry(), None),
                section(SENSOR..=BEADS, vec![hertz(), viscoelastic()], Some(oil)),
            ]
        }
        (Case::Hertz, None) => vec![section(0..=BEADS, vec![hertz()], None)],
        (Case::HertzViscoelastic, None) => {
            vec![section(0..=BEADS, vec![hertz(), viscoelastic()], None)]
        }
        (_, None) => vec![section(0..=BEADS, dry(), None)],
    }
}

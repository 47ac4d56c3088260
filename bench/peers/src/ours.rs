//! hertzchain itself: the one place to change when its fastest way changes.

use crate::case::{BEADS, Case, SENSOR};
use crate::watch::{FALLEN, SOONEST};
use hertzchain_chain::laws::{DampingCubic, DampingViscoelastic, ElasticHertz, Law, law};
use hertzchain_chain::observe::{Maximum, Passages};
use hertzchain_chain::wave::{DormandPrince, Flow, Limits, Observer, Piece, run};
use hertzchain_chain::{Bead, Chain, FarEnd, Material, Push, Section, Start, System, Tension};
use std::sync::Arc;

/// Incident and reflected ToF in s, one pair per speed, each meant to lie
/// within `accuracy` of its converged value.
pub fn ours(case: Case, speeds_m_s: &[f64], accuracy: f64) -> Vec<(f64, f64)> {
    let tolerance = (0.1 * accuracy).clamp(1e-13, 1e-3);
    let shot = |speed: &f64| shot(case, *speed, tolerance, End::WhenPassed);
    speeds_m_s.iter().map(shot).collect()
}

/// How the rows of the tables call what `ours` does.
pub const METHOD: &str = "wave::run, one shot at a time";

/// ns per bead and step of one long chain with all contacts closed; `None`
/// until there is a way to measure it.
pub fn ns_per_bead_and_step(_beads: usize) -> Option<f64> {
    None
}

/// Instruction set that `ours` runs on.
pub fn instruction_set() -> String {
    crate::table::native()
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
    let method = DormandPrince { tolerance };
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
        let now = 0.5 * (piece.force(SENSOR - 1, 1.0) + piece.force(SENSOR, 1.0));
        reflected.time_s > soonest_s && now < FALLEN * reflected.value
    }
}

const STEEL: Material = Material {
    young_modulus_pa: 213e9,
    poisson_ratio: 0.3,
    shear_viscosity_pa_s: 3.2e4,
    bulk_viscosity_pa_s: 3.2e4,
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

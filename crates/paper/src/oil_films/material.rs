//! The material that a film would be taken for by its incident time and wall peak.

use super::{MODEL_ACCURACY, SPEEDS_M_S};
use crate::claims::Evidence;
use crate::reproduce::{Cases, OILS, ReproduceError, ReproduceProgress, failed, plan};
use hertzchain_chain::Material;
use hertzchain_experiment::{Experiment, PathError};
use hertzchain_sim::{Control, InstructionSet, run_plans};
use rayon::prelude::*;
use serde::Serialize;

/// Wet contacts as Hertz's with a viscoelastic loss: steel's Young modulus, and two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct WetContact {
    /// Y/(1 − ν²) over that of the dry steel, and so K over K.
    pub stiffness_ratio: f64,
    pub poisson_ratio: f64,
    pub viscosity_pa_s: f64,
}

/// A film as a material, and the paper's own material for its oil.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct EffectiveMaterial {
    pub case: &'static str,
    pub speed_m_s: f64,
    /// Not a number where no material has the film's time and peak.
    pub film: WetContact,
    pub paper: WetContact,
}

pub(super) fn effective(
    cases: &Cases,
    films: &Evidence,
    progress: &dyn ReproduceProgress,
) -> Result<Vec<EffectiveMaterial>, ReproduceError> {
    let jobs = OILS.iter().flat_map(|case| SPEEDS_M_S.map(|speed| (*case, speed)));
    let jobs: Vec<(&'static str, f64)> = jobs.collect();
    let one = |&(case, speed_m_s): &(&'static str, f64)| {
        let wet = WetRow::new(cases, case, speed_m_s)?;
        let film = films.curve(case).and_then(|curve| curve.at(speed_m_s));
        let target = film.map_or([f64::NAN; 2], |p| [p.tof_incident_s.ln(), p.wall_peak_n.ln()]);
        let row =
            EffectiveMaterial { case, speed_m_s, film: wet.matching(target)?, paper: wet.paper()? };
        progress.advance();
        Ok(row)
    };
    jobs.par_iter().map(one).collect()
}

/// A row without a push, as the paper's model, whose wet contacts have a material that may be changed.
pub(super) struct WetRow<'a> {
    case: &'static str,
    speed_m_s: f64,
    experiment: &'a Experiment,
    steel: Material,
}

impl<'a> WetRow<'a> {
    pub(super) fn new(
        cases: &'a Cases,
        case: &'static str,
        speed_m_s: f64,
    ) -> Result<Self, ReproduceError> {
        let steel = cases.get("dry")?.chain(Some(1.0))?.0.beads[0].material;
        Ok(Self { case, speed_m_s, experiment: cases.get(case)?, steel })
    }

    /// The contact with these logarithms of K over K and of η.
    fn contact(&self, [stiffness, viscosity]: [f64; 2]) -> WetContact {
        let dry = 1.0 - self.steel.poisson_ratio.powi(2);
        let poisson_ratio = (1.0 - dry / stiffness.exp()).sqrt();
        WetContact {
            stiffness_ratio: stiffness.exp(),
            poisson_ratio,
            viscosity_pa_s: viscosity.exp(),
        }
    }

    fn with(&self, contact: &WetContact) -> Result<Experiment, PathError> {
        let wet = self.experiment.sections().iter().find(|section| section.wet);
        let name = wet.and_then(|wet| self.experiment.effective_material(wet)).unwrap_or_default();
        let numbers = [
            ("young_modulus", self.steel.young_modulus_pa),
            ("poisson_ratio.prefactor", contact.poisson_ratio),
            ("poisson_ratio.exponent", 0.0),
            ("shear_viscosity.prefactor", contact.viscosity_pa_s),
            ("shear_viscosity.exponent", 0.0),
        ];
        let named = numbers.map(|(key, value)| (format!("materials.{name}.{key}"), value));
        let named: Vec<(&str, f64)> = named.iter().map(|(key, v)| (key.as_str(), *v)).collect();
        self.experiment.set(&named)
    }

    /// Logarithms of incident time and wall peak.
    pub(super) fn shot(&self, contacts: &[[f64; 2]]) -> Result<Vec<[f64; 2]>, ReproduceError> {
        let plan = |logs: &[f64; 2]| {
            let experiment = self.with(&self.contact(*logs))?;
            Ok(plan(&experiment, self.speed_m_s, MODEL_ACCURACY)?.for_flights())
        };
        let plans = contacts.iter().map(plan).collect::<Result<Vec<_>, ReproduceError>>()?;
        let shots = run_plans(&plans, Control::None, InstructionSet::default(), &|| {});
        let logs = |shot: Result<hertzchain_sim::Shot, _>| {
            let shot = shot.map_err(|error| failed(self.case, self.speed_m_s, error))?;
            let passage = shot.passage.as_ref().ok();
            let [time_s, peak_n] =
                passage.map_or([f64::NAN; 2], |p| [p.tof_incident_s(), p.wall.value]);
            Ok([time_s.ln(), peak_n.ln()])
        };
        shots.into_iter().map(logs).collect()
    }

    /// Newton's method in both logarithms, with differences.
    pub(super) fn matching(&self, target: [f64; 2]) -> Result<WetContact, ReproduceError> {
        const STEP: f64 = 1e-3;
        // Above dry steel, where ν has a value, and within what oils were read as.
        let inside = |[k, eta]: [f64; 2]| [k.clamp(1e-3, 1.5), eta.clamp(7.0, 15.0)];
        let mut at = [0.2, 11.5];
        for _ in 0..12 {
            let [k, eta] = at;
            let found = self.shot(&[at, [k + STEP, eta], [k, eta + STEP]])?;
            let off = [0, 1].map(|i| found[0][i] - target[i]);
            if off[0].abs().max(off[1].abs()) < 1e-5 {
                return Ok(self.contact(at));
            }
            let [[a, b], [c, d]] =
                [0, 1].map(|i| [1, 2].map(|moved: usize| (found[moved][i] - found[0][i]) / STEP));
            let whole = a * d - b * c;
            let step = [(d * off[0] - b * off[1]) / whole, (a * off[1] - c * off[0]) / whole];
            at = inside([k - step[0].clamp(-0.3, 0.3), eta - step[1].clamp(-1.0, 1.0)]);
            if at.iter().any(|log| log.is_nan()) {
                break;
            }
        }
        Ok(self.contact([f64::NAN; 2]))
    }

    fn paper(&self) -> Result<WetContact, ReproduceError> {
        let (chain, _) = self.experiment.chain(Some(self.speed_m_s))?;
        let wet = chain.sections.iter().find_map(|section| section.material);
        let modulus = |m: &Material| m.young_modulus_pa / (1.0 - m.poisson_ratio.powi(2));
        Ok(wet.map_or(self.contact([f64::NAN; 2]), |wet| WetContact {
            stiffness_ratio: modulus(&wet) / modulus(&self.steel),
            poisson_ratio: wet.poisson_ratio,
            viscosity_pa_s: wet.shear_viscosity_pa_s,
        }))
    }
}

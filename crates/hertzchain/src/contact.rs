//! Hertz's contact of two bodies at its highest pressure.

use hertzchain_chain::laws::Nature;
use hertzchain_chain::{BeadPair, Chain, Section};
use hertzchain_experiment::Units;
use hertzchain_sim::{Group, Plan, Row, Shot, Value};
use serde::Serialize;
use std::f64::consts::PI;

/// Spheres of ν = 0.3 yield first, below the surface, where p₀ is so many times the yield strength
/// [Thornton1997].
const FIRST_YIELD: f64 = 1.6;

/// A contact at a force: circle and pressure of elastic spheres [Hertz1881].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct HertzContact {
    /// Number of the contact.
    pub(crate) contact: usize,
    /// The wall's largest force, the hardest contact's at its largest overlap, where losses are none.
    pub(crate) force_n: f64,
    /// Yield strength of the weaker ball, where it is known.
    pub(crate) material_yield_strength_pa: Option<f64>,
    /// Largest pressure, p₀ = 3 F/(2 π a²).
    pub(crate) pressure_pa: f64,
    /// Radius of the circle, a² = R* (F/K)^(2/3).
    pub(crate) radius_m: f64,
    /// Yield strength of the balls below which they yield at this force.
    pub(crate) yield_strength_pa: f64,
}

impl HertzContact {
    /// The wall's; `None` without a wall pulse, material or unit.
    pub(crate) fn of_wall(units: Units, plan: &Plan, shot: &Shot) -> Option<Self> {
        let contact = plan.chain.beads.len();
        let at_rest_n = plan.chain.system().ok()?.static_contact(contact).force_n;
        let force_n = at_rest_n + shot.passage.as_ref().ok()?.wall.value;
        Self::of(units, plan, (contact, force_n))
    }

    /// That of the highest pressure over its yield strength, where any is known; `None` without a material or unit.
    pub(crate) fn hardest(units: Units, plan: &Plan, shot: &Shot) -> Option<Self> {
        Self::of(units, plan, shot.hardest?)
    }

    fn of(units: Units, plan: &Plan, (contact, force_n): (usize, f64)) -> Option<Self> {
        // The pressure of a contact that has yielded is not Hertz's.
        let yields = |section: &Section| {
            let mut laws = section.laws.iter();
            let plastic = laws.any(|law| law.info().nature == Nature::ElasticPlastic);
            section.contacts.contains(&contact) && plastic
        };
        if plan.chain.sections.iter().any(yields) {
            return None;
        }
        let pair = plan.chain.pair(contact).filter(|_| units == Units::Si)?;
        Self::new((contact, &pair), force_n)
    }

    fn new((contact, pair): (usize, &BeadPair), force_n: f64) -> Option<Self> {
        let overlap_m = (force_n / pair.hertz_stiffness()).powf(2.0 / 3.0);
        let radius_m = (pair.radius_m * overlap_m).sqrt();
        let pressure_pa = 1.5 * force_n / (PI * radius_m * radius_m);
        let is_known = pressure_pa.is_finite() && pressure_pa > 0.0;
        is_known.then_some(Self {
            contact,
            force_n,
            radius_m,
            pressure_pa,
            yield_strength_pa: pressure_pa / FIRST_YIELD,
            material_yield_strength_pa: pair.yield_strength_pa(),
        })
    }
}

/// Force at which the first ball of a contact yields, (π p₀ R*/1.5)³/K² with p₀ of first yield.
fn first_yield_n(pair: &BeadPair) -> Option<f64> {
    let pressure_pa = FIRST_YIELD * pair.yield_strength_pa()?;
    let force_n = (PI * pressure_pa * pair.radius_m / 1.5).powi(3) / pair.hertz_stiffness().powi(2);
    Some(force_n).filter(|force_n| force_n.is_finite() && *force_n > 0.0)
}

/// The forces from which on contacts of a chain yield, where yield strengths are known.
pub(crate) fn first_yield(chain: &Chain) -> Option<Group> {
    let pairs = (0..=chain.beads.len()).filter_map(|contact| chain.pair(contact));
    let forces: Vec<f64> = pairs.filter_map(|pair| first_yield_n(&pair)).collect();
    let least = forces.iter().copied().reduce(f64::min)?;
    let most = forces.iter().copied().fold(least, f64::max);
    let value = match least == most {
        true => Value::Number(least),
        false => Value::Range(least, most),
    };
    let row = Row { name: "force of first yield".to_owned(), value, unit: "N".to_owned() };
    Some(Group { title: "Yield".to_owned(), rows: vec![row] })
}

#[cfg(test)]
#[path = "tests/contact.rs"]
mod tests;

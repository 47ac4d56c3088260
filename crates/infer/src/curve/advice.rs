//! What would tell confused parameters apart.

use super::problem::CurveProblem;
use crate::data::Observable;
use crate::free::Form;

impl CurveProblem {
    /// What could be measured or fixed so that the data determine more, most
    /// promising first: for a fit that leaves combinations open.
    #[must_use]
    pub fn would_separate(&self) -> Vec<String> {
        let mut advice = Vec::new();
        advice.extend(self.three_for_two());
        if !self.data().has(Observable::Reflected) {
            advice.push(
                "measure reflected times of flight: losses lengthen them more than incident ones"
                    .to_owned(),
            );
        }
        let ratios = [
            Observable::WallOverPassing,
            Observable::ReturningOverPassing,
        ];
        if !ratios.into_iter().any(|of| self.data().has(of)) {
            advice.push(
                "use ratios of peaks (--use incident,reflected,returning-ratio): they fall with \
                 losses and hardly change with stiffness"
                    .to_owned(),
            );
        }
        if self.data().rows.len() < FEW_SPEEDS {
            advice.push("measure at more speeds, slow and fast ones".to_owned());
        }
        advice.push("add a preload: a stiffer row weighs the same numbers otherwise".to_owned());
        advice
    }

    /// Young modulus, Poisson ratio and viscosity of one material enter
    /// through two numbers of its contacts alone.
    fn three_for_two(&self) -> Option<String> {
        let numbers = self.model().numbers().as_slice();
        let constant = numbers.iter().filter(|n| n.form() != Form::EachSpeed);
        let owners: Vec<(&str, &str)> = constant
            .filter_map(|number| number.material_number())
            .collect();
        let all = |owner: &str| {
            ["young_modulus", "poisson_ratio", "shear_viscosity"]
                .iter()
                .all(|number| owners.contains(&(owner, number)))
        };
        let (owner, _) = owners.iter().find(|(owner, _)| all(owner))?;
        Some(format!(
            "Young modulus, Poisson ratio and viscosity of `{owner}` enter only through K and A of \
             its contacts, three numbers for two: free K and A instead (--free K,A), or keep one of \
             the three fixed"
        ))
    }
}

/// With fewer speeds, more of them are the first thing to ask for.
const FEW_SPEEDS: usize = 5;

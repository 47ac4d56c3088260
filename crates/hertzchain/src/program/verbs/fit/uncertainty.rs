//! Figures of uncertainty: profiles, samples, and what the data determine.

use crate::fit::Inferred;
use hertzchain_figures::Figure;
use hertzchain_figures::inference::{Corner, ProfileCurve, SingularValues, profile_figure};
use hertzchain_infer::{Parameter, Posterior, Profile, RISE_OF_95_PERCENT};

fn labels(fit_result: &Inferred) -> Vec<String> {
    let label = |parameter: &Parameter| match parameter.unit.as_str() {
        "" => parameter.name.clone(),
        unit => format!("{} ({})", parameter.name, in_markup(unit)),
    };
    fit_result.parameters.iter().map(label).collect()
}

/// A unit with its powers raised: `N/m^(3/2)` as a figure shows it.
fn in_markup(unit: &str) -> String {
    let mut parts = unit.split('^');
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| {
        let (power, rest) = match part.strip_prefix('(').and_then(|part| part.split_once(')')) {
            Some(parts) => parts,
            None => part.split_at(part.find([' ', '/']).unwrap_or(part.len())),
        };
        format!("{text}$^{{{power}}}${rest}")
    })
}

/// Rise of chi-square along each parameter, beside the parabola that the
/// covariance stands for.
pub(super) fn profiles(fit_result: &Inferred, profiles: &[Profile]) -> Figure {
    let labels = labels(fit_result);
    let curves: Vec<ProfileCurve> = (profiles.iter())
        .map(|profile| ProfileCurve {
            label: &labels[profile.parameter],
            values: &profile.values,
            rise: &profile.rise,
            best: fit_result.fit.point[profile.parameter],
            standard_error: Some(fit_result.covariance.sd[profile.parameter]),
            levels: &[(1.0, "68 %"), (RISE_OF_95_PERCENT, "95 %")],
        })
        .collect();
    profile_figure(&curves)
}

/// The posterior of each parameter and pair, beside the covariance's.
pub(super) fn corner(fit_result: &Inferred, posterior: &Posterior) -> Figure {
    Corner {
        labels: &labels(fit_result),
        samples: &posterior.samples,
        marks: &fit_result.fit.point,
        covariance: &fit_result.covariance.matrix,
    }
    .figure()
}

/// Singular values of the Jacobian, each parameter in units of its scale.
pub(super) fn singular_values(fit_result: &Inferred) -> Figure {
    let found = &fit_result.identifiability;
    let names = fit_result.parameters.iter().map(|p| p.name.clone());
    SingularValues {
        names: &names.collect::<Vec<String>>(),
        values: &found.singular_values,
        directions: &found.directions,
        floor: found.floor,
    }
    .figure()
}

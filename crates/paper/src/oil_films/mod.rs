//! The paper's row with films of its oils, by the oils' own properties and without a fitted number.
//!
//! Beside it the same oils if pressure did not thicken them, the film with the one factor on all
//! viscosities that brings its ratios nearest to the paper's, and the paper's effective materials.

mod material;
mod report;
mod shots;

pub(crate) use self::material::{EffectiveMaterial, WetContact};

use self::shots::{FACTORS, FilmShots, FilmVariant};
use crate::claims::{EvaluatedClaim, Evaluator, Evidence, claims, evaluate_all};
use crate::reproduce::{Cases, Effort, Gathering, OILS, ReproduceError, ReproduceProgress, gather};
use hertzchain_experiment::Reading;

pub(crate) const SPEEDS_M_S: [f64; 5] = [0.075, 0.15, 0.3, 0.6, 1.2];

/// The paper's statements on oil that ratios of incident times decide, by their names.
const CLAIMS: [&str; 11] = [
    "oil-either-way",
    "pump-below",
    "pump-above",
    "pump-crosses-once",
    "gear-below",
    "motor-above",
    "pump-rises",
    "pump-rises-log",
    "pump-ends-higher",
    "pump-motor-ratios",
    "viscosity-no-simple-role",
];

/// Accuracy of the paper's own model, whose shots cost little.
const MODEL_ACCURACY: f64 = 1e-6;

/// Wet contacts of one kind at all speeds.
#[derive(Clone, Debug)]
pub(crate) struct OilModel {
    pub name: String,
    pub evidence: Evidence,
    pub evaluated: Vec<EvaluatedClaim>,
}

/// Wet over dry incident times of the paper's oils at 0.075 to 1.2 m/s.
#[derive(Clone, Debug)]
pub struct OilFilms {
    /// Films, films that pressure does not thicken, films with the common factor, and the paper's
    /// effective materials.
    pub(crate) models: [OilModel; 4],
    /// Least and largest ratio of films at each speed, oil by oil: over temperature and
    /// pressure–viscosity coefficient, and rounding of the printed viscosity and density.
    pub(crate) ranges: Vec<Vec<[f64; 2]>>,
    /// Common to all viscosities, by least squares of the ratios to the paper's model.
    pub factor: f64,
    /// What a fit of time and wall peak would take each film for.
    pub(crate) materials: Vec<EffectiveMaterial>,
}

impl OilFilms {
    /// Shoots all rows, films to this relative accuracy of times of flight.
    ///
    /// # Errors
    /// The first shot that can't be computed.
    pub fn compute(
        accuracy: f64,
        progress: &dyn ReproduceProgress,
    ) -> Result<Self, ReproduceError> {
        let cases = Cases::new(&Reading::default())?;
        let how = Gathering {
            cases: &cases,
            speeds_m_s: &SPEEDS_M_S,
            accuracy: MODEL_ACCURACY,
            effort: Effort::Lean(&[]),
        };
        let paper = gather(&how, None, &|| {})?;
        let shots = FilmShots::new((accuracy, &SPEEDS_M_S), cases.oils())?;
        let variants: Vec<FilmVariant> = FilmVariant::all().collect();
        let evidence = shots.run(&variants, "films of oil", progress)?;
        let of = |wanted: &FilmVariant| {
            let at = variants.iter().position(|variant| variant == wanted);
            at.and_then(|at| evidence.get(at)).cloned().unwrap_or_default()
        };
        let scaled: Vec<Evidence> = FACTORS.iter().map(|f| of(&FilmVariant::scaled(*f))).collect();
        let factor = nearest_factor(&scaled, &paper);
        let nearest = shots.run(&[FilmVariant::scaled(factor)], "with one factor", progress)?;
        let nearest = nearest.into_iter().next().unwrap_or_default();
        let corners: Vec<Evidence> = FilmVariant::corners().iter().map(of).collect();
        let film = of(&FilmVariant::USUAL);
        let evaluators = evaluators()?;
        let model = |name: &str, evidence: Evidence, draws: &[Evidence]| OilModel {
            name: name.to_owned(),
            evaluated: evaluate_all(&evaluators, &evidence, draws),
            evidence,
        };
        progress.begin("effective materials", (OILS.len() * SPEEDS_M_S.len()) as u64);
        Ok(Self {
            ranges: ranges(&corners, &scaled, &shots.rounding()?),
            materials: material::effective(&cases, &film, progress)?,
            models: [
                model("film", film, &corners),
                model("film, α = 0", of(&FilmVariant::ISOVISCOUS), &[]),
                model(&format!("film, η × {factor:.3}"), nearest, &[]),
                model("the paper's materials", paper, &[]),
            ],
            factor,
        })
    }

    /// Root mean square of a model's ratios less the paper's.
    fn residual(&self, model: &OilModel) -> f64 {
        let squares = squares(&incident(&model.evidence), &incident(&self.models[3].evidence));
        (squares / (OILS.len() * SPEEDS_M_S.len()) as f64).sqrt()
    }
}

fn evaluators() -> Result<Vec<Evaluator>, ReproduceError> {
    let all = claims()?.into_iter();
    Ok(all.filter(|own| CLAIMS.contains(&own.claim.id.as_str())).collect())
}

/// Incident ratios of all oils and speeds, oil by oil.
pub(crate) fn incident(evidence: &Evidence) -> Vec<f64> {
    let ratios = OILS.iter().flat_map(|case| evidence.ratios(case));
    ratios.map(|ratio| ratio.incident).collect()
}

fn squares(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// Ratios at a factor on all viscosities: Lagrange's polynomial in its logarithm through those
/// at [`FACTORS`].
fn at_factor(scaled: &[Vec<f64>], log: f64) -> Vec<f64> {
    let nodes = FACTORS.map(f64::ln);
    let weight = |own: usize| -> f64 {
        let others = (0..nodes.len()).filter(|other| *other != own);
        others.map(|other| (log - nodes[other]) / (nodes[own] - nodes[other])).product()
    };
    let weights: Vec<f64> = (0..nodes.len()).map(weight).collect();
    let count = scaled.first().map_or(0, Vec::len);
    let at = |place: usize| -> f64 {
        let own = scaled.iter().filter_map(|ratios| ratios.get(place));
        own.zip(&weights).map(|(ratio, weight)| ratio * weight).sum()
    };
    (0..count).map(at).collect()
}

/// The factor within [`FACTORS`] with the least squares, to a hundredth of itself.
fn nearest_factor(scaled: &[Evidence], paper: &Evidence) -> f64 {
    let (scaled, paper): (Vec<Vec<f64>>, _) =
        (scaled.iter().map(incident).collect(), incident(paper));
    let (least, most) = (FACTORS[0].ln(), FACTORS[FACTORS.len() - 1].ln());
    let tried = (0..=500).map(|step| least + (most - least) * f64::from(step) / 500.0);
    let cost = |log: &f64| squares(&at_factor(&scaled, *log), &paper);
    tried.min_by(|a, b| cost(a).total_cmp(&cost(b))).unwrap_or(0.0).exp()
}

/// Extremes over the corners, wider by what rounding of each oil's η does.
fn ranges(corners: &[Evidence], scaled: &[Evidence], rounding: &[f64]) -> Vec<Vec<[f64; 2]>> {
    let scaled: Vec<Vec<f64>> = scaled.iter().map(incident).collect();
    let step = 0.01;
    let slopes = at_factor(&scaled, step).into_iter().zip(at_factor(&scaled, -step));
    let slopes: Vec<f64> = slopes.map(|(up, down)| (up - down).abs() / (2.0 * step)).collect();
    let corners: Vec<Vec<f64>> = corners.iter().map(incident).collect();
    let range = |place: usize, rounding: f64| {
        let moved = rounding * slopes.get(place).copied().unwrap_or(0.0);
        let ratios = corners.iter().filter_map(|ratios| ratios.get(place).copied());
        let [least, most] = ratios
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], ratio| {
                [least.min(ratio), most.max(ratio)]
            });
        [least - moved, most + moved]
    };
    let speeds = SPEEDS_M_S.len();
    let oil = |(oil, rounding): (usize, &f64)| {
        (0..speeds).map(|speed| range(oil * speeds + speed, *rounding)).collect()
    };
    rounding.iter().enumerate().map(oil).collect()
}

#[cfg(test)]
#[path = "../../tests/oil_films.rs"]
mod tests;

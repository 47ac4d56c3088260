//! Shots of rows with films.

use crate::claims::{Curve, Evidence, PrintedOil, ShotPoint};
use crate::reproduce::{OILS, ReproduceError, ReproduceProgress, failed, plan, read_off};
use hertzchain_experiment::{Experiment, preset};
use hertzchain_sim::shoot;
use rayon::prelude::*;

/// Pressure–viscosity coefficients in 1/Pa of each of [`OILS`]: least, largest, none. Mineral
/// oils at 20 to 40 °C have 15 to 25, poly-α-olefins (a 0W-30) 10 to 15 1/GPa, and the
/// reciprocal asymptotic one, which builds the film, is some tenths less.
const THICKENING_PER_PA: [[f64; 3]; 3] =
    [[12e-9, 20e-9, 0.0], [12e-9, 22e-9, 0.0], [8e-9, 15e-9, 0.0]];

/// Temperatures in K that the paper's room may have had, beside the presets' 25 °C.
const ROOMS_K: [f64; 2] = [293.15, 313.15];

/// Factors on all viscosities between which ratios are interpolated.
pub(super) const FACTORS: [f64; 3] = [0.05, 0.22, 1.0];

/// How the oils of a row differ from the presets'.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FilmVariant {
    temperature_k: Option<f64>,
    /// Column of [`THICKENING_PER_PA`].
    thickening: Option<usize>,
    /// On all viscosities.
    factor: f64,
}

impl FilmVariant {
    pub(super) const USUAL: Self = Self { temperature_k: None, thickening: None, factor: 1.0 };
    pub(super) const ISOVISCOUS: Self = Self { thickening: Some(2), ..Self::USUAL };

    pub(super) const fn scaled(factor: f64) -> Self {
        Self { factor, ..Self::USUAL }
    }

    /// Cold oil that thickens most, and warm oil that thickens least: times fall with both.
    pub(super) fn corners() -> [Self; 2] {
        [(0, 1), (1, 0)].map(|(room, column)| Self {
            temperature_k: Some(ROOMS_K[room]),
            thickening: Some(column),
            factor: 1.0,
        })
    }

    /// All but the nearest to the paper.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let scaled = FACTORS.into_iter().map(Self::scaled);
        scaled.chain([Self::ISOVISCOUS]).chain(Self::corners())
    }

    fn experiment(&self, oil: usize) -> Result<Experiment, ReproduceError> {
        let mut film = film(oil)?;
        if let Some(kelvin) = self.temperature_k {
            film = film.set(&[("liquid.temperature", kelvin)])?;
        }
        if let Some(column) = self.thickening {
            film = film.set(&[("liquid.pressure_viscosity", THICKENING_PER_PA[oil][column])])?;
        }
        let viscosity = film.liquid().and_then(|liquid| liquid.dynamic_viscosity_pa_s());
        let viscosity = viscosity.unwrap_or(f64::NAN) * self.factor;
        Ok(film.set(&[("film_entrained.viscosity", viscosity)])?)
    }
}

fn film(oil: usize) -> Result<Experiment, ReproduceError> {
    preset(&format!("{}-film", OILS[oil])).map_err(ReproduceError::Preset)
}

/// Push on bead 1 in N of the rows with films, and of those beside them.
fn push_n() -> Result<f64, ReproduceError> {
    Ok(film(0)?.get("near_end.force")?)
}

/// How rows with films are shot, and the dry row beside them.
pub(super) struct FilmShots {
    accuracy: f64,
    dry: Curve,
    oils: Vec<PrintedOil>,
}

impl FilmShots {
    pub(super) fn new(
        (accuracy, speeds_m_s): (f64, &[f64]),
        oils: Vec<PrintedOil>,
    ) -> Result<Self, ReproduceError> {
        let dry = preset("dry").map_err(ReproduceError::Preset)?.with_push(push_n()?)?;
        let point = |speed: &f64| point(&dry, ("dry", *speed), accuracy, None);
        let points = speeds_m_s.par_iter().map(point).collect::<Result<_, _>>()?;
        Ok(Self { accuracy, dry: Curve { case: "dry".to_owned(), points }, oils })
    }

    /// One set of curves a variant.
    pub(super) fn run(
        &self,
        variants: &[FilmVariant],
        stage: &str,
        progress: &dyn ReproduceProgress,
    ) -> Result<Vec<Evidence>, ReproduceError> {
        let (oils, speeds) = (OILS.len(), self.dry.points.len());
        let jobs = variants.len() * oils * speeds;
        progress.begin(stage, jobs as u64);
        let shot = |job: usize| {
            let (variant, oil) = (variants[job / (oils * speeds)], job / speeds % oils);
            let dry = &self.dry.points[job % speeds];
            // Oil in 34 of 40 contacts: the wall's peak is over well before.
            let duration_s = Some(1.4 * dry.tof_incident_s);
            let at = (OILS[oil], dry.speed_m_s);
            let point = point(&variant.experiment(oil)?, at, self.accuracy, duration_s);
            progress.advance();
            point
        };
        let points: Vec<ShotPoint> =
            (0..jobs).into_par_iter().map(shot).collect::<Result<_, ReproduceError>>()?;
        let evidence = |points: &[ShotPoint]| {
            let curves = OILS.iter().zip(points.chunks(speeds));
            let curves = curves
                .map(|(case, points)| Curve { case: (*case).to_owned(), points: points.to_vec() });
            let curves = std::iter::once(self.dry.clone()).chain(curves).collect();
            Evidence { curves, oils: self.oils.clone(), ..Evidence::default() }
        };
        Ok(points.chunks(oils * speeds).map(evidence).collect())
    }

    /// Half a unit of the last printed digit of each oil's η over η.
    pub(super) fn rounding(&self) -> Result<Vec<f64>, ReproduceError> {
        let half = |film: &Experiment, path: &str| {
            let place = film.place(path)?;
            Ok::<_, ReproduceError>(place.half_digit / place.value.unwrap_or(f64::NAN))
        };
        let of = |oil| {
            let film = film(oil)?;
            Ok(half(&film, "liquid.kinematic_viscosity_40")? + half(&film, "liquid.density")?)
        };
        (0..OILS.len()).map(of).collect()
    }
}

fn point(
    experiment: &Experiment,
    (case, speed_m_s): (&str, f64),
    accuracy: f64,
    duration_s: Option<f64>,
) -> Result<ShotPoint, ReproduceError> {
    let mut plan = plan(experiment, speed_m_s, accuracy)?.for_flights();
    plan.duration_s = duration_s;
    let shot = shoot(&plan).map_err(|error| failed(case, speed_m_s, error))?;
    Ok(read_off(&plan, speed_m_s, &shot))
}

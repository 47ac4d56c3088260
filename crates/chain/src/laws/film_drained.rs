use super::{Closed, ContactState, LawError, LawInfo, Nature, Parameter, Source, Term};
use crate::material::BeadPair;
use std::f64::consts::PI;

/// Oil between bodies that start apart: a film of thickness u that drains between rigid spheres
/// [Reynolds1886] and, as they flatten by w = δ + u, like Stefan's disc.
///
/// F = K w^{3/2} = (6πη R*² |u̇|/u) (1 + A y + y²) X², y = w/(2u), while it is pressed; oil that is drawn
/// cavitates and pulls nothing. X = 1 − 1/√(1 + V/(πR* u²)) is what a volume V leaves of a flooded gap [Pitois2000].
/// 1 and y² are the limits of rigid spheres and of a disc; A, a pure number, is fitted to a transient
/// elastohydrodynamic contact (`bench/film`).
///
/// While w is below 1 % of the gap, the bodies count as rigid: u = −δ. The law never creates energy: F δ̇ is the
/// change of (2/5) K w^{5/2} plus F |u̇|. A contact that touches at the start is dry until it parts.
#[derive(Clone, Debug)]
pub(super) struct FilmDrained {
    viscosity_pa_s: f64,
    volume_m3: f64,
    stiffness: Option<f64>,
}

/// A: how a flattening film resists, between a sphere's and a disc's.
const FLATTENING: f64 = 5.5;

/// Flattening over film from which on bodies are elastic.
const RIGID: f64 = 0.01;

impl Term<4> for FilmDrained {
    const INFO: LawInfo = LawInfo {
        name: "film_drained",
        equation: "F = K w^{3/2} − K max(δ, 0)^{3/2},  w = δ + u,  \
                   u̇ = −u K w^{3/2}/(6πη R*² X² (1 + 5.5 y + y²)),  y = w/(2u),  \
                   X = 1 − 1/√(1 + V/(πR* u²));  while w would be below u/100: u = −δ, F = 6πη R*² X² max(δ̇, 0)/u",
        parameters: &[
            Parameter {
                name: "viscosity",
                unit: "Pa s",
                meaning: "viscosity η of the oil",
                source: Source::Liquid,
                least: 0.0,
            },
            Parameter {
                name: "volume",
                unit: "m^3",
                meaning: "volume V of the oil in the contact; flooded without one",
                source: Source::Default(f64::INFINITY),
                least: 0.0,
            },
            Parameter {
                name: "stiffness",
                unit: "N/m^1.5",
                meaning: "stiffness K of the Hertz contact that the oil is in",
                source: Source::Hertz,
                least: 0.0,
            },
        ],
        validity: "beside elastic_hertz, for bodies that start apart with oil between them, 10 to 300 times the speed \
                   that the oil stops; Newtonian isothermal oil that pressure does not thicken",
        reference: "Reynolds1886",
        nature: Nature::WithState,
        gated: false,
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self {
            viscosity_pa_s: values[0].unwrap_or(f64::NAN),
            volume_m3: values[1].unwrap_or(f64::INFINITY),
            stiffness: values[2],
        }
    }

    fn coefficients(&self, pair: &BeadPair) -> Result<[f64; 4], LawError> {
        let stiffness = self.stiffness.unwrap_or_else(|| pair.hertz_stiffness());
        let drag = 6.0 * PI * self.viscosity_pa_s * pair.radius_m * pair.radius_m;
        Ok(match self.volume_m3 > 0.0 {
            true => [stiffness, drag, PI * pair.radius_m / self.volume_m3, pair.radius_m],
            false => [stiffness, 0.0, 0.0, pair.radius_m],
        })
    }

    /// At rest the contact is Hertz's: all force is that of the state.
    fn force(_k: &[f64; 4], _contact: Closed) -> f64 {
        0.0
    }

    fn state(k: &[f64; 4]) -> Option<Box<dyn ContactState>> {
        let &[stiffness, drag, per_area, radius] = k;
        (drag > 0.0 && stiffness > 0.0).then(|| -> Box<dyn ContactState> {
            let regime = Regime::Dry;
            Box::new(DrainedFilm { stiffness, drag, per_area, radius, regime, flattened: 0.0 })
        })
    }
}

/// How the bodies of one contact meet.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Regime {
    /// They have touched since the start.
    Dry,
    /// Oil fills the gap between bodies that it does not flatten.
    Rigid,
    /// Oil flattens them: w is integrated.
    Elastic,
}

/// One contact with oil. Its number is the flattening w in m.
#[derive(Clone, Debug)]
struct DrainedFilm {
    stiffness: f64,
    /// 6πη R*².
    drag: f64,
    /// πR*/V.
    per_area: f64,
    radius: f64,
    regime: Regime,
    /// w at the start of the step, or what it would be of rigid bodies.
    flattened: f64,
}

/// Films thinner than this part of R* are not there.
const NO_FILM: f64 = 1e-12;

impl DrainedFilm {
    fn hertz(&self, flattening: f64) -> f64 {
        let w = flattening.max(0.0);
        self.stiffness * w * w.sqrt()
    }

    /// 6πη R*² X² of a film.
    fn drag(&self, film: f64) -> f64 {
        let left = 1.0 - (1.0 + (self.per_area * film * film).recip()).sqrt().recip();
        self.drag * left * left
    }

    /// Force of rigid bodies across the gap.
    fn rigid(&self, contact: Closed) -> f64 {
        let film = (-contact.overlap).max(NO_FILM * self.radius);
        self.drag(film) * contact.rate.max(0.0) / film
    }

    /// Flattening of almost rigid bodies over its largest.
    fn nearness(&self, contact: Closed) -> (f64, f64) {
        let film = (-contact.overlap).max(NO_FILM * self.radius);
        ((self.rigid(contact) / self.stiffness).cbrt().powi(2), RIGID * film)
    }

    /// Falls below 0 where oil flattens bodies that it did not before.
    fn until_elastic(&self, contact: Closed) -> f64 {
        let (flattening, largest) = self.nearness(contact);
        1.0 - flattening / largest
    }
}

impl ContactState for DrainedFilm {
    fn begin(&mut self, overlap_m: f64) {
        self.regime = if overlap_m < 0.0 { Regime::Rigid } else { Regime::Dry };
        self.flattened = 0.0;
    }

    fn acts_across(&self) -> bool {
        true
    }

    fn force_and_rates(&self, [w, ..]: [f64; 4], contact: Closed) -> (f64, [f64; 4]) {
        match self.regime {
            Regime::Dry => (0.0, [0.0; 4]),
            Regime::Rigid => (self.rigid(contact), [0.0; 4]),
            Regime::Elastic => {
                let film = (w - contact.overlap).max(NO_FILM * self.radius);
                let (force, y) = (self.hertz(w), 0.5 * w.max(0.0) / film);
                let drained = force * film / (self.drag(film) * (1.0 + y * (FLATTENING + y)));
                (force - self.hertz(contact.overlap), [contact.rate - drained, 0.0, 0.0, 0.0])
            }
        }
    }

    fn energy_j(&self, _numbers_m: [f64; 4], overlap_m: f64) -> f64 {
        let energy = |w: f64| 0.4 * self.hertz(w) * w;
        match self.regime {
            Regime::Dry => 0.0,
            Regime::Rigid => energy(self.flattened),
            Regime::Elastic => energy(self.flattened) - energy(overlap_m),
        }
    }

    fn until_change(&self, [w, ..]: [f64; 4], contact: Closed) -> f64 {
        match self.regime {
            Regime::Dry => 1.0,
            Regime::Rigid => self.until_elastic(contact),
            Regime::Elastic => w / self.flattened.max(NO_FILM * self.radius),
        }
    }

    fn accept(&mut self, [w, ..]: [f64; 4], contact: Closed) -> ([f64; 4], bool) {
        let was = self.regime;
        self.regime = match was {
            Regime::Dry if contact.overlap < 0.0 => Regime::Rigid,
            Regime::Rigid if self.until_elastic(contact) <= TURNS => Regime::Elastic,
            Regime::Elastic if w <= TURNS * self.flattened => Regime::Rigid,
            regime => regime,
        };
        self.flattened = match (was, self.regime) {
            (_, Regime::Dry) => 0.0,
            (Regime::Elastic, Regime::Elastic) => w,
            // Bodies that start closer begin almost rigid.
            _ => {
                let (flattening, largest) = self.nearness(contact);
                flattening.min(largest)
            }
        };
        let number = if self.regime == Regime::Elastic { self.flattened } else { 0.0 };
        ([number, 0.0, 0.0, 0.0], was != self.regime)
    }

    fn boxed(&self) -> Box<dyn ContactState> {
        Box::new(self.clone())
    }
}

/// What counts as 0 where a regime ends: a step that ends there ends a little before or after.
const TURNS: f64 = 1e-6;

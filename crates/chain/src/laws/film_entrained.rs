use super::{Closed, ContactState, LawError, LawInfo, Nature, Parameter, Source, Term};
use crate::material::BeadPair;
use std::f64::consts::PI;

/// What oil in a pressed contact adds to Hertz's force: a film that the growing edge entrains as the
/// inlet of an elastohydrodynamic contact does [Snoeijer2013], and a squeezed rim.
///
/// With K of Hertz, E* = 3K/(4 √R*), contact radius a and the overlap δ_e(s) at which the edge
/// passed radius s (without oil s²/R*; oil leaves a film of s²/R* − δ_e that stays),
///
/// F = 2E* (a δ − ∫_0^a δ_e ds + κ a y) − K δ^{3/2},  a² = R* (δ + β y) where a grows with y > 0;
///
/// the squeezed rim y relaxes, ẏ = δ̇ − (2E*/η) (κ a y / (c R*^{1.4} (R* y/a²)^g (R*/a)^e))^{5/3} − y ȧ/(2a), to
/// y = 0 at least: oil that is drawn cavitates. Viscosity η exp(α p): with x = α k E* (β a y/R*²)^{1/3} and
/// G = x/(1 − e^{−x}), β becomes β G^n and η becomes η G^m (1 + l α E* a/R*).
/// c, β, κ, g, e, k, m, n, l are pure numbers, fitted to a transient elastohydrodynamic contact
/// (`bench/film`), not to measurements.
///
/// A volume V of oil ends at a meniscus. The oil beyond, which is missing, would bear 12 η δ̇ ∫ W²/(2πr h³) dr
/// with Hertz's gap h and W = ∫ (1 − (2/π) arcsin(a/r)) 2πr dr: by its share D of the rim's force, κ becomes
/// φ κ, φ about e^{−D}. Where the oil outside, v a⁴/R*, hardly fills the inlet, β becomes s β. The rim's
/// force is ψ = 1 − e^{−v/0.01} of this: without oil the contact is Hertz's.
///
/// The law never creates energy: F δ̇ is the change of E* (∫_0^a (δ − δ_e)² ds + ψ κ a y²) − (2/5) K δ^{5/2} plus
/// a loss in the rim that is not negative, as ψ does not rise before the rim is relaxed. A contact starts
/// dry, at rest, and again after each gap.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmEntrained {
    /// Viscosity η in Pa s at ambient pressure.
    pub viscosity_pa_s: f64,
    /// Pressure–viscosity coefficient α in 1/Pa.
    pub pressure_viscosity_per_pa: f64,
    /// Volume V in m³ of the oil in the contact; infinite where it is flooded.
    pub volume_m3: f64,
    /// Stiffness K in N/m^{3/2} of the `elastic_hertz` beside it; `None`: from the materials.
    pub stiffness: Option<f64>,
}

/// c, g and e: the rim's resistance, and how it follows the rim's width and the contact's.
const RIM: [f64; 3] = [3.125, 0.0389, 0.05852];
/// β: film that the edge leaves over the rim's overlap.
const LEFT: f64 = 0.4871;
/// κ: the rim's stiffness.
const STIFF: f64 = 0.6664;
/// k, m and n: pressure of an inlet, and how viscosity and film follow it.
const PRESSURE: [f64; 3] = [2.47, -0.2138, 0.5311];
/// l: how viscosity at the rim follows the pressure in the contact.
const DEEP: f64 = 0.01202;

/// J near the edge and far away, to the power −0.8.
const J: [f64; 2] = [0.08922, 0.05819];
/// Least φ.
const LEAST: f64 = 0.1;
/// Oil that fills the inlet of a film of 3 % of a²/R*, in a⁴/R*.
const INLET: f64 = 0.01;

impl Term<5> for FilmEntrained {
    const INFO: LawInfo = LawInfo {
        name: "film_entrained",
        equation: "F = 2 E* (a δ − ∫ δ_e ds + κ a y) − K δ^{3/2},  a² = R* (δ + β y),  \
                   ẏ = δ̇ − (2 E*/η) (κ a y/(c R*^{1.4} (R* y/a²)^g (R*/a)^e))^{5/3} − y ȧ/(2a) for y > 0;  \
                   E* = 3 K/(4 √R*)",
        parameters: &[
            Parameter {
                name: "viscosity",
                unit: "Pa s",
                meaning: "viscosity η of the oil at ambient pressure",
                source: Source::Liquid,
                least: 0.0,
            },
            Parameter {
                name: "pressure_viscosity",
                unit: "1/Pa",
                meaning: "pressure–viscosity coefficient α of η exp(α p); that of [liquid], else 0",
                source: Source::Default(0.0),
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
        validity: "beside elastic_hertz, in contacts that are pressed or touch before the shot, flooded or with three \
                   times the oil that they trap; \
                   Newtonian isothermal oil, overlaps of 1 to 12 µm of steel balls, 0.03 to 0.3 Pa s, α up to 20 1/GPa",
        reference: "Snoeijer2013",
        nature: Nature::WithState,
        gated: true,
    };

    fn new(values: &[Option<f64>]) -> Self {
        Self {
            viscosity_pa_s: values[0].unwrap_or(f64::NAN),
            pressure_viscosity_per_pa: values[1].unwrap_or(0.0),
            volume_m3: values[2].unwrap_or(f64::INFINITY),
            stiffness: values[3],
        }
    }

    fn coefficients(&self, pair: &BeadPair) -> Result<[f64; 5], LawError> {
        let stiffness = self.stiffness.unwrap_or_else(|| pair.hertz_stiffness());
        let modulus = 0.75 * stiffness / pair.radius_m.sqrt();
        let (viscosity, alpha) = (self.viscosity_pa_s, self.pressure_viscosity_per_pa);
        // 0 is flooded: coefficients are finite.
        Ok(match self.volume_m3 > 0.0 {
            true => [modulus, pair.radius_m, viscosity, alpha, self.volume_m3.recip()],
            false => [modulus, pair.radius_m, 0.0, 0.0, 0.0],
        })
    }

    /// At rest the contact is Hertz's: all force is that of the state.
    fn force(_k: &[f64; 5], _contact: Closed) -> f64 {
        0.0
    }

    fn state(k: &[f64; 5]) -> Option<Box<dyn ContactState>> {
        let &[modulus, radius, viscosity, alpha, per_volume] = k;
        // Without oil, or without elasticity, nothing is entrained.
        (viscosity > 0.0 && modulus > 0.0).then(|| -> Box<dyn ContactState> {
            let (speed, reach) = (viscosity / (2.0 * modulus), radius.powf(1.4));
            let inlet = alpha * PRESSURE[0] * modulus * (LEFT / (radius * radius)).cbrt();
            Box::new(EntrainedFilm {
                radius,
                modulus,
                relaxing: (STIFF / (RIM[0] * reach)).powf(5.0 / 3.0) / speed,
                inlet,
                deep: DEEP * alpha * modulus / radius,
                meniscus: 6.0 / PI * (STIFF * radius).cbrt().powi(2) * RIM[0].powf(-5.0 / 3.0),
                volume: per_volume.recip(),
                rings: vec![Ring::default()],
                advances: true,
                drawn: false,
                rate: 0.0,
                film: 0.0,
                steep: 2.0,
                wet: 1.0,
            })
        })
    }
}

/// What the edge left at one radius. The spacer's force is 2E* ∫ a dδ along the edge's way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Ring {
    /// Radius a in m.
    radius: f64,
    /// Overlap δ_e in m when the edge passed.
    overlap: f64,
    /// ∫ a dδ up to there, in m².
    push: f64,
    /// ∫∫ a dδ dδ up to there, in m³: half the energy over E*.
    work: f64,
    /// ∫ a² dδ up to there, in m³.
    swept: f64,
}

impl Ring {
    /// The edge at an overlap between this ring and the next: its radius rises as a power of the
    /// overlap, such that `push` is right at both. Beyond the last ring the radius stays.
    fn towards(self, outer: Option<&Self>, overlap: f64) -> Self {
        let (rise, past) =
            (outer.map_or(0.0, |outer| outer.overlap - self.overlap), overlap - self.overlap);
        let wide = outer.map_or(0.0, |outer| outer.radius - self.radius);
        let mean = match outer {
            Some(outer) if wide > 0.0 => ((outer.push - self.push) / rise - self.radius) / wide,
            _ => 0.5,
        };
        let mean = mean.clamp(0.02, 0.98);
        let more = match wide > 0.0 {
            true => wide * (past / rise).powf((1.0 - mean) / mean),
            false => 0.0,
        };
        let swept =
            self.radius * (self.radius + 2.0 * more * mean) + more * more * mean / (2.0 - mean);
        let push = (self.radius + more * mean) * past;
        let work = self.push + past * (0.5 * self.radius + more * mean * mean / (1.0 + mean));
        let radius = self.radius + more;
        let (push, work) = (self.push + push, self.work + past * work);
        Self { radius, overlap, push, work, swept: self.swept + swept * past }
    }
}

/// What a limited volume leaves of a flooded contact.
#[derive(Clone, Copy)]
struct Supply {
    /// φ: of the rim's stiffness.
    share: f64,
    /// s: of the fresh film.
    film: f64,
    /// Oil around the contact in a⁴/R*.
    outside: f64,
}

impl Supply {
    const FLOODED: Self = Self { share: 1.0, film: 1.0, outside: f64::INFINITY };

    /// Of a film β G^n y in units of a²/R*, oil around the contact in a⁴/R*, and D over J.
    fn new(film: f64, outside: f64, scale: f64) -> Self {
        // J = ∫ W²/(ξ h³) dξ from the meniscus on is 20.5 v^−0.2 near the edge and 35.0 v^−0.5 far away;
        // between, within 4 %.
        let logarithm = outside.ln();
        let root = (0.08 * logarithm).exp();
        let lacking = scale * (root * root * J[0] + root.powi(5) * J[1]).powf(-1.25);
        // Over the gap of Hertz the film takes oil too, on the area up to the meniscus, and w^2.5 + z w = 1
        // for the width w of the wetted ring.
        let ring = 1.6 * PI * 0.643 * root.powi(5) + 1.6 * (PI * outside).sqrt();
        let taken = (1.63 * (film * ring / outside).ln()).exp();
        let share = |wide: f64| LEAST + (1.0 - LEAST) * (-lacking * wide / (1.0 - LEAST)).exp();
        let mut rim = share((1.0 + taken).powf(0.306));
        // The rim's overlap is larger by 1/√φ.
        for _ in 0..2 {
            let softer = -rim.ln();
            let wider = 1.0 + taken * (0.815 * softer).exp();
            rim = share((0.306 * wider.ln() + softer / 3.0).exp());
        }
        // Half the ring at the edge in which the gap is less than the film.
        let inlet = PI * film * (film / 1.2).cbrt().powi(2);
        let film = -(-outside * rim / inlet.max(f64::MIN_POSITIVE)).exp_m1();
        Self { share: rim, film, outside }
    }

    /// ψ: of the rim's force.
    fn wet(&self) -> f64 {
        -(-self.outside / INLET).exp_m1()
    }
}

/// The edge of a contact that grows.
struct Reach {
    /// Radius a in m.
    radius: f64,
    /// Fresh film over u: s β G^n √(R*/(φ a)).
    film: f64,
    /// 3 d ln (film over u)/d ln u at constant a of a flooded contact: n x G′/G.
    slope: f64,
    supply: Supply,
    /// Slope of a − R* (δ + fresh film)/a.
    steep: f64,
    /// Cube root of a y, and G, where an oil thickens.
    of_rim: Option<(f64, f64)>,
}

impl Reach {
    /// Where no film is left.
    fn dry(radius: f64) -> Self {
        Self { radius, film: 0.0, slope: 0.0, supply: Supply::FLOODED, steep: 2.0, of_rim: None }
    }
}

/// One contact with oil. Its numbers are u = y √(a/R*), whose rate √(a/R*) (δ̇ − loss) has neither ȧ nor
/// a pole at a = 0, and, since the last ring, ∫ a dδ/(0.02 R*), ∫∫ a dδ dδ/(0.02 R*)² and, of a limited
/// volume, ∫ a² dδ/(0.02 R*)², all in m.
#[derive(Clone, Debug)]
struct EntrainedFilm {
    radius: f64,
    modulus: f64,
    /// (2E*/η) (κ/(c R*^{1.4}))^{5/3}.
    relaxing: f64,
    /// x over (a y)^{1/3}.
    inlet: f64,
    /// l α E*/R*.
    deep: f64,
    /// D/J over (a y)^{2/3}/a² and `giving_way`.
    meniscus: f64,
    /// V.
    volume: f64,
    /// What the edge left, inner rings first; δ_e rises outward.
    rings: Vec<Ring>,
    /// Whether the edge advances at the start of the step; else it is held by what it left.
    advances: bool,
    /// Whether the rim is drawn there; else u is above 0 or about to be.
    drawn: bool,
    /// Overlap rate there.
    rate: f64,
    /// Fresh film over u there.
    film: f64,
    /// Slope of the edge's equation there.
    steep: f64,
    /// Least ψ since the rim was last relaxed: a ψ that rises would create energy.
    wet: f64,
}

/// Makes errors of ∫ a dδ errors of an overlap: a contact's radius over R*.
const SPAN: f64 = 0.02;

/// Growth below which an edge turns: a step that ends there ends a little before or after.
const TURNS: f64 = 1e-6;

/// Rim over R* that counts as relaxed, over `TURNS`.
const SLIGHT: f64 = 1e-6;

/// Part of u over which a slope is taken.
const SLOPE: f64 = 1e-4;

impl EntrainedFilm {
    /// The rim of area a y = c³ of oil that thickens: G and x G′/G there.
    fn thickening(&self, root_of_rim: f64) -> (f64, f64) {
        let x = self.inlet * root_of_rim;
        if x < 1e-9 {
            return (1.0, 0.0);
        }
        let less = -(-x).exp_m1();
        (x / less, 1.0 - x * (1.0 - less) / less)
    }

    /// What the widths of rim and contact and thickened oil make of the rate at which a rim a y relaxes:
    /// (R* y/a²)^{−5g/3} (R*/a)^{−5e/3} G^{−m}/(1 + l α E* a/R*).
    fn giving_way(&self, rim: f64, a: f64, thick: f64) -> f64 {
        let narrow = (rim.max(f64::MIN_POSITIVE) * self.radius / (a * a * a)).ln();
        let resisting = RIM[1] * narrow + RIM[2] * (self.radius / a).ln();
        let thicker = if self.inlet > 0.0 { PRESSURE[1] * thick.ln() } else { 0.0 };
        (-5.0 / 3.0 * resisting - thicker).exp() / (1.0 + self.deep * a)
    }

    /// What the volume leaves of a contact with its edge at radius a, at (δ, ∫ a² dδ).
    fn supply(&self, unknown: f64, a: f64, (overlap, swept): (f64, f64)) -> Supply {
        let r = self.radius;
        if self.volume == f64::INFINITY || a < SLIGHT * r {
            return Supply::FLOODED;
        }
        // ∫ (s²/R* − δ_e) 2πs ds is what the contact has trapped.
        let trapped = PI * (a * a * (0.5 * a * a / r - overlap) + swept);
        let outside = ((self.volume - trapped) * r / a.powi(4)).max(SLIGHT);
        if unknown <= 0.0 {
            return Supply { outside, ..Supply::FLOODED };
        }
        let rim = unknown * (a * r).sqrt();
        let root = rim.cbrt();
        let thick = self.thickening(root).0;
        let film = LEFT * thick.powf(PRESSURE[2]) * rim * r / a.powi(3);
        let share = self.meniscus * root * root / (a * a) * self.giving_way(rim, a, thick);
        Supply::new(film, outside, share)
    }

    /// An edge at radius a, wherever a² = R* (δ + fresh film) has it.
    fn edge(&self, unknown: f64, a: f64, at: (f64, f64)) -> Reach {
        let supply = self.supply(unknown, a, at);
        let cube_root = (unknown * (a * self.radius / supply.share).sqrt()).cbrt();
        let (thick, steepness) = self.thickening(cube_root);
        let film = supply.film * LEFT * (self.radius / (supply.share * a)).sqrt();
        let of_rim = (self.inlet > 0.0).then_some((cube_root, thick));
        let (film, slope) = (film * thick.powf(PRESSURE[2]), PRESSURE[2] * steepness);
        Reach { radius: a, film, slope, supply, steep: self.steep, of_rim }
    }

    /// Solves a² = R* (δ + fresh film) at (δ, ∫ a² dδ), from the film of the last step.
    fn reach(&self, unknown: f64, root: f64, swept: f64) -> Reach {
        if unknown <= 0.0 || self.volume == f64::INFINITY || self.film == 0.0 {
            let flooded = self.reach_flooded(unknown, root);
            if self.volume == f64::INFINITY || flooded.radius == 0.0 {
                return flooded;
            }
            return self.reach_from(flooded.radius, unknown, (root * root, swept));
        }
        let film = self.film * unknown;
        self.reach_from((self.radius * (root * root + film)).sqrt(), unknown, (root * root, swept))
    }

    /// Solves it by secants from a radius: the further out the edge, the less oil is left for a film.
    fn reach_from(&self, from: f64, unknown: f64, at: (f64, f64)) -> Reach {
        let mut reach = self.edge(unknown, from, at);
        let beyond = |reach: &Reach| {
            reach.radius - self.radius * (at.0 + reach.film * unknown.max(0.0)) / reach.radius
        };
        let (mut off, mut steep) = (beyond(&reach), self.steep);
        for _ in 0..40 {
            let step = off / steep;
            if step.abs() <= 1e-12 * reach.radius {
                break;
            }
            reach = self.edge(unknown, reach.radius - step, at);
            // A secant of a step of 1e-9 ends within 1e-12.
            if step.abs() <= 1e-9 * reach.radius {
                break;
            }
            let now = beyond(&reach);
            (off, steep) = (now, ((off - now) / step).clamp(1.0, 20.0));
        }
        Reach { steep, ..reach }
    }

    /// Solves a² = R* (δ + β G^n u √(R*/a)) by Newton in √a.
    fn reach_flooded(&self, unknown: f64, root: f64) -> Reach {
        let root_radius = self.radius.sqrt();
        let dry = root_radius * root;
        if unknown <= 0.0 {
            return Reach::dry(dry);
        }
        let (level, thin) = (dry * dry, LEFT * self.radius * root_radius);
        let mut q = (level + self.radius * self.film * unknown).sqrt().sqrt();
        if q == 0.0 {
            q = (thin * unknown).powf(0.2);
        }
        if q == 0.0 {
            return Reach::dry(0.0);
        }
        for _ in 0..30 {
            let (mut film, mut slope, mut of_rim) = (thin, 0.0, None);
            if self.inlet > 0.0 {
                let cube_root = (unknown * q * root_radius).cbrt();
                let (thick, steepness) = self.thickening(cube_root);
                film *= thick.powf(PRESSURE[2]);
                (slope, of_rim) = (PRESSURE[2] * steepness, Some((cube_root, thick)));
            }
            let (fourth, fresh) = (q * q * q * q, film * unknown);
            let steep = 5.0 * fourth - level - slope * fresh / (3.0 * q);
            let step = ((fourth - level) * q - fresh) / steep;
            q -= step;
            of_rim = of_rim.map(|(cube_root, thick)| (cube_root * (1.0 - step / (3.0 * q)), thick));
            // Convergence is quadratic: 1e-12 is left.
            if step.abs() <= 1e-6 * q {
                let film = film / (self.radius * q);
                return Reach {
                    radius: q * q,
                    film,
                    slope,
                    supply: Supply::FLOODED,
                    steep: 2.0,
                    of_rim,
                };
            }
        }
        Reach { film: f64::NAN, ..Reach::dry(f64::NAN) }
    }

    fn outer(&self) -> Ring {
        self.rings.last().copied().unwrap_or_default()
    }

    /// How many rings the edge passed up to an overlap: mostly all but the last few.
    fn inside(&self, overlap: f64) -> usize {
        self.rings.iter().rposition(|ring| ring.overlap <= overlap).map_or(0, |last| last + 1)
    }

    /// Where the edge has been drawn back to, along what it left.
    fn held(&self, overlap: f64) -> Ring {
        let next = self.inside(overlap);
        let inner = self.rings.get(next.saturating_sub(1)).copied().unwrap_or_default();
        inner.towards(self.rings.get(next), overlap)
    }

    /// Force in N at a radius, ∫ a dδ and a supply, and the rate of u in m/s; `of_rim` as in [`Reach`].
    fn pushed(
        &self,
        unknown: f64,
        contact: Closed,
        (a, push, supply): (f64, f64, Supply),
        of_rim: Option<(f64, f64)>,
    ) -> (f64, f64) {
        let hertz = 2.0 / 3.0 * self.radius.sqrt() * contact.overlap * contact.root;
        let (share, wet) = (supply.share, supply.wet().min(self.wet));
        let force = |rim: f64| 2.0 * self.modulus * (push + wet * rim - hertz);
        if self.drawn {
            return (force(0.0), 0.0);
        }
        // a y, below 0 only within a step that ends where it reaches 0.
        let rim = unknown * (a * self.radius / share).sqrt();
        let cube_root = of_rim.map_or_else(|| rim.abs().cbrt(), |(cube_root, _)| cube_root);
        let thick = of_rim.map_or_else(|| self.thickening(cube_root).0, |(_, thick)| thick);
        let relaxing = self.relaxing * self.giving_way(rim.abs(), a, thick);
        let given_way = relaxing * rim.abs() * cube_root * cube_root;
        let rate = (share * a / self.radius).sqrt() * (contact.rate - given_way.copysign(rim));
        (force(STIFF * share * rim), rate)
    }

    /// 3 d ln (film over u)/d ln u at constant a.
    fn slope(&self, unknown: f64, reach: &Reach, at: (f64, f64)) -> f64 {
        if unknown <= 0.0 || self.volume == f64::INFINITY {
            return reach.slope;
        }
        let [less, more] =
            [1.0 - SLOPE, 1.0 + SLOPE].map(|part| self.edge(part * unknown, reach.radius, at).film);
        1.5 * (more / less).ln() / SLOPE
    }

    /// Rate of a² = R* (δ + fresh film) over the sizes of its parts, −1 to 1.
    fn growth(&self, unknown: f64, contact: Closed, reach: &Reach, swept: f64) -> f64 {
        let edge = (reach.radius, 0.0, reach.supply);
        let (_, rate) = self.pushed(unknown, contact, edge, reach.of_rim);
        let slope = self.slope(unknown, reach, (contact.overlap, swept));
        let fresh = reach.film * (1.0 + slope / 3.0) * rate;
        (contact.rate + fresh) / (contact.rate.abs() + fresh.abs()).max(f64::MIN_POSITIVE)
    }

    /// ∫ a² dδ in m³ at a stage.
    fn swept(&self, wetted: f64, overlap: f64) -> f64 {
        match self.advances {
            true => self.outer().swept + wetted * (SPAN * self.radius).powi(2),
            false => self.held(overlap).swept,
        }
    }

    /// Leaves a ring where the edge has advanced or drawn back; returns the numbers since then.
    fn accept_edge(&mut self, numbers_m: [f64; 4], contact: Closed) -> [f64; 4] {
        let ([unknown, moved, worked, wetted], overlap) = (numbers_m, contact.overlap);
        let swept = self.swept(wetted, overlap);
        let reach = self.reach(unknown, contact.root, swept);
        let (outer, span) = (self.outer(), SPAN * self.radius);
        let grows = self.growth(unknown, contact, &reach, swept) > TURNS;
        (self.film, self.steep) = (reach.film, reach.steep);
        let edge = if self.advances { reach.radius } else { self.held(overlap).radius };
        self.wet = self.wet.min(self.supply(0.0, edge, (overlap, swept)).wet());
        let (was, mut numbers) = (self.advances, [unknown, 0.0, 0.0, 0.0]);
        if was && reach.radius > outer.radius && overlap > outer.overlap {
            let (push, work) = (outer.push + moved * span, outer.work + worked * span * span);
            self.rings.push(Ring { radius: reach.radius, overlap, push, work, swept });
            self.advances = grows;
        } else if was {
            // Rounding of a contact at rest.
            self.advances = grows;
            numbers = numbers_m;
        } else {
            let held = self.held(overlap);
            self.advances = grows && reach.radius > held.radius;
            if self.advances || overlap < outer.overlap {
                self.rings.truncate(self.inside(overlap).max(1));
                self.rings.push(held);
            }
        }
        numbers
    }
}

impl ContactState for EntrainedFilm {
    fn begin(&mut self, overlap_m: f64) {
        let radius = (self.radius * overlap_m).sqrt();
        let push = 2.0 / 3.0 * radius * overlap_m;
        self.rings.truncate(1);
        let (work, swept) = (0.4 * push * overlap_m, 0.75 * radius * push);
        self.rings.push(Ring { radius, overlap: overlap_m, push, work, swept });
        (self.advances, self.drawn, self.rate, self.film, self.wet) = (true, false, 0.0, 0.0, 1.0);
    }

    fn force_and_rates(&self, numbers_m: [f64; 4], contact: Closed) -> (f64, [f64; 4]) {
        let [unknown, moved, _, wetted] = numbers_m;
        if !self.advances {
            let ring = self.held(contact.overlap);
            let supply = self.supply(unknown, ring.radius, (contact.overlap, ring.swept));
            let edge = (ring.radius, ring.push, supply);
            let (force, rate) = self.pushed(unknown, contact, edge, None);
            return (force, [rate, 0.0, 0.0, 0.0]);
        }
        let span = SPAN * self.radius;
        let reach = self.reach(unknown, contact.root, self.swept(wetted, contact.overlap));
        let (a, push) = (reach.radius, self.outer().push + moved * span);
        let (force, rate) = self.pushed(unknown, contact, (a, push, reach.supply), reach.of_rim);
        let wider = if self.volume == f64::INFINITY { 0.0 } else { (a / span).powi(2) };
        let [moved, worked] = [a / span, push / (span * span)].map(|by| by * contact.rate);
        (force, [rate, moved, worked, wider * contact.rate])
    }

    fn energy_j(&self, [unknown, _, worked, _]: [f64; 4], overlap_m: f64) -> f64 {
        let bodies = match self.advances {
            true => self.outer().work + worked * (SPAN * self.radius).powi(2),
            false => self.held(overlap_m).work,
        };
        let rim = 0.5 * self.wet * STIFF * unknown * unknown * self.radius;
        let hertz = 4.0 / 15.0 * self.radius.sqrt() * overlap_m * overlap_m * overlap_m.sqrt();
        2.0 * self.modulus * (bodies + rim - hertz)
    }

    fn until_change(&self, [unknown, _, _, wetted]: [f64; 4], contact: Closed) -> f64 {
        if self.drawn {
            return contact.rate / self.rate;
        }
        let relaxed = unknown / (SLIGHT * self.radius);
        let swept = self.swept(wetted, contact.overlap);
        let reach = self.reach(unknown, contact.root, swept);
        if self.advances {
            return relaxed.min(self.growth(unknown, contact, &reach, swept));
        }
        let overtaken = 1.0 - (reach.radius / self.held(contact.overlap).radius).powi(2);
        let back = self.rate < 0.0 && contact.overlap < self.outer().overlap;
        let pressed = if back { contact.rate / self.rate } else { 1.0 };
        relaxed.min(overtaken).min(pressed)
    }

    fn accept(&mut self, numbers_m: [f64; 4], contact: Closed) -> ([f64; 4], bool) {
        let [unknown, moved, worked, wetted] = numbers_m;
        let was = (self.advances, self.drawn);
        if contact.overlap == 0.0 {
            self.begin(0.0);
            return ([0.0; 4], was != (true, false));
        }
        let mut numbers = self.accept_edge([unknown.max(0.0), moved, worked, wetted], contact);
        let relaxed = unknown <= TURNS * SLIGHT * self.radius;
        self.drawn = relaxed && contact.rate < -TURNS * self.rate.abs();
        self.rate = contact.rate;
        if self.drawn {
            numbers[0] = 0.0;
            self.wet = 1.0;
        };
        (numbers, was != (self.advances, self.drawn))
    }

    fn boxed(&self) -> Box<dyn ContactState> {
        Box::new(self.clone())
    }
}

//! Forces of contacts, written down anew from docs/explanation/physics.md: nothing is shared with the crates.

use crate::row::{Ball, Far, GRAVITY, Law, Material, Row};
use std::f64::consts::PI;

/// Product over sum; the other one where one is infinite.
pub(crate) fn reduced(one: f64, other: f64) -> f64 {
    match (one.is_infinite(), other.is_infinite()) {
        (true, _) => other,
        (_, true) => one,
        _ => one * other / (one + other),
    }
}

fn compliance(material: &Material) -> f64 {
    (1.0 - material.poisson * material.poisson) / material.young_pa
}

/// K of two spheres by radius and material.
pub(crate) fn hertz_stiffness(one: (f64, &Material), other: (f64, &Material)) -> f64 {
    let soft = compliance(one.1) + compliance(other.1);
    4.0 / 3.0 * reduced(one.0, other.0).sqrt() / soft
}

/// A of Goldobin and co-workers (2015), η2 = η1.
fn relaxation_s(material: &Material) -> f64 {
    let nu = material.poisson;
    let viscosity = 4.0 / 3.0 * (1.0 - nu + nu * nu) + (1.0 - 2.0 * nu).powi(2);
    (1.0 + nu) / (1.0 - nu) * viscosity * material.viscosity_pa_s / material.young_pa
}

/// A of Brilliantov and co-workers (1996), η2 = η1.
fn relaxation_1996_s(material: &Material) -> f64 {
    let nu = material.poisson;
    let viscosity = 4.0 / 15.0 * material.viscosity_pa_s;
    viscosity * (1.0 - nu * nu) * (1.0 - 2.0 * nu) / (material.young_pa * nu * nu)
}

/// A law with its numbers for one contact.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Term {
    /// K δ^{3/2}.
    Hertz(f64),
    /// k δ^n.
    Elastic(f64, f64),
    /// Hertz's K, overlap where yielding begins, slope beyond, E*, pressure.
    Plastic([f64; 5]),
    /// c √δ δ̇.
    Root(f64),
    /// c δ^{1/4} δ̇.
    Quarter(f64),
    /// c δ̇.
    Linear(f64),
    /// c δ̇³.
    Cubic(f64),
    /// c δ̇³, open contacts included.
    Ungated(f64),
    /// c δ^p |δ̇|^q sgn δ̇: c, q, p.
    Power(f64, f64, f64),
}

impl Term {
    fn of(law: &Law, one: (&Ball, &Material), other: (f64, f64, &Material)) -> Self {
        let (radius, mass) = (reduced(one.0.radius_m, other.0), reduced(one.0.mass_kg, other.1));
        let (soft, softer) = (compliance(one.1), compliance(other.2));
        let hertz = 4.0 / 3.0 * radius.sqrt() / (soft + softer);
        let mean =
            |of: fn(&Material) -> f64| (of(one.1) * soft + of(other.2) * softer) / (soft + softer);
        match *law {
            Law::ElasticHertz => Self::Hertz(hertz),
            Law::ElasticPower { stiffness, exponent } => Self::Elastic(stiffness, exponent),
            Law::ElasticPlastic { yield_pa } => {
                let modulus = 1.0 / (soft + softer);
                let yields = radius * (PI * yield_pa / (2.0 * modulus)).powi(2);
                Self::Plastic([hertz, yields, PI * yield_pa * radius, modulus, yield_pa])
            }
            Law::Viscoelastic => Self::Root(1.5 * hertz * mean(relaxation_s)),
            Law::Brilliantov1996 => Self::Root(1.5 * hertz * mean(relaxation_1996_s)),
            Law::KuwabaraKono { coefficient } => Self::Root(coefficient),
            Law::Tsuji { ratio } => Self::Quarter(ratio * (mass * hertz).sqrt()),
            Law::Linear { coefficient } => Self::Linear(coefficient),
            Law::Cubic { coefficient } => Self::Cubic(coefficient),
            Law::CubicUngated { coefficient } => Self::Ungated(coefficient),
            Law::Power { coefficient, rate, overlap } => Self::Power(coefficient, rate, overlap),
        }
    }

    /// Of an overlap that is not negative, a rate, and the largest overlap so far.
    #[inline(always)]
    fn force(&self, d: f64, r: f64, largest: f64) -> f64 {
        match *self {
            Self::Hertz(k) => k * d * d.sqrt(),
            Self::Elastic(k, n) => k * d.powf(n),
            Self::Plastic(k) => plastic(k, d, largest)[0],
            Self::Root(c) => c * d.sqrt() * r,
            Self::Quarter(c) => c * d.sqrt().sqrt() * r,
            Self::Linear(c) => c * r,
            Self::Cubic(c) | Self::Ungated(c) => c * r * r * r,
            Self::Power(c, q, p) => c * d.powf(p) * r.abs().powf(q).copysign(r),
        }
    }

    /// Derivatives of the force by overlap and by rate.
    fn slopes(&self, d: f64, r: f64, largest: f64) -> [f64; 2] {
        match *self {
            Self::Hertz(k) => [1.5 * k * d.sqrt(), 0.0],
            Self::Elastic(k, n) => [n * k * d.powf(n - 1.0), 0.0],
            Self::Plastic(k) => [plastic(k, d, largest)[1], 0.0],
            Self::Root(c) => [0.5 * c * r / d.sqrt(), c * d.sqrt()],
            Self::Quarter(c) => [0.25 * c * r / d.powf(0.75), c * d.sqrt().sqrt()],
            Self::Linear(c) => [0.0, c],
            Self::Cubic(c) | Self::Ungated(c) => [0.0, 3.0 * c * r * r],
            Self::Power(c, q, p) => {
                let by_rate = c * d.powf(p) * q * r.abs().powf(q - 1.0);
                let size = c * r.abs().powf(q).copysign(r);
                let by_overlap = if p == 0.0 { 0.0 } else { p * d.powf(p - 1.0) * size };
                [by_overlap, by_rate]
            }
        }
    }
}

/// Thornton's law and its slope; on the loading curve `largest` is the overlap itself.
fn plastic([hertz, yields, slope, modulus, pressure]: [f64; 5], d: f64, largest: f64) -> [f64; 2] {
    let loading = d >= largest;
    let largest = largest.max(d);
    if largest <= yields {
        return [hertz * d * d.sqrt(), 1.5 * hertz * d.sqrt()];
    }
    let at_yield = hertz * yields.powf(1.5);
    let most = at_yield + slope * (largest - yields);
    if loading {
        return [most, slope];
    }
    let flatter =
        4.0 * modulus / (3.0 * most) * ((2.0 * most + at_yield) / (2.0 * PI * pressure)).powf(1.5);
    let stiffness = 4.0 / 3.0 * modulus * flatter.sqrt();
    let rest = largest - (most / stiffness).powf(2.0 / 3.0);
    let above = (d - rest).max(0.0);
    [stiffness * above.powf(1.5), 1.5 * stiffness * above.sqrt()]
}

/// One contact of a row.
#[derive(Clone, Debug)]
pub(crate) struct Contact {
    terms: Vec<Term>,
    /// Overlap at rest in m, minus the gap.
    pub rest_m: f64,
    /// Force at rest in N.
    pub load_n: f64,
    pub is_plastic: bool,
    /// Its force has an infinite slope where the rate changes sign.
    pub is_sharp: bool,
}

impl Contact {
    /// Force of a closed contact, uncut.
    #[inline(always)]
    pub(crate) fn closed(&self, d: f64, r: f64, largest: f64) -> f64 {
        let d = d.max(0.0);
        self.terms.iter().map(|term| term.force(d, r, largest)).sum()
    }

    /// Force of an open contact.
    #[inline(always)]
    pub(crate) fn open(&self, r: f64) -> f64 {
        let ungated = self.terms.iter().filter(|term| matches!(term, Term::Ungated(_)));
        ungated.map(|term| term.force(0.0, r, 0.0)).sum()
    }

    /// Derivatives of the force by overlap and by rate, of a closed or an open contact.
    pub(crate) fn slopes(&self, is_open: bool, d: f64, r: f64, largest: f64) -> [f64; 2] {
        let acts = |term: &&Term| !is_open || matches!(term, Term::Ungated(_));
        let slopes = self.terms.iter().filter(acts).map(|term| term.slopes(d.max(0.0), r, largest));
        slopes.fold([0.0; 2], |sum, slope| [sum[0] + slope[0], sum[1] + slope[1]])
    }

    /// Overlap at which the elastic terms carry a force, by bisection.
    fn overlap_at(&self, force_n: f64) -> f64 {
        if force_n == 0.0 {
            return 0.0;
        }
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        for _ in 0..2000 {
            let middle = if low == 0.0 { high * 1e-3 } else { (low * high).sqrt() };
            match self.closed(middle, 0.0, 0.0) < force_n {
                true => low = middle,
                false => high = middle,
            }
            if low > 0.0 && high <= low * (1.0 + 4.0 * f64::EPSILON) {
                break;
            }
        }
        high
    }
}

/// A row as equations of motion.
#[derive(Clone, Debug)]
pub(crate) struct Equations {
    /// Of striker, beads and stop; 0 for what does not move.
    pub inverse_mass: Vec<f64>,
    /// Constant force on each body in N.
    pub force_n: Vec<f64>,
    pub contacts: Vec<Contact>,
    /// Force at rest and stiffness of a spring on bead 1.
    pub spring: Option<(f64, f64)>,
    pub clipped: bool,
}

impl Equations {
    pub(crate) fn new(row: &Row) -> Self {
        let slope = GRAVITY * row.incline_deg.to_radians().sin();
        let stop_kg = match row.far {
            Far::Stop { mass_kg } | Far::PlaneStop { mass_kg } => mass_kg,
            Far::HalfBead | Far::Plane => f64::INFINITY,
        };
        let push_n = row.push.map_or(0.0, |push| push.force_n);
        let mut masses = vec![row.striker.mass_kg];
        masses.extend(row.beads.iter().map(|bead| bead.mass_kg));
        let mut force_n: Vec<f64> = masses.iter().map(|mass| mass * slope).collect();
        let mut load_n = push_n;
        let mut contacts = vec![contact(row, 0, 0.0)];
        for (c, bead) in row.beads.iter().enumerate() {
            load_n += bead.mass_kg * slope;
            contacts.push(contact(row, c + 1, load_n));
        }
        let spring = row.push.filter(|push| push.stiffness_n_m > 0.0);
        if spring.is_none() {
            force_n[1] += push_n;
        }
        masses.push(stop_kg);
        force_n.push(-load_n);
        Self {
            inverse_mass: masses.iter().map(|mass| mass.recip()).collect(),
            force_n,
            contacts,
            spring: spring.map(|push| (push.force_n, push.stiffness_n_m)),
            clipped: row.clipped,
        }
    }
}

fn contact(row: &Row, c: usize, load_n: f64) -> Contact {
    let count = row.beads.len();
    let left = if c == 0 { &row.striker } else { &row.beads[c - 1] };
    let last = &row.beads[count - 1];
    let (radius, mass, material) = match (c == count, row.far) {
        (false, _) => (row.beads[c].radius_m, row.beads[c].mass_kg, row.beads[c].material),
        (true, Far::HalfBead) => (last.radius_m, f64::INFINITY, last.material),
        (true, Far::Plane) => (f64::INFINITY, f64::INFINITY, last.material),
        (true, Far::Stop { mass_kg }) => (last.radius_m, mass_kg, last.material),
        (true, Far::PlaneStop { mass_kg }) => (f64::INFINITY, mass_kg, last.material),
    };
    let section = row.sections.iter().rev().find(|(first, _)| *first <= c);
    let laws = section.map_or(&[][..], |(_, laws)| laws);
    let materials = (&row.materials[left.material], &row.materials[material]);
    let other = (radius, mass, materials.1);
    let terms: Vec<Term> =
        laws.iter().map(|law| Term::of(law, (left, materials.0), other)).collect();
    let gap_m = row.gaps.iter().find(|(at, _)| *at == c).map_or(0.0, |(_, gap_m)| *gap_m);
    let is_plastic = terms.iter().any(|term| matches!(term, Term::Plastic(_)));
    let is_sharp = terms.iter().any(|term| matches!(term, Term::Power(_, rate, _) if *rate < 1.0));
    let mut contact = Contact { terms, rest_m: 0.0, load_n, is_plastic, is_sharp };
    contact.rest_m = match load_n > 0.0 {
        true => contact.overlap_at(load_n),
        false => -gap_m,
    };
    contact
}

//! Random harsh rows: unlike beads, gaps, loads, stops, laws, strikers of any mass.

use crate::physics::{hertz_stiffness, reduced};
use crate::row::{Ball, Far, GRAVITY, Law, Material, Push, Row};
use std::f64::consts::PI;

/// SplitMix64: one stream a row, whatever was drawn for the others.
pub(crate) struct Chance(u64);

impl Chance {
    /// The stream of a row.
    pub(crate) fn new(seed: u64, row: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ row.wrapping_mul(0xD1B5_4A32_D192_ED03))
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Even between two numbers.
    pub(crate) fn even(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Even in the logarithm.
    pub(crate) fn decades(&mut self, least: f64, most: f64) -> f64 {
        self.even(least.ln(), most.ln()).exp()
    }

    fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    fn chance(&mut self, share: f64) -> bool {
        self.even(0.0, 1.0) < share
    }
}

/// Overlap, force and time of two beads that meet at the striker's speed: what
/// sizes of laws, gaps and loads are measured in.
struct Sizes {
    overlap_m: f64,
    force_n: f64,
    speed_m_s: f64,
    time_s: f64,
}

impl Sizes {
    fn new(bead: &Ball, material: &Material, speed_m_s: f64) -> Self {
        let stiffness = hertz_stiffness((bead.radius_m, material), (bead.radius_m, material));
        let energy = 0.25 * bead.mass_kg * speed_m_s * speed_m_s;
        let overlap_m = (2.5 * energy / stiffness).powf(0.4);
        Self {
            overlap_m,
            force_n: stiffness * overlap_m.powf(1.5),
            speed_m_s,
            time_s: overlap_m / speed_m_s,
        }
    }
}

/// Rows of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Family {
    /// Strikers of 1/1000 to 1/10 of bead 1.
    Light,
    /// Strikers of 10 to 1000 times bead 1.
    Heavy,
    /// Beads by turns, or all unlike.
    Split,
    /// Under a push.
    Loaded,
    /// With soft contacts from some bead on.
    Soft,
    /// With stops of 1/1000 to 1 times the last bead.
    Stops,
}

impl Family {
    /// By its name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        let all = [Self::Light, Self::Heavy, Self::Split, Self::Loaded, Self::Soft, Self::Stops];
        all.into_iter().find(|it| format!("{it:?}").to_lowercase() == name)
    }

    /// Makes a row one of these.
    fn shape(self, chance: &mut Chance, row: &mut Row, sizes: &Sizes) {
        let count = row.beads.len();
        match self {
            Self::Light => row.striker.mass_kg = row.beads[0].mass_kg * chance.decades(1e-3, 0.1),
            Self::Heavy => row.striker.mass_kg = row.beads[0].mass_kg * chance.decades(10.0, 1e3),
            Self::Split => {}
            Self::Loaded => {
                row.gaps.clear();
                let push = |chance: &mut Chance| Push {
                    force_n: sizes.force_n * chance.decades(1e-4, 3.0),
                    stiffness_n_m: 0.0,
                };
                row.push.get_or_insert_with(|| push(chance));
            }
            Self::Soft => {
                let first = 1 + chance.below(count);
                let soft = Law::ElasticPower {
                    stiffness: chance.decades(1e-4, 1e-1) * sizes.force_n
                        / sizes.overlap_m.powf(1.5),
                    exponent: 1.5,
                };
                row.sections.retain(|(from, _)| *from < first);
                row.sections.push((first, vec![soft]));
            }
            Self::Stops => {
                let mass_kg = row.beads[count - 1].mass_kg * chance.decades(1e-3, 1.0);
                row.far = match chance.chance(0.5) {
                    true => Far::Stop { mass_kg },
                    false => Far::PlaneStop { mass_kg },
                };
            }
        }
    }
}

/// Row number `at` of a seed, of a family or any.
pub(crate) fn row(seed: u64, at: u64, family: Option<Family>) -> Row {
    let mut chance = Chance::new(seed, at);
    let fewest = if family.is_some() { 3.0 } else { 1.0 };
    let count = chance.decades(fewest, 101.0) as usize;
    let speed_m_s = chance.decades(0.03, 3.0);
    let young_pa = chance.decades(1e9, 3e11);
    let mut materials = vec![material(&mut chance, young_pa)];
    if chance.chance(0.6) {
        let ratio = chance.decades(3e-3, 3e2);
        materials.push(material(&mut chance, (young_pa * ratio).clamp(1e7, 1e12)));
    }
    let densities: Vec<f64> = materials.iter().map(|_| chance.decades(800.0, 2e4)).collect();
    let radius_m = chance.decades(1e-3, 3e-2);
    let ball = |radius_m: f64, material: usize| Ball {
        radius_m,
        mass_kg: 4.0 / 3.0 * PI * radius_m.powi(3) * densities[material],
        material,
    };
    let is_split = family == Some(Family::Split);
    let beads = beads(&mut chance, (count, is_split), materials.len(), |scale, material| {
        ball(radius_m * scale, material)
    });
    let striker = striker(&mut chance, &beads[0]);
    let sizes = Sizes::new(&beads[0], &materials[beads[0].material], speed_m_s);
    for material in &mut materials {
        // A of about this many contact times.
        material.viscosity_pa_s = 0.5 * material.young_pa * sizes.time_s * damping(&mut chance);
    }
    let sections = sections(&mut chance, count, &sizes, &beads[0], &materials[beads[0].material]);
    let last = beads[count - 1];
    let far = far(&mut chance, last.mass_kg);
    let mut row = Row {
        title: format!("random chain {at} of seed {seed}"),
        materials,
        striker,
        speed_m_s,
        beads,
        sections,
        far,
        push: None,
        incline_deg: 0.0,
        gaps: Vec::new(),
        clipped: chance.chance(0.3),
        sensor: (count / 2).clamp(1, 7).min(1 + chance.below(count)),
    };
    surroundings(&mut chance, &mut row, &sizes);
    if let Some(family) = family {
        family.shape(&mut chance, &mut row, &sizes);
    }
    row
}

fn material(chance: &mut Chance, young_pa: f64) -> Material {
    Material { young_pa, poisson: chance.even(0.05, 0.45), viscosity_pa_s: 0.0 }
}

/// Strength of a dissipative term over the elastic force.
fn damping(chance: &mut Chance) -> f64 {
    chance.decades(1e-3, 0.5)
}

/// Equal beads, dimers, tapers, rows with an intruder, and beads at random.
fn beads(
    chance: &mut Chance,
    (count, is_split): (usize, bool),
    materials: usize,
    ball: impl Fn(f64, usize) -> Ball,
) -> Vec<Ball> {
    let other = materials - 1;
    let ratio = chance.decades(0.15, 4.0);
    let kind = match is_split {
        true => [1, 4][chance.below(2)],
        false => chance.below(5),
    };
    match kind {
        0 => vec![ball(1.0, 0); count],
        1 => {
            let cell = [ball(1.0, 0), ball(ratio, other)];
            (0..count).map(|i| cell[i % 2]).collect()
        }
        2 => {
            let last = chance.decades(0.3, 3.0);
            let scale = |i: usize| last.powf(i as f64 / count as f64);
            (0..count).map(|i| ball(scale(i), 0)).collect()
        }
        3 => {
            let mut beads = vec![ball(1.0, 0); count];
            beads[chance.below(count)] = ball(ratio, other);
            beads
        }
        _ => {
            let mut bead = || ball(chance.decades(0.4, 2.5), chance.below(materials));
            (0..count).map(|_| bead()).collect()
        }
    }
}

fn striker(chance: &mut Chance, first: &Ball) -> Ball {
    match chance.below(3) {
        0 => *first,
        1 => Ball { mass_kg: first.mass_kg * chance.decades(1e-3, 1e3), ..*first },
        _ => {
            let scale: f64 = chance.decades(0.15, 5.0);
            Ball {
                radius_m: first.radius_m * scale,
                mass_kg: first.mass_kg * scale.powi(3),
                ..*first
            }
        }
    }
}

fn far(chance: &mut Chance, last_kg: f64) -> Far {
    let mass_kg = last_kg * chance.decades(0.03, 1e3);
    match chance.below(6) {
        0 => Far::Stop { mass_kg },
        1 => Far::PlaneStop { mass_kg },
        2 | 3 => Far::Plane,
        _ => Far::HalfBead,
    }
}

/// Laws of the whole row, or of two parts of it.
fn sections(
    chance: &mut Chance,
    count: usize,
    sizes: &Sizes,
    bead: &Ball,
    material: &Material,
) -> Vec<(usize, Vec<Law>)> {
    let mut sections = vec![(0, laws(chance, sizes, bead, material))];
    if count > 2 && chance.chance(0.25) {
        let first = 1 + chance.below(count);
        sections.push((first, laws(chance, sizes, bead, material)));
    }
    sections
}

fn laws(chance: &mut Chance, sizes: &Sizes, bead: &Ball, material: &Material) -> Vec<Law> {
    let elastic = match chance.below(8) {
        0 | 1 => {
            let exponent = (100.0 * chance.even(1.0, 3.0)).round() / 100.0;
            let size = chance.decades(0.3, 3.0) * sizes.force_n;
            Law::ElasticPower { stiffness: size / sizes.overlap_m.powf(exponent), exponent }
        }
        2 => {
            let modulus = 0.5 * material.young_pa / (1.0 - material.poisson.powi(2));
            let yields_m = sizes.overlap_m * chance.decades(0.05, 2.0);
            let root = (yields_m / reduced(bead.radius_m, bead.radius_m)).sqrt();
            Law::ElasticPlastic { yield_pa: 2.0 * modulus * root / PI }
        }
        _ => Law::ElasticHertz,
    };
    let mut laws = vec![elastic];
    for _ in 0..chance.below(3) {
        laws.push(dissipative(chance, sizes));
    }
    laws.dedup_by_key(|law| std::mem::discriminant(law));
    laws
}

fn dissipative(chance: &mut Chance, sizes: &Sizes) -> Law {
    let size = damping(chance) * sizes.force_n;
    let speed = sizes.speed_m_s;
    match chance.below(9) {
        0 | 1 => Law::Viscoelastic,
        2 => Law::Brilliantov1996,
        3 => Law::Cubic { coefficient: size / speed.powi(3) },
        4 => Law::KuwabaraKono { coefficient: size / (speed * sizes.overlap_m.sqrt()) },
        5 => Law::Tsuji { ratio: damping(chance) },
        6 => Law::Linear { coefficient: size / speed },
        7 if chance.chance(0.3) => Law::CubicUngated { coefficient: size / speed.powi(3) },
        _ => {
            let hundredths = |value: f64| (100.0 * value).round() / 100.0;
            let rate = hundredths(chance.even(0.5, 2.5));
            let overlap = hundredths(chance.even(0.0, 1.5));
            let unit = sizes.overlap_m.powf(overlap) * speed.powf(rate);
            Law::Power { coefficient: size / unit, rate, overlap }
        }
    }
}

/// Loads, inclines and gaps.
fn surroundings(chance: &mut Chance, row: &mut Row, sizes: &Sizes) {
    let count = row.beads.len();
    if chance.chance(0.3) {
        let force_n = sizes.force_n * chance.decades(1e-4, 1.0);
        let stiffness_n_m = match chance.chance(0.5) {
            true => 0.0,
            false => force_n / sizes.overlap_m * chance.decades(1e-3, 1.0),
        };
        row.push = Some(Push { force_n, stiffness_n_m });
    }
    if chance.chance(0.15) {
        row.incline_deg = (10.0 * chance.decades(0.1, 90.0)).round() / 10.0;
    }
    let weight_n = GRAVITY * row.incline_deg.to_radians().sin();
    if row.push.is_none() && weight_n == 0.0 && chance.chance(0.4) {
        let gap_m = sizes.overlap_m * chance.decades(1e-3, 1e2);
        let every = 1.max(chance.below(count + 1));
        let contacts = (1..=count).step_by(every);
        row.gaps = contacts.map(|contact| (contact, gap_m * chance.even(0.0, 2.0))).collect();
    }
}

//! Random shots of the sort that ensembles are for, the same in every run.

use super::*;
use hertzchain_chain::laws::LAWS;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngSeed, TestRunner};

/// One random chain, and what kind it is.
#[derive(Clone, Debug)]
pub struct RandomShot {
    pub chain: Chain,
    pub row: &'static str,
    pub laws: String,
    pub wall: &'static str,
    pub tension: Tension,
    pub gap: bool,
}

impl RandomShot {
    /// Bead 7 of 28 or more beads, nearer to the striker in a shorter row.
    pub fn sensors(&self) -> Vec<Sensor> {
        let beads = self.chain.beads.len();
        vec![Sensor::Bead((beads / 4).min(7)), Sensor::Contact(beads)]
    }

    /// Whether all forces end and begin gently: no law jumps, nothing flies
    /// freely into a contact, nothing is cut. In dimers several maxima of nearly
    /// the same size come back, and which is the largest hangs on a hair.
    pub fn suits_equal_steps(&self) -> bool {
        const SHARP: [&str; 5] = ["tsuji", "linear", "damping_power", "ungated", "plastic"];
        let gentle = SHARP.iter().all(|name| !self.laws.contains(name));
        gentle && self.row != "dimer" && !self.gap && self.tension == Tension::Allowed
    }
}

/// The first of an endless list of random shots.
pub fn random_shots(count: usize) -> Vec<RandomShot> {
    let config = Config { rng_seed: RngSeed::Fixed(7), ..Config::default() };
    let mut runner = TestRunner::new(config);
    let strategy = shot();
    (0..count).map(|_| strategy.new_tree(&mut runner).unwrap().current()).collect()
}

fn material() -> impl Strategy<Value = Material> {
    (5e9..3e11, 0.1..0.45, 0.0..5e4).prop_map(|(young_modulus_pa, poisson_ratio, eta)| Material {
        young_modulus_pa,
        poisson_ratio,
        shear_viscosity_pa_s: eta * young_modulus_pa / 213e9,
        bulk_viscosity_pa_s: eta * young_modulus_pa / 213e9,
        yield_strength_pa: None,
    })
}

fn scaled(bead: Bead, radius: f64, mass: f64) -> Bead {
    Bead { radius_m: radius * bead.radius_m, mass_kg: mass * bead.mass_kg, ..bead }
}

/// Equal beads, dimers, tapered rows, rows with an intruder.
fn beads() -> impl Strategy<Value = (&'static str, Bead, Vec<Bead>)> {
    let sizes = (8..=60_usize, 0..4_usize, -1.0..1.0_f64, 0.0..1.0_f64);
    (material(), 3e-3..1e-2_f64, sizes).prop_map(|(material, radius_m, sizes)| {
        let (count, kind, size, place) = sizes;
        let bead = Bead {
            radius_m,
            mass_kg: 7960.0 * 4.0 / 3.0 * std::f64::consts::PI * radius_m.powi(3),
            material,
        };
        let mut beads = vec![bead; count];
        let ratio = 5_f64.powf(size);
        match kind {
            0 => {}
            1 => beads.iter_mut().skip(1).step_by(2).for_each(|b| *b = scaled(bead, 1.0, ratio)),
            2 => {
                let factor = |i: usize| (1.0 + 0.02 * size).powi(i as i32);
                for (i, b) in beads.iter_mut().enumerate() {
                    *b = scaled(bead, factor(i), factor(i).powi(3));
                }
            }
            _ => {
                let at = 1 + (place * (count - 2) as f64) as usize;
                beads[at] = scaled(bead, ratio.cbrt(), ratio);
            }
        }
        (["equal", "dimer", "tapered", "intruder"][kind], bead, beads)
    })
}

/// Sums of laws by name: half of them those that the paper uses.
const SUMS: [&[&str]; 14] = [
    &["elastic_hertz"],
    &["elastic_hertz", "damping_viscoelastic"],
    &["elastic_hertz", "damping_viscoelastic", "damping_cubic"],
    &["elastic_hertz", "damping_viscoelastic", "damping_cubic"],
    &["elastic_hertz", "damping_cubic"],
    &["elastic_hertz", "damping_kuwabara_kono"],
    &["elastic_hertz", "damping_brilliantov_1996"],
    &["elastic_hertz", "damping_tsuji"],
    &["elastic_hertz", "damping_linear"],
    &["elastic_hertz", "damping_power"],
    &["elastic_hertz", "damping_cubic_ungated"],
    &["elastic_power"],
    &["elastic_power", "damping_power"],
    &["elastic_plastic_thornton"],
];

/// A law with parameters of the size that contacts of steel have.
fn law_of(name: &str, size: f64, other: f64) -> Arc<dyn Law> {
    let given: Vec<(&str, f64)> = match name {
        "damping_cubic" | "damping_cubic_ungated" => vec![("coefficient", 100.0 * size)],
        "damping_kuwabara_kono" => vec![("coefficient", 4e3 * size)],
        "damping_tsuji" => vec![("damping_ratio", 0.2 * size)],
        "damping_linear" => vec![("coefficient", 5.0 * size)],
        "damping_power" => vec![
            ("coefficient", 3.0 * size * 30_f64.powf(2.0 * other)),
            ("rate_exponent", 1.0 + 0.8 * other),
            ("overlap_exponent", 0.5 * other),
        ],
        // As stiff as steel at ten micrometres.
        "elastic_power" => {
            vec![("exponent", 1.2 + other), ("stiffness", 8.8e9 * 1e-5_f64.powf(0.3 - other))]
        }
        "elastic_plastic_thornton" => vec![("yield_pressure", 1e9 * (0.5 + size))],
        _ => vec![],
    };
    let row = LAWS.iter().find(|row| row.info.name == name).unwrap();
    row.build(&given).unwrap()
}

fn laws() -> impl Strategy<Value = (String, Vec<Arc<dyn Law>>)> {
    (0..SUMS.len(), 0.05..1.0_f64, 0.0..1.0_f64).prop_map(|(sum, size, other)| {
        let laws = SUMS[sum].iter().map(|name| law_of(name, size, other));
        (SUMS[sum].join("+"), laws.collect())
    })
}

fn wall() -> impl Strategy<Value = (&'static str, FarEnd)> {
    (0..3_usize, material(), -1.0..1.0_f64).prop_map(|(kind, material, size)| match kind {
        0 => {
            let radius_m = 6e-3;
            ("half-bead", FarEnd::HalfBead { radius_m, material })
        }
        1 => ("plane", FarEnd::Plane { material }),
        _ => {
            let (radius_m, mass_kg) = (6e-3, 0.5 * 20_f64.powf(size));
            let stop = FarEnd::Stop { radius_m, material, mass_kg };
            ("stop", stop)
        }
    })
}

fn shot() -> impl Strategy<Value = RandomShot> {
    let loads = (0..4_u8, 0.0..5.0_f64, 0..4_u8, 0.0..1.0_f64);
    let rest = (loads, 0..4_u8, 0..4_u8, -8.0..-5.0_f64, -1.3..0.4_f64);
    (beads(), laws(), wall(), rest).prop_map(|((row, striker, beads), (names, laws), far, rest)| {
        let ((pushed, push_n, inclined, incline_rad), gapped, clipped, gap, speed) = rest;
        let last = beads.len();
        let (push_n, gap) = (if pushed == 0 { push_n } else { 0.0 }, (gapped == 0).then_some(gap));
        let incline_rad = if inclined == 0 { incline_rad } else { 0.0 };
        let tension = [Tension::Clipped, Tension::Allowed][usize::from(clipped != 0)];
        let gaps = gap.map(|gap| Gap { contact: last / 2, gap_m: 10_f64.powf(gap) });
        let speed_m_s = 10_f64.powf(speed);
        let chain = Chain {
            beads,
            start: Start::Striker { bead: striker, speed_m_s },
            push: Push::Constant { force_n: push_n },
            far: far.1,
            sections: vec![Section { contacts: 0..=last, laws, material: None }],
            gaps: gaps.into_iter().collect(),
            incline_rad,
            tension,
            ..super::row(1, 1.0, vec![])
        };
        let gap = !chain.gaps.is_empty() && push_n == 0.0 && incline_rad == 0.0;
        RandomShot { laws: names, wall: far.0, chain, row, tension, gap }
    })
}

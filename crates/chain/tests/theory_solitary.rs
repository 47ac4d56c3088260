//! The exact lattice solitary wave against published digits, theorems and the lattice itself.

use crate::row::verlet_step;
use hertzchain_chain::ChainError;
use hertzchain_chain::theory::solitary::{SolitaryShape, SolitaryWave, kinetic_share_by_virial};

const EXPONENTS: [f64; 9] = [1.02, 1.2, 1.5, 2.0, 2.5, 3.0, 5.0, 10.0, 20.0];

fn relative(computed: f64, expected: f64) -> f64 {
    (computed / expected - 1.0).abs()
}

#[test]
fn hertz_speed_constants_have_the_known_fourteen_digits() {
    let shape = SolitaryShape::hertz().unwrap();
    // Half a unit of the last digit given, plus rounding.
    let tolerance = 8e-15;
    assert!((shape.speed_per_force_power() - 0.90551577641912).abs() < tolerance);
    assert!((shape.speed_per_velocity_power() - 0.90747007841219).abs() < tolerance);
}

#[test]
fn kinetic_share_is_the_virial_one_for_every_exponent() {
    for exponent in EXPONENTS {
        let shape = SolitaryShape::new(exponent).unwrap();
        // Both are quadratures of a profile known to about 1e-14.
        assert!((shape.kinetic_share() - kinetic_share_by_virial(exponent)).abs() < 1e-12);
    }
    // Rounding of the sums alone.
    let hertz = SolitaryShape::hertz().unwrap().kinetic_share();
    assert!((hertz - 5.0 / 9.0).abs() < 1e-14);
}

#[test]
fn speed_tends_to_the_gaussian_limit_for_exponents_near_one() {
    // For n = 1 + ε the wave is a Gaussian and c² falls linearly below the sound speed:
    // the extrapolated limit is 1 up to the curvature of c²(ε), of order ε².
    let near = SolitaryShape::new(1.02).unwrap().speed_squared();
    let far = SolitaryShape::new(1.04).unwrap().speed_squared();
    assert!((2.0 * near - far - 1.0).abs() < 1e-3);
}

#[test]
fn profile_solves_the_advance_delay_equation_between_the_grid_points() {
    for exponent in EXPONENTS {
        let shape = SolitaryShape::new(exponent).unwrap();
        for step in 0..40 {
            let x = 0.0371 + 0.0913 * f64::from(step);
            // Both series carry rounding of a few hundred terms; the power
            // amplifies it n-fold.
            let gap = shape.overlap(x).powf(exponent) - shape.force(x);
            assert!(gap.abs() < 2e-14 * exponent, "n = {exponent}, x = {x}: {gap:e}");
        }
    }
}

#[test]
fn tail_falls_double_exponentially() {
    let shape = SolitaryShape::hertz().unwrap();
    let logs: Vec<f64> = [2.0, 3.0, 4.0].iter().map(|&x| shape.overlap(x).ln()).collect();
    // ln p(x+1) ~ n ln p(x) + slowly varying terms: the ratio of logarithms tends
    // to 3/2 from above, the tail's next bead is far smaller than a geometric one.
    let ratios = (logs[1] / logs[0], logs[2] / logs[1]);
    assert!(ratios.0 > ratios.1 && ratios.1 > 1.5, "{ratios:?}");
    assert!(logs[2] - logs[1] < logs[1] - logs[0] - 3.0);
}

#[test]
fn every_way_to_name_a_wave_gives_the_same_wave() {
    let shape = SolitaryShape::hertz().unwrap();
    let (stiffness, mass) = (8.79e9, 8.54e-3);
    let wave = SolitaryWave::from_peak_force(&shape, stiffness, mass, 40.0).unwrap();
    let others = [
        SolitaryWave::from_peak_overlap(&shape, stiffness, mass, wave.peak_overlap_m()),
        SolitaryWave::from_speed(&shape, stiffness, mass, wave.speed_beads_s()),
        SolitaryWave::from_peak_bead_speed(&shape, stiffness, mass, wave.peak_bead_speed_m_s()),
        SolitaryWave::from_energy(&shape, stiffness, mass, wave.energy_j()),
    ];
    for other in others {
        // Powers up to δ ∝ c⁴ amplify rounding.
        assert!(relative(other.unwrap().peak_force_n(), 40.0) < 1e-13);
    }
}

#[test]
fn dimensional_speed_follows_the_dimensionless_constants() {
    let shape = SolitaryShape::hertz().unwrap();
    let (stiffness, mass, force) = (8.79e9_f64, 8.54e-3_f64, 40.0_f64);
    let wave = SolitaryWave::from_peak_force(&shape, stiffness, mass, force).unwrap();
    let by_force = 0.90551577641912 * stiffness.cbrt() / mass.sqrt() * force.powf(1.0 / 6.0);
    let by_velocity =
        0.90747007841219 * (stiffness / mass).powf(0.4) * wave.peak_bead_speed_m_s().powf(0.2);
    // Fourteen digits of the constants and a few roundings.
    assert!(relative(wave.speed_beads_s(), by_force) < 2e-14);
    assert!(relative(wave.speed_beads_s(), by_velocity) < 2e-14);
}

#[test]
fn lattice_carries_the_wave_unchanged() {
    let shape = SolitaryShape::hertz().unwrap();
    let wave = SolitaryWave::from_peak_force(&shape, 1.0, 1.0, 1.0).unwrap();
    let (beads, start, travelled) = (40, 10.0, 20.0);
    let at = |bead: usize, centre: f64| bead as f64 - centre;
    let mut velocity: Vec<f64> =
        (0..beads).map(|bead| wave.bead_speed_m_s(at(bead, start))).collect();
    // overlap[i] sits between beads i and i + 1.
    let mut overlap: Vec<f64> =
        (0..beads - 1).map(|bead| wave.overlap_m(at(bead, start) + 0.5)).collect();
    let steps = 20_000;
    let h = wave.time_of_flight_s(travelled) / f64::from(steps);
    for _ in 0..steps {
        verlet_step(&mut overlap, &mut velocity, h);
    }
    let error = (0..beads)
        .map(|bead| velocity[bead] - wave.bead_speed_m_s(at(bead, start + travelled)))
        .fold(0.0, |worst: f64, gap| worst.max(gap.abs()));
    // Second-order steps of 1e-3: 1.3e-6, a quarter of that at half the step.
    assert!(error < 2e-6, "{error:e}");
}

#[test]
fn energy_and_momentum_are_those_of_the_sampled_lattice_at_any_instant() {
    let shape = SolitaryShape::hertz().unwrap();
    let wave = SolitaryWave::from_peak_force(&shape, 3.0, 2.0, 0.7).unwrap();
    for centre in [0.0, 0.13, 0.5, 0.77] {
        let beads = || (-9..=9).map(|bead| f64::from(bead) - centre);
        let kinetic: f64 = beads().map(|x| wave.bead_speed_m_s(x).powi(2)).sum();
        let elastic: f64 = beads().map(|x| 3.0 / 2.5 * wave.overlap_m(x + 0.5).powf(2.5)).sum();
        let momentum: f64 = beads().map(|x| 2.0 * wave.bead_speed_m_s(x)).sum();
        // Quadrature and profile to 1e-14; nineteen terms.
        assert!(relative(kinetic + elastic, wave.energy_j()) < 1e-13);
        assert!(relative(momentum, wave.momentum_kg_m_s()) < 1e-13);
    }
}

#[test]
fn widths_are_where_the_profiles_pass_half_their_height() {
    let shape = SolitaryShape::hertz().unwrap();
    // Slope of the profiles of order one: rounding only.
    let tolerance = 1e-14;
    let half = |width: f64, profile: &dyn Fn(f64) -> f64| {
        (profile(0.5 * width) - 0.5 * profile(0.0)).abs() < tolerance
    };
    assert!(half(shape.force_width_beads(), &|x| shape.force(x)));
    assert!(half(shape.velocity_width_beads(), &|x| shape.velocity(x)));
    assert!(half(shape.sensor_width_beads(), &|x| shape.sensor(x)));
    assert!(shape.force_width_beads() < shape.velocity_width_beads());
}

#[test]
fn exponents_and_sizes_out_of_range_are_refused() {
    for exponent in [f64::NAN, -1.0, 1.0, 1e300] {
        let refused = SolitaryShape::new(exponent);
        assert!(matches!(refused, Err(ChainError::Value { .. })));
    }
    let shape = SolitaryShape::hertz().unwrap();
    for force in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(SolitaryWave::from_peak_force(&shape, 1.0, 1.0, force).is_err());
    }
}

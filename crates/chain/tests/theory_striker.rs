//! The leading pulse of an equal striker: conservation, the exact wave and the lattice agree.

use crate::row::verlet_step;
use hertzchain_chain::theory::solitary::SolitaryShape;
use hertzchain_chain::theory::striker::{LeadingPulse, least_waves};

#[test]
fn energy_share_of_an_equal_striker_fixes_the_known_speed_force_and_bead_speed() {
    let shape = SolitaryShape::hertz().unwrap();
    let pulse = LeadingPulse::from_energy_share(&shape, 1.0, 0.99366101).unwrap();
    // One unit of the last printed digit, which the energy share's own rounding can cause.
    let tolerance = 1e-8;
    assert!((pulse.bead_speed - 0.68163155).abs() < tolerance, "{pulse:?}");
    assert!((pulse.speed - 0.84050877).abs() < tolerance, "{pulse:?}");
    assert!((pulse.peak_force - 0.63955423).abs() < tolerance, "{pulse:?}");
}

#[test]
fn equal_striker_must_bounce() {
    let shape = SolitaryShape::hertz().unwrap();
    let pulse = LeadingPulse::from_energy_share(&shape, 1.0, 0.99366101).unwrap();
    assert!(pulse.momentum_share > 1.1);
    assert!(least_waves(&shape, 1.0) < 1.0);
    assert!(least_waves(&shape, 2.0) > 1.0);
}

#[test]
fn lattice_puts_the_known_energy_share_into_the_leading_pulse() {
    let (coarse, fine) = (leading_energy_share(2e-3), leading_energy_share(1e-3));
    let extrapolated = fine + (fine - coarse) / 3.0;
    // The scheme is of second order (the finer share is 4e-8 off); what the
    // extrapolation leaves is below the last digit known.
    assert!((extrapolated - 0.99366101).abs() < 1e-8, "{extrapolated:.10}");
}

/// Energy of the beads ahead of bead 40 when the pulse is near bead 48: what
/// follows it is slower and farther behind by then.
fn leading_energy_share(h: f64) -> f64 {
    let beads = 70;
    let mut overlap = vec![0.0; beads - 1];
    let mut velocity = vec![0.0; beads];
    velocity[0] = 1.0;
    let steps = (48.0 / 0.84 / h) as usize;
    for _ in 0..steps {
        verlet_step(&mut overlap, &mut velocity, h);
    }
    (40..beads - 1).map(|i| velocity[i] * velocity[i] + 0.8 * overlap[i].max(0.0).powf(2.5)).sum()
}

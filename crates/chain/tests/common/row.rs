//! A row of equal beads (K = m = 1) by velocity Verlet in overlaps: independent
//! of the wave loop.

/// One step `h` of overlaps and bead velocities; contact c is between beads c and c + 1.
pub fn verlet_step(overlap: &mut [f64], velocity: &mut [f64], h: f64) {
    let drift = |overlap: &mut [f64], velocity: &[f64]| {
        for (bead, gap) in overlap.iter_mut().enumerate() {
            *gap += 0.5 * h * (velocity[bead] - velocity[bead + 1]);
        }
    };
    drift(overlap, velocity);
    for (contact, gap) in overlap.iter().enumerate() {
        let push = h * gap.max(0.0).powf(1.5);
        velocity[contact] -= push;
        velocity[contact + 1] += push;
    }
    drift(overlap, velocity);
}

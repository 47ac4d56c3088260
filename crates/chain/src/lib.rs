//! Physics of a row of beads: materials, contact laws, chains, the wave loop, sensors, theory.

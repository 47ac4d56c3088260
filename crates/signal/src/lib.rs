//! Pulses in sampled slices: picks, times of flight, power laws. Knows nothing of chains or files.

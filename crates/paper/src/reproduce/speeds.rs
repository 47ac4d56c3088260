//! Speeds at which the paper's chains are shot.

/// Speeds of the tables and curves in m/s: those that the paper names or that
/// others can compare with, and enough between them for smooth curves.
pub const SPEEDS_M_S: [f64; 31] = [
    0.075, 0.085, 0.1, 0.115, 0.125, 0.1368, 0.1396, 0.16, 0.18, 0.2, 0.225, 0.25, 0.28, 0.32,
    0.36, 0.3993, 0.45, 0.5, 0.55, 0.6, 0.675, 0.75, 0.825, 0.9, 0.95, 1.0, 1.05, 1.1, 1.152, 1.19,
    1.23,
];

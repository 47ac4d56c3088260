//! Shots, sweeps, the paper's claims and their reproduction.

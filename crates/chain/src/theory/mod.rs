//! Closed forms and exact waves.

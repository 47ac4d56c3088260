//! The `hertzchain` program: one file a verb, no logic of its own.

fn main() {}

//! The experiment file: TOML with units, presets and readings; it becomes chains and shots.

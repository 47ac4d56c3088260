//! Rows of beads and their solitary waves: predict, measure, infer.
//!
//! A row of touching balls is hit at one end, and a solitary wave runs down it. This crate has what
//! the program `hertzchain` has, from memory. One `use` brings it: [`prelude`].
//!
//! An [`Experiment`](prelude::Experiment) is a row with its striker, from a file, a preset or a text.
//! Options of a verb are one struct in [`options`]; results are structs that serialise in SI; mistakes
//! are a [`Failure`] that prints as a report.
//!
//! ```
//! use hertzchain::prelude::*;
//!
//! // `Experiment::open("row.toml")` reads a file, `preset("dry")` is the paper's dry row.
//! let row = Experiment::from_text("row", r#"
//!     [materials]
//!     steel = { young_modulus = "213 GPa", poisson_ratio = 0.3, density = "7.96 g/cm^3", shear_viscosity = "32 kPa s" }
//!     [striker]
//!     speed = "0.5 m/s"
//!     [[beads]]
//!     count = 20
//!     radius = "6.35 mm"
//!     material = "steel"
//!     [[contacts]]
//!     laws = ["elastic_hertz", "damping_viscoelastic"]
//!     [sensors]
//!     bead = 5
//! "#)?;
//!
//! // Predict: a shot at 0.5 m/s, and times of flight against speed.
//! let one = shot(&row, &ShotOptions::at(0.5))?;
//! let flight = one.flight.expect("the pulse reaches the wall");
//! let speeds = SweepOptions { speeds: "0.2,0.5,1".to_owned(), ..SweepOptions::default() };
//! let swept = sweep(&row, &speeds)?;
//! assert_eq!(swept.points[1].speed_m_s, 0.5);
//!
//! // Measure: sample the sensors at 1 MHz and pick the pulses, as from a recording.
//! let mut records = Vec::new();
//! for speed_m_s in [0.2, 0.5, 1.0] {
//!     let options = ShotOptions::at(speed_m_s);
//!     let mut prepared = PreparedShot::new(&row, &options)?;
//!     prepared.plan = prepared.plan.watching(row.sensors(), Some(1e-6));
//!     let trace = prepared.run()?.shot.trace.expect("sensors are watched");
//!     let channel = |volts| Channel { volts, ..Channel::default() };
//!     records.push(Record {
//!         file: format!("{speed_m_s} m/s").into(),
//!         interval_s: 1e-6,
//!         channels: trace.columns.into_iter().map(channel).collect(),
//!         speed_m_s: Some(speed_m_s),
//!         speed_error_m_s: Some(1e-4),
//!         ..Record::default()
//!     });
//! }
//! let measured = measure_records(records, &MeasureOptions::default())?;
//! let curve = measured.curve("")?;
//!
//! // Infer: the viscosity of the steel from these times of flight.
//! let found = fit(&curve, &row, &FitOptions::free(["eta"]))?;
//! let eta_pa_s = found.inferred.fit.point[0];
//! assert!((eta_pa_s / 32e3 - 1.0).abs() < 0.05, "{eta_pa_s}");
//! # assert!(flight.reflected_s.is_some());
//! # Ok::<(), hertzchain::Failure>(())
//! ```

// Without the program, what it alone uses is dead.
#![cfg_attr(target_family = "wasm", allow(dead_code))]

mod bibliography;
pub mod campaign;
mod contact;
mod csv;
pub mod describe;
pub mod design;
#[cfg(feature = "explore")]
pub mod explorer;
pub mod failure;
pub mod fit;
pub mod gauge;
pub mod inference;
mod input;
pub mod laws;
pub mod live;
pub mod measure;
mod missing;
pub mod options;
#[cfg(not(target_family = "wasm"))]
pub mod program;
mod quantity;
pub mod records;
pub mod shot;
pub mod sweep;
mod table;

pub use self::{
    campaign::campaign,
    describe::{Description, check, theory},
    design::design,
    failure::Failure,
    fit::fit,
    gauge::gauge,
    input::instruction_set,
    measure::measure,
    records::measure_records,
    shot::shot,
    sweep::sweep,
};

/// The page's examples, compiled and run with the tests.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/how-to/use-from-rust.md")]
pub struct UseFromRust;

/// What most programs need, by one `use`.
pub mod prelude {
    pub use crate::{
        campaign::{PreparedCampaign, campaign},
        describe::{Description, check, theory},
        design::{DesignResult, design},
        fit::{FitResult, fit},
        gauge::{GaugeResult, gauge},
        measure::{MeasureResult, measure},
        options::{
            CampaignOptions, CheckOptions, DesignOptions, FitOptions, GaugeOptions, MeasureOptions,
            Method, ShotOptions, SweepOptions, from_json,
        },
        records::{Channel, Record, measure_records},
        shot::{PreparedShot, ShotResult, shot},
        sweep::{SweepResult, sweep},
        {Failure, inference},
    };
    pub use hertzchain_experiment::{Experiment, preset};
    pub use hertzchain_infer::Data;
    pub use hertzchain_sim::{Batch, Plan, Shard, shoot};
}

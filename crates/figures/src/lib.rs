//! Pictures of results as SVG, PDF and PNG.
//!
//! A [`Figure`] holds panels: a [`Chart`] with [`Series`] and perhaps a
//! [`HeatMap`], a [`VerdictMatrix`], or a [`RigDrawing`]. All data come as
//! plain slices. An [`Animation`] becomes one HTML file that needs nothing else.
//!
//! Text is markup: inside `$...$`, `v_0`, `10^{-5}`, `K_{\mathrm{eff}}` and `\alpha` are set as in
//! TeX; outside everything is literal apart from commands such as `\mu`.
#![doc = include_str!("../README.md")]

pub mod inference;

mod animation;
mod axis;
mod chart;
mod draw;
mod figure;
mod files;
mod heat;
mod matrix;
mod rig;
mod text;

pub use self::{
    animation::Animation,
    chart::{Chart, Dash, Marker, Series, case_look},
    draw::{Colour, ColourMap},
    figure::{Figure, Panel},
    files::FigureError,
    heat::HeatMap,
    matrix::{ClaimVerdict, VerdictMatrix},
    rig::{RigDrawing, RigEnd},
};

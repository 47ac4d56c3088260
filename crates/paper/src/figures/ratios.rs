//! Wet over dry times of flight, the paper's Fig. 4.

use super::label;
use crate::claims::Evidence;
use crate::reproduce::OILS;
use hertzchain_figures::{Chart, Dash, Figure, Series, case_look};

/// Three ratios against speed with a line at 1.
pub(super) fn figure(evidence: &Evidence) -> Figure {
    let ratio = r"$\mathrm{ToF}_{\mathrm{wet}} / \mathrm{ToF}_{\mathrm{dry}}$, incident";
    let empty = Chart::new("Striker speed $v_0$ (m/s)", ratio).h_line(1.0, "");
    let chart = OILS
        .iter()
        .fold(empty, |chart, case| chart.with(series(evidence, case)));
    Figure::single_column(68.0)
        .panel(chart)
        .title("Ratio of wet to dry time of flight against the striker's speed")
        .caption(
            "Incident time of flight of the chain with oil on the contacts from bead 7 to the \
             wall over that of the dry chain at the same speed of the striker. Symbols: computed \
             shots, one after the other joined by lines. Dashed line: oil makes no difference.",
        )
}

fn series(evidence: &Evidence, case: &str) -> Series {
    let ratios = evidence.ratios(case);
    let speeds: Vec<f64> = ratios.iter().map(|r| r.speed_m_s).collect();
    let values: Vec<f64> = ratios.iter().map(|r| r.incident).collect();
    let (colour, marker) = case_look(case, 0);
    Series::line(label(case), &speeds, &values)
        .marker(marker)
        .colour(colour)
        .dash(Dash::Solid)
        .width(0.6)
}

//! The figure of ratios with films of oil.

use super::label;
use crate::oil_films::{OilFilms, SPEEDS_M_S, incident};
use crate::reproduce::OILS;
use hertzchain_figures::{Chart, Dash, Figure, Series, case_look};

/// Wet over dry incident times of films and of the paper's materials, a panel an oil.
pub fn oil_film_figure(of: &OilFilms) -> Figure {
    let [film, _, scaled, paper] = of.models.each_ref().map(|model| incident(&model.evidence));
    let count = SPEEDS_M_S.len();
    let panel = |(at, case): (usize, &&str)| {
        let (colour, marker) = case_look(case, 0);
        let [film, scaled, paper] = [&film, &scaled, &paper]
            .map(|all| all.get(at * count..(at + 1) * count).unwrap_or(&[]));
        let range = of.ranges.get(at).map_or(&[][..], Vec::as_slice);
        let ends = [0, 1].map(|end| range.iter().map(|own| own[end]).collect::<Vec<f64>>());
        let line = |name: &str, ratios| Series::line(name, &SPEEDS_M_S, ratios).colour(colour);
        let ratio = r"$\mathrm{ToF}_{\mathrm{wet}} / \mathrm{ToF}_{\mathrm{dry}}$";
        Chart::new("Striker speed $v_0$ (m/s)", ratio)
            .title(label(case))
            .x_log()
            .y_range(0.88, 1.06)
            .h_line(1.0, "")
            .with(Series::band("", &SPEEDS_M_S, &ends[0], &ends[1]).colour(colour))
            .with(line("film", film).marker(marker).dash(Dash::Solid))
            .with(line("with one factor", scaled).dash(Dash::Dashed).width(0.8))
            .with(line("the paper's model", paper).dash(Dash::DashDotted).width(0.8))
            .legend(at == 0)
    };
    let panels = OILS.iter().enumerate().map(panel);
    panels
        .fold(Figure::single_column(170.0).letters(), Figure::panel)
        .title("Ratio of wet to dry time of flight with films of oil")
        .caption(&format!(
            "Incident time of flight with a film of oil on contacts 7 to 40 over that of the dry chain, both pushed by \
             0.24 N. Symbols: by each oil's own properties at 25 °C. Bands: 20 to 40 °C, the range of \
             pressure–viscosity coefficients of its class, rounding of what the paper prints. Dashed: all viscosities \
             times {:.3}, the factor whose ratios are nearest to the paper's model. Dash-dotted: the paper's effective \
             materials, without a push.",
            of.factor
        ))
}

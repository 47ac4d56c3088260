//! Where the energy of a shot is, over time.

use super::{US, label};
use crate::reproduce::Film;
use hertzchain_chain::wave::Budget;
use hertzchain_figures::{Chart, Colour, Dash, Figure, Legend, Series};

/// A panel of stacked shares for each shot, and what the budgets miss.
pub(super) fn figure(films: &[Film]) -> Figure {
    let empty = Figure::single_column(150.0).letters();
    let shares = films.iter().enumerate();
    let shares = shares.map(|(i, film)| shares_of(film, i == 0));
    let full = shares.fold(empty, Figure::panel).panel(residuals(films));
    full.title("Energy budget over time").caption(
        "(a, b) Where the striker's energy is, as stacked shares: in motion, in overlaps, and lost \
         to each dissipative term of the contact law. (c) What the budgets miss of the initial \
         energy, the error of the computation.",
    )
}

fn times_us(film: &Film) -> Vec<f64> {
    film.budgets
        .iter()
        .map(|budget| budget.time_s * US)
        .collect()
}

/// Stacked shares: kinetic lowest, then elastic, then one band a lossy law.
fn shares_of(film: &Film, legend: bool) -> Chart {
    let time = times_us(film);
    let title = format!("{}, $v_0$ = {:.4} m/s", label(&film.case), film.speed_m_s);
    let empty = Chart::new("Time (µs)", "Share of initial energy").title(&title);
    let mut chart = empty
        .y_range(0.0, 1.0)
        .legend(if legend { Legend::Auto } else { Legend::Off });
    let mut below = vec![0.0; time.len()];
    for (name, colour, part) in parts(&film.budgets) {
        let share = film
            .budgets
            .iter()
            .zip(&part)
            .map(|(b, part)| part / b.start_j);
        let above: Vec<f64> = below
            .iter()
            .zip(share)
            .map(|(low, share)| low + share)
            .collect();
        chart = chart.with(Series::band(&name, &time, &below, &above).colour(colour));
        below = above;
    }
    chart
}

/// Name, colour and energy in J over time of each part.
fn parts(budgets: &[Budget]) -> Vec<(String, Colour, Vec<f64>)> {
    let column = |of: &dyn Fn(&Budget) -> f64| budgets.iter().map(of).collect::<Vec<f64>>();
    let mut parts = vec![
        ("kinetic".to_owned(), Colour::SKY, column(&|b| b.kinetic_j)),
        (
            "elastic".to_owned(),
            Colour::GREEN,
            column(&|b| b.elastic_j),
        ),
    ];
    let colours = [Colour::OCHRE, Colour::VERMILION, Colour::PURPLE];
    let laws = budgets.first().map_or(&[][..], |first| &first.dissipated);
    for (i, law) in laws.iter().enumerate() {
        let lost = column(&|b| b.dissipated.get(i).map_or(0.0, |line| line.energy_j));
        let kind = law.law.trim_start_matches("damping_").replace('_', " ");
        let colour = colours
            .get(i % colours.len())
            .copied()
            .unwrap_or(Colour::GREY);
        parts.push((format!("lost, {kind}"), colour, lost));
    }
    parts
}

fn residuals(films: &[Film]) -> Chart {
    let looks = [
        (Colour::BLACK, Dash::Solid),
        (Colour::VERMILION, Dash::Dashed),
        (Colour::BLUE, Dash::DashDotted),
    ];
    let empty = Chart::new("Time (µs)", "Share of initial energy")
        .title("residual of the budgets")
        .y_log();
    let looks = looks.into_iter().cycle();
    films.iter().zip(looks).fold(empty, |chart, (film, look)| {
        let missing = film.budgets.iter().map(|b| b.relative_residual().abs());
        let missing: Vec<f64> = missing
            .map(|share| if share > 0.0 { share } else { f64::NAN })
            .collect();
        let line = Series::line(label(&film.case), &times_us(film), &missing);
        chart.with(line.colour(look.0).dash(look.1).width(0.8))
    })
}

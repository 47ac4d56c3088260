//! Where the energy of a shot is, over time.

use super::{US, label};
use crate::{Chart, Colour, Dash, Figure, Legend, Series};
use hertzchain_chain::wave::Budget;
use hertzchain_study::reproduce::Film;

/// Shares of the energy above, what the budget misses below; a column a shot.
pub(super) fn figure(films: &[Film]) -> Figure {
    let empty = Figure::double_column(110.0)
        .columns(films.len().max(1))
        .letters();
    let tops = films
        .iter()
        .enumerate()
        .map(|(i, film)| shares(film, i == 0));
    let panels = tops.chain(films.iter().map(residual));
    let full = panels.fold(empty, Figure::panel);
    full.share_x().title("Energy budget over time")
}

fn times_us(film: &Film) -> Vec<f64> {
    film.budgets
        .iter()
        .map(|budget| budget.time_s * US)
        .collect()
}

/// Stacked shares: kinetic lowest, then elastic, then one band a lossy law.
fn shares(film: &Film, legend: bool) -> Chart {
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
        ("elastic".to_owned(), Colour::BLUE, column(&|b| b.elastic_j)),
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

fn residual(film: &Film) -> Chart {
    let missing = film.budgets.iter().map(|b| b.relative_residual().abs());
    let missing: Vec<f64> = missing
        .map(|share| if share > 0.0 { share } else { f64::NAN })
        .collect();
    Chart::new("Time (µs)", "|Residual| / initial")
        .y_log()
        .y_range(1e-14, 1e-8)
        .with(
            Series::line("", &times_us(film), &missing)
                .colour(Colour::BLACK)
                .dash(Dash::Solid)
                .width(0.6),
        )
}

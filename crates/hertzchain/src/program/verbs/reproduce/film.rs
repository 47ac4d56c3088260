//! `hertzchain reproduce --film`: what films of the paper's oils do.

use crate::program::{Counter, Failure, Folder};
use hertzchain_paper::figures::oil_film_figure;
use hertzchain_paper::oil_films::OilFilms;

/// Relative accuracy of times of flight: a hundredth of what oils do.
const ACCURACY: f64 = 1e-4;

/// Shoots the rows and writes tables and picture; returns what was found, for people.
pub(super) fn run(into: &mut Folder, counter: &Counter) -> Result<String, Failure> {
    let films = OilFilms::compute(ACCURACY, counter).map_err(|error| super::failure(&error))?;
    let page = films.markdown();
    into.write("oil-films.md", page.as_bytes())?;
    into.write("oil-films.csv", films.csv().as_bytes())?;
    into.write("oil-films.json", format!("{:#}\n", films.json()).as_bytes())?;
    let figure = oil_film_figure(&films);
    into.figure("oil_films", &figure)?;
    into.write("oil_films.pdf", &figure.pdf())?;
    Ok(format!("\n{page}"))
}

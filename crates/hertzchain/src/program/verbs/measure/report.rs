//! A page with a plot of every flagged shot.

use super::pictures;
use crate::program::Failure;
use hertzchain_figures::Figure;
use hertzchain_measure::records::{without_controls, write_whole};
use hertzchain_measure::{Curves, Example, Measurement, Shot};
use std::path::Path;

pub(super) const MOST: usize = 500;

const HEAD: &str = "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\">\
<title>Flagged shots</title>\n<style>body{font-family:sans-serif;max-width:60em;margin:auto}\
img{width:100%}h2{font-size:1em;margin-top:2em}</style>\n";

/// Writes the page: one HTML file, without anything beside it.
pub(super) fn write(path: &Path, measured: &Measurement, curves: &Curves) -> Result<(), Failure> {
    let page = page(measured, curves.keep_dubious);
    write_whole(path, |out| out.write_all(page.as_bytes()))
        .map_err(|error| Failure::User(format!("cannot write {}: {error}", path.display())))
}

fn page(measured: &Measurement, keep_dubious: bool) -> String {
    let flagged = measured.shots.iter().filter(|shot| !shot.flags().is_empty()).count();
    let (shown, all) = (measured.flagged.len(), measured.shots.len());
    let mut page = format!("{HEAD}<h1>{flagged} of {all} shots are flagged</h1>\n");
    if shown < flagged {
        page += &format!("<p>The first {shown} are shown.</p>\n");
    }
    for refused in &measured.refused {
        page += &format!("<p>refused: {}</p>\n", escaped(&refused.to_string()));
    }
    measured.flagged.iter().for_each(|example| page += &section(example, keep_dubious));
    page + "</html>\n"
}

fn section(example: &Example, keep_dubious: bool) -> String {
    let Shot { source, .. } = &example.shot;
    let counted = match example.shot.reasons(keep_dubious) {
        none if none.is_empty() => "counts".to_owned(),
        codes => format!("does not count: {}", codes.join(", ")),
    };
    let figure = Figure::double_column(63.0).panel(pictures::signal(example));
    format!(
        "<h2>{}</h2>\n<p>{}; {counted}</p>\n<img alt=\"\" src=\"data:image/svg+xml,{}\">\n",
        escaped(source),
        escaped(&example.shot.flags()),
        in_address(&figure.svg())
    )
}

fn escaped(text: &str) -> String {
    without_controls(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// A picture as a part of an address.
fn in_address(svg: &str) -> String {
    let mut address = String::with_capacity(svg.len() + svg.len() / 4);
    for letter in svg.chars() {
        match letter {
            '%' | '#' | '"' | '<' | '>' | '\n' | '\r' | '\t' => {
                address += &format!("%{:02X}", u32::from(letter));
            }
            plain => address.push(plain),
        }
    }
    address
}

//! Films of oil as Markdown, CSV and JSON.

use super::{OilFilms, OilModel, SPEEDS_M_S, WetContact, incident};
use crate::claims::{claims_json, computed_text, table_head, table_row};
use crate::reproduce::OILS;
use crate::reproduce::tables::TableText;
use serde_json::{Value, json};
use std::fmt::Write as _;

const HEAD: &str = "# Films of the paper's oils\n\n\
    Steel balls on a film of oil that the growing contact traps, contacts 7 to 40, by the oils' own viscosity at 25 °C \
    and pressure–viscosity coefficient; nothing is fitted but where a factor is named. The constant of each class of \
    oils is an estimate. Ranges: 20 to 40 °C, least to largest coefficient, rounding of the printed viscosity and density. \
    Rows with films, and the dry row beside them, are pushed by 0.24 N. The last column is the paper's own model, in rows \
    without a push, whose effective materials were fitted to its measurements.\n";

impl OilFilms {
    /// Tables for people: ratios, claims, materials.
    pub fn markdown(&self) -> String {
        let mut page = HEAD.to_owned();
        page += "\n## Wet over dry incident time\n\n";
        let names = self.models.each_ref().map(|model| model.name.as_str());
        let [film, rest @ ..] = names;
        let head = ["oil", "v0, m/s", film, "least to largest"];
        page += &table_head(head.into_iter().chain(rest));
        for (place, (case, speed, ratios)) in self.rows().enumerate() {
            let [least, most] = self.range(place);
            let [film, rest @ ..] = ratios.map(|ratio| format!("{ratio:.4}"));
            let range = format!("{least:.3} to {most:.3}");
            let first = [case.to_owned(), speed.to_string(), film, range];
            page += &table_row(first.into_iter().chain(rest));
        }
        page += "\nRoot mean square less the paper's:";
        for model in &self.models[..3] {
            let _ = write!(page, " {} {:.4};", model.name, self.residual(model));
        }
        let _ = writeln!(
            page,
            " the factor {:.3} on all viscosities is the least within 0.05 to 1.",
            self.factor
        );
        self.claims(&mut page);
        self.contacts(&mut page);
        page
    }

    /// A column a model. A verdict of the film that its ranges flip is not decidable.
    fn claims(&self, page: &mut String) {
        page.push_str(
            "\n## What the paper says\n\nThe paper's materials are taken as printed here; `claims.md` draws their \
             rounding, which leaves some of these claims not decidable.\n\n",
        );
        let names = self.models.iter().map(|model| model.name.as_str());
        *page += &table_head(std::iter::once("claim").chain(names));
        for (at, first) in self.models[0].evaluated.iter().enumerate() {
            let found = self.models.iter().filter_map(|model| model.evaluated.get(at));
            let cells = found.map(|own| format!("{}: {}", own.verdict, computed_text(own)));
            *page += &table_row(std::iter::once(first.claim.statement.clone()).chain(cells));
        }
    }

    fn contacts(&self, page: &mut String) {
        page.push_str(
            "\n## The material that the film would be taken for\n\n\
             Hertz's contact with a viscoelastic loss, of steel's Young modulus, that gives the film's time and wall peak in a row \
             without a push, as the paper fits it.\n\n",
        );
        let titles = ["K over dry", "paper", "ν", "paper", "η, Pa s", "paper"];
        *page += &table_head(["oil", "v0, m/s"].into_iter().chain(titles));
        for row in &self.materials {
            let (own, paper) = (numbers(&row.film), numbers(&row.paper));
            let pairs = (0..3).flat_map(|at| [own[at], paper[at]].map(|n| (at, n)));
            let cells = pairs.map(|(at, number)| match at {
                2 => format!("{number:.3e}"),
                _ => format!("{number:.3}"),
            });
            let first = [row.case.to_owned(), row.speed_m_s.to_string()];
            *page += &table_row(first.into_iter().chain(cells));
        }
    }

    /// Ratios, and the materials that films would be taken for.
    pub fn csv(&self) -> String {
        let mut csv = TableText::new(
            "case,speed_m_s,ratio_film,ratio_least,ratio_largest,ratio_isoviscous,ratio_factor,ratio_paper,\
             stiffness_ratio,poisson_ratio,viscosity_pa_s,stiffness_ratio_paper,poisson_ratio_paper,viscosity_paper_pa_s",
        );
        for (place, (case, speed, [film, rest @ ..])) in self.rows().enumerate() {
            let material =
                self.materials.get(place).map(|row| [&row.film, &row.paper].map(numbers));
            let ratios = [film].into_iter().chain(self.range(place)).chain(rest);
            let all: Vec<f64> = ratios.chain(material.into_iter().flatten().flatten()).collect();
            csv.row(&[case], Some(speed), &all);
        }
        csv.0
    }

    /// All numbers and verdicts.
    pub fn json(&self) -> Value {
        let model = |model: &OilModel| {
            json!({
                "name": model.name,
                "ratio": by_oil(&incident(&model.evidence)),
                "residual_rms": self.residual(model),
                "claims": claims_json(&model.evaluated),
            })
        };
        json!({
            "speed_m_s": SPEEDS_M_S,
            "models": self.models.iter().map(model).collect::<Vec<_>>(),
            "ratio_range": OILS.iter().zip(&self.ranges).map(|(case, own)| json!({ "case": case, "least_largest": own })).collect::<Vec<_>>(),
            "factor": self.factor,
            "materials": self.materials,
        })
    }

    /// Oil, speed and the models' ratios, oil by oil.
    fn rows(&self) -> impl Iterator<Item = (&'static str, f64, [f64; 4])> {
        let ratios = self.models.each_ref().map(|model| incident(&model.evidence));
        let jobs = OILS.iter().flat_map(|case| SPEEDS_M_S.map(|speed| (*case, speed)));
        jobs.enumerate().map(move |(at, (case, speed))| {
            let ratio = |own: &Vec<f64>| own.get(at).copied().unwrap_or(f64::NAN);
            (case, speed, ratios.each_ref().map(ratio))
        })
    }

    fn range(&self, place: usize) -> [f64; 2] {
        self.ranges.iter().flatten().nth(place).copied().unwrap_or([f64::NAN; 2])
    }
}

fn by_oil(ratios: &[f64]) -> Value {
    let own = OILS.iter().zip(ratios.chunks(SPEEDS_M_S.len()));
    own.map(|(case, ratios)| ((*case).to_owned(), json!(ratios))).collect()
}

fn numbers(contact: &WetContact) -> [f64; 3] {
    [contact.stiffness_ratio, contact.poisson_ratio, contact.viscosity_pa_s]
}

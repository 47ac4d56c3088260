//! What the gauge says as tables (CSV), in SI: what `gauge.json` holds.

use super::GaugeResult;
use crate::csv::{Cell, Csv};
use hertzchain_infer::Problem;
use hertzchain_infer::gauge::{Branch, Contact, Match, NuisanceParameter, Pair, WetRow};

/// Every table: files' names and what stands in them.
pub fn tables(run_gauge: &GaugeResult) -> Vec<(&'static str, String)> {
    let mut all = vec![
        ("summary.csv", summary(run_gauge)),
        ("dry.csv", dry(run_gauge)),
        ("contacts.csv", contacts(run_gauge)),
        ("oils.csv", oils(run_gauge)),
    ];
    all.extend((!run_gauge.verdict.failed.is_empty()).then(|| ("failed.csv", failed(run_gauge))));
    all
}

/// One line a number or sentence of the whole.
fn summary(run_gauge: &GaugeResult) -> String {
    let (gauge, verdict) = (&run_gauge.gauge, &run_gauge.verdict);
    let chi_square = gauge.dry_goodness().chi_square;
    let lines: [(&str, Cell); 6] = [
        ("verdict", verdict.sentence().into()),
        ("doubts", gauge.doubts(verdict).into()),
        ("to_add", gauge.to_add().into()),
        ("dry_chi_square", chi_square.map(|c| c.value).into()),
        ("dry_freedom", chi_square.map(|c| c.freedom).into()),
        ("dry_probability", chi_square.map(|c| c.probability).into()),
    ];
    let line = |(name, value): (&str, Cell)| [name.into(), value];
    Csv::new(["quantity", "value"]).with_all(lines, line).text()
}

/// One line a parameter of the dry contacts.
fn dry(run_gauge: &GaugeResult) -> String {
    let gauge = &run_gauge.gauge;
    let numbered = gauge.dry.parameters().iter().enumerate();
    let line = |(at, parameter): (usize, &hertzchain_infer::Parameter)| -> [Cell; 4] {
        [
            parameter.name.clone().into(),
            parameter.unit.clone().into(),
            gauge.dry_fit.point[at].into(),
            gauge.dry_covariance.sd[at].into(),
        ]
    };
    let table = Csv::new(["name", "unit", "value", "standard_error"]);
    table.with_all(numbered, line).text()
}

/// One line a pair of K and A that a speed allows, the one taken first if any is; one line a
/// speed that determines a combination, or nothing.
fn contacts(run_gauge: &GaugeResult) -> String {
    let titles = "line,speed_m_s,stiffness (N/m^1.5),stiffness_error (N/m^1.5),relaxation_time_s,relaxation_time_s_error,ln_covariance,\
                  combination_exponent,combination_reference_s,taken,missing,branch,scan_complete";
    let lines = run_gauge.rows.iter().flat_map(|row| match &row.contact {
        Err(why) => vec![missing(row, why)],
        Ok(contact) => pairs(row, contact),
    });
    Csv::new(titles.split(',')).with_all(lines, |line| line).text()
}

/// Cells of a table of contacts.
type Line = [Cell; 13];

fn begun(row: &WetRow) -> Line {
    let mut cells = [const { Cell::Empty }; 13];
    cells[0] = row.line.to_string().into();
    cells[1] = row.speed_m_s.into();
    cells
}

fn missing(row: &WetRow, why: &str) -> Line {
    let mut cells = begun(row);
    cells[10] = why.into();
    cells
}

fn pairs(row: &WetRow, contact: &Contact) -> Vec<Line> {
    let mut taken = match &contact.combination {
        None => pair(row, &contact.first),
        Some(combination) => {
            let [(k, k_sd), _] = contact.first.estimates();
            let mut cells = begun(row);
            (cells[2], cells[3]) = (k.into(), k_sd.into());
            (cells[7], cells[8]) = (combination.exponent.into(), combination.reference_s.into());
            cells
        }
    };
    taken[9] = (contact.branch != Branch::Unknown).into();
    taken[11] = contact.branch.name().into();
    taken[12] = contact.is_complete.map_or(Cell::Empty, Cell::from);
    let other = |other: &Pair| {
        let mut cells = pair(row, other);
        cells[9] = false.into();
        cells
    };
    std::iter::once(taken).chain(contact.others.iter().map(other)).collect()
}

fn pair(row: &WetRow, pair: &Pair) -> Line {
    let [(k, k_sd), (a, a_sd)] = pair.estimates();
    let mut cells = begun(row);
    (cells[2], cells[3]) = (k.into(), k_sd.into());
    (cells[4], cells[5]) = (a.into(), a_sd.into());
    cells[6] = pair.covariance[0][1].into();
    cells
}

/// One line an oil, nearest first.
fn oils(run_gauge: &GaugeResult) -> String {
    let titles =
        "name,distance,chi_square,freedom,probability,possible,farthest,farthest_standard_errors";
    let own: Vec<&str> = run_gauge.verdict.matches.first().map_or_else(Vec::new, |found| {
        found.own.iter().map(|own| own.parameter.name.as_str()).collect()
    });
    let titles = titles.split(',').map(str::to_owned);
    let own = own.iter().flat_map(|name| [(*name).to_owned(), format!("{name} error")]);
    let line = |found: &Match| {
        let chi_square = &found.chi_square;
        let cells: [Cell; 8] = [
            found.oil.clone().into(),
            found.distance.into(),
            chi_square.value.into(),
            chi_square.freedom.into(),
            chi_square.probability.into(),
            found.fits().into(),
            found.largest.0.clone().into(),
            found.largest.1.into(),
        ];
        let numbers = |own: &NuisanceParameter| [Cell::from(own.value), own.standard_error.into()];
        cells.into_iter().chain(found.own.iter().flat_map(numbers)).collect::<Vec<_>>()
    };
    let table = Csv::new(titles.chain(own));
    table.with_all(&run_gauge.verdict.matches, line).text()
}

/// One line an oil that could not be computed.
fn failed(run_gauge: &GaugeResult) -> String {
    let line = |(oil, why): &(String, String)| [oil.clone(), why.clone()];
    Csv::new(["name", "why"]).with_all(&run_gauge.verdict.failed, line).text()
}

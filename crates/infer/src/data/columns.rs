//! Which column is what, by title.

use super::{DataError, Observable};

/// A column: its place and its title.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    pub(super) at: usize,
    pub(super) title: String,
}

/// A measured quantity's column, that of its standard error, and those that tell how
/// well this one is known.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Measured {
    pub(super) value: Column,
    pub(super) sigma: Option<Column>,
    /// How many shots it is the mean of.
    pub(super) count: Option<Column>,
    /// The part of its error that all shots share, and that no scatter tells.
    pub(super) shared: Option<Column>,
}

/// All columns that a fit can use.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Columns {
    pub(super) case: Option<Column>,
    /// How many shots a row is of.
    pub(super) shots: Option<Column>,
    pub(super) speed: Measured,
    pub(super) observables: [Option<Measured>; 4],
    /// Correlation of the errors of both times of flight.
    pub(super) correlation: Option<Column>,
}

impl Columns {
    /// Columns of the wanted observables, of which a table must have one.
    pub(super) fn of(
        titles: &[String],
        wanted: &[Observable],
        file: &str,
    ) -> Result<Self, DataError> {
        let missing = |column: &str, expected: String| DataError::NoColumn {
            file: file.to_owned(),
            column: column.to_owned(),
            expected,
        };
        let speed = measured(titles, "speed_m_s").ok_or_else(|| {
            let near = other_unit(titles, "speed", "_m_s");
            missing("speed_m_s", format!("speeds of the striker in m/s{near}"))
        })?;
        let speed = Measured {
            count: find(titles, &["speed_error_shots"]),
            ..speed
        };
        let column = |of: Observable| {
            let is_wanted = wanted.contains(&of);
            let finer = of.finer_column().and_then(|name| finer(titles, name, of));
            let found = finer.or_else(|| measured(titles, of.column()));
            found.filter(|_| is_wanted)
        };
        let observables = Observable::ALL.map(column);
        if observables.iter().all(Option::is_none) {
            let names: Vec<&str> = wanted.iter().map(|of| of.column()).collect();
            return Err(missing(&names.join("` or `"), instead(titles, wanted)));
        }
        // It is that of the times which are read: a table's finer ones, or its plain means.
        let finer = observables[0].as_ref().map(|of| of.value.title.as_str());
        let correlation = match finer == Observable::Incident.finer_column() {
            true => "tof_at_mean_speed_correlation",
            false => "tof_correlation",
        };
        Ok(Self {
            correlation: find(titles, &[correlation]),
            case: find(titles, &["case"]),
            shots: find(titles, &["shots"]),
            speed,
            observables,
        })
    }
}

/// What a table without any wanted observable should have, with a hint at what it has.
fn instead(titles: &[String], wanted: &[Observable]) -> String {
    let kinds = [(true, "times in s"), (false, "ratios of peaks")];
    let kinds = kinds
        .iter()
        .filter(|(times, _)| wanted.iter().any(|of| of.is_time() == *times));
    let kinds: Vec<&str> = kinds.map(|(_, name)| *name).collect();
    let others = Observable::ALL
        .into_iter()
        .filter(|of| !wanted.contains(of));
    let mut others = others.map(Observable::column);
    let there = others.find(|column| titles.iter().any(|title| title == column));
    let hint = there.map_or_else(
        || other_unit(titles, "tof", "_s"),
        |column| format!("; `{column}` is there, but --use does not name it"),
    );
    format!("{}{hint}", kinds.join(" or "))
}

/// A hint at a column that looks like the one wanted, but for its unit.
fn other_unit(titles: &[String], beginning: &str, unit: &str) -> String {
    let near = |title: &&String| title.starts_with(beginning) && !title.ends_with(unit);
    titles.iter().find(near).map_or(String::new(), |title| {
        format!("; `{title}` is not read, since its title does not end with the SI unit")
    })
}

fn find(titles: &[String], names: &[&str]) -> Option<Column> {
    let found = |name: &&str| titles.iter().position(|title| title == name);
    let at = names.iter().find_map(found)?;
    Some(Column {
        at,
        title: titles[at].clone(),
    })
}

/// The column of a quantity, and that of its error under any of the names that
/// `measure` gives it: `x_s_error`, `x_error_s`, `x_sigma_s`.
fn measured(titles: &[String], name: &str) -> Option<Measured> {
    let value = find(titles, &[name])?;
    let unit = ["_m_s", "_s"]
        .into_iter()
        .find(|unit| name.ends_with(unit) && name.len() > unit.len());
    let unit = unit.unwrap_or("");
    let stem = name.strip_suffix(unit).unwrap_or(name);
    let names = [
        format!("{name}_error"),
        format!("{stem}_error{unit}"),
        format!("{stem}_sigma{unit}"),
        format!("{name}_sigma"),
    ];
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    Some(Measured {
        value,
        sigma: find(titles, &names),
        count: find(titles, &[&format!("{name}_count")]),
        shared: None,
    })
}

/// A time taken to the mean speed: shots are counted with the plain mean, and its error
/// holds what they share.
fn finer(titles: &[String], name: &str, of: Observable) -> Option<Measured> {
    let plain = of.column();
    let stem = plain.strip_suffix("_s").unwrap_or(plain);
    Some(Measured {
        count: find(titles, &[&format!("{plain}_count")]),
        shared: find(titles, &[&format!("{stem}_shared_s")]),
        ..measured(titles, name)?
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]
#[path = "tests/columns.rs"]
mod tests;

//! What an experiment says, as one text that two files share if they say the same.

use crate::document::{Number, Value};
use crate::experiment::Experiment;
use crate::spec::SectionSpec;
use std::fmt::Write;

impl Experiment {
    /// Everything that results follow from: keys and values with the numbers that
    /// a program has set, the reading, and the contacts of the chosen case.
    ///
    /// Comments, blanks, and where the file lies do not matter; a number is its
    /// bits. For fingerprints: nobody reads it.
    #[must_use]
    pub fn understood(&self) -> String {
        let mut text = format!("{:?}\n", self.reading());
        for section in self.sections() {
            text += &contacts(section);
        }
        // Files that the text names are read by what needs them; a chain whose
        // end they move has no striker, and is neither swept nor shot at by a rig.
        value(&self.tree().value, &mut text);
        text
    }
}

fn contacts(section: &SectionSpec) -> String {
    let laws = section.laws.iter().map(|law| {
        let given = law.given.iter();
        let given: String = given
            .map(|(name, value)| format!(" {name}={:016x}", value.to_bits()))
            .collect();
        format!(" {}{given};", law.name())
    });
    let laws: String = laws.collect();
    let SectionSpec { from, to, wet, .. } = section;
    let material = section.material;
    format!("{from} {to:?} {wet} {material:?}{laws}\n")
}

fn value(of: &Value, text: &mut String) {
    match of {
        Value::Text(words) => put(text, format_args!("{words:?}")),
        Value::Number(Number { value, .. }) => put(text, format_args!("{:016x}", value.to_bits())),
        Value::Flag(flag) => put(text, format_args!("{flag}")),
        Value::Other(what) => put(text, format_args!("{what}")),
        Value::List(items) => {
            put(text, format_args!("["));
            items.iter().for_each(|item| value(&item.value, text));
            put(text, format_args!("]"));
        }
        Value::Table(entries) => {
            put(text, format_args!("{{"));
            for entry in entries {
                put(text, format_args!("{:?}=", entry.key));
                value(&entry.node.value, text);
            }
            put(text, format_args!("}}"));
        }
    }
}

fn put(text: &mut String, what: std::fmt::Arguments<'_>) {
    // A text takes whatever is written into it.
    let _ = writeln!(text, "{what}");
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROW: &str = "title = \"row\"\n[materials.steel]\nyoung_modulus = \"200 GPa\"\npoisson_ratio = 0.3\n\
        density = \"7.8 g/cm^3\"\n[striker]\nspeed = \"0.5 m/s\"\n[[beads]]\ncount = 20\nradius = \"5 mm\"\n\
        material = \"steel\"\n[[contacts]]\nlaws = [\"elastic_hertz\"]\n";

    fn row(name: &str, text: &str) -> Experiment {
        Experiment::from_text(name, text).unwrap()
    }

    #[test]
    fn comments_blanks_and_places_do_not_matter() {
        let plain = row("row.toml", ROW).understood();
        let commented = ROW.replace("count = 20", "# twenty of them\n\n  count   =  20");
        assert_eq!(row("/elsewhere/other.toml", &commented).understood(), plain);
    }

    #[test]
    fn numbers_readings_and_cases_do() {
        let plain = row("row.toml", ROW);
        let other = row("row.toml", &ROW.replace("0.3", "0.31"));
        assert_ne!(other.understood(), plain.understood());
        let set = plain.set(&[("poisson_ratio", 0.31)]).unwrap();
        assert_eq!(set.understood(), other.understood());
        let dry = crate::preset("dry").unwrap();
        let clipped = dry.with_reading(&crate::Reading {
            tension: crate::reading::TensionReading::Clipped,
            ..dry.reading()
        });
        assert_ne!(clipped.unwrap().understood(), dry.understood());
        let paper = crate::preset("paper").unwrap();
        let of = |case: &str| paper.case(case).unwrap().unwrap().understood();
        assert_ne!(of("dry"), of("pump"));
    }
}

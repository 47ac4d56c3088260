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
    /// bits. For fingerprints: not for reading.
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
#[path = "tests/understood.rs"]
mod tests;

//! What a file counts and names, for messages about what it gets wrong.

use crate::document::{Node, Value};

/// Beads and materials of a file, as far as they can be counted before it is
/// checked.
#[derive(Clone, Debug, Default)]
pub(crate) struct Known {
    /// Number of beads N, where every group has its own.
    beads: Option<i64>,
    materials: Vec<String>,
}

impl Known {
    pub(crate) fn of(tree: &Node) -> Self {
        let groups = tree.get("beads").map_or(&[][..], Node::members);
        let beads = groups.iter().map(group).sum::<Option<i64>>();
        let materials = tree.get("materials").map_or(&[][..], Node::entries);
        Self {
            beads: beads.filter(|&beads| beads > 0),
            materials: materials.iter().map(|entry| entry.key.clone()).collect(),
        }
    }

    /// What a key may count to: beads from 1, contacts and bodies from 0.
    pub(crate) fn range(&self, key: &str) -> Option<(i64, i64)> {
        let beads = self.beads?;
        match key {
            "bead" | "beads" => Some((1, beads)),
            "from" | "to" | "contact" | "contacts" | "positions" | "velocities" => Some((0, beads)),
            _ => None,
        }
    }

    pub(crate) fn counting(key: &str) -> Option<&'static str> {
        match key {
            "bead" | "beads" => Some(BEADS),
            "from" | "to" | "contact" | "contacts" => Some(CONTACTS),
            "positions" | "velocities" => Some(BODIES),
            _ => None,
        }
    }

    /// The names that `material` may have, in words.
    pub(crate) fn expected_material(&self) -> String {
        expected_material(self.materials.iter().map(String::as_str))
    }
}

pub(crate) const BEADS: &str =
    "beads are counted from 1, the first that the striker meets; 0 is the striker itself";
const CONTACTS: &str = "contact 0 lies before bead 1, contact c between beads c and c + 1, the \
                        last one between the last bead and the wall";
const BODIES: &str = "body 0 is the striker, beads are counted from 1";

/// "one of: "steel", "brass"", or the table that is missing.
pub(crate) fn expected_material<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<String> = names.map(|name| format!("\"{name}\"")).collect();
    match names.len() {
        0 => "expected the name of a table [materials.NAME], in quotes".to_owned(),
        1 => format!("expected {}, the file's only material", names[0]),
        _ => format!("expected one of the file's materials: {}", names.join(", ")),
    }
}

fn group(table: &Node) -> Option<i64> {
    let Some(cell) = table.get("cell") else {
        return count(table, "count");
    };
    let parts = cell.members().iter().map(|part| count(part, "count"));
    parts
        .sum::<Option<i64>>()?
        .checked_mul(count(table, "repeat")?)
}

fn count(table: &Node, key: &str) -> Option<i64> {
    match table.get(key).map(|node| &node.value) {
        None => Some(1),
        // A chain has at most some millions of beads.
        Some(Value::Number(number)) if (1.0..1e9).contains(&number.value) => {
            Some(number.value as i64)
        }
        Some(_) => None,
    }
}

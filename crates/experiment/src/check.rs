//! A document against the declared keys: every mistake of form at once.

use crate::bodies::expected_material;
use crate::contacts;
use crate::document::{Node, TableEntry, TomlValue};
use crate::keys::{self, Fields, Key, KeyKind, Need, ROOT, ValueLimits, Variants};
use crate::report::{FileProblem, nearest_word};
use crate::spec::BEADS;
use crate::units;
use crate::values::{ExpectedQuantity, HAS_NONE, HAS_ONE, POWER_LAW, Units, whole};

/// Checks a whole document.
pub(crate) fn check(tree: &Node, units: Units) -> Result<(), Vec<FileProblem>> {
    let mut check = FormCheck { tree, units, problems: Vec::new(), fitting: 0 };
    check.table(tree, &ROOT, None);
    match check.problems.is_empty() {
        true => Ok(()),
        false => Err(merge_unit_slips(check)),
    }
}

/// A check of tables that collects what is wrong.
struct FormCheck<'a> {
    tree: &'a Node,
    units: Units,
    problems: Vec<FileProblem>,
    /// Quantities with a dimension that suit the unit system.
    fitting: usize,
}

impl FormCheck<'_> {
    /// Checks a table against its keys; `tag` is a deciding key already read.
    fn table(&mut self, node: &Node, fields: &'static Fields, tag: Option<&str>) {
        if !node.is_table() {
            let message = format!("{} is {}", fields.title, node.kind());
            let label = format!("expected a table, written {}", written(fields));
            return self.add(&node.span, message, label);
        }
        let mut misspelt = Vec::new();
        for entry in node.entries() {
            match fields.key(&entry.key) {
                Some(key) => self.value(key, &entry.node),
                None if tag == Some(entry.key.as_str()) => {}
                None => {
                    misspelt.extend(fields.slip_of(&entry.key));
                    self.unknown(entry, fields, tag);
                }
            }
        }
        for key in fields.keys {
            let needed = match key.need {
                Need::Always => true,
                Need::InSi => self.units == Units::Si,
                Need::Never => false,
            };
            // A misspelt key is one mistake, and has been reported.
            if needed && node.get(key.name).is_none() && !misspelt.contains(&key.name) {
                let message = format!("{} has no `{}`", fields.title, key.name);
                let label = format!("expected {}: {}", example(key), key.about);
                self.add(&node.span, message, label);
            }
        }
    }

    fn add(&mut self, span: &std::ops::Range<usize>, message: String, label: impl Into<String>) {
        self.problems.push(FileProblem::new(span, message, label));
    }

    fn unknown(&mut self, entry: &TableEntry, fields: &Fields, tag: Option<&str>) {
        let key = &entry.key;
        let names: Vec<&str> = fields.names().into_iter().chain(tag).collect();
        let label = match names.is_empty() {
            true => "expected nothing here".to_owned(),
            false => format!("expected one of: {}", names.join(", ")),
        };
        let message = format!("{} has no key `{key}`", fields.title);
        let mut problem = FileProblem::new(&entry.key_span, message, label);
        if let Some(place) = keys::home(key) {
            problem = problem.help(format!("`{key}` belongs {place}"));
        }
        self.problems.push(match keys::advice_on_key(fields.title, key) {
            Some(advice) => problem.help(advice),
            None if fields.title == ROOT.title && is_material(&entry.node) => {
                problem.help(format!("a material is written [materials.{key}]"))
            }
            None => problem.nearest(fields.slip_of(key).or_else(|| nearest_word(key, tag))),
        });
    }

    fn value(&mut self, key: &'static Key, node: &Node) {
        match &key.kind {
            KeyKind::Quantity(unit, limits) => self.quantity(key.name, unit, *limits, node),
            KeyKind::Scaled(unit, limits) => self.scaled(key.name, unit, *limits, node),
            KeyKind::Quantities(unit) => {
                let before = self.problems.len();
                self.each(key, node, |check, member| {
                    check.quantity(key.name, unit, ValueLimits::ANY, member);
                });
                // A slip that all members share is one mistake.
                let mut own = self.problems.split_off(before);
                own.dedup_by(|next, first| next.message == first.message);
                self.problems.append(&mut own);
            }
            KeyKind::Count { least, most } => self.count(key.name, *least, *most, node),
            KeyKind::Counts => self.each(key, node, |check, member| {
                check.count(key.name, 0, i64::MAX, member);
            }),
            KeyKind::Choice(options) => self.choice(key.name, options, node),
            KeyKind::Text if key.name == "material" => self.material(node),
            KeyKind::Text => self.kind(key, node, "text in quotes", node.text().is_some()),
            KeyKind::Flag => {
                let fits = matches!(node.value, TomlValue::Flag(_));
                self.kind(key, node, "true or false", fits);
            }
            KeyKind::Table(fields) => self.table(node, fields, None),
            KeyKind::Tables(fields) => {
                self.each(key, node, |check, member| check.table(member, fields, None));
            }
            KeyKind::Named(fields) => self.named(key, node, fields),
            KeyKind::Variants(variants) => self.variants(node, variants),
            KeyKind::Laws => self.each(key, node, |check, member| {
                check.problems.extend(contacts::check_law(member, check.units));
            }),
        }
    }

    fn kind(&mut self, key: &Key, node: &Node, expected: &str, fits: bool) {
        if !fits {
            let message = format!("`{}` is {}", key.name, node.kind());
            self.add(&node.span, message, format!("expected {expected}"));
        }
    }

    /// The name of a material; whether there is one is seen later.
    fn material(&mut self, node: &Node) {
        if node.text().is_some() {
            return;
        }
        let message = format!("`material` is {}, not a name in quotes", node.kind());
        let materials = self.tree.get("materials").map_or(&[][..], Node::entries);
        let names: Vec<&str> = materials.iter().map(|entry| entry.key.as_str()).collect();
        let problem = FileProblem::new(&node.span, message, expected_material(&names));
        self.problems.push(match node.is_table() {
            true => problem.help("write it as a table of its own, [materials.NAME]"),
            false => problem,
        });
    }

    fn each(&mut self, key: &Key, node: &Node, mut check: impl FnMut(&mut Self, &Node)) {
        match (&node.value, &key.kind) {
            (TomlValue::List(members), KeyKind::Counts) => {
                members.iter().for_each(|m| check(self, m))
            }
            (TomlValue::List(members), _) if members.is_empty() => {
                let message = format!("`{}` is empty", key.name);
                self.add(&node.span, message, "expected at least one member");
            }
            (TomlValue::List(members), _) => members.iter().for_each(|m| check(self, m)),
            (_, KeyKind::Tables(fields)) => {
                let expected = format!("a list of tables, written {}", written(fields));
                self.kind(key, node, &expected, false);
            }
            _ => self.kind(key, node, "a list in [ ]", false),
        }
    }

    fn quantity(&mut self, name: &str, unit: &str, limits: ValueLimits, node: &Node) {
        let units = self.units;
        match (ExpectedQuantity { name, unit, limits, units }).read(node) {
            Ok(_) => self.fitting += usize::from(unit != "1"),
            Err(problem) => self.problems.push(problem),
        }
    }

    fn scaled(&mut self, name: &str, unit: &str, limits: ValueLimits, node: &Node) {
        if !node.is_table() {
            return self.quantity(name, unit, limits, node);
        }
        let mut misspelt = Vec::new();
        for entry in node.entries() {
            if !POWER_LAW.contains(&entry.key.as_str()) {
                let near = nearest_word(&entry.key, POWER_LAW);
                misspelt.extend(near);
                let message = format!("a power law has no key `{}`", entry.key);
                let problem =
                    FileProblem::new(&entry.key_span, message, "expected prefactor, exponent");
                self.problems.push(problem.nearest(near));
            }
        }
        for (part, unit) in POWER_LAW.into_iter().zip([unit, "1"]) {
            match node.get(part) {
                Some(value) => self.quantity(part, unit, ValueLimits::ANY, value),
                None if misspelt.contains(&part) => {}
                None => {
                    let label = "expected { prefactor = …, exponent = … }, a power law of the \
                                 striker's speed in m/s";
                    self.add(&node.span, format!("`{name}` has no `{part}`"), label);
                }
            }
        }
    }

    fn count(&mut self, name: &str, least: i64, most: i64, node: &Node) {
        let Err(problem) = whole(name, least, most, node) else {
            return;
        };
        let (first, help) = match name {
            "bead" | "beads" => (1, BEADS),
            "from" | "to" | "contact" | "contacts" => (
                0,
                "contact 0 lies before bead 1, contact c between beads c and c + 1, the last one \
                 between the last bead and the wall",
            ),
            "positions" | "velocities" => (0, "body 0 is the striker, beads are counted from 1"),
            _ => return self.problems.push(problem),
        };
        // The same, with the length of this chain.
        let own = bead_count(self.tree).and_then(|beads| whole(name, first, beads, node).err());
        self.problems.push(own.unwrap_or(problem).help(help));
    }

    fn choice(&mut self, name: &str, options: &[&str], node: &Node) {
        let text = node.text().unwrap_or_default();
        let message = match node.text() {
            Some(text) if options.contains(&text) => return,
            Some(text) => format!("`{name}` has no option \"{text}\""),
            None => format!("`{name}` is {}", node.kind()),
        };
        let label = format!("expected one of: \"{}\"", options.join("\", \""));
        let problem = FileProblem::new(&node.span, message, label);
        self.problems.push(match keys::advice_on_option(name, text) {
            Some(advice) => problem.help(advice),
            None => problem.nearest(nearest_word(text, options.iter().copied())),
        });
    }

    fn named(&mut self, key: &Key, node: &Node, fields: &'static Fields) {
        let name = key.name;
        let expected = format!("tables with names, such as [{name}.steel]");
        self.kind(key, node, &expected, node.is_table());
        if let Some(entry) = node.entries().iter().find(|entry| !entry.node.is_table()) {
            let label = match entry.node.value {
                TomlValue::List(_) => format!("expected a table, written [{name}.{}]", entry.key),
                _ => format!("expected it in a table with a name, such as [{name}.steel]"),
            };
            let message = format!("`{}` stands in [{name}] itself", entry.key);
            return self.add(&entry.key_span, message, label);
        }
        for entry in node.entries() {
            // A material inside another table of materials, for want of quotes.
            let mut inner = entry.node.entries().iter();
            match inner.find(|inner| is_material(&inner.node) && !is_material(&entry.node)) {
                Some(inner) => {
                    let (outer, inner_key) = (&entry.key, &inner.key);
                    let message =
                        format!("a point parts the name `{outer}.{inner_key}` in two tables");
                    let label = format!(
                        "expected one name: [{name}.{inner_key}] or [{name}.\"{outer}.{inner_key}\"]"
                    );
                    self.add(&inner.key_span, message, label);
                }
                None => self.table(&entry.node, fields, None),
            }
        }
    }

    fn variants(&mut self, node: &Node, variants: &'static Variants) {
        let (title, tag) = (variants.title, variants.tag);
        let options: Vec<&str> = variants.options.iter().map(|(name, _)| *name).collect();
        if let Some(option) = node.get(tag) {
            self.choice(tag, &options, option);
            if let Some(fields) = option.text().and_then(|option| variants.fields(option)) {
                self.table(node, fields, Some(tag));
            }
            return;
        }
        if !node.is_table() {
            let message = format!("{title} is {}", node.kind());
            return self.add(&node.span, message, "expected a table");
        }
        // Without its deciding key, the problem is at a key that may stand for it.
        let label = format!("expected {tag} = \"{}\"", options.join("\" or \""));
        let known = |key: &str| variants.options.iter().any(|(_, f)| f.key(key).is_some());
        let Some(entry) = node.entries().iter().find(|entry| !known(&entry.key)) else {
            return self.add(&node.span, format!("{title} has no `{tag}`"), label);
        };
        let message = format!("{title} has no key `{}`, and needs `{tag}`", entry.key);
        let advice = entry.node.text().and_then(|text| keys::advice_on_option(tag, text));
        let problem = FileProblem::new(&entry.key_span, message, label);
        self.problems.push(match advice {
            Some(advice) => problem.help(advice),
            None => problem,
        });
    }
}

/// Number of beads N of a file not yet checked; `None` where a group has no valid count.
fn bead_count(tree: &Node) -> Option<i64> {
    let count = |table: &Node, key: &str| match table.get(key).map(|node| &node.value) {
        None => Some(1),
        // A chain has at most some millions of beads.
        Some(TomlValue::Number(number)) if (1.0..1e9).contains(&number.value) => {
            Some(number.value as i64)
        }
        Some(_) => None,
    };
    let group = |table: &Node| match table.get("cell") {
        None => count(table, "count"),
        Some(cell) => {
            let parts = cell.members().iter().map(|part| count(part, "count"));
            parts.sum::<Option<i64>>()?.checked_mul(count(table, "repeat")?)
        }
    };
    let beads: i64 = tree.list("beads").iter().map(group).sum::<Option<i64>>()?;
    (beads > 0).then_some(beads)
}

/// Whether a table has keys that only materials have.
fn is_material(node: &Node) -> bool {
    node.get("young_modulus").is_some() || node.get("poisson_ratio").is_some()
}

/// The form of a table in a file.
fn written(fields: &Fields) -> &'static str {
    match fields.title.starts_with('[') {
        true => fields.title,
        false => "{ key = value, … }",
    }
}

/// A key with a value, as an example of what is missing.
fn example(key: &Key) -> String {
    let name = key.name;
    match &key.kind {
        KeyKind::Quantity("1", _) | KeyKind::Scaled("1", _) => format!("`{name} = 0.3`"),
        KeyKind::Quantity(unit, _) | KeyKind::Scaled(unit, _) => {
            let example = units::parse_unit(unit).map(|unit| unit.dimension.example());
            format!("`{name} = \"{}\"`", example.unwrap_or_default())
        }
        KeyKind::Tables(_) => format!("a table [[{name}]]"),
        KeyKind::Count { .. } => format!("`{name} = 1`"),
        KeyKind::Laws => "`laws = [\"elastic_hertz\"]`".to_owned(),
        _ => format!("`{name} = \"…\"`"),
    }
}

/// The problems of a file, with one in place of all about units where no
/// quantity at all suits the file's unit system.
fn merge_unit_slips(check: FormCheck<'_>) -> Vec<FileProblem> {
    let end = match check.units {
        Units::Si => HAS_NONE,
        Units::Dimensionless => HAS_ONE,
    };
    let (slips, mut others): (Vec<FileProblem>, Vec<FileProblem>) =
        (check.problems.into_iter()).partition(|problem| problem.message.ends_with(end));
    match &slips[..] {
        [first, _, ..] if check.fitting == 0 => {
            let count = slips.len();
            others.insert(0, match (check.units, check.tree.get("units")) {
                (Units::Dimensionless, Some(node)) => {
                    let message = format!("this file is dimensionless, but its {count} quantities have units");
                    let label = "expected \"SI\", or plain numbers throughout";
                    FileProblem::new(&node.span, message, label)
                        .also(&first.span, "the first quantity with a unit")
                }
                _ => {
                    let message = format!("none of the {count} quantities of this file has a unit");
                    let label = "the first: expected a unit, as in \"6.35 mm\"";
                    FileProblem::new(&first.span, message, label)
                        .help("where plain numbers are meant, write units = \"dimensionless\" at the top")
                }
            });
        }
        _ => {
            others.extend(slips);
            others.sort_by_key(|problem| problem.span.start);
        }
    }
    others
}

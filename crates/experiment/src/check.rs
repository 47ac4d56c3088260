//! A document against the declared keys: every mistake of form at once.

use crate::document::{Entry, Node, Value};
use crate::finding::Problem;
use crate::keys::{self, Fields, Key, Kind, Limits, Need, ROOT, Variants, advice};
use crate::known::Known;
use crate::laws;
use crate::nearest;
use crate::value::{Expected, HAS_NONE, HAS_ONE, Units, short};

/// Checks tables and collects what is wrong.
#[derive(Debug)]
pub(crate) struct Check {
    pub(crate) units: Units,
    pub(crate) problems: Vec<Problem>,
    /// Quantities with a dimension that suit the unit system.
    pub(crate) fitting: usize,
    known: Known,
}

/// The keys of a power law of the striker's speed.
pub(crate) const POWER_LAW: [&str; 2] = ["prefactor", "exponent"];

impl Check {
    /// A check of this document.
    pub(crate) fn new(units: Units, tree: &Node) -> Self {
        Self {
            units,
            problems: Vec::new(),
            fitting: 0,
            known: Known::of(tree),
        }
    }

    /// Checks a table against its keys; `tag` is a deciding key already read.
    pub(crate) fn table(&mut self, node: &Node, fields: &'static Fields, tag: Option<&str>) {
        if !matches!(node.value, Value::Table(_)) {
            let message = format!("{} is {}", fields.title, node.kind());
            let label = format!("expected a table, written {}", written(fields));
            self.add(Problem::new(&node.span, message, label));
            return;
        }
        for entry in node.entries() {
            match fields.key(&entry.key) {
                Some(key) => self.value(key, &entry.node),
                None if tag == Some(entry.key.as_str()) => {}
                None => self.unknown(entry, fields, tag),
            }
        }
        // A misspelt key is one mistake, and has been reported.
        let strange = |entry: &&Entry| fields.key(&entry.key).is_none();
        let strange = node.entries().iter().filter(strange);
        let misspelt: Vec<&str> = strange.filter_map(|e| slip_of(&e.key, fields)).collect();
        let missing = |key: &&Key| !misspelt.contains(&key.name);
        for key in fields.keys.iter().filter(missing) {
            self.needed(key, node, fields);
        }
    }

    pub(crate) fn add(&mut self, problem: Problem) {
        self.problems.push(problem);
    }

    fn unknown(&mut self, entry: &Entry, fields: &Fields, tag: Option<&str>) {
        let known: Vec<&str> = fields.keys.iter().map(|key| key.name).chain(tag).collect();
        let message = format!("{} has no key `{}`", fields.title, entry.key);
        let label = format!("expected one of: {}", known.join(", "));
        let label = if known.is_empty() {
            "expected nothing here".to_owned()
        } else {
            label
        };
        let near = slip_of(&entry.key, fields).or_else(|| nearest::of(&entry.key, tag));
        let problem = Problem::new(&entry.key_span, message, label);
        let problem = match keys::home(&entry.key) {
            Some(place) => problem.help(format!("`{}` belongs {place}", entry.key)),
            None => problem,
        };
        self.add(match advice::about(fields.title, &entry.key) {
            Some(advice) => problem.help(advice),
            None if fields.title == ROOT.title && is_material(&entry.node) => {
                problem.help(format!("a material is written [materials.{}]", entry.key))
            }
            None => problem.nearest(near),
        });
    }

    fn needed(&mut self, key: &Key, node: &Node, fields: &Fields) {
        let needed = match key.need {
            Need::Always => true,
            Need::InSi => self.units == Units::Si,
            Need::Never => false,
        };
        if needed && node.get(key.name).is_none() {
            let message = format!("{} has no `{}`", fields.title, key.name);
            let label = format!("expected {}: {}", example(key), key.about);
            self.add(Problem::new(&node.span, message, label));
        }
    }

    fn value(&mut self, key: &'static Key, node: &Node) {
        match &key.kind {
            Kind::Quantity(unit, limits) => self.quantity(key.name, unit, *limits, node),
            Kind::Scaled(unit, limits) => self.scaled(key.name, unit, *limits, node),
            Kind::Quantities(unit) => {
                let before = self.problems.len();
                self.each(key, node, |check, member| {
                    check.quantity(key.name, unit, Limits::ANY, member);
                });
                // A slip that all members share is one mistake.
                let mut own = self.problems.split_off(before);
                own.dedup_by(|next, first| next.same_message(first));
                self.problems.append(&mut own);
            }
            Kind::Count { least, most } => self.count(key.name, *least, *most, node),
            Kind::Counts => self.each(key, node, |check, member| {
                check.count(key.name, 0, i64::MAX, member);
            }),
            Kind::Choice(options) => self.choice(key.name, options, node),
            Kind::Text if key.name == "material" => self.material(node),
            Kind::Text => self.kind(key, node, "text in quotes", node.text().is_some()),
            Kind::Flag => {
                let fits = matches!(node.value, Value::Flag(_));
                self.kind(key, node, "true or false", fits);
            }
            Kind::Table(fields) => self.table(node, fields, None),
            Kind::Tables(fields) => self.each(key, node, |check, member| {
                check.table(member, fields, None);
            }),
            Kind::Named(fields) => self.named(key, node, fields),
            Kind::Variants(variants) => self.variants(node, variants),
            Kind::Laws => self.each(key, node, |check, member| {
                let mut problems = laws::check(member, check.units);
                check.problems.append(&mut problems);
            }),
        }
    }

    fn kind(&mut self, key: &Key, node: &Node, expected: &str, fits: bool) {
        if !fits {
            let message = format!("`{}` is {}", key.name, node.kind());
            self.add(Problem::new(
                &node.span,
                message,
                format!("expected {expected}"),
            ));
        }
    }

    /// The name of a material; whether there is one is seen later.
    fn material(&mut self, node: &Node) {
        if node.text().is_some() {
            return;
        }
        let message = format!("`material` is {}, not a name in quotes", node.kind());
        let problem = Problem::new(&node.span, message, self.known.expected_material());
        self.add(match node.value {
            Value::Table(_) => problem.help("write it as a table of its own, [materials.NAME]"),
            _ => problem,
        });
    }

    fn each(&mut self, key: &Key, node: &Node, mut check: impl FnMut(&mut Self, &Node)) {
        match &node.value {
            Value::List(members) if members.is_empty() && !matches!(key.kind, Kind::Counts) => {
                let message = format!("`{}` is empty", key.name);
                self.add(Problem::new(
                    &node.span,
                    message,
                    "expected at least one member",
                ));
            }
            Value::List(members) => members.iter().for_each(|member| check(self, member)),
            _ => {
                let expected = match key.kind {
                    Kind::Tables(fields) => {
                        format!("a list of tables, written {}", written(fields))
                    }
                    _ => "a list in [ ]".to_owned(),
                };
                self.kind(key, node, &expected, false);
            }
        }
    }

    fn quantity(&mut self, name: &str, unit: &str, limits: Limits, node: &Node) {
        let expected = Expected {
            name,
            unit,
            limits,
            units: self.units,
        };
        match expected.read(node) {
            Ok(_) => self.fitting += usize::from(unit != "1"),
            Err(problem) => self.add(problem),
        }
    }

    fn scaled(&mut self, name: &str, unit: &str, limits: Limits, node: &Node) {
        if !matches!(node.value, Value::Table(_)) {
            return self.quantity(name, unit, limits, node);
        }
        for (part, unit) in POWER_LAW.into_iter().zip([unit, "1"]) {
            match node.get(part) {
                Some(value) => self.quantity(part, unit, Limits::ANY, value),
                None if is_slip_of(part, node) => {}
                None => {
                    let message = format!("`{name}` has no `{part}`");
                    let label = "expected { prefactor = …, exponent = … }, a power law of the \
                                 striker's speed in m/s";
                    self.add(Problem::new(&node.span, message, label));
                }
            }
        }
        for entry in node.entries() {
            if !POWER_LAW.contains(&entry.key.as_str()) {
                let message = format!("a power law has no key `{}`", entry.key);
                let problem =
                    Problem::new(&entry.key_span, message, "expected prefactor, exponent");
                self.add(problem.nearest(nearest::of(&entry.key, POWER_LAW)));
            }
        }
    }

    fn count(&mut self, name: &str, least: i64, most: i64, node: &Node) {
        if let Err(problem) = whole(name, least, most, node) {
            // The same, with what this chain has.
            let problem = match self.known.range(name) {
                Some((least, most)) => whole(name, least, most, node).err().unwrap_or(problem),
                None => problem,
            };
            self.add(match Known::counting(name) {
                Some(help) => problem.help(help),
                None => problem,
            });
        }
    }

    fn choice(&mut self, name: &str, options: &[&str], node: &Node) {
        if node.text().is_some_and(|text| options.contains(&text)) {
            return;
        }
        let message = match node.text() {
            Some(text) => format!("`{name}` has no option \"{text}\""),
            None => format!("`{name}` is {}", node.kind()),
        };
        let label = format!("expected one of: \"{}\"", options.join("\", \""));
        let problem = Problem::new(&node.span, message, label);
        let text = node.text().unwrap_or_default();
        self.add(match advice::option(name, text) {
            Some(advice) => problem.help(advice),
            None => problem.nearest(nearest::of(text, options.iter().copied())),
        });
    }

    fn named(&mut self, key: &Key, node: &Node, fields: &'static Fields) {
        self.kind(
            key,
            node,
            &format!("tables with names, such as [{}.steel]", key.name),
            matches!(node.value, Value::Table(_)),
        );
        let bare = |entry: &&Entry| !matches!(entry.node.value, Value::Table(_));
        if let Some(entry) = node.entries().iter().find(bare) {
            let message = format!("`{}` stands in [{}] itself", entry.key, key.name);
            let label = match entry.node.value {
                Value::List(_) => format!("expected a table, written [{}.{}]", key.name, entry.key),
                _ => format!(
                    "expected it in a table with a name, such as [{}.steel]",
                    key.name
                ),
            };
            return self.add(Problem::new(&entry.key_span, message, label));
        }
        for entry in node.entries() {
            match inner_material(entry) {
                Some(inner) => self.add(name_with_point(key, entry, inner)),
                None => self.table(&entry.node, fields, None),
            }
        }
    }

    fn variants(&mut self, node: &Node, variants: &'static Variants) {
        let options: Vec<&str> = variants.options.iter().map(|(name, _)| *name).collect();
        let Some(tag) = node.get(variants.tag) else {
            return self.untagged(node, variants, &options);
        };
        self.choice(variants.tag, &options, tag);
        if let Some(fields) = tag.text().and_then(|tag| variants.fields(tag)) {
            self.table(node, fields, Some(variants.tag));
        }
    }

    /// A table without its deciding key, at the key that may stand for it.
    fn untagged(&mut self, node: &Node, variants: &Variants, options: &[&str]) {
        if !matches!(node.value, Value::Table(_)) {
            let message = format!("{} is {}", variants.title, node.kind());
            return self.add(Problem::new(&node.span, message, "expected a table"));
        }
        let (title, tag) = (variants.title, variants.tag);
        let label = format!("expected {tag} = \"{}\"", options.join("\" or \""));
        let known = |key: &str| variants.options.iter().any(|(_, f)| f.key(key).is_some());
        let mut entries = node.entries().iter();
        self.add(match entries.find(|entry| !known(&entry.key)) {
            Some(entry) => {
                let message = format!("{title} has no key `{}`, and needs `{tag}`", entry.key);
                let advice = entry.node.text().and_then(|text| advice::option(tag, text));
                let problem = Problem::new(&entry.key_span, message, label);
                match advice {
                    Some(advice) => problem.help(advice),
                    None => problem,
                }
            }
            None => Problem::new(&node.span, format!("{title} has no `{tag}`"), label),
        });
    }
}

/// A whole number within limits.
pub(crate) fn whole(name: &str, least: i64, most: i64, node: &Node) -> Result<i64, Problem> {
    let words = match most {
        i64::MAX => format!("expected a whole number from {least}"),
        _ => format!("expected a whole number from {least} to {most}"),
    };
    let problem = |message: String| Problem::new(&node.span, message, words.clone());
    let Value::Number(number) = &node.value else {
        return Err(problem(format!("`{name}` is {}", node.kind())));
    };
    let value = number.value;
    // Whole numbers beyond 2^53 are not distinguished by a double.
    if value.fract() != 0.0 || value.abs() > 9e15 || !value.is_finite() {
        let message = match value.fract() == 0.0 {
            true => format!("`{name}` = {} is too large", short(value)),
            false => format!("`{name}` = {} is not a whole number", short(value)),
        };
        return Err(problem(message));
    }
    let found = value as i64;
    if (least..=most).contains(&found) {
        Ok(found)
    } else {
        Err(problem(format!("`{name}` = {found} is out of range")))
    }
}

/// Whether a table says what only materials say.
fn is_material(node: &Node) -> bool {
    node.get("young_modulus").is_some() || node.get("poisson_ratio").is_some()
}

/// A material inside another table of materials, for want of quotes.
fn inner_material(entry: &Entry) -> Option<&Entry> {
    let mut inner = entry.node.entries().iter();
    let inner = inner.find(|inner| is_material(&inner.node));
    inner.filter(|_| !is_material(&entry.node))
}

fn name_with_point(key: &Key, outer: &Entry, inner: &Entry) -> Problem {
    let name = format!("{}.{}", outer.key, inner.key);
    let message = format!("a point parts the name `{name}` in two tables");
    let label = format!(
        "expected one name: [{0}.{1}] or [{0}.\"{name}\"]",
        key.name, inner.key
    );
    Problem::new(&inner.key_span, message, label)
}

/// Whether a key that a power law does not know is a slip of this one.
fn is_slip_of(part: &str, node: &Node) -> bool {
    let mut strange = (node.entries().iter()).filter(|e| !POWER_LAW.contains(&e.key.as_str()));
    strange.any(|entry| nearest::of(&entry.key, POWER_LAW) == Some(part))
}

/// How a table is written in a file.
fn written(fields: &Fields) -> &'static str {
    match fields.title.starts_with('[') {
        true => fields.title,
        false => "{ key = value, … }",
    }
}

/// The key of a table that another word was probably meant for.
fn slip_of(word: &str, fields: &Fields) -> Option<&'static str> {
    let known: Vec<&'static str> = fields.keys.iter().map(|key| key.name).collect();
    advice::meant(word, &known).or_else(|| nearest::of(word, known))
}

/// A key with a value, as an example of what is missing.
fn example(key: &Key) -> String {
    let name = key.name;
    match &key.kind {
        Kind::Quantity("1", _) | Kind::Scaled("1", _) => format!("`{name} = 0.3`"),
        Kind::Quantity(unit, _) | Kind::Scaled(unit, _) => {
            let dimension = crate::units::parse_unit(unit).map(|unit| unit.dimension);
            let example = dimension.map_or_else(|_| String::new(), |d| d.example());
            format!("`{name} = \"{example}\"`")
        }
        Kind::Tables(_) => format!("a table [[{name}]]"),
        Kind::Count { .. } => format!("`{name} = 1`"),
        Kind::Laws => "`laws = [\"elastic_hertz\"]`".to_owned(),
        _ => format!("`{name} = \"…\"`"),
    }
}

/// The problems of a file, with one in place of all about units where no
/// quantity at all suits the file's unit system.
pub(crate) fn merge_unit_slips(
    problems: Vec<Problem>,
    fitting: usize,
    units: Units,
    tree: &Node,
) -> Vec<Problem> {
    let about_units = |problem: &Problem| match units {
        Units::Si => problem.says(HAS_NONE),
        Units::Dimensionless => problem.says(HAS_ONE),
    };
    let (slips, mut others): (Vec<Problem>, Vec<Problem>) =
        problems.into_iter().partition(about_units);
    match slips.first() {
        Some(first) if fitting == 0 && slips.len() > 1 => {
            others.insert(0, unit_slip(first, slips.len(), units, tree));
            others
        }
        _ => {
            others.extend(slips);
            others.sort_by_key(Problem::start);
            others
        }
    }
}

fn unit_slip(first: &Problem, count: usize, units: Units, tree: &Node) -> Problem {
    match (units, tree.get("units")) {
        (Units::Dimensionless, Some(node)) => {
            let message =
                format!("this file is dimensionless, but its {count} quantities have units");
            Problem::new(
                &node.span,
                message,
                "expected \"SI\", or plain numbers throughout",
            )
            .beside(first.place(), "the first quantity with a unit")
        }
        _ => {
            let message = format!("none of the {count} quantities of this file has a unit");
            let label = "the first: expected a unit, as in \"6.35 mm\"";
            Problem::new(first.place(), message, label)
                .help("where plain numbers are meant, write units = \"dimensionless\" at the top")
        }
    }
}

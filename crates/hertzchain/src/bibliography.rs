//! The sources of `references.bib`, for reading.

/// The bibliography of the code and the documents: one field a line.
const BIBLIOGRAPHY: &str = include_str!("../../../references.bib");

/// What the bibliography writes in LaTeX, and the same in letters.
const LETTERS: [(&str, &str); 16] = [
    (r"{\'a}", "á"),
    (r"{\'e}", "é"),
    (r"{\'i}", "í"),
    (r"{\'o}", "ó"),
    (r#"{\"a}"#, "ä"),
    (r#"{\"o}"#, "ö"),
    (r#"{\"u}"#, "ü"),
    (r#"{\"U}"#, "Ü"),
    (r"{\'c}", "ć"),
    (r"{\v{s}}", "š"),
    (r"{\o}", "ø"),
    ("--", "–"),
    ("``", "“"),
    ("''", "”"),
    ("{", ""),
    ("}", ""),
];

/// A published work.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Work {
    /// Authors, family name first.
    pub authors: Vec<String>,
    /// Its title.
    pub title: String,
    /// `None` for a book, a thesis or an unpublished work.
    pub journal: Option<String>,
    /// Volume of the journal.
    pub volume: Option<String>,
    /// Pages or number of the article.
    pub pages: Option<String>,
    /// Year in which it appeared.
    pub year: String,
    /// Publisher, school or a note, where there is no journal.
    elsewhere: Option<String>,
}

impl Work {
    /// The work with this key.
    pub fn of_key(key: &str) -> Option<Self> {
        let entry = entry(key)?;
        let field = |name: &str| field(entry, name);
        let authors = field("author")?;
        let places = ["publisher", "school", "note"];
        Some(Self {
            authors: authors.split(" and ").map(str::to_owned).collect(),
            title: field("title")?,
            journal: field("journal"),
            volume: field("volume"),
            pages: field("pages"),
            year: field("year")?,
            elsewhere: places.iter().find_map(|name| field(name)),
        })
    }

    /// Authors, title and place in a line each.
    pub fn lines(&self) -> [String; 3] {
        [self.authors.join("; "), self.title.clone(), self.place()]
    }

    /// "Physical Review E 53, 5382–5392 (1996)".
    fn place(&self) -> String {
        let mut place = self.journal.clone().unwrap_or_default();
        if let Some(volume) = &self.volume {
            place += &format!(" {volume}");
        }
        if let Some(pages) = &self.pages {
            place += &format!(", {pages}");
        }
        if let (None, Some(elsewhere)) = (&self.journal, &self.elsewhere) {
            place += elsewhere;
        }
        format!("{place} ({})", self.year)
    }
}

/// The fields of an entry.
fn entry(key: &str) -> Option<&'static str> {
    let mut entries = BIBLIOGRAPHY.split("\n@").skip(1);
    let of_key = |entry: &&str| {
        let head = entry.lines().next().and_then(|head| head.split_once('{'));
        head.is_some_and(|(_, named)| named.trim_end_matches(',') == key)
    };
    entries.find(of_key)
}

/// A field's text in letters: `name = {text},` on a line of its own.
fn field(entry: &str, name: &str) -> Option<String> {
    let text = entry.lines().find_map(|line| {
        let (key, text) = line.split_once('=')?;
        (key.trim() == name).then(|| text.trim().trim_end_matches(','))
    })?;
    let letters = |text: String, (from, to): &(&str, &str)| text.replace(from, to);
    Some(LETTERS.iter().fold(text.to_owned(), letters))
}

#[cfg(test)]
mod tests {
    use super::{BIBLIOGRAPHY, Work};
    use hertzchain_chain::laws::LAWS;

    fn keys() -> Vec<&'static str> {
        let heads = BIBLIOGRAPHY.lines().filter(|line| line.starts_with('@'));
        let key = |head: &'static str| head.split(['{', ',']).nth(1);
        heads.filter_map(key).collect()
    }

    #[test]
    fn every_entry_reads_without_a_trace_of_latex() {
        assert!(!keys().is_empty());
        for key in keys() {
            let work = Work::of_key(key);
            assert!(work.is_some(), "{key}");
            let text = work.map(|work| work.lines().join("\n")).unwrap_or_default();
            assert!(!text.contains(['\\', '{', '}', '$', '~', '`']), "{text}");
        }
    }

    #[test]
    fn names_and_pages_are_written_as_they_are_read() {
        let work = Work::of_key("Brilliantov1996");
        let lines = work.map(|work| work.lines());
        let expected = [
            "Brilliantov, N. V.; Spahn, F.; Hertzsch, J.-M.; Pöschel, T.",
            "Model for collisions in granular gases",
            "Physical Review E 53, 5382–5392 (1996)",
        ];
        assert_eq!(lines, Some(expected.map(str::to_owned)));
    }

    #[test]
    fn a_work_outside_journals_tells_where_it_is() {
        let place = |key| Work::of_key(key).map(|work| work.lines()[2].clone());
        assert_eq!(place("Nesterenko2001"), Some("Springer (2001)".to_owned()));
        assert!(place("Labbe2017").is_some_and(|place| place.contains("Santiago")));
    }

    #[test]
    fn every_law_has_its_source() {
        for row in LAWS {
            assert!(
                Work::of_key(row.info.reference).is_some(),
                "{}",
                row.info.name
            );
        }
        assert_eq!(Work::of_key("Nobody1900"), None);
    }
}

//! The sources of `references.bib`, for reading.

/// The bibliography of the code and the documents: one field a line.
const BIBLIOGRAPHY: &str = include_str!("../references.bib");

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

#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub(crate) struct Publication {
    /// Authors, family name first.
    pub(crate) authors: Vec<String>,
    /// Its title.
    pub(crate) title: String,
    /// `None` for a book, a thesis or an unpublished work.
    pub(crate) journal: Option<String>,
    /// Volume of the journal.
    pub(crate) volume: Option<String>,
    /// Pages or number of the article.
    pub(crate) pages: Option<String>,
    /// Year in which it appeared.
    pub(crate) year: i32,
    /// Publisher, school or a note, where there is no journal.
    #[serde(skip)]
    elsewhere: Option<String>,
}

impl Publication {
    pub(crate) fn of_key(key: &str) -> Option<Self> {
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
            year: field("year")?.parse().ok()?,
            elsewhere: places.iter().find_map(|name| field(name)),
        })
    }

    /// Authors, title and place in a line each.
    pub(crate) fn lines(&self) -> [String; 3] {
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
#[path = "tests/bibliography.rs"]
mod tests;

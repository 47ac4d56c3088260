//! "Did you mean": the valid word nearest to a mistyped one.

/// Longer texts are no slip of any key.
const LONGEST: usize = 64;

/// The word nearest to `text`, if near enough to be a slip.
pub(crate) fn of<'a>(text: &str, words: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if text.chars().count() > LONGEST {
        return None;
    }
    words
        .into_iter()
        .map(|word| (distance(text, word), word))
        .filter(|(distance, _)| *distance <= allowed(text))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, word)| word)
}

/// As [`of`], for words made on the fly.
pub(crate) fn of_owned(text: &str, words: impl IntoIterator<Item = String>) -> Option<String> {
    let words: Vec<String> = words.into_iter().collect();
    of(text, words.iter().map(String::as_str)).map(str::to_owned)
}

/// Slips, not case, make the distance.
fn distance(a: &str, b: &str) -> usize {
    strsim::damerau_levenshtein(&a.to_lowercase(), &b.to_lowercase())
}

/// One slip in three letters, begun ones counted.
fn allowed(text: &str) -> usize {
    text.chars().count().div_ceil(3).max(1)
}

//! Breaking markup into lines of a given width.

use super::TextLine;

/// Breaks at spaces so that no line is wider than `width`; a single word that
/// is too wide shrinks. At most `max_lines` lines, the last one ending in an
/// ellipsis if something was left out.
pub(crate) fn wrap(markup: &str, size: f64, width: f64, max_lines: usize) -> Vec<TextLine> {
    let mut lines: Vec<String> = Vec::new();
    for word in words(markup) {
        match lines.last_mut() {
            Some(line) if TextLine::new(&format!("{line} {word}"), size).width() <= width => {
                line.push(' ');
                line.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    if lines.len() > max_lines {
        lines.truncate(max_lines);
        if let Some(last) = lines.last_mut() {
            last.push('…');
        }
    }
    lines
        .iter()
        .map(|l| TextLine::new(l, size).shrunk_to(width))
        .collect()
}

/// Words of markup; formulas between dollar signs and no-break spaces hold together.
fn words(markup: &str) -> Vec<String> {
    let (mut found, mut math) = (vec![String::new()], false);
    for c in markup.chars() {
        math ^= c == '$';
        if c.is_whitespace() && c != '\u{a0}' && !math {
            found.push(String::new());
        } else if let Some(word) = found.last_mut() {
            word.push(c);
        }
    }
    found.retain(|w| !w.is_empty());
    found
}

#[cfg(test)]
#[path = "tests/wrap.rs"]
mod tests;

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
        .map(|l| TextLine::new(l, size).fitted(width))
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
mod tests {
    use super::*;

    #[test]
    fn wrapped_lines_stay_within_the_width() {
        let lines = wrap("time of flight falls strictly with the speed", 7.0, 50.0, 9);
        assert!(lines.len() > 1);
        // What is not cut may be wider by a part in a thousand.
        assert!(lines.iter().all(|l| l.width() <= 50.0 * (1.0 + 1e-3)));
    }

    #[test]
    fn too_many_lines_end_in_an_ellipsis() {
        assert_eq!(wrap("one two three four five", 7.0, 12.0, 2).len(), 2);
    }
}

use super::*;

#[test]
fn stacked_scripts_are_as_wide_as_the_wider_one() {
    let width = |markup: &str| TextLine::new(markup, 10.0).width();
    let base = width("$v$");
    let stacked = width("$v_{12}^{3}$") - base;
    let wider = width("$v_{12}$") - base;
    // Both sums round independently in the last bits.
    assert!((stacked - wider).abs() < 1e-9);
}

#[test]
fn fitted_text_is_no_wider_than_asked() {
    let line = TextLine::new("a rather long label", 9.0).shrunk_to(20.0);
    // What is not cut may be wider by a part in a thousand.
    assert!(line.width() <= 20.0 * (1.0 + 1e-3));
}

#[test]
fn what_would_be_too_small_to_read_is_cut_instead() {
    for markup in ["a rather long label", "$K_{12}$ of a rather long label"] {
        let whole = TextLine::new(markup, 9.0);
        let line = whole.clone().shrunk_to(30.0);
        let smallest = line.spans.iter().map(|span| span.scale * line.size);
        // Rounding of one division and product.
        assert!(smallest.fold(9.0, f64::min) > LEAST_SIZE - 1e-9);
        let count = |line: &TextLine| -> usize {
            line.spans.iter().map(|span| span.text.chars().count()).sum()
        };
        assert!(count(&line) < count(&whole));
        // What is not cut may be wider by a part in a thousand.
        assert!(line.width() <= 30.0 * (1.0 + 1e-3));
    }
    assert_eq!(TextLine::new("label", 9.0).shrunk_to(1.0).width(), 0.0);
}

#[test]
fn superscripts_raise_the_line() {
    assert!(TextLine::new("$10^{-5}$", 8.0).ascent() > TextLine::new("10", 8.0).ascent());
}

#[test]
fn live_text_keeps_scripts_as_shifted_runs() {
    let text = TextLine::new("$v_0$ < 1", 10.0).live(Anchor::CENTRE);
    assert!(text.contains("text-anchor=\"middle\"") && text.contains("> &lt; 1</tspan>"), "{text}");
    assert!(text.contains("font-style=\"italic\">v</tspan><tspan dy="), "{text}");
}

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

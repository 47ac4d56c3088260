use super::*;

fn moving(beads: usize, frames: usize) -> Animation {
    let times: Vec<f64> = (0..frames).map(|i| i as f64 * 1e-6).collect();
    let path = |bead: usize| times.iter().map(|t| bead as f64 * 0.01 + t).collect();
    let positions: Vec<Vec<f64>> = (0..beads).map(path).collect();
    let forces = vec![vec![1.0; frames]; beads];
    Animation::new(&times, &positions, &forces, &[0.005])
}

#[test]
fn page_holds_no_reference_to_anything_outside() {
    let page = moving(5, 50).html();
    for outside in ["http:", "https:", "src=", "@import", "href=", "@DATA@", "@TITLE@", "@SCRIPT@"]
    {
        assert!(!page.contains(outside), "{outside}");
    }
}

#[test]
fn units_are_those_asked_for() {
    let plain = moving(3, 4);
    let page =
        Animation { time_unit: (1.0, String::new()), force_unit: String::new(), ..plain }.html();
    assert!(page.contains(r#""timeUnit":"""#) && page.contains(r#""forceUnit":"""#));
    assert!(!page.contains("µs"));
}

#[test]
fn a_title_that_looks_like_a_part_of_the_page_stays_a_title() {
    let title = "@SCRIPT@ and @TITLE@ and \"@DATA@\"";
    let page = Animation { title: title.into(), ..moving(2, 3) }.html();
    let shown = crate::files::escape(title);
    assert_eq!(page.matches(&shown).count(), 2, "{page}");
    assert_eq!(page.matches("const data =").count(), 1);
}

#[test]
fn names_cannot_break_out_of_the_script() {
    let page = Animation {
        title: "<i>".into(),
        marks: vec![(0, "</script><b>\"x\\".into())],
        ..moving(2, 3)
    }
    .html();
    assert_eq!(page.matches("</script>").count(), 1);
    assert!(!page.contains("<i>"));
}

#[test]
fn long_rows_make_files_of_bounded_size() {
    // Two quantities of two bytes, four thirds for base64, and the page itself.
    let most = MOST_VALUES * 2 * 2 * 4 / 3 + 300_000;
    assert!(moving(20_000, 4).html().len() < most);
}

#[test]
fn missing_and_infinite_data_still_make_a_page() {
    let nan = vec![vec![f64::NAN; 3], vec![f64::INFINITY; 2], Vec::new()];
    for times in [&[][..], &[f64::NAN, 1.0], &[0.0, 1.0, 2.0]] {
        let page = Animation::new(times, &nan, &nan, &[f64::NAN]).html();
        assert!(!page.contains("NaN,") && page.contains("</html>"));
    }
}

#[test]
fn quantised_values_keep_the_range_to_half_a_step() {
    let rows = vec![vec![-2.0, 0.1], vec![0.7, 5.0]];
    let (levels, (lo, hi)) = quantised(&rows);
    let step = (hi - lo) / 65535.0;
    for (level, value) in levels.iter().zip(rows.iter().flatten()) {
        // Half a quantum, and a little for rounding.
        assert!((lo + f64::from(*level) * step - value).abs() <= 0.500001 * step);
    }
}

#[test]
fn resampling_passes_over_what_is_not_finite() {
    let found = resampled(&[0.0, 1.0, 2.0], &[0.0, f64::NAN, 4.0], &[0.0, 1.0, 2.0, 9.0]);
    assert_eq!(found, [0.0, 2.0, 4.0, 4.0]);
}

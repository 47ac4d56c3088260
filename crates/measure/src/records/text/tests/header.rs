use super::*;

fn header(text: &str) -> TextHeader {
    TextHeader::of(text, &Dialect::of(text).unwrap(), false)
}

#[test]
fn a_column_of_times_is_told_by_name_unit_or_even_steps() {
    let named = header("Time (ms),Channel A (mV)\n0.000,1.0\n0.001,2.5\n");
    assert_eq!(named.time, Some((0, Some(1e-3))));
    assert_eq!(named.names, ["Channel A"]);
    let units = header("Time,A,B\n(us),(mV),(mV)\n\n0,1.5,2\n1,3.5,4\n2,3.5,1\n");
    assert_eq!((units.time, units.scales), (Some((0, Some(1e-6))), vec![1e-3, 1e-3]));
    let mixed = header("t (s),a (V),b (uV),c (Pa),d\n0,1.5,2,1,1\n1,3.5,4,1,1\n2,3.5,1,1,1\n");
    assert_eq!(mixed.scales, [1.0, 1e-6, 1.0, 1.0]);
    let slashed = header("t/ms;U/V\n0.5;1\n1;2\n1.5;3\n");
    assert_eq!(slashed.time, Some((0, Some(1e-3))));
    let ending = header("time_us,a\n0.5,1\n1,2\n1.5,3\n");
    assert_eq!(ending.time, Some((0, Some(1e-6))));
    let both = header("time_us,ch1_mV,ch2_V\n0.5,1,1\n1,2,1\n1.5,3,1\n");
    assert_eq!(both.scales, [1e-3, 1.0]);
    assert_eq!(units.names, ["A", "B"]);
    let bare = header("0.000,5\n0.002,7\n0.004,1\n0.006,3\n");
    assert_eq!(bare.time, Some((0, None)));
    let strange = header("Moment,a\n0.000,5\n0.002,7\n0.004,1\n0.006,3\n");
    assert_eq!((strange.time, strange.channels), (Some((0, None)), vec![1]));
    let counted = header("0,5.5\n1,7.5\n2,1.5\n3,3.5\n");
    assert_eq!((counted.time, counted.channels), (None, vec![1]));
}

#[test]
fn units_of_time_are_read_however_they_are_written() {
    for (title, unit_s) in [
        ("Time (microseconds)", 1e-6),
        ("Zeit in ms", 1e-3),
        ("time [usec]", 1e-6),
        ("t (msec)", 1e-3),
        ("Time/milliseconds", 1e-3),
        ("Zeit (Mikrosekunden)", 1e-6),
        ("Time in seconds", 1.0),
        ("time ns", 1e-9),
        ("Time (sec.)", 1.0),
        ("Moment in µs", 1e-6),
    ] {
        let found = header(&format!("{title};a\n0.5;1\n1;2\n1.5;4\n"));
        assert_eq!(found.time, Some((0, Some(unit_s))), "{title}");
        assert_eq!(found.strange_unit, None, "{title}");
    }
}

#[test]
fn a_unit_that_no_user_knows_is_named() {
    for title in ["Time (shakes)", "Zeit in shakes", "t [shakes]"] {
        let found = header(&format!("{title};a\n0.5;1\n1;2\n1.5;4\n"));
        assert_eq!(found.time, Some((0, None)), "{title}");
        assert_eq!(found.strange_unit.as_deref(), Some("shakes"), "{title}");
    }
    assert_eq!(header("Time;a\n0.5;1\n1;2\n1.5;4\n").strange_unit, None);
}

#[test]
fn counts_are_times_where_a_caller_says_what_one_is() {
    for text in ["0,5.5\n1,7.5\n2,1.5\n3,3.5\n", "n,a\n0,5\n1,7\n2,1\n3,3\n"] {
        let dialect = Dialect::of(text).unwrap();
        assert_eq!(TextHeader::of(text, &dialect, false).time, None);
        let times = TextHeader::of(text, &dialect, true);
        assert_eq!((times.time, times.channels), (Some((0, None)), vec![1]));
    }
}

#[test]
fn the_mark_of_a_comment_is_no_title() {
    for text in [
        "# t v\n0.5 1\n1 2\n1.5 4\n",
        "# t,v\n0.5,1\n1,2\n1.5,4\n",
        "#t;v\n0.5;1\n1;2\n1.5;4\n",
        "% recorded\n% t v\n0.5 1\n1 2\n1.5 4\n",
    ] {
        let found = header(text);
        assert_eq!(found.time.map(|time| time.0), Some(0), "{text}");
        assert_eq!((found.names, found.channels), (vec!["v".to_owned()], vec![1]));
    }
    // A line of words is none of titles; times are reported by their even steps.
    let worded = header("# recorded\n0.5 1\n1 2\n1.5 4\n");
    assert_eq!(worded.time, Some((0, None)));
    let channels = header("# summed other\n0.5 1\n0.1 2\n1.5 4\n");
    assert_eq!(channels.names, ["summed", "other"]);
    // But a mark over numbers from 1 on is one.
    for text in ["# a\n1 0.5\n2 0.1\n3 0.9\n", "#,a\n1,0.5\n2,0.1\n3,0.9\n"] {
        let counted = header(text);
        assert_eq!((counted.names, counted.channels), (vec!["a".to_owned()], vec![1]));
    }
}

#[test]
fn a_single_column_is_a_channel() {
    let text = "0.1\n0.2\n0.3\n0.4\n";
    assert_eq!(header(text).channels, [0]);
}

#[test]
fn a_stated_interval_may_have_a_decimal_comma() {
    let text = "Increment;1,0E-6\n1,5;2,0\n2,5;1,0\n0,5;3,0\n";
    assert_eq!(header(text).interval_s, Some(1e-6));
}

#[test]
fn an_interval_may_stand_under_its_title() {
    let text =
        "X,CH1,Start,Increment,\nSequence,Volt,-5.0e-04,1.0e-06\n0,1.5,\n1,2.5,\n2,0.5,\n3,1,\n";
    assert_eq!(header(text).interval_s, Some(1e-6));
}

#[test]
fn intervals_and_rates_are_read_with_their_units() {
    for line in [
        "Sample Interval,1e-06",
        "\"Sampling Interval\";\"1 us\"",
        "# sample rate: 1 MS/s",
        "Sampling Rate (MHz) = 1",
        "fs=1000000 Hz",
    ] {
        let text = format!("{line}\n1.5\n2.5\n3.5\n2.5\n7.5\n");
        let stated = header(&text).interval_s.unwrap();
        // Rounding of 1/1e6 and of 1e6 · 1e-6.
        assert!((stated - 1e-6).abs() < 1e-20, "{line}: {stated}");
    }
}

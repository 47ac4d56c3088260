use super::*;

#[test]
fn speeds_in_another_unit_are_refused_not_taken_for_metres_a_second() {
    for title in ["velocity [mm/s]", "speed (cm/s)", "speed error (%)"] {
        let list = ShotList::parse(&format!("file,{title}\na.csv,500\n"));
        assert!(
            matches!(list, Err(MeasureError::List(ref why)) if why.contains("another unit")),
            "{title}"
        );
    }
    for title in ["speed (m/s)", "v0 [m s^-1]", "speed"] {
        let list = ShotList::parse(&format!("file,{title}\na.csv,0.5\n"));
        assert!(list.is_ok(), "{title}");
    }
}

#[test]
fn speeds_of_nothing_are_refused_like_those_below() {
    for speed in ["0", "0.0 m/s", "-0.5"] {
        let list = ShotList::parse(&format!("file,speed\na.csv,{speed}\n"));
        let line_2 = matches!(list, Err(MeasureError::List(ref why)) if why.starts_with("line 2"));
        assert!(line_2, "{speed}");
    }
    assert!(ShotList::parse("file,speed,speed error\na.csv,0.5,0\n").is_ok());
}

#[test]
fn a_list_gives_files_their_speeds() {
    let list = ShotList::parse("file,case,speed,speed error\na.csv,dry,0.5,0.003\nb.csv,,0.7\n");
    let list = list.unwrap();
    let a = list.find(Path::new("data/a.csv"), Some(1)).unwrap();
    assert_eq!((a.case.as_deref(), a.speed_m_s), (Some("dry"), Some(0.5)));
    assert_eq!(a.speed_error_m_s, Some(0.003));
    let b = list.find(Path::new("b.csv"), None).unwrap();
    assert_eq!((b.case.as_deref(), b.speed_m_s), (None, Some(0.7)));
    assert_eq!(list.find(Path::new("c.csv"), None), None);
}

#[test]
fn shots_of_one_file_have_speeds_of_their_own() {
    let list = ShotList::parse("File;Shot;Speed (m/s)\na.h5;1;0,5\na.h5;2;0,7\n").unwrap();
    let speed = |shot| list.find(Path::new("a.h5"), Some(shot)).unwrap().speed_m_s;
    assert_eq!((speed(1), speed(2)), (Some(0.5), Some(0.7)));
}

#[test]
fn quoted_fields_keep_their_commas_and_quotes() {
    let list = "file,case,speed\n\"run 1, dry.csv\",\"gear, 2 drops of \"\"EP\"\"\",0.5\n\n,,\n";
    let list = ShotList::parse(list).unwrap();
    let entry = list.find(Path::new("run 1, dry.csv"), None).unwrap();
    let case = entry.case.as_deref();
    assert_eq!((case, entry.speed_m_s), (Some("gear, 2 drops of \"EP\""), Some(0.5)));
    assert_eq!(list.entries.len(), 1);
    let list = ShotList::parse("file,speed\na.csv,\"0,5\"\n");
    assert!(
        matches!(list, Err(MeasureError::List(ref why)) if why.starts_with("line 2")),
        "{list:?}"
    );
}

#[test]
fn mistakes_are_told_with_their_line() {
    let untitled = ShotList::parse("a,b\n").unwrap_err();
    assert!(untitled.to_string().contains("name the columns"));
    let error = ShotList::parse("file,speed\n\na.csv,fast\n").unwrap_err();
    assert!(error.to_string().contains("line 3"), "{error}");
}

#[test]
fn a_list_excludes_shots_by_yes_and_no() {
    let list = ShotList::parse("file,counts\na.csv,no\nb.csv,Yes\nc.csv,\n").unwrap();
    let counts = |file: &str| list.find(Path::new(file), None).unwrap().counts;
    assert_eq!(["a.csv", "b.csv", "c.csv"].map(counts), [Some(false), Some(true), None]);
    let wrong = ShotList::parse("file,counts\na.csv,perhaps\n");
    assert!(matches!(wrong, Err(MeasureError::List(ref why)) if why.contains("yes or no")));
}

#[test]
fn a_list_has_times_that_were_picked_by_hand() {
    let text = "file;wall pick (s);pick error (s)\na.csv;1,2e-3;2e-7\nb.csv;;\n";
    let list = ShotList::parse(text).unwrap();
    let entry = |file: &str| list.find(Path::new(file), None).unwrap();
    assert_eq!(entry("a.csv").picks_s, [None, Some(1.2e-3), None]);
    assert_eq!(entry("a.csv").pick_error_s, Some(2e-7));
    assert_eq!(entry("b.csv").picks_s, [None; 3]);
    for (text, what) in [("a.csv,,1e-6", "no pick"), ("a.csv,1e-3,0", "above 0")] {
        let wrong = ShotList::parse(&format!("file,wall pick,pick error\n{text}\n"));
        assert!(
            matches!(wrong, Err(MeasureError::List(ref why)) if why.contains(what)),
            "{wrong:?}"
        );
    }
    let other = ShotList::parse("file,wall pick (us)\na.csv,1200\n");
    assert!(matches!(other, Err(MeasureError::List(ref why)) if why.contains("picks in s")));
}

#[test]
fn tables_of_shots_are_known_by_their_titles() {
    for text in [
        "file,case,speed\na.csv,dry,0.5\n",
        "# by hand\n\nFile;Shot;Speed (m/s)\na.h5;1;0,5\n",
        "file,speed (mm/s)\n",
    ] {
        assert!(ShotList::is_begun_by(text), "{text:?}");
    }
    for text in [
        "",
        "file\na.csv\n",
        "time,volt\n0,1\n",
        "Record,Segment,Time,Volt\n1,1,0,0.5\n",
        "1.5\n2.5\n",
    ] {
        assert!(!ShotList::is_begun_by(text), "{text:?}");
    }
}

#[test]
fn columns_that_are_not_read_are_named_and_two_of_one_kind_refused() {
    let list = ShotList::parse("file,date,Speed (m/s),operator\na.csv,today,0.5,me\n").unwrap();
    let unmatched = list.unmatched(&[PathBuf::from("a.csv")], &[]);
    assert!(unmatched[0].contains("not read: date, operator;"), "{unmatched:?}");
    for titles in ["file,speed,v0", "file,speed,speed", "file,record,speed"] {
        let list = ShotList::parse(&format!("{titles}\na,1,2\n"));
        assert!(
            matches!(list, Err(MeasureError::List(ref why)) if why.contains("both taken for")),
            "{titles}: {list:?}"
        );
    }
}

//! Tables of measured curves: what is read and what is refused, with its place.

use hertzchain_infer::{Data, Observable, Selection};

const HEAD: &str = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error\n";

fn parse(text: &str) -> Result<Data, String> {
    let data = Data::parse("a.csv", text, &Selection::default());
    data.map_err(|error| error.to_string())
}

fn refused(rows: &str) -> String {
    parse(&format!("{HEAD}{rows}")).unwrap_err()
}

#[test]
fn rows_come_in_order_of_speed_with_the_line_they_stood_in() {
    let data = parse(&format!("# made\n{HEAD}1.0,0.001,6e-4,1e-7\n0.5,0.001,7e-4,1e-7\n")).unwrap();
    let lines: Vec<u64> = data.rows.iter().map(|row| row.line).collect();
    assert_eq!((lines, data.speeds_m_s()), (vec![4, 3], vec![0.5, 1.0]));
    let incident = data.rows[0].value(Observable::Incident).unwrap();
    assert_eq!((incident.value, incident.sigma), (7e-4, 1e-7));
    assert_eq!(data.rows[0].speed_m_s.sigma, 0.001);
}

#[test]
fn decimal_commas_and_empty_cells_are_read() {
    let head = HEAD.replace(',', ";");
    let data = parse(&format!("{head}0,5;0;7e-4;1e-7\n0,7;0;;\n")).unwrap();
    assert_eq!(data.rows.len(), 1);
    assert_eq!(data.rows[0].speed_m_s.value, 0.5);
}

#[test]
fn two_rows_of_one_speed_are_read() {
    let data = parse(&format!("{HEAD}1,0,6e-4,1e-7\n0.5,0,7e-4,1e-7\n0.5,0,7.1e-4,1e-7\n"));
    assert_eq!(data.unwrap().speeds_m_s(), [0.5, 0.5, 1.0]);
}

#[test]
fn mistakes_name_their_row_and_column() {
    for (rows, words) in [
        ("-0.5,0,7e-4,1e-7\n", "line 2, speed_m_s: -0.5 is no speed"),
        ("500,0,7e-4,1e-7\n", "looks like mm/s"),
        ("0.5,0,7e-4,0\n", "line 2, tof_incident_s_error: 0 is no uncertainty"),
        ("0.5,0,7e-4,-1e-7\n", "-0.0000001 is no uncertainty"),
        ("0.5,0,7e-4,\n", "no uncertainty of this incident ToF"),
        (
            "0.5,0,700,1\n",
            "line 2, tof_incident_s: 700 s is no incident ToF; it looks like microseconds",
        ),
        ("0.5,0,0.7,1e-3\n", "it looks like milliseconds"),
        ("0.5,0,7e-4,0.5\n", "the uncertainty 0.5 s is larger than the value"),
        ("0.5,0,NaN,1e-7\n", "NaN is no incident ToF"),
        ("0.5,0,quick,1e-7\n", "`quick` is no number"),
        (",0,7e-4,1e-7\n", "no speed"),
        ("0.5,0.6,7e-4,1e-7\n", "is not below the speed"),
        ("0.5,0\n", "a.csv"),
        ("0.5,0,,\n", "no row has any of the numbers that are used"),
    ] {
        let error = refused(rows);
        assert!(error.contains(words), "{rows}: {error}");
    }
}

#[test]
fn lines_are_counted_whatever_ends_them() {
    let text = format!("{HEAD}0.4,0,7e-4,1e-7\n-0.5,0,7e-4,1e-7\n");
    for ends in ["\n", "\r\n", "\r"] {
        let error = parse(&text.replace('\n', ends)).unwrap_err();
        assert!(error.contains("line 3, speed_m_s"), "{ends:?}: {error}");
    }
    assert!(parse("\u{feff}\n").unwrap_err().contains("is empty"));
}

#[test]
fn a_missing_column_is_named_with_what_stands_in_its_place() {
    let error = parse("speed,tof_incident_us,tof_incident_us_error\n0.5,700,1\n").unwrap_err();
    assert!(error.contains("no column `speed_m_s`"), "{error}");
    let error = parse("speed_m_s,tof_us\n0.5,700\n").unwrap_err();
    assert!(error.contains("`tof_us` is not read"), "{error}");
    let error = parse("speed_m_s,tof_incident_s\n0.5,7e-4\n").unwrap_err();
    assert!(error.contains("tof_incident_s_error") && error.contains("--tof-error"), "{error}");
    let selection = Selection { time_error_s: Some(1e-7), ..Selection::default() };
    let text = "speed_m_s,tof_incident_s\n0.5,7e-4\n";
    let data = Data::parse("a.csv", text, &selection);
    assert_eq!(data.unwrap().rows[0].values[0].unwrap().sigma, 1e-7);
}

#[test]
fn one_of_several_cases_must_be_chosen() {
    let text = "case,speed_m_s,tof_incident_s,tof_incident_s_error\ndry,0.5,7e-4,1e-7\npump,0.5,6.9e-4,1e-7\n";
    let of = |case: Option<&str>| {
        let case = case.map(str::to_owned);
        let selection = Selection { case, ..Selection::default() };
        Data::parse("a.csv", text, &selection)
    };
    let error = of(None).unwrap_err().to_string();
    assert!(error.contains("--case") && error.contains("dry, pump"), "{error}");
    assert!(of(Some("gear")).unwrap_err().to_string().contains("no case `gear`"));
    // A table without cases takes the case of its model.
    let case = Some("pump".to_owned());
    let selection = Selection { case, ..Selection::default() };
    let plain = Data::parse("a.csv", &format!("{HEAD}0.5,0,7e-4,1e-7\n"), &selection).unwrap();
    assert_eq!((plain.case.as_str(), plain.rows.len()), ("pump", 1));
    let pump = of(Some("pump")).unwrap();
    assert_eq!((pump.case.as_str(), pump.rows.len()), ("pump", 1));
}

#[test]
fn the_correlation_is_that_of_the_times_that_are_read() {
    let head = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error,tof_reflected_s,\
                tof_reflected_s_error,tof_correlation";
    let row = "0.5,1e-3,7e-4,1e-7,7.3e-4,1e-7,";
    let read = |text: &str| Data::parse("a.csv", text, &Selection::default());
    let plain = read(&format!("{head}\n{row}-0.4\n")).unwrap();
    assert_eq!(plain.rows[0].correlation, Some(-0.4));
    assert!(plain.lines_without_correlation().is_empty());
    let finer = format!(
        "{head},tof_incident_at_mean_speed_s,tof_incident_at_mean_speed_s_error,\
         tof_reflected_at_mean_speed_s,tof_reflected_at_mean_speed_s_error,\
         tof_at_mean_speed_correlation\n{row}0.9,7e-4,1e-7,7.3e-4,1e-7,-0.6\n"
    );
    assert_eq!(read(&finer).unwrap().rows[0].correlation, Some(-0.6));
    let without = read(&format!("{head}\n{row}\n")).unwrap();
    assert_eq!(without.rows[0].correlation, None);
    assert_eq!(without.lines_without_correlation(), [2]);
    for wrong in ["1", "-1.5", "nan"] {
        let reported = read(&format!("{head}\n{row}{wrong}\n")).unwrap_err();
        assert!(reported.to_string().contains("tof_correlation"), "{reported}");
    }
}

use super::*;

fn titles(text: &str) -> Vec<String> {
    text.split(',').map(str::to_owned).collect()
}

#[test]
fn errors_are_found_by_either_ending() {
    for text in [
        "case,speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_deviation,tof_incident_s_error",
        "case,speed_m_s,speed_sigma_m_s,tof_incident_s,tof_incident_sigma_s",
    ] {
        let wanted = [Observable::Incident];
        let columns = Columns::of(&titles(text), &wanted, "a.csv").unwrap();
        assert_eq!(columns.speed.sigma, Some(2), "{text}");
        let incident = columns.observables[0].unwrap();
        let last = titles(text).len() - 1;
        assert_eq!(incident.sigma, Some(last), "{text}");
    }
}

#[test]
fn a_missing_column_is_told_with_what_is_there_instead() {
    let reported = |text: &str, wanted: &[Observable]| {
        Columns::of(&titles(text), wanted, "a.csv").unwrap_err().to_string()
    };
    let there = reported("speed_m_s,tof_incident_s", &[Observable::WallOverPassing]);
    let expected =
        "expected ratios of peaks; `tof_incident_s` is there, but --use does not name it";
    assert!(there.ends_with(expected), "{there}");
    let other = reported("speed_m_s,tof_incident_us", &[Observable::Incident]);
    let expected = "expected times in s; `tof_incident_us` is not read, since its title does not end with the SI unit";
    assert!(other.ends_with(expected), "{other}");
    let neither = reported("speed_m_s,speed_error_m_s", &Observable::ALL);
    assert!(neither.ends_with("expected times in s or ratios of peaks"), "{neither}");
}

#[test]
fn a_time_in_another_unit_and_a_column_twice_are_not_left_out_without_a_word() {
    let reported = |text: &str| Columns::of(&titles(text), &Observable::ALL, "a.csv").map(|_| ());
    let other = reported("speed_m_s,tof_incident_us,tof_reflected_s").unwrap_err().to_string();
    assert!(other.contains("`tof_incident_us` is there without"), "{other}");
    let twice = reported("speed_m_s,tof_incident_s,tof_incident_s").unwrap_err().to_string();
    assert!(twice.contains("stands there twice"), "{twice}");
    for error in ["tof_incident_s_error", "speed_error_m_s", "shots", "tof_correlation"] {
        let twice = reported(&format!("speed_m_s,tof_incident_s,{error},{error}")).unwrap_err();
        assert!(twice.to_string().contains(&format!("`{error}` stands there twice")), "{twice}");
    }
    assert!(reported("speed_m_s,tof_incident_s,note,note").is_ok());
    assert!(reported("speed_m_s,tof_incident_s,tof_incident_s_error").is_ok());
}

#[test]
fn a_table_of_single_shots_is_refused_with_what_to_fit() {
    let text = "file,speed_m_s,tof_incident_s,tof_incident_sigma_s,counted,not_counted_because";
    let refused = Columns::of(&titles(text), &Observable::ALL, "shots.csv").map(|_| ());
    assert!(refused.unwrap_err().to_string().contains("`speeds.csv` of the same folder"));
}

#[test]
fn times_at_the_mean_speed_are_read_before_means_that_scatter_with_speeds() {
    let text = "speed_m_s,tof_incident_s,tof_incident_s_error,\
                tof_incident_at_mean_speed_s,tof_incident_at_mean_speed_s_error";
    let columns = Columns::of(&titles(text), &Observable::ALL, "a.csv").unwrap();
    let incident = columns.observables[0].unwrap();
    assert_eq!((incident.value, incident.sigma), (3, Some(4)));
    let columns = Columns::of(&titles(text), &[Observable::Reflected], "a.csv");
    assert!(columns.is_err());
}

#[test]
fn the_correlation_is_that_of_the_times_that_are_read() {
    let read =
        |text: &str| Columns::of(&titles(text), &Observable::ALL, "a.csv").unwrap().correlation;
    let at_mean_speed = "speed_m_s,tof_incident_at_mean_speed_s,tof_reflected_at_mean_speed_s";
    // Of a table with these times alone, `tof_correlation` can mean no others.
    assert_eq!(read(&format!("{at_mean_speed},tof_correlation")), Some(3));
    let own = format!("{at_mean_speed},tof_correlation,tof_at_mean_speed_correlation");
    assert_eq!(read(&own), Some(4));
    assert_eq!(read(&format!("{at_mean_speed},tof_incident_s,tof_correlation")), None);
    let plain = "speed_m_s,tof_incident_s,tof_at_mean_speed_correlation";
    assert_eq!((read(plain), read(&format!("{plain},tof_correlation"))), (None, Some(3)));
}

#[test]
fn a_row_is_not_passed_over_for_a_time_at_the_mean_speed_that_is_missing() {
    let text = "speed_m_s,tof_incident_s,tof_incident_at_mean_speed_s\n0.5,1e-3,1e-3\n1,9e-4,\n";
    let selection = Selection { time_error_s: Some(1e-7), ..Selection::default() };
    let reported = crate::Data::parse("a.csv", text, &selection).unwrap_err().to_string();
    assert!(reported.contains("line 3, tof_incident_at_mean_speed_s: no number"), "{reported}");
    assert!(reported.contains("`tof_incident_s` has one"), "{reported}");
}

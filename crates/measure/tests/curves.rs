//! Records into curves: what counts, what is left out, and in which order.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on should fail")]

use hertzchain_measure::MeasureError;
use hertzchain_measure::records::{SeriesChannels, SeriesInfo, SeriesWriter, ShotRow};
use hertzchain_measure::signal::{
    Bandwidth, Flight, QualityFlag, SignalOptions, without_systematic,
};
use hertzchain_measure::{
    Curves, Cut, Grouping, Level, Measurement, Options, ShotList, measure, shots_csv,
};
use std::fs;
use std::path::{Path, PathBuf};

/// Size of a count in V.
const COUNT_V: f64 = 1e-4;

fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("curves-{test}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Three bells and noise by a formula; heights in counts.
fn samples(incident: f64, height: f64, seed: u64) -> Vec<i16> {
    let bell = |at: f64, i: f64| ((i - at) / 35.0).cosh().powi(-4);
    let noise = |i: u64| ((i * 7919 + seed * 104_729 + i * i * 31) % 23) as f64 - 11.0;
    let sample = |i: u64| {
        let t = i as f64;
        let pulses = bell(500.0, t) + 1.6 * bell(500.0 + incident, t);
        let all = height * (pulses + 0.4 * bell(500.0 + 2.02 * incident, t)) + noise(i);
        all.clamp(-32_768.0, 32_767.0) as i16
    };
    (0..4000).map(sample).collect()
}

fn info(case: &str, reported: &[(&str, &str)]) -> SeriesInfo {
    SeriesInfo {
        channels: SeriesChannels::Summed,
        interval_s: 1e-6,
        volts_per_count: COUNT_V,
        offset_v: 0.0,
        pretrigger: 0,
        samples_per_shot: 4000,
        series: 0,
        case: case.to_owned(),
        seed: 0,
        experiment: String::new(),
        long_names: &[],
        more: [("measured_speed_error_m_s", "0.001")]
            .iter()
            .chain(reported)
            .map(|(name, value)| ((*name).to_owned(), (*value).to_owned()))
            .collect(),
    }
}

fn push(writer: &mut SeriesWriter, shot: u64, speed_m_s: f64, samples: &[i16]) {
    let row = ShotRow {
        shot,
        programmed_speed_m_s: speed_m_s,
        measured_speed_m_s: speed_m_s + 0.002 * (shot as f64 - 2.0),
        triggered: true,
        contacts: &[],
        samples,
        truth: &[],
    };
    writer.push(&row).unwrap();
}

/// As [`series`], of which only so many shots have a return.
fn returning_series(folder: &Path, returns: u64) -> PathBuf {
    let path = folder.join("few.h5");
    let mut writer = SeriesWriter::create(&path, &info("dry", &[])).unwrap();
    for shot in 0..5 {
        let mut samples = samples(700.0, 9000.0, shot);
        if shot >= returns {
            let noise = samples[..1000].to_vec();
            samples.splice(1500..2500, noise.iter().map(|n| n.clamp(&-30, &30)).copied());
        }
        push(&mut writer, shot, 0.5, &samples);
    }
    writer.finish().unwrap()
}

#[test]
fn a_return_that_fewer_than_half_of_a_speeds_shots_have_counts_in_nothing() {
    let folder = folder("few-returns");
    for (returns, missing) in [(5, 0), (3, 2), (2, 5)] {
        let mut measured = measured(&[returning_series(&folder, returns)]);
        // Without the row a shot of two pulses is doubtful; here it is known.
        for shot in &mut measured.shots {
            shot.doubts.clear();
        }
        let curves = Curves::of(&measured.shots, &Grouping::default());
        let row = &curves.cases[0].rows[0];
        let counted = row.reflected_s.map_or(0, |reflected| reflected.count);
        assert_eq!((row.shots.0, row.returns_missing), (5, missing));
        assert_eq!(counted, 5 - missing);
    }
}

/// A series of five shots whose times of flight differ by 0.2 samples.
fn series(folder: &Path, case: &str, speed_m_s: f64, height: f64) -> PathBuf {
    told_series(folder, case, speed_m_s, height, &[])
}

/// The same, of which the file determines more.
fn told_series(
    folder: &Path,
    case: &str,
    speed_m_s: f64,
    height: f64,
    reported: &[(&str, &str)],
) -> PathBuf {
    let path = folder.join(format!("{case}-{speed_m_s}.h5"));
    let mut writer = SeriesWriter::create(&path, &info(case, reported)).unwrap();
    for shot in 0..5_u64 {
        let incident = 630.0 * speed_m_s.powf(-0.2) + 0.2 * (shot as f64 - 2.0);
        push(&mut writer, shot, speed_m_s, &samples(incident, height, shot));
    }
    writer.finish().unwrap()
}

fn measured(files: &[PathBuf]) -> Measurement {
    measure(files, &Options::default(), &())
}

#[test]
fn the_droop_of_the_high_pass_that_a_recording_tells_of_is_taken_out_unless_options_say_more() {
    let folder = folder("high-pass");
    let reported = [("high_pass_hz", "160")];
    let files = [told_series(&folder, "dry", 0.5, 9000.0, &reported)];
    let flights = |options: &Options| {
        let measured = measure(&files, options, &());
        let notes = measured.notes.iter();
        let reported = notes.filter(|note| note.text.contains("high-pass of 160 Hz"));
        let reported = reported.count();
        let flights = measured.shots.into_iter().map(|shot| shot.flight.unwrap());
        (reported, flights.collect::<Vec<Flight>>())
    };
    let given = |hz: f64| Options {
        measuring: SignalOptions {
            high_pass_s: Some((std::f64::consts::TAU * hz).recip()),
            ..SignalOptions::default()
        },
        ..Options::default()
    };
    let kept = Options { keep_droop: true, ..Options::default() };
    let (unasked, of_options) = (flights(&Options::default()), flights(&given(160.0)));
    assert_eq!((unasked.0, of_options.0), (1, 0));
    assert_eq!(unasked.1, of_options.1);
    for other in [given(80.0), kept] {
        let (reported, flights) = flights(&other);
        assert_eq!(reported, 0);
        assert_ne!(flights, unasked.1);
    }
}

#[test]
fn maxima_are_corrected_for_the_low_pass_that_a_recording_states_unless_options_say_more() {
    let folder = folder("low-pass");
    let stated = |order: &'static str, kind: &'static str| {
        let stated = [("low_pass_hz", "20000"), ("low_pass_order", order), ("low_pass_kind", kind)];
        [told_series(&folder, &format!("{order}-{kind}"), 0.5, 9000.0, &stated)]
    };
    let flights = |files: &[PathBuf], options: &Options| {
        let measured = measure(files, options, &());
        let notes = measured.notes.iter();
        let noted = notes.filter(|note| note.text.contains("low-pass of 20000 Hz"));
        let noted = noted.count();
        let flights = measured.shots.into_iter().map(|shot| shot.flight.unwrap());
        (noted, measured.bandwidth, flights.collect::<Vec<Flight>>())
    };
    let given = |corner_hz: f64, order| Options {
        measuring: SignalOptions {
            bandwidth: Some(Bandwidth { corner_hz, order, bessel: false }),
            ..SignalOptions::default()
        },
        ..Options::default()
    };
    let kept = Options { keep_low_pass: true, ..Options::default() };
    for (order, kind, poles) in [("first", "bessel", 1), ("second", "butterworth", 2)] {
        let files = stated(order, kind);
        let unasked = flights(&files, &Options::default());
        let of_options = flights(&files, &given(20e3, poles));
        assert_eq!((unasked.0, of_options.0), (1, 0));
        assert_eq!((unasked.1, &unasked.2), (of_options.1, &of_options.2));
        for other in [given(40e3, poles), kept.clone()] {
            let (noted, _, flights) = flights(&files, &other);
            assert_eq!(noted, 0);
            assert_ne!(flights, unasked.2);
        }
    }
    // Without an order of its own, a corner has the recording's.
    let files = stated("third", "bessel");
    let (bessel, corner) = (flights(&files, &Options::default()), flights(&files, &given(20e3, 0)));
    assert_eq!(bessel.1, Some(Bandwidth { corner_hz: 20e3, order: 3, bessel: true }));
    assert_eq!((bessel.1, bessel.2), (corner.1, corner.2));
}

#[test]
fn what_lies_under_pulses_of_a_summed_channel_does_not_average_out_of_ratios() {
    let folder = folder("ratios");
    let measured = measured(&[series(&folder, "dry", 0.5, 9000.0)]);
    let curves = Curves::of(&measured.shots, &Grouping::default());
    let ratio = curves.cases[0].rows[0].reflected_over_incident.unwrap();
    let picks = measured.shots[0].flight.as_ref().unwrap().picks;
    let shared = picks.reflected.unwrap().systematic.height / picks.incident.height;
    let scatter = ratio.deviation / (ratio.count as f64).sqrt();
    assert!(shared > 2.0 * scatter && ratio.error > 0.9 * shared, "{ratio:?} {shared}");
}

#[test]
fn shots_of_one_programmed_speed_are_one_row_with_mean_and_spread() {
    let folder = folder("row");
    let files = [0.2, 0.5, 1.0].map(|speed| series(&folder, "dry", speed, 9000.0));
    let measured = measured(&files);
    let curves = Curves::of(&measured.shots, &Grouping::default());
    let rows = &curves.cases[0].rows;
    assert_eq!(rows.len(), 3);
    for (row, speed) in rows.iter().zip([0.2_f64, 0.5, 1.0]) {
        assert_eq!(row.shots, (5, 0));
        // The five deviations of the speed cancel up to rounding.
        assert!((row.speed_m_s.value - speed).abs() < 1e-12);
        // The measured speeds' own error, not their spread.
        assert!((row.speed_m_s.sigma - 1e-3 / 5.0_f64.sqrt()).abs() < 1e-12);
        // Noise of 7 in 9000 moves a time by some 0.03 µs; five shots average.
        let expected_s = 630e-6 * speed.powf(-0.2);
        assert!((row.incident_s.mean - expected_s).abs() < 6e-8, "{row:?}");
        // 0.2 samples times the deviation of −2..=2, √2.5, and the noise.
        assert!((row.incident_s.deviation - 0.316e-6).abs() < 1e-7, "{row:?}");
    }
    let law = curves.cases[0].laws.incident.as_ref().unwrap();
    // Speeds are wrong by less than 1e-12 here; times by 1e-4 at most.
    assert!((law.exponent + 0.2).abs() < 2e-4, "{law:?}");
}

#[test]
fn clipped_shots_are_flagged_and_count_only_if_asked() {
    let folder = folder("clipped");
    let files = [series(&folder, "dry", 0.5, 30_000.0)];
    let measured = measured(&files);
    for shot in &measured.shots {
        let clipped = |doubt: &QualityFlag| matches!(doubt, QualityFlag::Saturation(_));
        assert!(shot.doubts.iter().any(clipped), "{}", shot.flags());
    }
    assert!(Curves::of(&measured.shots, &Grouping::default()).cases.is_empty());
    let keep = Grouping { keep_dubious: true, ..Grouping::default() };
    assert_eq!(Curves::of(&measured.shots, &keep).cases[0].rows[0].shots.0, 5);
}

#[test]
fn shots_without_a_time_or_a_speed_of_their_own_are_counted_as_left_out_of_their_speed() {
    let folder = folder("left-out");
    let mut shots = measured(&[series(&folder, "dry", 0.5, 9000.0)]).shots;
    // What a photogate with a large error may determine.
    shots[0].speed_m_s.as_mut().unwrap().value = -0.1;
    shots[1].flight = Err(MeasureError::TooShort(3, 30));
    let curves = Curves::of(&shots, &Grouping::default());
    assert_eq!(curves.cases[0].rows[0].shots, (3, 2));
    assert!(curves.unmeasured.is_empty());
    let flags = shots[0].flags();
    assert!(flags.contains("speed of -0.1000 m/s is none"), "{flags}");
}

#[test]
fn scatter_that_measured_speeds_explain_is_no_error_of_a_law() {
    let folder = folder("explained");
    let mut shots = measured(&[series(&folder, "dry", 0.5, 9000.0)]).shots;
    // Speeds to which these very times belong.
    for shot in &mut shots {
        let time_s = shot.flight.as_ref().unwrap().incident_s.value;
        let speed = shot.speed_m_s.as_mut().unwrap();
        speed.value = (time_s / 630e-6).powf(-5.0);
    }
    let curves = Curves::of(&shots, &Grouping::default());
    let row = &curves.cases[0].rows[0];
    let at_mean = row.at_mean_speed_s[0].unwrap();
    // Rounding: all times are one when taken to one speed, and that is the law's.
    assert!((at_mean.value / (630e-6 * row.speed_m_s.value.powf(-0.2)) - 1.0).abs() < 1e-12);
    // Errors that are a shot's own average out over five shots; what lies under their
    // pulses they share, and it stays.
    let flights = shots.iter().map(|shot| shot.flight.as_ref().unwrap());
    let own = |flight: &Flight| {
        without_systematic(flight.incident_s.sigma, flight.systematic()[0]).powi(2)
    };
    let own: f64 = flights.map(own).sum();
    let stated = (own.sqrt() / 5.0).hypot(row.shared_s[0]);
    assert!(row.shared_s[0] > 0.1 * stated);
    // Taking a time to the mean speed moves its sigma by 1e-3 of itself.
    assert!((at_mean.sigma / stated - 1.0).abs() < 1e-3);
    // Times differ by 0.2 samples a shot, more than noise moves them.
    assert!(own.sqrt() / 5.0 < 0.5 * row.incident_s.error, "{row:?}");
}

#[test]
fn wet_is_held_against_dry_with_both_errors() {
    let folder = folder("ratio");
    let files = [series(&folder, "dry", 0.5, 9000.0), series(&folder, "pump", 0.5, 9000.0)];
    let curves = Curves::of(&measured(&files).shots, &Grouping::default());
    let ratio = curves.ratios[0].incident[0];
    // The same series twice, to the last bit.
    assert_eq!(ratio.ratio.value, 1.0);
    let relative = |case: usize| {
        let row = &curves.cases[case].rows[0];
        let speed = 0.2 * row.speed_m_s.sigma / row.speed_m_s.value;
        let time = row.at_mean_speed_s[0].unwrap();
        (time.sigma / time.value).hypot(speed)
    };
    // Rounding.
    assert!((ratio.ratio.sigma - relative(0).hypot(relative(1))).abs() < 1e-15);
}

#[test]
fn results_come_in_the_order_of_the_records_whatever_the_threads() {
    let folder = folder("order");
    let files = [0.2, 0.5].map(|speed| series(&folder, "dry", speed, 9000.0));
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| measured(&files).shots)
    };
    let one = on(1);
    let numbers: Vec<u64> = one.iter().filter_map(|shot| shot.shot).collect();
    assert_eq!(numbers, [0, 1, 2, 3, 4, 0, 1, 2, 3, 4]);
    assert_eq!(one, on(3));
}

#[test]
fn a_list_overrides_what_files_say() {
    let folder = folder("list");
    let files = [series(&folder, "dry", 0.5, 9000.0)];
    let list = "file,shot,case,speed,speed error\ndry-0.5.h5,3,gear,0.7,0.01\n";
    let options = Options { list: Some(ShotList::parse(list).unwrap()), ..Options::default() };
    let shots = measure(&files, &options, &()).shots;
    let third = shots[3].speed_m_s.unwrap();
    assert_eq!((shots[3].case.as_str(), third.value, third.sigma), ("gear", 0.7, 0.01));
    assert_eq!(shots[2].case, "dry");
}

/// Shots of one kind in one recording, 50,000 samples apart, as text.
fn recording(folder: &Path, heights: &[f64]) -> PathBuf {
    let path = folder.join("long.csv");
    let mut text = "# rate: 1 MS/s\n".to_owned();
    for height in heights {
        let shot = samples(700.0, *height, 1);
        for i in 0..50_000_usize {
            // Between shots there is the noise of the shot's beginning.
            text += &format!("{}\n", shot.get(i).copied().unwrap_or(shot[i % 300]));
        }
    }
    fs::write(&path, text).unwrap();
    path
}

fn cut(file: &Path, cutting: Cut) -> Measurement {
    let options = Options { cutting, ..Options::default() };
    measure(&[file.to_owned()], &options, &())
}

#[test]
fn several_shots_in_one_recording_are_cut_apart_where_that_is_plain() {
    let file = recording(&folder("plain"), &[9000.0, 8000.0, 9000.0]);
    let found = cut(&file, Cut::Plain);
    let numbers: Vec<_> = found.shots.iter().map(|shot| shot.shot).collect();
    assert_eq!(numbers, [Some(1), Some(2), Some(3)]);
    for shot in &found.shots {
        let incident_s = shot.flight.as_ref().unwrap().incident_s.value;
        // Noise of 7 in 8000 moves a time by some 0.03 µs.
        assert!((incident_s - 700e-6).abs() < 2e-7, "{incident_s}");
        assert_eq!(shot.flags(), "");
    }
    assert!(found.notes.iter().any(|note| note.text.contains("--whole")));
    // One record all the same: no time between pulses of two shots counts.
    let one = cut(&file, Cut::Never).shots;
    assert_eq!(one.len(), 1);
    assert_eq!(one[0].reasons(false)[..1], ["no-speed"]);
    assert!(one[0].holds_several && one[0].is_dubious());
}

#[test]
fn several_shots_that_are_not_plain_are_a_doubt_and_a_level_cuts_them() {
    let file = recording(&folder("mixed"), &[9000.0, 2000.0, 9000.0]);
    let found = cut(&file, Cut::Plain);
    assert_eq!(found.shots.len(), 1);
    assert!(found.shots[0].flags().contains("--level"), "{}", found.shots[0].flags());
    assert!(found.shots[0].is_dubious());
    let level = |volts, samples| Cut::Level(Level { volts, samples });
    for samples in [None, Some(4000)] {
        let found = cut(&file, level(1000.0, samples));
        assert_eq!(found.shots.len(), 3);
        for shot in &found.shots {
            let incident_s = shot.flight.as_ref().unwrap().incident_s.value;
            // Noise of 7 in 2000.
            assert!((incident_s - 700e-6).abs() < 1e-6, "{incident_s}");
        }
        assert!(found.shots[2].source.contains("shot 3 at 0.1005 s"), "{}", found.shots[2].source);
    }
    let never = cut(&file, level(50_000.0, None));
    let why = never.refused[0].to_string();
    assert!(why.contains("never passes the level of 50000 V"), "{why}");
}

#[test]
fn speeds_of_a_list_that_numbers_more_shots_than_were_cut_out_are_of_none() {
    let file = recording(&folder("shifted"), &[9000.0, 2000.0, 9000.0]);
    let speeds = |volts, lines: u32| {
        let lines = (1..=lines).map(|shot| format!("long.csv,{shot},0.{shot}\n"));
        let list = "file,shot,speed\n".to_owned() + &lines.collect::<String>();
        let options = Options {
            cutting: Cut::Level(Level { volts, samples: Some(4000) }),
            list: Some(ShotList::parse(&list).unwrap()),
            ..Options::default()
        };
        let found = measure(std::slice::from_ref(&file), &options, &());
        let of = found.shots.iter().map(|shot| shot.speed_m_s.map(|speed| speed.value));
        (of.collect::<Vec<_>>(), found.refused.first().map(ToString::to_string))
    };
    assert_eq!(speeds(1000.0, 3), (vec![Some(0.1), Some(0.2), Some(0.3)], None));
    // The level passes over the second shot.
    let (none, why) = speeds(5000.0, 3);
    assert_eq!(none, [None, None]);
    let why = why.unwrap();
    assert!(why.contains("is cut into 2 shots, and the table of shots has speeds for 3"), "{why}");
    assert_eq!(speeds(5000.0, 2).0, [Some(0.1), Some(0.2)]);
}

#[test]
fn a_level_finds_the_same_shots_whatever_the_pieces() {
    let folder = folder("pieces");
    let path = folder.join("long.h5");
    let info = SeriesInfo {
        channels: SeriesChannels::Summed,
        interval_s: 1e-6,
        volts_per_count: COUNT_V,
        offset_v: 0.01,
        pretrigger: 0,
        samples_per_shot: 1_300_000,
        series: 0,
        case: "dry".to_owned(),
        seed: 0,
        experiment: String::new(),
        long_names: &[],
        more: Vec::new(),
    };
    let mut writer = SeriesWriter::create(&path, &info).unwrap();
    let shot = samples(700.0, -9000.0, 1);
    // The second lies across the end of the first piece of 2^20 samples.
    let mut counts = vec![3_i16; 1_300_000];
    for at in [1000, (1 << 20) - 1000, 1_200_000] {
        counts[at..at + 4000].copy_from_slice(&shot);
    }
    writer
        .push(&ShotRow {
            shot: 0,
            programmed_speed_m_s: 0.5,
            measured_speed_m_s: 0.5,
            triggered: true,
            contacts: &[],
            samples: &counts,
            truth: &[],
        })
        .unwrap();
    let file = writer.finish().unwrap();
    let falling = Cut::Level(Level { volts: -0.4, samples: Some(4000) });
    let found = cut(&file, falling);
    assert_eq!(found.shots.len(), 3);
    let times = found.shots.iter().map(|shot| shot.flight.as_ref().unwrap().incident_s.value);
    let times: Vec<f64> = times.collect();
    // The same samples thrice; only where they begin differs.
    assert!(times.iter().all(|time| (time - times[0]).abs() < 1e-9), "{times:?}");
    assert_eq!(found.shots[2].speed_m_s.map(|speed| speed.value), Some(0.5));
}

#[test]
fn lines_and_shots_that_do_not_find_each_other_are_told() {
    let folder = folder("unmatched");
    let files = [series(&folder, "dry", 0.5, 9000.0)];
    let list = "file,shot,speed\ndry-0.5.h5,3,0.7\ndry-0.5.h5,3,0.8\ndry-0.5.h5,9,0.7\nno.h5,,1\n";
    let options = Options { list: Some(ShotList::parse(list).unwrap()), ..Options::default() };
    let reported = measure(&files, &options, &()).unmatched;
    assert_eq!(reported.len(), 3, "{reported:?}");
    assert_eq!(reported[0], "line 3: an earlier line is about the same");
    assert_eq!(reported[1], "line 4: dry-0.5.h5 has no shot 9");
    assert_eq!(reported[2], "line 5: no.h5 is none of the files given (dry-0.5.h5)");
}

#[test]
fn picks_by_hand_replace_those_of_the_program_and_make_shots_count() {
    let folder = folder("by-hand");
    let path = folder.join("series.h5");
    let mut writer = SeriesWriter::create(&path, &info("dry", &[])).unwrap();
    push(&mut writer, 0, 0.5, &samples(700.0, 9000.0, 0));
    // Too high for the converter, and noise alone.
    push(&mut writer, 1, 0.5, &samples(700.0, 40_000.0, 1));
    push(&mut writer, 2, 0.5, &samples(700.0, 0.0, 2));
    writer.finish().unwrap();
    let text = "file,shot,incident pick,wall pick,pick error\n\
                series.h5,0,,1.2e-3,1e-6\nseries.h5,1,5e-4,1.2e-3,\nseries.h5,2,5e-4,1.2e-3,\n";
    let list = Some(ShotList::parse(text).unwrap());
    let measured = measure(&[path], &Options { list, ..Options::default() }, &());
    let flights: Vec<&Flight> =
        measured.shots.iter().map(|shot| shot.flight.as_ref().unwrap()).collect();
    assert_eq!(flights[0].picks.wall.time_s, 1.2e-3);
    assert_eq!(flights[0].picks.wall.sigma_s, 1e-6);
    assert!((flights[0].picks.incident.time_s - 5e-4).abs() < 1e-6, "the program's own");
    for flight in &flights[1..] {
        assert!((flight.incident_s.value - 7e-4).abs() < 1e-12);
        assert!((flight.incident_s.sigma - 2.0_f64.sqrt() * 1e-6).abs() < 1e-12, "of a sample");
    }
    for shot in &measured.shots {
        assert_eq!(shot.reasons(false), Vec::<&str>::new(), "{}", shot.flags());
        assert!(shot.flags().contains("wall pulse picked by hand"), "{}", shot.flags());
    }
}

#[test]
fn picks_by_hand_outside_the_record_are_refused() {
    let folder = folder("by-hand-outside");
    let path = folder.join("series.h5");
    let mut writer = SeriesWriter::create(&path, &info("dry", &[])).unwrap();
    push(&mut writer, 0, 0.5, &samples(700.0, 9000.0, 0));
    push(&mut writer, 1, 0.5, &samples(700.0, 9000.0, 1));
    writer.finish().unwrap();
    // Of 4 ms.
    let text = "file,shot,wall pick,reflected pick\nseries.h5,0,9,\nseries.h5,1,3.8e-3,3.9e-3\n";
    let list = Some(ShotList::parse(text).unwrap());
    let measured = measure(&[path], &Options { list, ..Options::default() }, &());
    assert_eq!(measured.shots[0].reasons(true), ["no-time"]);
    assert!(measured.shots[1].flight.is_ok());
    let reported = &measured.unmatched[0];
    for part in ["wall pick of 9 s (line 2 ", "series.h5", "shot 0", "from 0 to 0.004000000 s"] {
        assert!(reported.contains(part), "{reported}");
    }
    assert!(measured.shots[0].flags().contains(reported.as_str()));
}

#[test]
fn picks_by_hand_that_do_not_follow_each_other_as_the_wave_passes_are_refused() {
    let folder = folder("by-hand-order");
    let path = folder.join("series.h5");
    let mut writer = SeriesWriter::create(&path, &info("dry", &[])).unwrap();
    (0..4).for_each(|shot| push(&mut writer, shot, 0.5, &samples(700.0, 9000.0, shot)));
    writer.finish().unwrap();
    // The program's own incident pulse is at 0.5 ms.
    let text = "file,shot,incident pick,wall pick,reflected pick\nseries.h5,0,1.2e-3,6e-4,\n\
                series.h5,1,,4e-4,\nseries.h5,2,5e-4,1.2e-3,1.2e-3\nseries.h5,3,5e-4,1.2e-3,2e-3\n";
    let list = Some(ShotList::parse(text).unwrap());
    let measured = measure(&[path], &Options { list, ..Options::default() }, &());
    for shot in 0..3 {
        assert_eq!(measured.shots[shot].reasons(true), ["no-time"]);
    }
    assert!(measured.shots[3].flight.is_ok());
    let [first, mixed, equal] = [0, 1, 2].map(|shot| &*measured.unmatched[shot]);
    for part in ["wall pulse at 0.0006 s", "incident pulse at 0.0012 s", "shot 0", "line 2 "] {
        assert!(first.contains(part), "{first}");
    }
    assert!(mixed.contains("wall pulse at 0.0004 s is not after the incident"), "{mixed}");
    assert!(equal.contains("reflected pulse at 0.0012 s is not after the wall"), "{equal}");
}

/// A shot whose incident pulse has two equal maxima.
fn split(seed: u64) -> Vec<i16> {
    let bell = |at: f64, i: f64| 9000.0 * ((i - at) / 35.0).cosh().powi(-4);
    let rest = samples(700.0, 9000.0, seed);
    let one = |(i, sample): (usize, i16)| {
        let i = i as f64;
        sample + (bell(465.0, i) + bell(535.0, i) - bell(500.0, i)) as i16
    };
    rest.into_iter().enumerate().map(one).collect()
}

#[test]
fn a_shot_that_the_mean_of_its_speed_leaves_out_is_reported_as_not_counted() {
    let path = folder("undecided").join("series.h5");
    let mut writer = SeriesWriter::create(&path, &info("dry", &[])).unwrap();
    (0..4).for_each(|shot| push(&mut writer, shot, 0.5, &samples(700.0, 9000.0, shot)));
    push(&mut writer, 4, 0.5, &split(4));
    writer.finish().unwrap();
    let mut measured = measure(&[path], &Options::default(), &());
    let curves = measured.curves(&Grouping::default());
    assert_eq!(curves.cases[0].rows[0].shots, (4, 1));
    let last = &measured.shots[4];
    assert_eq!(last.reasons(false), ["ambiguous"], "{}", last.flags());
    let table = shots_csv(&measured.shots, &curves);
    assert_eq!(table.matches(",yes,").count(), 4, "{table}");
    assert_eq!(table.matches(",no,ambiguous,").count(), 1, "{table}");
    let keep = Grouping { keep_dubious: true, ..Grouping::default() };
    let curves = measured.curves(&keep);
    assert_eq!(curves.cases[0].rows[0].shots, (5, 0));
    assert_eq!(shots_csv(&measured.shots, &curves).matches(",yes,").count(), 5);
}

//! What fit doubts: models that do not follow the data, numbers that act in one way alone,
//! and how numbers stand in what it says.

use crate::common::{curve, file, folder, json, refused, run, with_errors};

/// What a run says: its result and its warnings.
fn reported(arguments: &[&str]) -> [String; 2] {
    let output = run(arguments);
    [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap())
}

#[test]
fn a_model_that_does_not_follow_the_data_is_told_and_ranked() {
    let folder = folder("misfit");
    let data = curve(&folder, "dry");
    // Without the cubic term no viscosity gives these times.
    let misfit =
        ["fit", &data, "-p", "hertz-viscoelastic", "--free", "eta", "--against", "dry=eta,B"];
    let found = json(&with_errors(&[&misfit[..], &["--json"]].concat()));
    assert_eq!(found["follows_data"], false);
    let models = found["comparison"]["models"].as_array().unwrap();
    assert_eq!(models.len(), 2);
    let aicc = |at: usize| models[at]["aicc"].as_f64().unwrap();
    assert!(models[0]["model"].as_str().unwrap().starts_with("hertz-viscoelastic"));
    assert!(aicc(0) > aicc(1) + 100.0, "{models:?}");
    let [text, _] = reported(&with_errors(&misfit));
    assert!(text.contains("warning: the model does not follow the data"), "{text}");
    // The better one stands above the fit's own.
    let place = |model: &str| text.rfind(model).unwrap();
    let table = text.find("AICc above best").unwrap();
    assert!(table < text[table..].find("dry (eta, B)").unwrap() + table);
    let other = text[table..].find("hertz-viscoelastic.toml (eta)");
    assert!(text[table..].find("dry (eta, B)") < other, "{text}");
    assert!(place("is rejected") > table, "{text}");
    // What follows the data is not doubted.
    let fit = ["fit", &data, "-p", "dry", "--free", "eta,B"];
    assert_eq!(json(&with_errors(&[&fit[..], &["--json"]].concat()))["follows_data"], true);
    let [text, _] = reported(&with_errors(&fit));
    assert!(!text.contains("warning"), "{text}");
}

#[test]
fn a_young_modulus_beside_a_stiffness_of_its_own_acts_through_the_relaxation_time_and_a_warning_says_so()
 {
    let folder = folder("beside");
    let data = curve(&folder, "dry");
    let warned = |more: &[&str]| {
        let fit = ["fit", &data, "-p", "dry", "--accuracy", "1e-5"];
        let [_, warnings] = reported(&with_errors(&[&fit[..], more].concat()));
        warnings.contains("acts through the relaxation time A alone")
    };
    assert!(warned(&["--free", "Y,K"]));
    assert!(warned(&["--free", "Y", "--set", "elastic_hertz.stiffness=8.8e9 N/m^1.5"]));
    assert!(!warned(&["--free", "Y,eta"]));
    assert!(!warned(&["--free", "eta", "--set", "elastic_hertz.stiffness=8.8e9 N/m^1.5"]));
}

#[test]
fn priors_that_are_none_are_told_with_what_is_expected() {
    let folder = folder("priors");
    let data = curve(&folder, "dry");
    for (prior, words) in [
        ("eta=3e4", "--prior eta=3e4: expected MEAN+-SD, or MEDIAN*/FACTOR"),
        ("eta=3e4*/0.9", "expected a factor above 1 after */"),
        ("eta=fast+-1", "--prior eta=fast+-1:"),
        (
            "eta=1e3+-0",
            "eta: a prior 1000 ± 0 is no distribution; widths and medians must be positive",
        ),
        ("eta=-3e4*/1.1", "eta: a prior -30000 times or over 1.1 is no distribution"),
        (
            "eta=3.1e4+-100",
            "eta starts at 32000, 10.0 standard deviations from the middle of its prior",
        ),
    ] {
        let fit = ["fit", &data, "-p", "dry", "--free", "eta", "--prior", prior];
        let message = refused(&with_errors(&fit));
        assert!(message.contains(words), "{prior}: {message}");
    }
}

/// The longest run of digits after a point in a text, and where it stands.
fn longest_decimals(text: &str) -> (usize, &str) {
    let fractions = text.split(|letter: char| !letter.is_ascii_digit() && letter != '.');
    let decimals = |word: &&str| word.split_once('.').map_or(0, |(_, rest)| rest.len());
    let longest = fractions.max_by_key(decimals).unwrap_or_default();
    (decimals(&longest), longest)
}

/// No user gave 0.008726646259971648 or 1.1000000000000003.
#[test]
fn no_number_is_told_with_digits_that_no_user_gave() {
    let folder = folder("digits");
    let data = curve(&folder, "dry");
    let fit = ["fit", &data, "-p", "dry", "--free"];
    let mut texts = Vec::new();
    for more in [
        &["eta,incline", "--start", "incline=0.5deg", "--bounds", "incline=0.7deg:0.9deg"][..],
        &["eta,incline", "--bounds", "incline=0.9deg:0.7deg"],
        &["eta", "--prior", "eta=0*/1.1"],
        &["eta", "--prior", "eta=0.1kPa s+-0"],
        &["eta", "--start", "eta=32.1 kPa s", "--prior", "eta=30.1 kPa s+-0.1 kPa s"],
        &["nu", "--start", "nu=0.3", "--scale", "nu=-0.1"],
    ] {
        texts.push(refused(&with_errors(&[&fit[..], more].concat())));
    }
    let softer = String::from_utf8(run(&["presets", "dry"]).stdout).unwrap();
    let softer = file(&folder, "softer.toml", &softer.replace("\"213 GPa\"", "\"75.8641 GPa\""));
    let whole = [&fit[..], &["eta,B", "--method", "profile", "--set", "young_modulus=213.1GPa"]];
    texts.extend(reported(&with_errors(&whole.concat())));
    let other = ["fit", &data, "-m", &softer, "--free", "Y,eta", "--start", "Y=210.1GPa"];
    texts.extend(reported(&with_errors(&other)));
    let design = ["design", &data, "-p", "dry", "--free", "eta,B", "--preloads", "0.3N"];
    texts.extend(reported(&with_errors(&design)));
    for text in &texts {
        // Times of flight to their errors have eight; a ten-digit number below 1, twelve.
        let (count, number) = longest_decimals(text);
        assert!(count <= 12, "{number}: {text}");
    }
}

#[test]
fn a_fit_with_as_many_numbers_as_parameters_reports_no_degrees_of_freedom() {
    let folder = folder("no-freedom");
    let rows = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error,tof_reflected_s,tof_reflected_s_error\n\
                0.5,1e-4,7.5e-4,1e-7,7.9e-4,1e-7\n";
    let data = file(&folder, "one.csv", rows);
    let fit = ["fit", &data, "-p", "hertz-viscoelastic", "--free", "K,A"];
    let [text, _] = reported(&fit);
    assert!(text.contains("ν = 0: as many numbers as parameters"), "{text}");
    assert!(!text.contains("runs") && !text.contains("largest residual"), "{text}");
    assert!(json(&[&fit[..], &["--json"]].concat())["runs"].is_null());
}

/// Times of the dry chain at its two slowest speeds, with errors that leave B open.
const TWO: &str = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error,tof_reflected_s,\
                   tof_reflected_s_error,tof_correlation\n\
                   0.1183961371494931,0.002,0.000992561614763589,3e-7,0.0010254300323363174,5e-7,-0.6\n\
                   0.15233724181052974,0.002,0.0009445795708972756,3e-7,0.0009788467304079284,5e-7,-0.6\n";

#[test]
fn a_fit_that_ends_next_to_where_the_model_fails_says_so_in_sizes() {
    let data = file(&folder("edge"), "two.csv", TWO);
    let fit = |bounds: &str| {
        let found = run(&["fit", &data, "-p", "dry", "--free", "eta,B", "--bounds", bounds]);
        String::from_utf8(found.stdout).unwrap()
    };
    let text = fit("B=-1000:1000");
    let warning = "warning: the model fails next to this B: at 0.11";
    assert!(text.contains(warning), "{text}");
    // One scale for the change and for how well the combination is known: B starts at 77.
    assert!(text.contains("B up 1.00 % of 77 kg s/m^2"), "{text}");
    // One end is left out, or infinite.
    for bounds in ["B=0:", "B=0:inf", "B=-inf:1e6", "B=:"] {
        let text = fit(bounds);
        assert!(text.contains("at its bound") && !text.contains("the model fails"), "{text}");
    }
    let message = refused(&["fit", &data, "-p", "dry", "--free", "B", "--bounds", "B=0"]);
    assert!(message.contains("expected FROM:TO"), "{message}");
}

//! The viscosity of a film of oil, from times of flight and back.

use crate::common::{chains, model};
use hertzchain_experiment::Experiment;
use hertzchain_infer::gauge::{Chains, Gauge, LEAST_PROBABILITY};
use hertzchain_infer::{
    Choices, Covariance, CurveProblem, Data, DataRow, ExpectedErrors, Fitting, Freedom, Goodness,
    Model, Problem, Speeds, design, fit, ways,
};
use hertzchain_measure::signal::Estimate;
use hertzchain_sim::Stop;

/// A row short enough for a test: a film has the adaptive loop alone.
const ROW: &str = "[materials.steel]\nyoung_modulus = \"213 GPa\"\npoisson_ratio = 0.3\n\
    shear_viscosity = \"3.2e4 Pa s\"\n\
    [liquid]\nkinematic_viscosity_40 = \"55 cSt\"\nkinematic_viscosity_100 = \"7.7 cSt\"\n\
    density = \"870 kg/m^3\"\npressure_viscosity = \"16 1/GPa\"\n\
    [striker]\nspeed = \"0.3 m/s\"\n\
    [[beads]]\ncount = 6\nradius = \"6.35 mm\"\nmass = \"8.54 g\"\nmaterial = \"steel\"\n\
    [[contacts]]\nto = 1\nlaws = [\"elastic_hertz\", \"damping_viscoelastic\"]\n\
    [[contacts]]\nfrom = 2\nwet = true\nlaws = [\"elastic_hertz\", \"damping_viscoelastic\", \"film_entrained\"]\n\
    [near_end]\npush = \"constant\"\nforce = \"0.24 N\"\n[far_end]\nkind = \"half-bead\"\n[sensors]\nbead = 2\n\
    [solver]\nduration = \"0.2 ms\"\n";

/// Standard error of a time of flight in s.
const TIME_S: f64 = 0.1e-6;

/// Incident times of a model at a point, off by these numbers of standard errors.
fn measured(model: &Model, point: &[f64], off: &[(f64, f64)]) -> Data {
    let speeds: Vec<f64> = off.iter().map(|(speed, _)| *speed).collect();
    let curve = model.curves(&[point.to_vec()], &Speeds::of_rows(&speeds)).remove(0).unwrap();
    let row = |(at, (speed, off)): (usize, &(f64, f64))| DataRow {
        line: at as u64 + 2,
        speed_m_s: Estimate { value: *speed, sigma: 0.0 },
        values: [
            Some(Estimate { value: curve[at][0].unwrap() + off * TIME_S, sigma: TIME_S }),
            None,
            None,
            None,
        ],
        correlation: None,
        freedom: Freedom::KNOWN,
    };
    let rows = off.iter().enumerate().map(row).collect();
    Data { file: "simulated".to_owned(), case: String::new(), rows }
}

#[test]
fn a_film_gives_its_viscosity_back_within_its_error() {
    let experiment = Experiment::from_text("film.toml", ROW).unwrap();
    let model = model(&experiment, &["viscosity"]).with_accuracy(3e-5);
    let exact = 0.08;
    let data = measured(&model, &[exact], &[(0.8, 0.7)]);
    let mut parameters = model.numbers.parameters(&data.speeds_m_s());
    // Where it starts is the oil's at 25 °C.
    assert!((parameters[0].start / 0.1065 - 1.0).abs() < 1e-3, "{}", parameters[0].start);
    // Thinner oils cost more steps, and the law does not hold for them.
    (parameters[0].lower, parameters[0].upper) = (0.03, 0.3);
    let problem = CurveProblem::new(model, data, parameters).unwrap();
    let best =
        fit(&problem, &Fitting { iterations: 3, tolerance: 1e-3, ..Fitting::default() }).unwrap();
    let sd = Covariance::new(problem.parameters(), &best).sd[0];
    // The one time is off by 0.7 of its error.
    assert!((best.point[0] - exact).abs() < 2.0 * sd, "{:?} ± {sd}", best.point);
    assert!(sd < 0.3 * exact, "{sd}");
}

/// Speeds of the wet rows, and by how many standard errors their times are off.
const OFF: [(f64, f64); 3] = [(0.3, 0.5), (0.5, -0.4), (1.0, 0.3)];

/// The wet row and the dry one.
fn rows() -> [Experiment; 2] {
    let without = ROW.replace(", \"film_entrained\"", "").replace("wet = true\n", "");
    [("film.toml", ROW), ("dry.toml", &without)]
        .map(|(name, text)| Experiment::from_text(name, text).unwrap())
}

/// Wet incident times at up to three speeds, of films of these viscosities, and dry ones, off by
/// these numbers of standard errors.
fn gauge(viscosities: &[f64], off: &[(f64, f64)]) -> Gauge {
    let [wet, dry] = rows();
    let chains = Chains {
        dry: &dry,
        wet: &wet,
        free: &["eta".to_owned()],
        systematic: &[],
        own: &[],
        film: &["viscosity".to_owned()],
        accuracy: 1e-5,
    };
    let model = model(&wet, &["viscosity"]);
    let rows = viscosities.iter().zip(&OFF);
    let rows = rows.map(|(viscosity, off)| measured(&model, &[*viscosity], &[*off]).rows.remove(0));
    let data = Data { rows: rows.collect(), ..measured(&model, &[0.1], &[]) };
    let eta = crate::common::model(&dry, &["eta"]);
    Gauge::new(&chains, measured(&eta, &[3.2e4], off), data).unwrap()
}

#[test]
fn the_gauge_gives_a_films_viscosity_at_each_speed_and_over_all() {
    let (gauge, mut errors) = (gauge(&[0.08; 3], &OFF), Vec::new());
    for row in gauge.rows() {
        let (value, sd) = row.contact.unwrap().first.estimates()[0];
        // The time is off by half its error, the dry contacts are known by three times.
        assert!((value - 0.08).abs() < 2.0 * sd && sd < 0.08, "{value} ± {sd}");
        errors.push(sd);
    }
    let (problem, found, chi_square) = gauge.film().unwrap();
    let sd = Covariance::new(problem.parameters(), &found).sd;
    let at = problem.parameters().iter().position(|p| p.name == "viscosity").unwrap();
    assert!((found.point[at] - 0.08).abs() < 2.0 * sd[at], "{:?} ± {sd:?}", found.point);
    assert!(errors.iter().all(|of_one| sd[at] < *of_one), "{sd:?} {errors:?}");
    // Three wet times for one viscosity.
    let chi_square = chi_square.unwrap();
    assert!(chi_square.freedom == 2 && chi_square.probability > 0.1, "{chi_square:?}");
}

#[test]
fn the_gauge_rejects_one_film_where_speeds_need_different_ones() {
    let (_, _, chi_square) = gauge(&[0.04, 0.08, 0.2], &OFF).film().unwrap();
    assert!(chi_square.unwrap().probability < LEAST_PROBABILITY);
}

/// Sixty rows of these errors, in turn positive and negative.
fn many_rows(off: f64) -> Vec<(f64, f64)> {
    let row = |at: usize| (OFF[at % 3].0, if at.is_multiple_of(2) { off } else { -off });
    (0..60).map(row).collect()
}

#[test]
fn dry_rows_do_not_hide_a_misfit_of_the_wet_ones() {
    let (problem, found, chi_square) = gauge(&[0.066, 0.08, 0.1], &many_rows(0.3)).film().unwrap();
    let both = Goodness::new(&problem, &found).chi_square.unwrap();
    assert!(both.probability > LEAST_PROBABILITY, "{both:?}");
    let chi_square = chi_square.unwrap();
    assert!(chi_square.probability < LEAST_PROBABILITY, "{chi_square:?}");
    assert_eq!(chi_square.freedom, 2);
}

#[test]
fn a_dry_curve_off_its_model_is_not_the_films_fault() {
    let (problem, found, chi_square) = gauge(&[0.08; 3], &many_rows(2.0)).film().unwrap();
    let both = Goodness::new(&problem, &found).chi_square.unwrap();
    assert!(both.probability < LEAST_PROBABILITY, "{both:?}");
    let chi_square = chi_square.unwrap();
    assert!(chi_square.probability > 0.1, "{chi_square:?}");
}

#[test]
fn a_volume_of_the_liquid_names_that_of_the_film() {
    let [_, dry] = rows();
    let liquid = "pressure_viscosity = \"16 1/GPa\"\n";
    let limited = ROW.replace(liquid, &format!("{liquid}volume = \"1e-14 m^3\"\n"));
    let wet = Experiment::from_text("limited.toml", &limited).unwrap();
    let (free, film) = (["eta".to_owned()], ["volume".to_owned()]);
    let chains = Chains { free: &free, film: &film, ..chains(&dry, &wet) };
    let eta = crate::common::model(&dry, &["eta"]);
    let data = || measured(&eta, &[3.2e4], &OFF[..1]);
    let number = Gauge::new(&chains, data(), data()).unwrap().film_number().unwrap();
    assert_eq!((number.name.as_str(), number.start), ("film_entrained.volume", 1e-14));
}

#[test]
fn one_wet_row_leaves_nothing_to_test_a_film_by() {
    let (problem, found, chi_square) = gauge(&[0.08], &OFF).film().unwrap();
    assert!(chi_square.is_none(), "{chi_square:?}");
    // The dry curve has degrees of freedom of its own.
    assert!(Goodness::new(&problem, &found).chi_square.is_some());
}

#[test]
fn a_film_has_no_other_numbers_than_its_own() {
    let [wet, dry] = rows();
    let eta = crate::common::model(&dry, &["eta"]);
    let data = || measured(&eta, &[3.2e4], &OFF[..1]);
    let refused = |wet: &Experiment, names: &[&str]| {
        let film: Vec<String> = names.iter().map(ToString::to_string).collect();
        let free = ["eta".to_owned()];
        let chains = Chains { free: &free, film: &film, ..chains(&dry, wet) };
        Gauge::new(&chains, data(), data()).err().unwrap().to_string()
    };
    for name in ["speed_scale", "delay", "wet.K", "Y"] {
        let message = refused(&wet, &["viscosity", name]);
        let expected = "is no number of a film: expected viscosity, pressure_viscosity or volume";
        assert_eq!(message, format!("{name} {expected}"));
    }
    assert!(refused(&wet, &["viscosity:each"]).contains("do not depend on speed"));
    let without = ROW.replace(", \"film_entrained\"", "");
    let without = Experiment::from_text("plain.toml", &without).unwrap();
    let message = refused(&without, &["viscosity"]);
    let expected = "add film_entrained to its wet contacts, or use --preset pump-film";
    assert!(message.contains("has no film") && message.ends_with(expected), "{message}");
}

#[test]
fn a_design_says_what_would_tighten_a_films_viscosity() {
    let experiment = Experiment::from_text("film.toml", ROW).unwrap();
    let model = model(&experiment, &["viscosity"]);
    let data = measured(&model, &[0.1], &[(0.3, 0.1), (0.6, -0.1)]);
    let parameters = model.numbers.parameters(&data.speeds_m_s());
    let problem = CurveProblem::new(model, data, parameters).unwrap();
    let best = fit(&problem, &Fitting::default()).unwrap();
    let errors = ExpectedErrors::like(problem.data());
    let ways = ways(&experiment, &Choices::default()).unwrap();
    let stop = Stop::default();
    stop.clone().adopt();
    let candidates = problem.candidates(&best, &ways[..1], &[0.4, 0.8], &errors).unwrap();
    let points = stop.done();
    // What reads more from the same shots computes none.
    let more = problem.candidates(&best, &ways[..3], &[0.4, 0.8], &errors).unwrap();
    assert!(points >= 6 && stop.done() == 2 * points, "{points} {}", stop.done());
    assert_eq!(more[..2], candidates);
    let ratio = problem.candidates(&best, &ways[2..3], &[0.4, 0.8], &errors).unwrap();
    assert_eq!(more[4..], ratio);
    let found = design(problem.parameters(), &best, &candidates, &[0], 1).unwrap();
    // Both data alone; a third time of the kind takes off a fifth.
    let (before, after) = (found.before[0], found.ranked[0].after[0]);
    assert!(before < 0.01 && after < 0.9 * before && after > 0.6 * before, "{before} {after}");
}

//! K and A of unlike contacts: one contact's value, to which the others keep their ratios.

use crate::common::{TRUTH, model, speeds_between};
use hertzchain_experiment::Experiment;
use hertzchain_infer::{
    Covariance, CurveProblem, Data, DataRow, End, Fitting, FreeNumber, Freedom, Model, Predicted,
    Problem, Profiling, Speeds, fit, profile,
};
use hertzchain_measure::signal::Estimate;

/// Steel and a softer, more viscous bronze.
const MATERIALS: &str = "[materials.steel]\nyoung_modulus = \"200 GPa\"\npoisson_ratio = 0.3\n\
    density = \"7.8 g/cm^3\"\nshear_viscosity = \"3e4 Pa s\"\n\
    [materials.bronze]\nyoung_modulus = \"110 GPa\"\npoisson_ratio = 0.34\ndensity = \"8.8 g/cm^3\"\n\
    shear_viscosity = \"5e4 Pa s\"\n[striker]\nspeed = \"0.5 m/s\"\n[sensors]\nbead = 3\n\
    [[contacts]]\nlaws = [\"elastic_hertz\", \"damping_viscoelastic\"]\n";

const ROW: &str = "[[beads]]\ncount = 12\nradius = \"5 mm\"\nmaterial = \"steel\"\n";
const DIMERS: &str = "[[beads]]\nrepeat = 6\ncell = [{ radius = \"5 mm\", material = \"steel\" }, \
    { radius = \"3 mm\", material = \"steel\" }]\n";
const MIXED: &str = "[[beads]]\nrepeat = 6\ncell = [{ radius = \"5 mm\", material = \"steel\" }, \
    { radius = \"5 mm\", material = \"bronze\" }]\n";

/// Rows whose contacts differ in radius or material, by name.
fn rows() -> [(&'static str, Experiment); 5] {
    [
        ("plane", ROW, "[far_end]\nkind = \"plane\"\n"),
        (
            "plane on a stop",
            ROW,
            "[far_end]\nkind = \"plane-stop\"\nmass = \"1 kg\"\nmaterial = \"bronze\"\n",
        ),
        ("smaller half-bead", ROW, "[far_end]\nkind = \"half-bead\"\nradius = \"2 mm\"\n"),
        ("dimers", DIMERS, "[far_end]\nkind = \"plane\"\n"),
        ("mixed", MIXED, "[far_end]\nkind = \"half-bead\"\n"),
    ]
    .map(|(name, beads, far)| {
        let text = format!("title = \"{name}\"\n{beads}{far}{MATERIALS}");
        (name, Experiment::from_text(name, &text).unwrap())
    })
}

/// Both materials 4 % stiffer with 10 % more viscosity: K and A of every contact grow by
/// 4 % and by 1.1/1.04.
fn changed(row: &Experiment) -> Experiment {
    let all = [
        ("materials.steel.young_modulus", 1.04 * 200e9),
        ("materials.bronze.young_modulus", 1.04 * 110e9),
        ("materials.steel.shear_viscosity", 1.1 * 3e4),
        ("materials.bronze.shear_viscosity", 1.1 * 5e4),
    ];
    row.set(&all).unwrap()
}

fn times(row: &Experiment, point: &[f64], names: &[&str], speeds: &[f64]) -> Vec<Predicted> {
    let model = model(row, names).with_accuracy(TRUTH);
    let curves = model.curves(&[point.to_vec()], &Speeds::of_rows(speeds));
    curves.into_iter().next().unwrap().unwrap()
}

#[test]
fn a_set_k_and_a_are_those_of_one_contact_and_scale_the_others() {
    let speeds = [0.2, 0.7];
    for (name, row) in rows() {
        let start = |name: &str| FreeNumber::find(&row, name, None).unwrap();
        let numbers = ["K", "A"].map(start);
        let reference = numbers[0].reference.as_ref().unwrap();
        assert_eq!(reference.contact, Some(1), "{name}");
        let [least, most] = reference.ratios;
        assert!(most / least > 1.01, "{name}: {least} to {most}");
        let own = numbers.map(|number| number.parameters(&[])[0].start);
        let truth = times(&changed(&row), &[], &[], &speeds);
        let scaled = times(&row, &[1.04 * own[0], 1.1 / 1.04 * own[1]], &["K", "A"], &speeds);
        let paths = ["elastic_hertz.stiffness", "damping_viscoelastic.relaxation_time"];
        let values = [1.04 * own[0], 1.1 / 1.04 * own[1]];
        let pairs = [(paths[0], values[0]), (paths[1], values[1])];
        let set = times(&row.set(&pairs).unwrap(), &[], &[], &speeds);
        for ((truth, scaled), set) in truth.iter().zip(&scaled).zip(&set) {
            for of in 0..2 {
                let [truth, scaled, set] = [truth, scaled, set].map(|row| row[of].unwrap());
                // The solver's own errors.
                assert!((scaled / truth - 1.0).abs() < 3.0 * TRUTH, "{name}: {scaled} {truth}");
                assert_eq!(scaled, set, "{name}");
            }
        }
    }
}

/// The changed row's times at these speeds, to 0.1 µs, against a model of the row.
fn measured(row: &Experiment, model: Model, speeds: &[f64]) -> CurveProblem {
    let truth = times(&changed(row), &[], &[], speeds);
    let estimate = |value: Option<f64>| value.map(|value| Estimate { value, sigma: 1e-7 });
    let line = |(at, (speed, of)): (usize, (&f64, &Predicted))| DataRow {
        line: at as u64 + 2,
        speed_m_s: Estimate { value: *speed, sigma: 0.0 },
        values: [estimate(of[0]), estimate(of[1]), None, None],
        correlation: None,
        freedom: Freedom::KNOWN,
    };
    let data = Data {
        file: row.name().to_owned(),
        case: String::new(),
        rows: speeds.iter().zip(&truth).enumerate().map(line).collect(),
    };
    let parameters = model.numbers.parameters(speeds);
    CurveProblem::new(model, data, parameters).unwrap()
}

#[test]
fn a_fit_of_k_and_a_finds_those_of_the_reference_contact() {
    let speeds = speeds_between(0.1, 1.0, 5);
    for (name, row) in rows() {
        let names = ["K", "A"];
        let model = model(&row, &names).with_accuracy(1e-6);
        let own: Vec<f64> = (model.numbers.parameters(&[]).iter()).map(|p| p.start).collect();
        let problem = measured(&row, model, &speeds);
        let best = fit(&problem, &Fitting::default()).unwrap();
        for (at, factor) in [1.04, 1.1 / 1.04].into_iter().enumerate() {
            let ratio = best.point[at] / (factor * own[at]);
            // Curves right to 1e-6 determine K to some 1e-5 and A to some 1e-3.
            let allowed = [1e-4, 5e-3][at];
            assert!((ratio - 1.0).abs() < allowed, "{name}: {}: {ratio}", names[at]);
        }
    }
}

#[test]
fn profiles_of_k_and_a_hold_those_of_the_reference_contact() {
    let speeds = speeds_between(0.1, 1.0, 5);
    let (name, row) = &rows()[0];
    let model = model(row, &["K", "A"]).with_accuracy(1e-6);
    let own = model.numbers.parameters(&[]);
    let truth = [1.04 * own[0].start, 1.1 / 1.04 * own[1].start];
    let problem = measured(row, model, &speeds);
    let best = fit(&problem, &Fitting::default()).unwrap();
    let covariance = Covariance::new(problem.parameters(), &best);
    let profiles = profile(&problem, &best, &covariance, &[0, 1], &Profiling::default());
    for (at, profile) in profiles.unwrap().iter().enumerate() {
        let interval = profile.intervals[0];
        let (End::At(lower), End::At(upper)) = (interval.lower, interval.upper) else {
            unreachable!("{name}: an open end of {interval:?}")
        };
        // Data without noise: the truth is in the middle of 68 %, but for the curves' own errors.
        let middle = (truth[at] - lower) / (upper - lower);
        assert!((0.3..0.7).contains(&middle), "{name}: {middle}");
    }
}

use super::*;
use crate::inference;
use crate::options::parsed;

/// A row of the paper's wet chain, K = 1.186e10 N/m^1.5 and A = 2.60 µs, with errors as
/// of 20 shots.
const ROW: &str = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error,tof_reflected_s,tof_reflected_s_error\n\
                   0.119052,0.0006708,0.000936197428,1.118e-07,0.00110372846,1.118e-07\n";

fn of_row(more: &[&str]) -> FitResult {
    let begin = ["row.csv", "--preset=pump", "--free=wet.K,wet.A"];
    let words = begin.iter().chain(more).map(|word| (*word).to_owned());
    let arguments: Arguments = parsed("fit", &words.collect::<Vec<_>>()).unwrap();
    let data = inference::parsed("row.csv", ROW, &arguments.measured, None).unwrap();
    let experiment = inference::experiment(&arguments.modelled, None).unwrap();
    let model = inference::model(&experiment, &arguments.modelled, &arguments.freed).unwrap();
    let problem = inference::problem(model, data, &arguments.freed).unwrap();
    fit_result(problem, &arguments).unwrap()
}

#[test]
fn another_pair_of_two_times_is_told_or_how_to_look_for_it() {
    let reported = of_row(&[]).pair_warning().unwrap();
    assert!(reported.contains("--starts") && reported.contains("gauge"), "{reported}");
    let bounds = ["--bounds=wet.K=5e9:2e10", "--bounds=wet.A=1e-7:1e-5"];
    let found = of_row(&[&bounds[..], &["--starts=10"]].concat());
    assert_eq!(found.pair_warning(), None);
    let minima = found.inferred.other_minima();
    let best = (&found.inferred.fit.point, 0);
    let others = minima.iter().map(|(start, _)| (&start.point, 1));
    let all: Vec<_> = std::iter::once(best).chain(others).collect();
    assert!(all.len() > 1, "{all:?}");
    // One of them is the true pair, within three percent: the row's own errors.
    let near = |value: f64, truth: f64| (value / truth - 1.0).abs() < 0.03;
    let is_true = |point: &[f64]| near(point[0], 1.186e10) && near(point[1], 2.60e-6);
    assert!(all.iter().any(|(point, _)| is_true(point)), "{all:?}");
    let rise = |start: &Started| 2.0 * (start.cost - found.inferred.fit.cost);
    assert!(minima.iter().all(|(start, _)| rise(start) <= 9.0));
}

/// Two minima, x = 1 and x = −1, of which the second is hardly better; the data reject both.
struct TwoMinima([Parameter; 1]);

impl Problem for TwoMinima {
    fn parameters(&self) -> &[Parameter] {
        &self.0
    }

    fn residual_count(&self) -> usize {
        2
    }

    fn residuals(&self, points: &[Vec<f64>]) -> hertzchain_infer::Outcomes {
        let rows = |x: f64| vec![(x * x - 1.0) / 0.1, 6.0 + 0.1 * x];
        points.iter().map(|p| Ok(hertzchain_infer::Residuals::new(rows(p[0])))).collect()
    }
}

#[test]
fn unasked_starts_replace_no_minimum_by_one_that_fits_as_well() {
    let problem = TwoMinima([Parameter::new("x", "", 1.0).within(-2.0, 2.0)]);
    let found = best_of_starts(&problem, 0, &Fitting::default()).unwrap();
    assert_eq!(found.starts.len(), UNASKED);
    assert!((found.point[0] - 1.0).abs() < 0.01, "{:?}", found.point);
    // The other is reported beside it: χ² is 12 · 0.2 lower.
    let (other, _) = found.other_minima(&[0.1])[0];
    assert!((2.0 * (other.cost - found.cost) + 2.4).abs() < 0.01, "{}", other.cost);
}

//! Stated errors of single shots where pulses are faint: noise that sharpens a top or steepens a
//! flank also moves it, and must not be taken for knowledge.

use crate::signal::{
    Channels, Estimate, Method, QualityFlag, SignalOptions, coverage, measure, median,
};
use crate::tests::source::{Source, bells, dry_shot, methods};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

const SHOTS: u64 = 400;

/// Incident and reflected times less the true ones, of the shots that would count in a mean.
fn errors(source: &Source, method: &Method, interval_s: f64, ratio_db: f64) -> [Vec<Estimate>; 2] {
    let mut rng = ChaCha8Rng::seed_from_u64(2026);
    let noise = 10_f64.powf(-ratio_db / 20.0);
    let measuring = SignalOptions { method: method.clone(), ..SignalOptions::default() };
    let [passing, wall, returning] = source.times_s;
    let mut errors = [const { Vec::new() }; 2];
    for _ in 0..SHOTS {
        let samples = source.recorded(interval_s, noise, &mut rng);
        let shot = measure(Channels::Summed(&samples), interval_s, &measuring).unwrap();
        let counts = !shot.found.flags.iter().any(QualityFlag::is_grave);
        let Some(flight) = shot.flight.ok().filter(|_| counts) else {
            continue;
        };
        let off = |found: Estimate, true_s: f64| Estimate { value: found.value - true_s, ..found };
        errors[0].push(off(flight.incident_s, wall - passing));
        errors[1].extend(flight.reflected_s.map(|t| off(t, returning - wall)));
    }
    errors
}

/// Share of 1.96 stated errors about a value.
fn covered(errors: &[Estimate], about: f64) -> f64 {
    let pulls: Vec<f64> = errors.iter().map(|e| (e.value - about) / e.sigma).collect();
    coverage(&pulls, 1.96).unwrap().share
}

/// The half of the shots whose errors are stated as the smallest.
fn surest(mut errors: Vec<Estimate>) -> Vec<Estimate> {
    errors.sort_by(|a, b| a.sigma.total_cmp(&b.sigma));
    errors.truncate(errors.len() / 2);
    errors
}

#[test]
fn stated_errors_of_the_default_cover_true_times_of_faint_pulses() {
    for source in [bells(), dry_shot()] {
        for interval_s in [1e-6, 2e-6] {
            for ratio_db in [14.0, 20.0, 26.0] {
                for (which, errors) in errors(&source, &Method::default(), interval_s, ratio_db)
                    .into_iter()
                    .enumerate()
                {
                    let reported = format!("{} {which} {interval_s:e} {ratio_db}", source.name);
                    assert!(errors.len() as u64 > SHOTS * 9 / 10, "{reported}");
                    // 95 % less two standard deviations of chance; with the fitted bend they were
                    // 72 to 94 % of the reflected times.
                    let share = covered(&errors, 0.0);
                    assert!(share > 0.928, "{reported}: {share}");
                    // Those stated as the surest as well: they were 55 to 90 %.
                    let share = covered(&surest(errors), 0.0);
                    assert!(share > 0.92, "{reported}, surest: {share}");
                }
            }
        }
    }
}

#[test]
fn stated_errors_of_the_default_are_not_widened_where_pulses_are_plain() {
    // What they were with the fitted bend without_systematic, 40 dB: medians in ns, to 3 %. They may be less: what is
    // known of pulses' shapes since makes those of returns a third less.
    for (source, were) in [(bells(), [316.0, 588.0]), (dry_shot(), [375.0, 746.0])] {
        let found = errors(&source, &Method::default(), 1e-6, 40.0);
        for ((errors, were), less) in found.iter().zip(were).zip([0.25, 0.4]) {
            let sigmas: Vec<f64> = errors.iter().map(|e| e.sigma * 1e9).collect();
            let stated = median(&sigmas).unwrap();
            let share = stated / were - 1.0;
            assert!((-less..0.03).contains(&share), "{stated} {were}");
        }
    }
}

#[test]
fn stated_errors_of_the_other_methods_cover_their_spread_on_faint_pulses() {
    for source in [bells(), dry_shot()] {
        for (name, method) in methods().into_iter().skip(1) {
            for (ratio_db, least) in [(20.0, 0.92), (26.0, 0.925)] {
                for errors in errors(&source, &method, 1e-6, ratio_db) {
                    let values: Vec<f64> = errors.iter().map(|e| e.value).collect();
                    // Their bias is in no stated error.
                    let share = covered(&errors, median(&values).unwrap());
                    // Three and two standard deviations of chance below 95 %.
                    assert!(share > least, "{} {name} {ratio_db}: {share}", source.name);
                }
            }
        }
    }
}

use super::*;
use crate::arguments::parsed;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The square of a number, and how often it was asked for.
struct Square {
    parameters: Vec<Parameter>,
    asked: AtomicUsize,
}

impl Square {
    fn new() -> Self {
        Self {
            parameters: vec![Parameter::new("x", "", 1.0)],
            asked: AtomicUsize::new(0),
        }
    }
}

impl Problem for Square {
    fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    fn residual_count(&self) -> usize {
        1
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Residuals, ModelError>> {
        self.asked.fetch_add(points.len(), Ordering::Relaxed);
        let square = |point: &Vec<f64>| match point[0] {
            x if x < 0.0 => Err(ModelError("negative".into())),
            x => Ok(Residuals::new(vec![x * x])),
        };
        points.iter().map(square).collect()
    }
}

fn arguments(out: &Path, resume: bool) -> Arguments {
    let mut words = vec!["data.csv".to_owned(), "--free=x".to_owned()];
    words.push(format!("--out={}", out.display()));
    words.extend(resume.then(|| "--resume".to_owned()));
    parsed("fit", &words).unwrap()
}

#[test]
fn what_a_broken_run_computed_is_not_computed_again_unless_the_problem_is_another() {
    let out = std::env::temp_dir().join(format!("hertzchain-partial-{}", std::process::id()));
    let points: Vec<Vec<f64>> = [0.1, -1.0, 1e300, 1.0 / 3.0].map(|x| vec![x]).to_vec();
    let of = |bytes: &[u8]| Fingerprint::of_bytes(bytes);
    let square = Square::new();
    let first = {
        let kept = Remembered::new(&square, || of(b"square"), &arguments(&out, false)).unwrap();
        let found = kept.residuals(&points);
        // What a second's delay, or a wish to stop, does.
        kept.kept.as_ref().unwrap().lock().unwrap().save();
        found
    };
    assert!(begun(&out));
    let again = Square::new();
    let kept = Remembered::new(&again, || of(b"square"), &arguments(&out, true)).unwrap();
    assert_eq!(kept.residuals(&points), first);
    // The one that failed.
    assert_eq!(again.asked.load(Ordering::Relaxed), 1);
    let Err(Failure::User(why)) = Remembered::new(&again, || of(b"cube"), &arguments(&out, true))
    else {
        unreachable!("residuals of another problem were taken for its own")
    };
    assert!(why.contains("leave --resume out"), "{why}");
    Remembered::new(&again, || of(b"cube"), &arguments(&out, false)).unwrap();
    assert_eq!(parts(&out.join(PARTIAL)).len(), 1);
    finished(&out);
    assert!(!begun(&out));
    let _ = fs::remove_dir_all(out);
}

#[test]
fn another_models_residuals_lie_beside_and_go_with_the_fits_own() {
    let out = std::env::temp_dir().join(format!("hertzchain-rivals-{}", std::process::id()));
    let of = |bytes: &[u8]| Fingerprint::of_bytes(bytes);
    let points = vec![vec![3.0]];
    let asked = |resume: bool| {
        let (own, rival) = (Square::new(), Square::new());
        let given = arguments(&out, resume);
        let kept = Remembered::new(&own, || of(b"square"), &given).unwrap();
        let beside = Remembered::of_attempt(&rival, (Some(0), 0), || of(b"rival"), &given).unwrap();
        for of in [&kept, &beside] {
            assert_eq!(
                of.residuals(&points)[0].as_ref().unwrap().standardised,
                [9.0]
            );
            of.kept.as_ref().unwrap().lock().unwrap().save();
        }
        [own, rival].map(|of| of.asked.load(Ordering::Relaxed))
    };
    assert_eq!(asked(false), [1, 1]);
    assert_eq!(asked(true), [0, 0]);
    finished(&out);
    assert!(!out.join(PARTIAL).exists());
    let _ = fs::remove_dir_all(out);
}

#[test]
fn a_part_with_any_flipped_bit_is_refused_and_none_is_taken_for_a_result() {
    let out = tempfile::tempdir().unwrap();
    let square = Square::new();
    let resumed = |resume| {
        Remembered::new(
            &square,
            || Fingerprint::of_bytes(b"square"),
            &arguments(out.path(), resume),
        )
    };
    let kept = resumed(false).unwrap();
    kept.residuals(&[vec![3.0]]);
    kept.kept.as_ref().unwrap().lock().unwrap().save();
    let part = parts(&out.path().join(PARTIAL)).pop().unwrap();
    let whole = fs::read(&part).unwrap();
    for bit in 0..8 * whole.len() {
        let mut flipped = whole.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        fs::write(&part, flipped).unwrap();
        let Err(Failure::User(why)) = resumed(true) else {
            unreachable!("bit {bit} was flipped, and the part was taken")
        };
        assert!(why.contains("damaged"), "{why}");
    }
    fs::write(&part, whole).unwrap();
    assert!(resumed(true).is_ok());
}

#[test]
fn a_damaged_part_is_none() {
    assert_eq!(entries(&[]), Some(Vec::new()));
    assert_eq!(entries(&[1, 2, 3]), None);
    assert_eq!(entries(&[255; 64]), None);
}

//! A posterior's checkpoint, as `fit --resume` continues it.
#![no_main]

use hertzchain_infer::{Chain, ModelError, Parameter, Prior, Problem, Requirements, Residuals};
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

/// Two parameters whose residuals are themselves.
struct Plane(Vec<Parameter>);

impl Problem for Plane {
    fn parameters(&self) -> &[Parameter] {
        &self.0
    }

    fn residual_count(&self) -> usize {
        self.0.len()
    }

    fn residuals(&self, points: &[Vec<f64>]) -> Vec<Result<Residuals, ModelError>> {
        points.iter().map(|point| Ok(Residuals::new(point.clone()))).collect()
    }
}

static PLANE: LazyLock<Plane> = LazyLock::new(|| {
    let parameter = |name: &str| Parameter {
        name: name.to_owned(),
        unit: String::new(),
        start: 0.0,
        lower: -10.0,
        upper: 10.0,
        scale: 1.0,
        prior: Prior::Flat,
    };
    Plane(vec![parameter("a"), parameter("b")])
});

fuzz_target!(|text: &[u8]| {
    let Ok(mut chain) = serde_json::from_slice::<Chain>(text) else { return };
    let found = chain.belongs_to(&*PLANE).and_then(|()| chain.advance(&*PLANE, 2));
    match found {
        Ok(()) => drop(chain.posterior(&Requirements::default())),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});

//! Ratios of two curves at speeds that both have.

use crate::signal::Estimate;

/// A point of a curve with errors in both coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Speed.
    pub speed: Estimate,
    /// What was measured there.
    pub value: Estimate,
}

/// One ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// Mean of both speeds.
    pub speed: f64,
    /// Upper over lower.
    pub ratio: Estimate,
}

/// Ratios upper/lower wherever both curves have speeds at most `gap` apart.
///
/// Values scale as speed^`exponent` nearly (−0.2 for times of flight in Hertz
/// chains); this takes out what is left of a difference of speeds, and carries
/// both speeds' errors into the ratio's:
/// (σ_r/r)² = (σ_u/u)² + (σ_l/l)² + exponent² ((σ_v,u/v_u)² + (σ_v,l/v_l)²).
/// Give 0 if speeds' errors are already in the values'. Each upper point is held
/// against the nearest lower one.
#[must_use]
pub fn ratios_at_common(upper: &[Point], lower: &[Point], gap: f64, exponent: f64) -> Vec<Ratio> {
    let ratio = |u: &Point| {
        let apart = |l: &Point| (l.speed.value - u.speed.value).abs();
        let nearest = lower.iter().filter(|l| apart(l) <= gap);
        let l = nearest.min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        let plain = u.value.over(l.value);
        let speeds = u.speed.over(l.speed);
        let at_one_speed = plain.value * speeds.value.powf(-exponent);
        let found = at_one_speed.is_finite();
        let of_speeds = exponent * speeds.sigma / speeds.value;
        let relative = (plain.sigma / plain.value).hypot(of_speeds);
        found.then(|| Ratio {
            speed: f64::midpoint(u.speed.value, l.speed.value),
            ratio: Estimate {
                value: at_one_speed,
                sigma: at_one_speed.abs() * relative,
            },
        })
    };
    upper.iter().filter_map(ratio).collect()
}

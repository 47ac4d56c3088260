//! Two-body collisions: closed forms, series and integration against each other.

use hertzchain_chain::ChainError;
use hertzchain_chain::theory::two_body::{
    ContactEnd, ElasticCollision, ViscoelasticCollision, rebound, reduced_mass_kg,
    restitution_by_series, restitution_coefficients,
};
use std::f64::consts::PI;

fn unit_collision(exponent: f64) -> ElasticCollision {
    ElasticCollision { exponent, stiffness: 1.0, reduced_mass_kg: 1.0, speed_m_s: 1.0 }
}

#[test]
fn hertz_contact_time_has_the_known_fifteen_digits() {
    // Half a unit of the last digit and rounding of Γ.
    let time = unit_collision(1.5).contact_time_s();
    assert!((time - 3.21806545971904).abs() < 1.5e-14, "{time:.16}");
}

#[test]
fn linear_contact_lasts_half_a_period() {
    // Rounding of Γ.
    assert!((unit_collision(1.0).contact_time_s() - PI).abs() < 1e-14);
}

#[test]
fn contact_time_scales_as_speed_to_minus_one_fifth() {
    let slow = ElasticCollision {
        exponent: 1.5,
        stiffness: 8.79e9,
        reduced_mass_kg: 4.27e-3,
        speed_m_s: 0.1,
    };
    let fast = ElasticCollision { speed_m_s: 3.2, ..slow };
    // Roundings of a few powers.
    assert!((slow.contact_time_s() / fast.contact_time_s() - 2.0).abs() < 1e-14);
}

#[test]
fn integration_without_damping_is_the_closed_form() {
    for exponent in [1.0, 1.5, 2.0, 2.5, 1.7, 1.23] {
        let elastic = unit_collision(exponent);
        for end in [ContactEnd::ZeroOverlap, ContactEnd::ZeroForce] {
            let found = rebound(exponent, 0.0, end).unwrap();
            // The integration's own accuracy.
            let tolerance = 1e-12;
            assert!((found.restitution - 1.0).abs() < tolerance, "{found:?}");
            let time = elastic.contact_time_s();
            assert!((found.contact_time / time - 1.0).abs() < tolerance);
            let overlap = elastic.largest_overlap_m();
            assert!((found.largest_overlap / overlap - 1.0).abs() < tolerance);
        }
    }
}

#[test]
fn hertz_restitution_series_has_the_known_coefficients() {
    let (first, second) = restitution_coefficients(1.5);
    // The closed form in other numbers: 2^{1/5} √π Γ(3/5) / (10^{2/5} Γ(21/10)), with
    // Γ(3/5) and Γ(21/10) to sixteen digits; rounding.
    let closed =
        2f64.powf(0.2) * PI.sqrt() * 1.489192248812817 / (10f64.powf(0.4) * 1.046485846853561);
    assert!((first - closed).abs() < 2e-15, "{first:.16} {closed:.16}");
    // One unit of the last digit known, which is cut off rather than rounded.
    assert!((first - 1.15344885809).abs() < 1e-11);
    assert!((second - 0.79827).abs() < 5e-6);
    // Identity of the two, to rounding.
    assert!((second - 0.6 * first * first).abs() < 1e-15);
}

#[test]
fn linear_dashpot_restitution_is_the_textbook_exponential() {
    // n = 1 ended at zero overlap: e = exp(−(x/2) T), T the damped half period.
    for x in [0.1f64, 0.5, 1.0] {
        let frequency = (1.0 - 0.25 * x * x).sqrt();
        let found = rebound(1.0, x, ContactEnd::ZeroOverlap).unwrap();
        let exact = (-0.5 * x * PI / frequency).exp();
        // The integration's own accuracy.
        assert!((found.restitution - exact).abs() < 1e-12);
        assert!((found.contact_time - PI / frequency).abs() < 1e-12);
    }
    let (first, second) = restitution_coefficients(1.0);
    // exp(−πx/2 + …) expanded, to rounding.
    assert!((first - 0.5 * PI).abs() < 1e-14);
    assert!((second - PI * PI / 8.0).abs() < 1e-14);
}

#[test]
fn series_remainder_is_half_a_cube_when_ended_at_zero_overlap() {
    for exponent in [1.5, 2.0, 1.7] {
        let remainder = |x: f64| {
            let exact = rebound(exponent, x, ContactEnd::ZeroOverlap).unwrap();
            (restitution_by_series(exponent, x) - exact.restitution) / x.powi(3)
        };
        // Third order: halving x leaves the quotient, up to the next order in x and
        // the integration's 1e-13 over x³.
        let (coarse, fine) = (remainder(0.02), remainder(0.01));
        assert!((coarse / fine - 1.0).abs() < 0.05, "{coarse} {fine}");
        if exponent == 1.5 {
            assert!((fine - 0.5).abs() < 0.1, "{fine}");
        }
    }
}

#[test]
fn clipped_remainder_is_of_order_five_halves() {
    let remainder = |x: f64| {
        let exact = rebound(1.5, x, ContactEnd::ZeroForce).unwrap();
        exact.restitution - restitution_by_series(1.5, x)
    };
    // Local order between x and x/4; the x³ term is still a share of x^{1/2}.
    let order = (remainder(1e-3) / remainder(2.5e-4)).ln() / 4f64.ln();
    assert!((order - 2.5).abs() < 0.05, "{order}");
    // What clipping gains to leading order is the pull it cuts, at speed close to one:
    // ∫ (x√y − y^{3/2}) dy over 0 < y < x = (4/15) x^{5/2}, up to relative order x^{1/2}.
    let x = 1e-4;
    assert!((remainder(x) / (4.0 / 15.0 * x.powf(2.5)) - 1.0).abs() < 0.05);
}

#[test]
fn restitution_falls_with_damping_and_clipping_never_lowers_it() {
    for exponent in [1.5, 1.8, 3.0] {
        let mut before = 1.0;
        for x in [0.01, 0.1, 0.5, 1.0, 2.0, 4.0] {
            let pulled = rebound(exponent, x, ContactEnd::ZeroOverlap).unwrap();
            let clipped = rebound(exponent, x, ContactEnd::ZeroForce).unwrap();
            assert!(pulled.restitution < clipped.restitution);
            assert!(pulled.contact_time > clipped.contact_time);
            assert!(clipped.restitution < before);
            before = clipped.restitution;
        }
    }
}

#[test]
fn dimensional_rebound_is_the_scaled_one() {
    let collision = ViscoelasticCollision {
        elastic: ElasticCollision {
            exponent: 1.5,
            stiffness: 8.7926303796e9,
            reduced_mass_kg: reduced_mass_kg(8.54e-3, 8.54e-3),
            speed_m_s: 1.0,
        },
        damping_time_s: 3.3852895149e-7,
    };
    let x = 1.5 * 3.3852895149e-7 * (8.7926303796e9f64 / 4.27e-3).powf(0.4);
    // Rounding of a few powers.
    assert!((collision.parameter() / x - 1.0).abs() < 1e-14);
    let found = collision.rebound(ContactEnd::ZeroOverlap).unwrap();
    let scaled = rebound(1.5, x, ContactEnd::ZeroOverlap).unwrap();
    assert!((found.restitution - scaled.restitution).abs() < 1e-14);
    let unit = (4.27e-3f64 / 8.7926303796e9).powf(0.4);
    assert!((found.contact_time / (scaled.contact_time * unit) - 1.0).abs() < 1e-13);
}

#[test]
fn parameters_out_of_range_are_refused() {
    for (exponent, x) in [(0.5, 0.1), (f64::NAN, 0.1), (1.5, -0.1), (1.5, f64::NAN), (1.5, 1e9)] {
        let refused = rebound(exponent, x, ContactEnd::ZeroOverlap);
        assert!(matches!(refused, Err(ChainError::Value { .. })));
    }
}

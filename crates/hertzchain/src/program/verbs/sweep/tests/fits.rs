use super::*;
use hertzchain_measure::signal::{power_law, uncertainty};

#[test]
fn no_error_is_quoted_below_the_accuracy_of_the_times() {
    let speeds = [0.1_f64, 0.3, 1.0];
    let times = speeds.map(|v| 630.841_591_2e-6 * v.powf(-0.2));
    let fit = power_law(&speeds, &times, None);
    let reported =
        |accuracy: f64| law_text("incident", &fit, uncertainty(&speeds, &[accuracy; 3]), Units::Si);
    // Σ|cᵢ| = 1.33 and Σ|dᵢ| = 0.88 for these speeds.
    assert!(reported(1e-6).starts_with("incident: ToF = (630.84159 ± 0.00"), "{}", reported(1e-6));
    assert!(reported(1e-6).contains("^(-0.20000000 ± 8."), "{}", reported(1e-6));
    assert!(reported(1e-3).contains("(630.84 ± 0."), "{}", reported(1e-3));
}

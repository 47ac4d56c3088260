//! Why there is no time of flight or no power law, in the same words wherever it is reported.

use crate::quantity::Style;
use hertzchain_chain::FarEnd;
use hertzchain_chain::observe::PassageError;
use hertzchain_experiment::Units;
use hertzchain_measure::signal::FitError;

/// The reason, as the end of a sentence.
pub(crate) fn reason(far: &FarEnd, units: Units, error: &PassageError) -> String {
    let time = |time_s: f64| Style::brief(units).quantity(time_s, "s");
    match (far, error) {
        (FarEnd::Free | FarEnd::Periodic { .. }, _) => "the chain has no wall".to_owned(),
        (_, PassageError::NoWallPulse { duration_s }) => {
            format!(
                "no pulse reached the wall within {}; a longer `duration` goes on",
                time(*duration_s)
            )
        }
        (_, PassageError::NoIncidentPulse { wall }) => format!(
            "the sensor bead's signal has no maximum before the wall's peak at {}",
            time(wall.time_s)
        ),
    }
}

/// Why times of flight have no power law.
pub(crate) fn law(error: &FitError) -> String {
    match error {
        FitError::TooFew => "fewer than two speeds have a time of flight".to_owned(),
        error => error.to_string(),
    }
}

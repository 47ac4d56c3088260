//! How hard each contact of a row is pressed.

use hertzchain_chain::wave::{Flow, Observer, Piece};
use hertzchain_chain::{Sensor, System};

/// Share of the largest force so far from which on a step is looked at within: forces change by
/// less during a step.
const NEAR: f64 = 0.8;

/// Largest dynamic force of each contact.
pub(crate) struct ContactPeaks(Vec<f64>);

impl ContactPeaks {
    pub(crate) fn new(system: &System) -> Self {
        Self(vec![0.0; system.contacts()])
    }

    /// The largest forces in N, with those at rest.
    pub(crate) fn forces_n(self, system: &System) -> Vec<f64> {
        let at_rest_n = |contact| system.static_contact(contact).force_n;
        let all = self.0.into_iter().enumerate();
        all.map(|(contact, force_n)| force_n + at_rest_n(contact)).collect()
    }
}

impl Observer for ContactPeaks {
    fn step(&mut self, piece: &Piece<'_>) -> Flow {
        for (contact, most_n) in self.0.iter_mut().enumerate() {
            let force_n = |theta| piece.signal(Sensor::Contact(contact), theta);
            let end_n = force_n(1.0);
            if end_n > NEAR * *most_n {
                let within = [0.25, 0.5, 0.75].map(force_n);
                *most_n = within.into_iter().fold(most_n.max(end_n), f64::max);
            }
        }
        Flow::Continue
    }
}

//! Pulses of one speed's shots picked again, with one shape in common.

use crate::curves::{GroupSpeed, grouped};
use crate::signal::{Flight, Picked, PulseKind, pool};
use crate::{Curves, Example, Grouping, Measurement, Shot};
use indexmap::IndexMap;
use rayon::prelude::*;

impl Measurement {
    /// Reduces shots to curves, after their maxima are picked again with one shape for all shots of a
    /// case and a speed that count. Noise leaves the shape of one pulse open and that of many less: at
    /// 40 dB times of 20 shots are two to three times as exact as each alone.
    pub fn curves(&mut self, grouping: &Grouping) -> Curves {
        // Names need not tell shots apart.
        let number = |example: &Example| self.shots.iter().position(|shot| *shot == example.shot);
        let examples = self.examples.iter().chain(&self.flagged);
        let numbers: Vec<Option<usize>> = examples.map(number).collect();
        pick_with_common_shapes(&mut self.shots, grouping);
        let curves = Curves::of(&self.shots, grouping);
        self.shots.iter_mut().for_each(|shot| shot.undecided = false);
        curves.undecided.iter().for_each(|number| self.shots[*number].undecided = true);
        let examples = self.examples.iter_mut().chain(&mut self.flagged);
        for (Example { shot, .. }, number) in examples.zip(numbers) {
            if let Some(number) = number {
                let Shot { flight, undecided, .. } = &self.shots[number];
                (shot.flight, shot.undecided) = (flight.clone(), *undecided);
            }
        }
        curves
    }
}

/// Picks maxima of all shots of a case and a speed again, as [`Measurement::curves`] does.
fn pick_with_common_shapes(shots: &mut [Shot], grouping: &Grouping) {
    let mut cases: IndexMap<&str, Vec<(usize, GroupSpeed)>> = IndexMap::new();
    for (number, shot) in
        shots.iter().enumerate().filter(|(_, shot)| shot.own_reasons(false).is_empty())
    {
        let speed = GroupSpeed::new(shot).map(|speed| (number, speed));
        cases.entry(&shot.case).or_default().extend(speed);
    }
    let groups = cases.values().flat_map(|case| grouped(case, |one| one.1, grouping.gap_m_s));
    let groups: Vec<Vec<usize>> =
        groups.map(|group| group.into_iter().map(|one| one.0).collect()).collect();
    let picked: Vec<(usize, PulseKind, Picked)> = groups
        .par_iter()
        .flat_map_iter(|group| PulseKind::ALL.map(|kind| picked(shots, group, kind)))
        .flatten_iter()
        .collect();
    for (number, kind, picked) in picked {
        if let Ok(flight) = &mut shots[number].flight {
            let mut picks = flight.picks;
            let time_s = picked.time_s - skew_s(flight, kind);
            picks.set(kind, Picked { time_s, ..picked });
            *flight = picks.flight().with_interval_error(flight.interval_error);
        }
    }
}

/// New picks of these shots' pulses, on the clock of their channel.
fn picked(shots: &[Shot], group: &[usize], kind: PulseKind) -> Vec<(usize, PulseKind, Picked)> {
    let own = |number: &usize| {
        let shot = &shots[*number];
        let flight = shot.flight.as_ref().ok()?;
        let own = flight.picks.pulse(kind)?;
        let time_s = own.time_s + skew_s(flight, kind);
        Some((*number, (shot.samples[kind as usize].as_deref()?, Picked { time_s, ..own })))
    };
    let (numbers, pulses): (Vec<usize>, Vec<_>) = group.iter().filter_map(own).unzip();
    let picks = numbers.into_iter().zip(pool(&pulses));
    picks.filter_map(|(number, picked)| Some((number, kind, picked?))).collect()
}

fn skew_s(flight: &Flight, kind: PulseKind) -> f64 {
    if kind == PulseKind::Wall { flight.picks.calibration.skew_s } else { 0.0 }
}

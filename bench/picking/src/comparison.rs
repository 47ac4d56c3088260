//! Other picks of the same records: a quartic over 54 µs, and a series' own averaged pulse.

use crate::row::Row;
use hertzchain_measure::Shot;
use hertzchain_measure::signal::median;

/// Half the quartic's window, and half that of an averaged pulse, in s.
const QUARTIC_S: f64 = 27e-6;
const AVERAGED_S: f64 = 30e-6;
/// Places of an averaged pulse a sample.
const FINE: f64 = 4.0;

/// Root mean square errors in ns of a row's times, incident and reflected: of the default, a quartic
/// over 54 µs and the averaged pulse of each series.
#[derive(Default)]
pub(crate) struct Comparison([Vec<[f64; 3]>; 2]);

impl Comparison {
    /// Adds a row's series of records of one channel, with the shots that the default made of them.
    pub(crate) fn add(&mut self, row: &Row, series: &[(Vec<&[f64]>, &[Shot])]) {
        let mut errors = [const { [const { Vec::new() }; 3] }; 2];
        for (records, shots) in series {
            add_errors(&mut errors, row, records, shots);
        }
        for (rows, errors) in self.0.iter_mut().zip(errors) {
            let count = errors.iter().map(Vec::len).min();
            if count > Some(0) {
                let square =
                    |of: &Vec<f64>| of.iter().map(|e| e * e).sum::<f64>() / of.len() as f64;
                rows.push(errors.each_ref().map(|of| 1e9 * square(of).sqrt()));
            }
        }
    }

    /// Medians over rows of either time, in how many the default is within 1.1 of the best of both
    /// others, and the most that it is of it.
    pub(crate) fn cells(&self) -> String {
        let cells = self.0.each_ref().map(|rows| {
            let of = |k: usize| median(&rows.iter().map(|row| row[k]).collect::<Vec<_>>());
            let medians = [0, 1, 2].map(|k| format!("{:.0}", of(k).unwrap_or(f64::NAN)));
            let ratios = rows.iter().map(|row| row[0] / row[1].min(row[2]));
            let within = ratios.clone().filter(|ratio| *ratio <= 1.1).count();
            let most = ratios.fold(0.0, f64::max);
            format!("{} | {within} of {}, {most:.1}", medians.join(" | "), rows.len())
        });
        cells.join(" | ")
    }
}

/// Errors in s of all three, of shots that have both times and count.
fn add_errors(all: &mut [[Vec<f64>; 3]; 2], row: &Row, records: &[&[f64]], shots: &[Shot]) {
    let counted = records.iter().zip(shots).filter(|(_, shot)| !shot.is_dubious());
    let timed = counted.filter_map(|(record, shot)| {
        let picks = shot.flight.as_ref().ok()?.picks;
        let times_s = [picks.incident.time_s, picks.wall.time_s, picks.reflected?.time_s];
        Some((*record, times_s.map(|time_s| time_s / shot.interval_s)))
    });
    let (records, own): (Vec<&[f64]>, Vec<[f64; 3]>) = timed.unzip();
    let Some(interval_s) = shots.first().map(|shot| shot.interval_s) else { return };
    let quartic = |(record, own): (&&[f64], &[f64; 3])| {
        own.map(|at| maximum(record, QUARTIC_S / interval_s, at).unwrap_or(f64::NAN))
    };
    let quartics: Vec<[f64; 3]> = records.iter().zip(&own).map(quartic).collect();
    let mut averaged = own.clone();
    for pulse in 0..3 {
        let begun: Vec<f64> = own.iter().map(|times| times[pulse]).collect();
        let aligned = aligned(&records, interval_s, begun);
        averaged.iter_mut().zip(aligned).for_each(|(times, at)| times[pulse] = at);
    }
    for (which, true_s) in row.flights_s().into_iter().enumerate() {
        let error_s = |times: &[f64; 3]| (times[which + 1] - times[which]) * interval_s - true_s;
        for (errors, times) in all[which].iter_mut().zip([&own, &quartics, &averaged]) {
            errors.extend(times.iter().map(error_s).filter(|error_s| error_s.is_finite()));
        }
    }
}

/// Where a quartic over so many samples on either side of its own maximum has that.
fn maximum(samples: &[f64], half: f64, begun: f64) -> Option<f64> {
    let mut centre = begun.round();
    for _ in 0..8 {
        let first = (centre - half).ceil().max(0.0);
        let values = samples.get(first as usize..=(centre + half) as usize)?;
        let u = |i: usize| (first + i as f64 - centre) / half;
        let rows = values.iter().enumerate();
        let rows = rows.map(|(i, y)| ((0..5).map(|k| u(i).powi(k)).collect(), *y));
        let top = centre + half * top_of(&least_squares(rows, 5))?;
        if (top - centre).abs() <= 0.5 {
            return Some(top);
        }
        centre = top.round();
    }
    None
}

/// The maximum of a quartic near 0.
fn top_of(c: &[f64]) -> Option<f64> {
    let mut u = 0.0_f64;
    for _ in 0..50 {
        let slope = c[1] + u * (2.0 * c[2] + u * (3.0 * c[3] + u * 4.0 * c[4]));
        let curvature = 2.0 * c[2] + u * (6.0 * c[3] + u * 12.0 * c[4]);
        let by = (curvature < 0.0 && u.abs() <= 1.0).then(|| slope / curvature)?;
        u -= by.clamp(-0.3, 0.3);
    }
    Some(u)
}

/// Times in samples of pulses by their average, to which each is fitted with a height, a shift and
/// an offset, in four rounds; the average's own maximum is that of a quartic.
fn aligned(records: &[&[f64]], interval_s: f64, mut times: Vec<f64>) -> Vec<f64> {
    let half = (AVERAGED_S / interval_s).round();
    let middle = FINE * half;
    for _ in 0..4 {
        let value = |place: usize| {
            let off = (place as f64 - middle) / FINE;
            let all = records.iter().zip(&times).map(|(record, time)| at(record, time + off));
            all.sum::<f64>() / records.len() as f64
        };
        let mean: Vec<f64> = (0..=2 * middle as usize).map(value).collect();
        let top = maximum(&mean, 0.9 * FINE * QUARTIC_S / interval_s, middle);
        let off = top.map_or(0.0, |top| (top - middle) / FINE);
        for (record, time) in records.iter().zip(&mut times) {
            *time += shift(record, *time, &mean, half) + off;
        }
    }
    times
}

/// By how many samples a pulse lies later than at a time, against an averaged one.
fn shift(record: &[f64], time: f64, mean: &[f64], half: f64) -> f64 {
    let mut shift = 0.0;
    for _ in 0..6 {
        let rows = (3..=2 * half as usize - 3).map(|k| {
            let off = k as f64 - half;
            let place = FINE * (k as f64 - shift);
            let slope = 0.5 * FINE * (at(mean, place + 1.0) - at(mean, place - 1.0));
            (vec![at(mean, place), -slope, 1.0], at(record, time + off))
        });
        let found = least_squares(rows, 3);
        shift += (found[1] / found[0]).clamp(-3.0, 3.0);
    }
    shift
}

/// Linear between samples.
fn at(samples: &[f64], place: f64) -> f64 {
    let first = (place.max(0.0) as usize).min(samples.len().saturating_sub(2));
    let share = place - first as f64;
    samples[first] * (1.0 - share) + samples[first + 1] * share
}

/// Of equations Σ row_k x_k = value, by elimination in the normal equations.
fn least_squares(equations: impl Iterator<Item = (Vec<f64>, f64)>, count: usize) -> Vec<f64> {
    let mut lines = vec![vec![0.0; count + 1]; count];
    for (mut row, value) in equations {
        row.push(value);
        for (line, by) in lines.iter_mut().zip(row.clone()) {
            line.iter_mut().zip(&row).for_each(|(sum, other)| *sum += by * other);
        }
    }
    for j in 0..count {
        let pivot = lines[j].clone();
        for (_, line) in lines.iter_mut().enumerate().filter(|(i, _)| *i != j) {
            let by = line[j] / pivot[j];
            line.iter_mut().zip(&pivot).for_each(|(left, other)| *left -= by * other);
        }
    }
    (0..count).map(|j| lines[j][count] / lines[j][j]).collect()
}

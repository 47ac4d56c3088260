//! Errors made beside errors stated, of shots, means and power laws.

use crate::Options;
use crate::comparison::Comparison;
use crate::fault::{Fault, record, volts};
use crate::row::Row;
use hertzchain_measure::signal::{
    Channels, Estimate, PowerLaw, SignalOptions, coverage, measure, power_law_both_errors,
};
use hertzchain_measure::{Curves, Grouping, Measurement, Shot};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Shots that make one mean.
const SERIES: usize = 20;
const WITHIN: f64 = 1.96;

/// Errors of incident and reflected times over the stated ones.
#[derive(Default)]
pub(crate) struct Pulls([Vec<f64>; 2]);

/// What came of one kind of records.
#[derive(Default)]
pub(crate) struct Tally {
    pub shots: u64,
    /// Shots with times, and those of them that count in means.
    pub timed: usize,
    pub counted: usize,
    pub all: Pulls,
    /// Of shots that count.
    pub of_counted: Pulls,
    pub means: Pulls,
    pub exponents: Pulls,
    /// Products of pulls of both means, and their stated correlations.
    pub correlations: Vec<(f64, f64)>,
    /// Coverage of the worst row of those with 10 shots or more that count.
    pub worst: [(f64, String); 2],
    pub comparison: Comparison,
}

impl Pulls {
    fn extend(&mut self, other: &Self) {
        for (own, other) in self.0.iter_mut().zip(&other.0) {
            own.extend(other);
        }
    }

    /// Per cent within 1.96, root mean square and mean, of either time.
    pub(crate) fn cells(&self) -> String {
        let cell = |pulls: &Vec<f64>| match coverage(pulls, WITHIN) {
            Some(of) => {
                let mean = pulls.iter().sum::<f64>() / pulls.len() as f64;
                format!("{:.1} | {:.2} | {mean:+.2}", 100.0 * of.share, of.scale)
            }
            None => "– | – | –".to_owned(),
        };
        self.0.each_ref().map(cell).join(" | ")
    }

    /// Sum of squares and count, of either time.
    pub(crate) fn squares(&self) -> String {
        let cell = |pulls: &Vec<f64>| {
            let sum: f64 = pulls.iter().map(|pull| pull * pull).sum();
            format!("{sum:.0} of {}", pulls.len())
        };
        self.0.each_ref().map(cell).join(" | ")
    }

    /// How many reflected times there are.
    pub(crate) fn returns(&self) -> usize {
        self.0[1].len()
    }
}

impl Tally {
    /// Of so many shots of each row.
    pub(crate) fn of(rows: &[Row], fault: &Fault, options: &Options) -> Self {
        let mut tally =
            Self { worst: [(100.0, String::new()), (100.0, String::new())], ..Self::default() };
        let mut series: Vec<Vec<Shot>> = Vec::new();
        for (number, row) in rows.iter().enumerate() {
            let volts = volts(row, fault);
            let (mut all, mut counted) = (Pulls::default(), Pulls::default());
            let drawn = |shot: u64| {
                let mut rng = ChaCha8Rng::seed_from_u64(options.seed);
                rng.set_stream(shot + options.shots * number as u64);
                record(row, &volts, fault, &mut rng)
            };
            let records: Vec<_> = (0..options.shots).map(drawn).collect();
            let own: Vec<Vec<Shot>> = records
                .chunks(SERIES)
                .map(|records| measured(row, records, fault, options.alone))
                .collect();
            if options.compare && !fault.separate {
                let series = records.chunks(SERIES).zip(&own);
                let series = series.map(|(records, shots)| {
                    (records.iter().map(|one| &one.0[0][..]).collect(), &shots[..])
                });
                tally.comparison.add(row, &series.collect::<Vec<_>>());
            }
            for shot in own.iter().flatten() {
                tally.shots += 1;
                let counts = !shot.is_dubious();
                if let Ok(flight) = &shot.flight {
                    tally.timed += 1;
                    tally.counted += usize::from(counts);
                    let slower = shot.speed_m_s.map_or(1.0, |speed| speed.value / row.speed_m_s);
                    let slower = slower.powf(-0.2);
                    let times = [Some(flight.incident_s), flight.reflected_s];
                    for (which, time) in times.into_iter().enumerate() {
                        let Some(time) = time else { continue };
                        let pull = (time.value - slower * row.flights_s()[which]) / time.sigma;
                        all.0[which].push(pull);
                        if counts {
                            counted.0[which].push(pull);
                        }
                    }
                }
            }
            if options.each {
                println!(
                    "|   {} {} | | {} | {} | {} | {}",
                    row.name,
                    row.speed_m_s,
                    all.0[0].len(),
                    counted.0[0].len(),
                    all.cells(),
                    counted.cells()
                );
            }
            tally.note_worst(row, &counted);
            tally.all.extend(&all);
            tally.of_counted.extend(&counted);
            for (number, shots) in own.into_iter().enumerate() {
                if series.len() <= number {
                    series.push(Vec::new());
                }
                series[number].extend(shots);
            }
        }
        for shots in &series {
            tally.reduce(rows, shots);
        }
        tally
    }

    fn note_worst(&mut self, row: &Row, counted: &Pulls) {
        for (worst, pulls) in self.worst.iter_mut().zip(&counted.0) {
            if let Some(of) = coverage(pulls, WITHIN).filter(|of| of.count >= 10)
                && 100.0 * of.share < worst.0
            {
                *worst = (100.0 * of.share, format!("{} {}", row.name, row.speed_m_s));
            }
        }
    }

    /// Means and power laws of one series a row.
    fn reduce(&mut self, rows: &[Row], shots: &[Shot]) {
        for case in Curves::of(shots, &Grouping::default()).cases {
            let truth = |speed_m_s: Estimate| {
                let near = |a: &&Row, b: &&Row| {
                    let apart = |row: &&Row| (row.speed_m_s / speed_m_s.value).ln().abs();
                    apart(a).total_cmp(&apart(b))
                };
                let row = rows.iter().filter(|row| row.name == case.name).min_by(near);
                row.map(|row| {
                    let slower = (speed_m_s.value / row.speed_m_s).powf(-0.2);
                    row.flights_s().map(|time| slower * time)
                })
            };
            for row in &case.rows {
                let Some(true_s) = truth(row.speed_m_s) else {
                    continue;
                };
                let pulls = [0, 1].map(|time| {
                    let mean = row.at_mean_speed_s[time].filter(|_| row.shots.0 == SERIES)?;
                    Some((mean.value - true_s[time]) / mean.sigma)
                });
                for (all, pull) in self.means.0.iter_mut().zip(pulls) {
                    all.extend(pull);
                }
                if let [Some(one), Some(other)] = pulls {
                    let stated = row.correlation_at_mean_speed.unwrap_or_default();
                    self.correlations.push((one * other, stated));
                }
            }
            let laws = [&case.laws.incident, &case.laws.reflected];
            for (which, law) in laws.into_iter().enumerate() {
                let points = case.rows.iter().filter_map(|row| {
                    let time = row.at_mean_speed_s[which]?;
                    Some((row.speed_m_s, time.sigma, truth(row.speed_m_s)?[which]))
                });
                let points: Vec<_> = points.collect();
                let (Ok(law), Some(exact)) = (law, exact(&points)) else {
                    continue;
                };
                let pull = (law.exponent - exact.exponent) / law.exponent_error;
                self.exponents.0[which].push(pull);
            }
        }
    }
}

/// The power law through true times, with the weights of measured ones.
fn exact(points: &[(Estimate, f64, f64)]) -> Option<PowerLaw> {
    let column = |of: &dyn Fn(&(Estimate, f64, f64)) -> f64| points.iter().map(of).collect();
    let (speeds, errors): (Vec<f64>, Vec<f64>) = (column(&|p| p.0.value), column(&|p| p.0.sigma));
    let (times, sigmas): (Vec<f64>, Vec<f64>) = (column(&|p| p.2), column(&|p| p.1));
    power_law_both_errors(&speeds, &errors, &times, &sigmas).ok()
}

/// A series of records as shots, whose pulses have one shape in common unless each is picked alone.
fn measured(row: &Row, records: &[(Vec<Vec<f64>>, f64)], fault: &Fault, alone: bool) -> Vec<Shot> {
    let shots = records.iter().map(|record| shot_of(row, record, fault)).collect();
    let mut measurement = Measurement { shots, ..Measurement::default() };
    if !alone {
        measurement.curves(&Grouping::default());
    }
    measurement.shots
}

fn shot_of(row: &Row, (samples, speed_m_s): &(Vec<Vec<f64>>, f64), fault: &Fault) -> Shot {
    let channels = match &samples[..] {
        [sensor, wall] => Channels::Separate { sensor, wall },
        one => Channels::Summed(&one[0]),
    };
    let measuring = SignalOptions {
        bandwidth: fault.low_pass.filter(|_| fault.corrected),
        ..SignalOptions::default()
    };
    let (interval_s, count) = (fault.rate_hz.recip(), samples[0].len());
    let (flight, doubts, samples) = match measure(channels, interval_s, &measuring) {
        Ok(shot) => (shot.flight, shot.found.flags, shot.samples),
        Err(error) => (Err(error), Vec::new(), [const { None }; 3]),
    };
    Shot {
        source: String::new(),
        file: Default::default(),
        shot: None,
        case: row.name.to_owned(),
        programmed_speed_m_s: Some(row.speed_m_s),
        speed_m_s: Some(Estimate { value: *speed_m_s, sigma: 1e-9 }),
        interval_s,
        duration_s: count as f64 * interval_s,
        flight,
        doubts,
        untriggered: false,
        gaps: None,
        gap_in_pulse: false,
        holds_several: false,
        is_cut: false,
        excluded: false,
        undecided: false,
        samples,
    }
}

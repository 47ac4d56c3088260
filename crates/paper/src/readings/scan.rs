//! Which claims hold in which reading.

use super::rounding::sharpened;
use crate::claims::{Claim, ClaimVerdict, Evaluator, claims};
use crate::reproduce::{
    Cases, Effort, Gathering, ReproduceError, ReproduceProgress, ShotCache, gather,
};
use hertzchain_experiment::Reading;
use std::time::Instant;

/// The claims' verdicts in one reading.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadingRow {
    pub reading: Reading,
    pub verdicts: Vec<ClaimVerdict>,
    /// The deciding numbers, not a number where there is none.
    pub values: Vec<f64>,
}

impl ReadingRow {
    /// Claims met, those in part for a half.
    pub fn score(&self) -> f64 {
        self.verdicts.iter().map(|verdict| verdict.score()).sum()
    }

    /// The same without claims that rounding of the printed constants leaves open.
    pub fn score_without(&self, flipped: &[usize]) -> f64 {
        let open = flipped.iter().filter_map(|&claim| self.verdicts.get(claim));
        self.score() - open.map(|verdict| verdict.score()).sum::<f64>()
    }

    /// Claims met better, and worse, than in another reading, by index.
    pub(crate) fn against(&self, other: &Self) -> (Vec<usize>, Vec<usize>) {
        let scores = self.verdicts.iter().zip(&other.verdicts).enumerate();
        let changes: Vec<(usize, f64)> =
            scores.map(|(i, (a, b))| (i, a.score() - b.score())).collect();
        let of = |better: bool| {
            let wanted = changes.iter().filter(|(_, change)| match better {
                true => *change > 0.0,
                false => *change < 0.0,
            });
            wanted.map(|(i, _)| *i).collect()
        };
        (of(true), of(false))
    }
}

/// The claims in many readings.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadingScan {
    /// The claims.
    pub claims: Vec<Claim>,
    /// The default reading.
    pub default: ReadingRow,
    /// One switch changed at a time.
    pub single: Vec<ReadingRow>,
    /// Switches of the full product with their options, the default first.
    pub product_of: Vec<SwitchOptions>,
    /// Switches that move a verdict but would have made the product larger
    /// than asked; the search for the closest reading still tries them.
    pub left_out: Vec<SwitchOptions>,
    /// The product.
    pub product: Vec<ReadingRow>,
    /// Readings tried on the way from the best of the product to the closest.
    pub search: Vec<ReadingRow>,
    /// Claims, by index, whose verdict in the default reading rounding of the
    /// printed constants alone flips; a scan by itself looks at no rounding.
    pub flipped_by_rounding: Vec<usize>,
    /// The same in the closest reading.
    pub flipped_in_closest: Vec<usize>,
}

/// Tries readings: one switch at a time, then the full product of those that move a verdict as far
/// as `most` readings go, then from the best of these one switch at a time for as long as that
/// improves it. A reading that leaves a claim open is computed again at a tenth of the accuracy.
pub(crate) fn scan(
    most: usize,
    speeds_m_s: &[f64],
    accuracy: f64,
    progress: &dyn ReproduceProgress,
) -> Result<ReadingScan, ReproduceError> {
    let start = Instant::now();
    let scanner = Scanner {
        evaluators: claims()?,
        cache: ShotCache::default(),
        speeds_m_s,
        accuracy,
        progress,
    };
    let default = scanner.row(&Reading::default())?;
    let readings = singles(&Reading::default());
    progress.begin("readings, one switch at a time", readings.len() as u64);
    let single = scanner.rows(&readings)?;
    let (product_of, left_out) = factors(&default, &single, most);
    let pace_s = start.elapsed().as_secs_f64() / (single.len() + 1) as f64;
    let readings = product(&product_of);
    // At most, as many of its readings share shots.
    let (count, minutes) = (readings.len(), (pace_s * readings.len() as f64 / 60.0).ceil());
    progress
        .note(&format!("{count} readings to combine: at the pace so far {minutes} min or less"));
    progress.begin("readings, product", readings.len() as u64);
    let product = scanner.rows(&readings)?;
    let start = best(single.iter().chain(&product).chain([&default])).clone();
    let search = scanner.climb(start)?;
    Ok(ReadingScan {
        claims: scanner.evaluators.into_iter().map(|evaluator| evaluator.claim).collect(),
        default,
        single,
        product_of,
        left_out,
        product,
        search,
        flipped_by_rounding: Vec::new(),
        flipped_in_closest: Vec::new(),
    })
}

impl ReadingScan {
    /// Every reading that was tried, the default first.
    pub fn rows(&self) -> impl Iterator<Item = &ReadingRow> {
        let rest = self.single.iter().chain(&self.product).chain(&self.search);
        std::iter::once(&self.default).chain(rest)
    }

    /// The reading that meets most claims; of equals, the one with fewest changes.
    pub fn closest(&self) -> &ReadingRow {
        best(self.rows())
    }

    /// Readings of the full product, those without room among them.
    pub(crate) fn full_product_size(&self) -> usize {
        let options = self.left_out.iter().map(|(_, options)| options.len());
        self.product.len() * options.product::<usize>()
    }

    /// Other readings that meet as many claims as the closest.
    pub(crate) fn as_close(&self) -> Vec<&ReadingRow> {
        let closest = self.closest();
        let mut found: Vec<&ReadingRow> = Vec::new();
        for row in self.rows() {
            let listed = found.iter().any(|other| other.reading == row.reading);
            if row.score() == closest.score() && row.reading != closest.reading && !listed {
                found.push(row);
            }
        }
        found
    }

    /// Each claim, by index, that the default does not fully meet, with the best reading in which it
    /// is met better; `None` when no reading that was tried does.
    pub(crate) fn prices(&self) -> impl Iterator<Item = (usize, Option<&ReadingRow>)> {
        let open = self.default.verdicts.iter().enumerate();
        let open = open.filter(|(_, verdict)| **verdict != ClaimVerdict::Holds);
        open.map(|(claim, verdict)| {
            let score = |row: &&ReadingRow| row.verdicts.get(claim).map_or(0.0, |v| v.score());
            let most = self.rows().map(|row| score(&row)).fold(0.0, f64::max);
            let better = self.rows().filter(|row| score(row) == most && most > verdict.score());
            (claim, better.reduce(|a, b| if closer(b, a) { b } else { a }))
        })
    }
}

/// Whether one reading meets more than another, or as much with fewer changes.
fn closer(one: &ReadingRow, other: &ReadingRow) -> bool {
    let rank = |row: &ReadingRow| (row.score(), usize::MAX - row.reading.changes().len());
    rank(one) > rank(other)
}

fn best<'a>(rows: impl IntoIterator<Item = &'a ReadingRow>) -> &'a ReadingRow {
    let best = rows.into_iter().reduce(|a, b| if closer(b, a) { b } else { a });
    best.expect("the default reading is always among the rows")
}

/// Every reading that differs from one in a single switch.
fn singles(from: &Reading) -> Vec<Reading> {
    let options = Reading::switches().iter();
    let options = options.flat_map(|switch| switch.options.iter().map(|o| (switch.name, *o)));
    let changed = options.filter(|(name, option)| from.get(name) != Some(option));
    changed.filter_map(|(name, option)| from.with(name, option).ok()).collect()
}

/// A switch with the options that move a verdict, the default first.
pub(crate) type SwitchOptions = (&'static str, Vec<&'static str>);

/// Switches of the product, those that move most verdicts first, until the
/// product would be too large; and those for which there was no room.
fn factors(
    default: &ReadingRow,
    single: &[ReadingRow],
    most: usize,
) -> (Vec<SwitchOptions>, Vec<SwitchOptions>) {
    let mut moving: Vec<(usize, SwitchOptions)> = Vec::new();
    for switch in Reading::switches() {
        let mut options: Vec<&'static str> = switch.options.first().copied().into_iter().collect();
        let mut moved = 0;
        for row in single {
            let changes = row.reading.changes();
            let own = changes.iter().find(|(name, _)| *name == switch.name);
            let verdicts = row.verdicts.iter().zip(&default.verdicts);
            let count = verdicts.filter(|(a, b)| a != b).count();
            if let (Some((_, option)), true) = (own, count > 0) {
                options.push(option);
                moved = moved.max(count);
            }
        }
        if moved > 0 {
            moving.push((moved, (switch.name, options)));
        }
    }
    moving.sort_by_key(|(moved, _)| std::cmp::Reverse(*moved));
    let (mut chosen, mut left_out, mut size) = (Vec::new(), Vec::new(), 1);
    for (_, factor) in moving {
        if size * factor.1.len() <= most {
            size *= factor.1.len();
            chosen.push(factor);
        } else {
            left_out.push(factor);
        }
    }
    (chosen, left_out)
}

fn product(factors: &[SwitchOptions]) -> Vec<Reading> {
    let start = vec![Reading::default()];
    factors.iter().fold(start, |readings, (switch, options)| {
        let with = |reading: &Reading| {
            let each = options.iter().filter_map(|option| reading.with(switch, option).ok());
            each.collect::<Vec<_>>()
        };
        readings.iter().flat_map(with).collect()
    })
}

struct Scanner<'a> {
    evaluators: Vec<Evaluator>,
    cache: ShotCache,
    speeds_m_s: &'a [f64],
    accuracy: f64,
    progress: &'a dyn ReproduceProgress,
}

impl Scanner<'_> {
    fn row(&self, reading: &Reading) -> Result<ReadingRow, ReproduceError> {
        let accuracies = [self.accuracy, 0.1 * self.accuracy];
        let cases = Cases::new(reading)?;
        let evidence = sharpened(&self.evaluators, &accuracies, &|accuracy| {
            let (speeds_m_s, effort) = (self.speeds_m_s, Effort::Lean(&self.evaluators));
            let how = Gathering { cases: &cases, speeds_m_s, accuracy, effort };
            gather(&how, Some(&self.cache), &|| {})
        })?;
        let findings = self.evaluators.iter().map(|evaluator| evaluator.decide(&evidence));
        let (verdicts, values) = findings.map(|f| (f.verdict, f.value)).unzip();
        Ok(ReadingRow { reading: *reading, verdicts, values })
    }

    fn rows(&self, readings: &[Reading]) -> Result<Vec<ReadingRow>, ReproduceError> {
        let row = |reading: &Reading| {
            let row = self.row(reading);
            self.progress.advance();
            row
        };
        readings.iter().map(row).collect()
    }

    /// From a reading, one switch at a time, for as long as that improves it.
    fn climb(&self, mut at: ReadingRow) -> Result<Vec<ReadingRow>, ReproduceError> {
        let mut tried = Vec::new();
        loop {
            let readings = singles(&at.reading);
            self.progress.begin("readings, towards the paper", readings.len() as u64);
            let rows = self.rows(&readings)?;
            let next = best(rows.iter().chain([&at])).clone();
            tried.extend(rows);
            if next.score() <= at.score() {
                return Ok(tried);
            }
            at = next;
        }
    }
}

//! Pulses of one speed's shots picked with one shape in common.
//!
//! Noise leaves a shape open that many shots determine. All of their pulses are fitted by one bell, each
//! with a time, a height and a width of its own: the bell, given these, then these, given the bell.

use super::log_polynomial::{BellTop, CommonBell, NARROWER, ShapePrior, half_width};
use super::{ChannelView, Picked, Systematic};
use crate::signal::linear::NormalEquations;
use crate::signal::{Estimate, MOST_POLES, Pulse, median};

/// Samples that are kept on either side of a pulse, in halves of a whole pulse's fit.
const MARGIN: f64 = 1.6;
/// Noise over height above which a pulse keeps its own pick: with it, what pulses have in common is
/// where each one's noise was taken for its top.
const NOISIEST: f64 = 0.25;
/// Noise over height up to which a pulse has a say in the shape, over the median of all.
const SAY: f64 = 2.0;
/// Standard deviation of one speed's widths, relative to their mean.
const WIDTHS: f64 = 0.03;
/// Deviations by which the squares that a bell leaves of a pulse may exceed those of noise, else the
/// pulse has another shape.
const ANOTHER: f64 = 5.0;
/// Rounds of fitting the bell and the pulses; each leaves a tenth of the error or less.
const ROUNDS: usize = 4;
/// Error by a subtracted baseline over that by noise up to which a pulse is picked with others: above
/// it, what is left of the baseline bends it.
const DRIFT: f64 = 0.2;
/// Steps of fitting one pulse to the bell.
const STEPS: usize = 6;

/// The samples about a pulse, and what else its pick needs.
#[derive(Clone, Debug, PartialEq)]
pub struct PulseSamples {
    pulse: Pulse,
    first: usize,
    heights: Vec<f32>,
    /// Of single samples, and of averages over many.
    noise: f64,
    broad_noise: f64,
    inverse: [f64; MOST_POLES],
    /// Falls a sample under the pulse: their deviation, with its sign, and the likely one.
    falls: [f64; 2],
    under: Estimate,
    interval_s: f64,
    /// Error in s of its maximum's time by a fitted baseline.
    pub(crate) of_drift_s: f64,
}

impl PulseSamples {
    /// About a pulse at a time in samples; none of a clipped one.
    pub(super) fn new(
        view: &ChannelView<'_>,
        pulse: &Pulse,
        time: f64,
        interval_s: f64,
    ) -> Option<Self> {
        let half = MARGIN * half_width(pulse, view.broad_noise(pulse));
        let (first, heights) = view.window(time - half, time + half);
        let heights = heights.into_iter().map(|height| height as f32).collect();
        pulse.clipped.is_none().then(|| Self {
            pulse: *pulse,
            first,
            heights,
            noise: view.noise(pulse),
            broad_noise: view.broad_noise(pulse),
            inverse: view.inverse,
            falls: [view.fall_under(pulse, time), view.likely_fall(pulse, time)],
            under: view.level_under(pulse, time),
            interval_s,
            of_drift_s: 0.0,
        })
    }

    pub(crate) fn count(&self) -> usize {
        self.heights.len()
    }

    fn relative_noise(&self) -> f64 {
        self.broad_noise / self.pulse.height
    }

    /// Samples about a place as (u, height), over so many samples on either side.
    fn points(&self, place: &Place, half: f64) -> impl Iterator<Item = (f64, f64)> {
        let (first, time, scale) = (self.first, place.time, half * place.width);
        let u = move |i: usize| ((first + i) as f64 - time) / scale;
        let points =
            self.heights.iter().enumerate().map(move |(i, height)| (u(i), f64::from(*height)));
        points.filter(|(u, _)| u.abs() <= 1.0)
    }

    /// Least squares of time, height and width with the bell given.
    fn placed(&self, bell: &CommonBell, mut place: Place, half: f64) -> Option<Place> {
        let noise = self.broad_noise.hypot(bell.inexact * self.pulse.height);
        for _ in 0..STEPS {
            let mut normal = NormalEquations::new(3);
            let (mut squares, mut count) = (0.0, 0.0);
            for (u, height) in self.points(&place, half) {
                let at = bell.polynomial.at(u);
                let value = place.height * at.value.exp();
                let by_time = -value * at.slope / (half * place.width);
                normal.add(&[by_time, value, by_time * half * u], height - value);
                squares += (height - value).powi(2);
                count += 1.0;
            }
            let weight = noise / WIDTHS;
            normal.add(&[0.0, 0.0, weight], (1.0 - place.width) * weight);
            let solution = normal.solve()?;
            let [time, height, width] = solution.values;
            let variance = |k: usize| noise * noise * solution.inverse[k][k];
            place = Place {
                time: place.time + time.clamp(-0.3 * half, 0.3 * half),
                height: place.height * height.clamp(-0.3, 0.3).exp(),
                width: place.width + width.clamp(-0.1, 0.1),
                variances: [variance(0), variance(1)],
                squares: squares / (noise * noise),
                freedom: count - 3.0,
            };
        }
        let near = (place.time - self.pulse.at as f64).abs() < half;
        (near && (0.7..1.4).contains(&place.width) && place.is_adequate()).then_some(place)
    }

    /// Whether noise moves it much farther than what is left of a baseline that was subtracted.
    fn is_free_of_drift(&self, place: &Place) -> bool {
        self.of_drift_s <= DRIFT * self.interval_s * place.variances[0].sqrt()
    }

    /// Pick at a place of the bell, whose maximum has an error in samples of its own.
    fn pick(
        &self,
        own: &Picked,
        place: &Place,
        top: &BellTop,
        (half, shape): (f64, f64),
    ) -> Picked {
        let half = half * place.width;
        let height = place.height * top.log_height.exp();
        let moved_by = |fall: f64| fall * half / (-top.curvature * height) * half;
        let [under, likely] = self.falls.map(moved_by);
        let variance = place.variances[0] + shape * shape;
        let misfit = (place.squares / place.freedom).sqrt();
        // What a low-pass takes of a top goes as its curvature.
        let before = height * (top.log_gain / place.width.powi(2)).exp();
        Picked {
            time_s: self.interval_s * (place.time + half * top.u + likely),
            sigma_s: (self.interval_s * variance.sqrt().hypot(under)).hypot(self.of_drift_s),
            systematic: Systematic {
                superposition_s: -under * self.interval_s,
                shape_s: shape * self.interval_s,
                height: 0.0,
            },
            height: before,
            height_sigma: before * (place.variances[1] + top.height_variance).sqrt(),
            signal_to_noise: height / self.noise,
            misfit: (self.noise > 0.0).then_some(misfit),
            ..*own
        }
        .above(self.under)
    }
}

/// Where a pulse lies by a bell: time in samples, height over the bell's, width over the bell's.
#[derive(Clone, Copy)]
struct Place {
    time: f64,
    height: f64,
    width: f64,
    /// Of the time in samples and of the height's logarithm, by noise.
    variances: [f64; 2],
    /// Sum of squares over noise, and degrees of freedom.
    squares: f64,
    freedom: f64,
}

impl Place {
    fn is_adequate(&self) -> bool {
        self.freedom > 0.0
            && self.squares / self.freedom <= 1.0 + ANOTHER * (2.0 / self.freedom).sqrt()
    }
}

/// Picks of pulses of one speed with one shape in common, each given with its own pick; `None` of
/// those that have another shape or too much noise.
pub(crate) fn pool(pulses: &[(&PulseSamples, Picked)]) -> Vec<Option<Picked>> {
    let alike = pulses.windows(2).all(|pair| {
        let [one, other] = [pair[0].0, pair[1].0];
        one.interval_s == other.interval_s && one.inverse == other.inverse
    });
    let mut best: Option<Pool> = None;
    for share in NARROWER.iter().filter(|_| alike) {
        let widest = best.as_ref().map_or(*share, |best| best.widest);
        let Some(next) = Pool::new(pulses, *share, widest) else { continue };
        if best.as_ref().is_some_and(|best| best.variance() <= next.variance()) {
            break;
        }
        best = Some(next);
    }
    best.map_or_else(|| vec![None; pulses.len()], |best| best.picks(pulses))
}

/// Pulses about one bell, over so many samples on either side.
struct Pool {
    half: f64,
    /// The widest window, as a share of the usual one, in which a bell leaves no more than noise.
    widest: f64,
    top: BellTop,
    /// Error in samples of the common maximum by what is open of the shape.
    shape: f64,
    places: Vec<Option<Place>>,
}

impl Pool {
    fn new(pulses: &[(&PulseSamples, Picked)], share: f64, widest: f64) -> Option<Self> {
        let middle = |of: &dyn Fn(&PulseSamples) -> f64| {
            median(&pulses.iter().map(|(one, _)| of(one)).collect::<Vec<f64>>())
        };
        let half = (share * middle(&|one| half_width(&one.pulse, one.broad_noise))?).max(4.0);
        let skewness = middle(&|one| one.pulse.skewness())?;
        let prior = ShapePrior::of_whole(pulses.first()?.0.pulse.kind, skewness, share);
        let most = SAY * middle(&PulseSamples::relative_noise)?;
        let begun = pulses.iter().map(|(one, own)| Place::begun(one, own));
        let mut places: Vec<Option<Place>> = begun.collect();
        let mut last: Option<(CommonBell, f64)> = None;
        for _ in 0..ROUNDS {
            let (mut points, mut squares, mut says) = (Vec::new(), 0.0, 0.0);
            for ((one, _), place) in pulses.iter().zip(&places) {
                let Some(place) = place.filter(|_| one.relative_noise() <= most) else { continue };
                let before = points.len();
                points.extend(one.points(&place, half).map(|(u, y)| (u, y / place.height)));
                let noise = one.broad_noise / place.height;
                squares += (points.len() - before) as f64 * noise * noise;
                says += 1.0;
            }
            if says < 2.0 {
                return None;
            }
            let noise = (squares / points.len() as f64).sqrt();
            let before = last.as_ref().map(|(bell, _)| bell.polynomial.solution.values);
            let bell = CommonBell::new(points, (noise, says), (prior, share, half), before)?;
            let placed = |((one, _), place): (&(&PulseSamples, Picked), &Option<Place>)| {
                one.placed(&bell, (*place)?, half)
            };
            places = pulses.iter().zip(&places).map(placed).collect();
            last = Some((bell, says));
        }
        let (bell, says) = last.filter(|(bell, _)| bell.is_adequate())?;
        let top = bell.top(pulses.first()?.0.inverse)?;
        let mut pool = Self { half, widest, top, shape: 0.0, places };
        // Of the error of the common maximum, that of the mean place is a part: it is in each place's.
        let in_samples = (half / pool.top.curvature).powi(2);
        let beyond = in_samples * pool.top.slope_variance - pool.place_variance() / says;
        pool.shape = beyond.max(in_samples * pool.top.open_variance).sqrt() / widest;
        Some(pool)
    }

    /// Mean variance by noise of a pulse's place.
    fn place_variance(&self) -> f64 {
        let placed = self.places.iter().flatten();
        let (sum, count) = placed.fold((0.0, 0.0), |(sum, n), at| (sum + at.variances[0], n + 1.0));
        sum / count
    }

    /// Of one pulse's time in samples.
    fn variance(&self) -> f64 {
        self.place_variance() + self.shape * self.shape
    }

    fn picks(&self, pulses: &[(&PulseSamples, Picked)]) -> Vec<Option<Picked>> {
        let pick = |((one, own), place): (&(&PulseSamples, Picked), &Option<Place>)| {
            let place = place.as_ref().filter(|place| one.is_free_of_drift(place))?;
            Some(one.pick(own, place, &self.top, (self.half, self.shape)))
        };
        pulses.iter().zip(&self.places).map(pick).collect()
    }
}

impl Place {
    fn begun(samples: &PulseSamples, own: &Picked) -> Option<Self> {
        // A low-pass delays a bell by its first coefficient, and the prior is of bells about their
        // maximum.
        (samples.relative_noise() <= NOISIEST).then(|| Self {
            time: own.time_s / samples.interval_s + samples.inverse[0],
            height: samples.pulse.height,
            width: 1.0,
            variances: [0.0; 2],
            squares: 0.0,
            freedom: 0.0,
        })
    }
}

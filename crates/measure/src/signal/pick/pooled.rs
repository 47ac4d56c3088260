//! Pulses of one speed's shots picked with one shape in common.
//!
//! Noise leaves a shape open that many shots determine. All of their pulses are fitted by one bell, each
//! with a time, a height and a width of its own: the bell, given these, then these, given the bell.
//! The bell changes with the height: where speeds differ by a few per cent, fragments that make up a
//! pulse do not grow equally. What differs otherwise from shot to shot, as by gaps, is estimated from
//! the samples' probability.

use super::common_bell::CommonBell;
use super::log_polynomial::{BellTop, NARROWER, ShapePrior, half_width};
use super::{ChannelView, Picked, Systematic, of_few_samples};
use crate::signal::linear::{MOST, NormalEquations, powers};
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
/// Deviations of shots' shapes from the common one that are tried, over those of shapes of chains; the
/// first stands for none.
const OWN: [f64; 9] = [1e-4, 0.004, 0.008, 0.016, 0.03, 0.06, 0.12, 0.25, 0.5];
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
    /// The same of its height.
    pub(crate) of_drift_v: f64,
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
            of_drift_v: 0.0,
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
        let polynomial = bell.of_shot(place.off);
        for _ in 0..STEPS {
            let mut normal = NormalEquations::new(3);
            let (mut squares, mut count) = (0.0, 0.0);
            for (u, height) in self.points(&place, half) {
                let at = polynomial.at(u);
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
                ..place
            };
        }
        let near = (place.time - self.pulse.at as f64).abs() < half;
        (near && (0.7..1.4).contains(&place.width) && place.is_adequate()).then_some(place)
    }

    /// Normal equations, in unit noise, of what its bell's coefficients are beyond the common bell's.
    fn normal(&self, bell: &CommonBell, place: &Place, half: f64) -> NormalEquations {
        let noise = self.broad_noise.hypot(bell.inexact * self.pulse.height);
        let polynomial = bell.of_shot(place.off);
        let mut normal = NormalEquations::new(MOST);
        for (u, height) in self.points(place, half) {
            let value = place.height * polynomial.at(u).value.exp();
            normal.add(&powers(u).map(|power| power * value / noise), (height - value) / noise);
        }
        normal
    }

    /// Whether noise moves it much farther than what is left of a baseline that was subtracted.
    fn is_free_of_drift(&self, place: &Place) -> bool {
        self.of_drift_s <= DRIFT * self.interval_s * place.variances[0].sqrt()
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
    /// Logarithm of the height over the mean of all.
    off: f64,
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
    bell: CommonBell,
    /// Error in samples of the common maximum by what is open of the shape, and of its change where a
    /// height's logarithm is 1 above the mean.
    shape: f64,
    change: f64,
    places: Vec<Option<Place>>,
    /// The maximum of each shot's bell.
    tops: Vec<Option<BellTop>>,
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
        let mut last: Option<(CommonBell, Say)> = None;
        for _ in 0..ROUNDS {
            let say = Say::new(pulses, &mut places, most)?;
            let (points, noise) = say.points(pulses, &places, half);
            let before = last.as_ref().map(|(bell, _)| bell);
            let shots = say.numbers.len() as f64;
            let bell = CommonBell::new(&points, (noise, shots), (prior, share, half), before)?;
            let placed = |((one, _), place): (&(&PulseSamples, Picked), &Option<Place>)| {
                one.placed(&bell, (*place)?, half)
            };
            places = pulses.iter().zip(&places).map(placed).collect();
            last = Some((bell, say));
        }
        let (bell, say) = last.filter(|(bell, _)| bell.is_adequate())?;
        let inverse = pulses.first()?.0.inverse;
        let top = |place: &Option<Place>| bell.top(inverse, place.as_ref()?.off);
        let tops = places.iter().map(top).collect();
        let mut pool = Self { half, widest, bell, shape: 0.0, change: 0.0, places, tops };
        let shots = say.numbers.len() as f64;
        pool.shape = pool.open_error(&pool.bell.top(inverse, 0.0)?, shots);
        pool.change = pool.open_error(&pool.bell.top_of_change(inverse)?, say.squares);
        pool.differ(pulses);
        Some(pool)
    }

    /// Moves tops to those of shots' own bells, whose shapes differ from the common one as far as is most
    /// probable.
    fn differ(&mut self, pulses: &[(&PulseSamples, Picked)]) {
        let normal = |((one, _), place): (&(&PulseSamples, Picked), &Option<Place>)| {
            Some(one.normal(&self.bell, place.as_ref()?, self.half))
        };
        let normals: Vec<_> = pulses.iter().zip(&self.places).map(normal).collect();
        let evidence = |share: f64| -> f64 {
            let placed = normals.iter().flatten();
            placed.filter_map(|normal| self.bell.log_evidence(normal, share)).sum()
        };
        let [none, shares @ ..] = OWN.map(|share| (share, evidence(share)));
        let (share, _) = shares.into_iter().fold(none, |a, b| if b.1 > a.1 { b } else { a });
        if share == none.0 {
            return;
        }
        for (number, normal) in normals.iter().enumerate() {
            let (Some(place), Some(normal)) = (&mut self.places[number], normal) else { continue };
            let inverse = pulses[number].0.inverse;
            self.tops[number] = self.bell.own_top(normal, (place.off, share), inverse);
            let Some(top) = &self.tops[number] else { continue };
            let in_samples = (self.half * place.width / top.curvature).powi(2);
            place.variances = [in_samples * top.slope_variance, 0.0];
        }
    }

    /// Error in samples of a maximum with these variances, which so many places determine. That of
    /// their mean is a part of it that is in each place's.
    fn open_error(&self, top: &BellTop, count: f64) -> f64 {
        let in_samples = (self.half / top.curvature).powi(2);
        let beyond = in_samples * top.slope_variance - self.place_variance() / count;
        beyond.max(in_samples * top.open_variance).sqrt() / self.widest
    }

    /// Mean of a pulse's place.
    fn mean(&self, of: impl Fn(&Place) -> f64) -> f64 {
        let placed = self.places.iter().flatten();
        let (sum, count) = placed.fold((0.0, 0.0), |(sum, n), at| (sum + of(at), n + 1.0));
        sum / count
    }

    /// Mean variance by noise of a pulse's place.
    fn place_variance(&self) -> f64 {
        self.mean(|place| place.variances[0])
    }

    /// Mean variance of one pulse's time in samples.
    fn variance(&self) -> f64 {
        let of_change = self.mean(|place| (place.off * self.change).powi(2));
        self.place_variance() + self.shape * self.shape + of_change
    }

    fn picks(&self, pulses: &[(&PulseSamples, Picked)]) -> Vec<Option<Picked>> {
        let pick = |(number, (one, own)): (usize, &(&PulseSamples, Picked))| {
            let place = self.places[number].as_ref();
            let place = place.filter(|place| one.is_free_of_drift(place))?;
            Some(self.pick(one, own, (place, self.tops[number].as_ref()?)))
        };
        pulses.iter().enumerate().map(pick).collect()
    }

    /// Pick at a place of the bell, whose maximum has errors of its own.
    fn pick(&self, one: &PulseSamples, own: &Picked, (place, top): (&Place, &BellTop)) -> Picked {
        let half = self.half * place.width;
        let height = place.height * top.log_height.exp();
        let moved_by = |fall: f64| fall * half / (-top.curvature * height) * half;
        let [under, likely] = one.falls.map(moved_by);
        let open = self.shape.hypot(self.change * place.off);
        let by_noise = place.variances[0].sqrt().hypot(open);
        // What a low-pass takes of a top goes as its curvature.
        let before = height * (top.log_gain / place.width.powi(2)).exp();
        let few_s = one.interval_s * of_few_samples(own.width_s / one.interval_s);
        let picked = Picked {
            time_s: one.interval_s * (place.time + half * top.u + likely),
            sigma_s: (one.interval_s * by_noise.hypot(under)).hypot(one.of_drift_s),
            systematic: Systematic {
                superposition_s: -under * one.interval_s,
                shape_s: self.shape * one.interval_s,
                height: before * top.height_variance.sqrt(),
            },
            height: before,
            height_sigma: (before * (place.variances[1] + top.height_variance).sqrt())
                .hypot(one.of_drift_v),
            signal_to_noise: height / one.noise,
            misfit: (one.noise > 0.0).then_some((place.squares / place.freedom).sqrt()),
            ..*own
        };
        picked.widened(few_s).above(one.under)
    }
}

/// Pulses that have a say in the shape.
struct Say {
    numbers: Vec<usize>,
    /// Sum of squares of logarithms of their heights over the mean.
    squares: f64,
}

impl Say {
    /// Of those with relative noise up to a limit; heights of all places are taken over their mean.
    fn new(
        pulses: &[(&PulseSamples, Picked)],
        places: &mut [Option<Place>],
        most: f64,
    ) -> Option<Self> {
        let has_say = |n: &usize| places[*n].is_some() && pulses[*n].0.relative_noise() <= most;
        let numbers: Vec<usize> = (0..pulses.len()).filter(has_say).collect();
        let logarithms = numbers.iter().filter_map(|n| Some(places[*n]?.height.ln()));
        let mean = logarithms.sum::<f64>() / numbers.len() as f64;
        for place in places.iter_mut().flatten() {
            place.off = place.height.ln() - mean;
        }
        let offsets = numbers.iter().filter_map(|n| Some(places[*n]?.off));
        let squares = offsets.map(|off| off * off).sum();
        (numbers.len() >= 2).then_some(Self { numbers, squares })
    }

    /// Their samples about their places, over so many on either side, as (u, relative height, logarithm
    /// of the height over the mean), and the root mean square of their relative noise.
    fn points(
        &self,
        pulses: &[(&PulseSamples, Picked)],
        places: &[Option<Place>],
        half: f64,
    ) -> (Vec<[f64; 3]>, f64) {
        let (mut points, mut squares) = (Vec::new(), 0.0);
        let placed = self.numbers.iter().filter_map(|n| Some((pulses[*n].0, places[*n]?)));
        for (one, place) in placed {
            let before = points.len();
            let of_one = one.points(&place, half);
            points.extend(of_one.map(|(u, height)| [u, height / place.height, place.off]));
            let noise = one.broad_noise / place.height;
            squares += (points.len() - before) as f64 * noise * noise;
        }
        let noise = (squares / points.len() as f64).sqrt();
        (points, noise)
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
            off: 0.0,
        })
    }
}

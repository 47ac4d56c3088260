//! A high-order step for a small smooth system, by extrapolated midpoints.

/// State of the desingularised collision: root of the overlap, velocity, time.
pub(super) type State = [f64; 3];

const COLUMNS: usize = 9;

/// One step of length `h` by Gragg's modified midpoint rule with 2, 4, … 18
/// substeps, extrapolated in h² (order 18); also the size of the last correction.
pub(super) fn extrapolated_step(
    rates: &impl Fn(&State) -> State,
    start: &State,
    h: f64,
) -> (State, f64) {
    let mut row: Vec<State> = Vec::with_capacity(COLUMNS);
    let mut correction = f64::INFINITY;
    for column in 0..COLUMNS {
        let mut best = midpoints(rates, start, h, 2 * (column + 1));
        let mut next = Vec::with_capacity(COLUMNS);
        next.push(best);
        for (order, older) in row.iter().enumerate() {
            let ratio = (column + 1) as f64 / (column - order) as f64;
            let better = extrapolate(&best, older, ratio * ratio);
            correction = distance(&better, &best);
            best = better;
            next.push(best);
        }
        row = next;
    }
    let best = row.last().copied().unwrap_or(*start);
    (best, correction)
}

fn midpoints(rates: &impl Fn(&State) -> State, start: &State, h: f64, substeps: usize) -> State {
    let step = h / substeps as f64;
    let mut before = *start;
    let mut here = advanced(start, &rates(start), step);
    for _ in 1..substeps {
        let next = advanced(&before, &rates(&here), 2.0 * step);
        before = here;
        here = next;
    }
    // An even number of substeps leaves an error in even powers of the step
    // without a closing smoothing step.
    here
}

fn extrapolate(fine: &State, coarse: &State, squared_ratio: f64) -> State {
    let mut result = *fine;
    for (value, old) in result.iter_mut().zip(coarse) {
        *value += (*value - old) / (squared_ratio - 1.0);
    }
    result
}

fn advanced(from: &State, rates: &State, step: f64) -> State {
    let mut result = *from;
    for (value, rate) in result.iter_mut().zip(rates) {
        *value += step * rate;
    }
    result
}

/// Largest difference, relative for entries above 1; NaN counts as infinite.
fn distance(a: &State, b: &State) -> f64 {
    let gap = |(x, y): (&f64, &f64)| (x - y).abs() / x.abs().max(1.0);
    let worse = |worst: f64, gap: f64| if gap <= worst { worst } else { gap };
    let largest = a.iter().zip(b).map(gap).fold(0.0, worse);
    if largest.is_nan() { f64::INFINITY } else { largest }
}

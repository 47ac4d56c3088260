//! Running means.

/// Centred running means over an odd number of samples; over fewer near the ends.
pub(crate) fn mean(values: &[f64], length: usize) -> Vec<f64> {
    if length < 2 {
        return values.to_vec();
    }
    let half = length / 2;
    let mut sums = Vec::with_capacity(values.len() + 1);
    let mut sum = 0.0;
    sums.push(0.0);
    for value in values {
        sum += value;
        sums.push(sum);
    }
    let mean = |i: usize| {
        let (from, to) = (i.saturating_sub(half), (i + half + 1).min(values.len()));
        (sums[to] - sums[from]) / (to - from) as f64
    };
    (0..values.len()).map(mean).collect()
}

/// Two running means, one after the other: weights that fall off as a triangle.
pub(crate) fn triangle(values: &[f64], length: usize) -> Vec<f64> {
    mean(&mean(values, length), length)
}

#[cfg(test)]
#[path = "tests/running.rs"]
mod tests;

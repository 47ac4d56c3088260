//! The default method: an embedded pair of orders 5 and 4.

use super::table::{DEGREE, Table};

/// The pair of Dormand and Prince [DormandPrince1980] with the continuous
/// extension of order 4 [Shampine1986].
pub(crate) fn dormand_prince() -> Table {
    let end = [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0];
    let rows: [&[f64]; 7] = [
        &[],
        &[0.2],
        &[3.0 / 40.0, 9.0 / 40.0],
        &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
        &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
        &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
        &end,
    ];
    let error = [
        71.0 / 57600.0,
        0.0,
        -71.0 / 16695.0,
        71.0 / 1920.0,
        -17253.0 / 339_200.0,
        22.0 / 525.0,
        -1.0 / 40.0,
    ];
    Table::from_runge_kutta(&rows, Some(&error), continuous_extension(&end), 5.0)
}

/// b_j(θ) = θ²(3−2θ) b_j + θ²(1−θ)² d_j, plus the Hermite slopes of the
/// first and last stage.
fn continuous_extension(end: &[f64; 6]) -> Vec<[f64; DEGREE]> {
    let bend = [
        -12_715_105_075.0 / 11_282_082_432.0,
        0.0,
        87_487_479_700.0 / 32_700_410_799.0,
        -10_690_763_975.0 / 1_880_347_072.0,
        701_980_252_875.0 / 199_316_789_632.0,
        -1_453_857_185.0 / 822_651_844.0,
        69_997_945.0 / 29_380_423.0,
    ];
    let slopes = [[1.0, -2.0, 1.0], [0.0, -1.0, 1.0]];
    (0..7)
        .map(|j| {
            let b = end.get(j).copied().unwrap_or(0.0);
            let [s1, s2, s3] = match j {
                0 => slopes[0],
                6 => slopes[1],
                _ => [0.0; 3],
            };
            [s1, s2 + 3.0 * b + bend[j], s3 - 2.0 * b - 2.0 * bend[j], bend[j], 0.0]
        })
        .collect()
}

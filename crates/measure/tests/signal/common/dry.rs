//! A computed dry shot as a function of time.

/// The shot's traces and where its maxima are.
pub struct Dry {
    sensor: Vec<f64>,
    wall: Vec<f64>,
}

/// Seconds between the table's rows.
const STEP_S: f64 = 1.9e-3 / 3000.0;

impl Dry {
    /// Maxima of the passing, the wall's and the reflected pulse in s.
    pub const MAXIMA_S: [f64; 3] =
        [0.000_163_206_845_155_876_9, 0.000_925_110_869_017_615, 0.001_722_994_635_316_393_3];

    pub fn load() -> Self {
        let text = include_str!("../data/dry_shot.csv");
        let rows = text.lines().filter(|line| !line.starts_with(['#', 's']));
        let pairs: Vec<(f64, f64)> = rows
            .filter_map(|row| {
                let (sensor, wall) = row.split_once(',')?;
                Some((sensor.parse().ok()?, wall.parse().ok()?))
            })
            .collect();
        let (sensor, wall) = pairs.into_iter().unzip();
        Self { sensor, wall }
    }

    /// Both forces, as shares of the incident pulse's maximum, summed, at a time after the impact.
    pub fn summed(&self, time_s: f64) -> f64 {
        self.separate(time_s).iter().sum()
    }

    /// The same, each alone: the sensor bead's and the wall's.
    pub fn separate(&self, time_s: f64) -> [f64; 2] {
        let at = time_s / STEP_S;
        [&self.sensor, &self.wall].map(|rows| lagrange(rows, at) / 92.601_657)
    }
}

/// The quintic through six rows; 0 outside the table.
fn lagrange(rows: &[f64], at: f64) -> f64 {
    let first = at.floor() - 2.0;
    let inside = first >= 0.0 && first + 6.0 < rows.len() as f64;
    let six = rows.get(first as usize..).filter(|_| inside);
    let u = at - first;
    let weight = |k: usize| -> f64 {
        let others = (0..6).filter(|j| *j != k);
        others.map(|j| (u - j as f64) / (k as f64 - j as f64)).product()
    };
    six.map_or(0.0, |six| (0..6).map(|k| weight(k) * six[k]).sum())
}

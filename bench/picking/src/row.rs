//! Computed forces at both sensors, with the times of their maxima.

use hertzchain_chain::Sensor;
use hertzchain_sim::{Plan, shoot};
use std::error::Error;

/// Interval in s of computed traces.
pub(crate) const FINE_S: f64 = 1e-7;

/// A preset's row at one speed: forces at the sensor bead and the wall over the incident maximum.
pub(crate) struct Row {
    pub preset: &'static str,
    pub speed_m_s: f64,
    pub forces: [Vec<f64>; 2],
    /// Times in s of the incident, the wall's and the reflected maximum.
    pub maxima_s: [f64; 3],
    /// Height of the wall's maximum.
    pub wall_height: f64,
}

impl Row {
    /// Followed until three incident times after the wall's maximum.
    pub(crate) fn compute(preset: &'static str, speed_m_s: f64) -> Result<Self, Box<dyn Error>> {
        let experiment = hertzchain_experiment::preset(preset)?;
        let (mut plan, _) = Plan::from_experiment(&experiment, Some(speed_m_s))?;
        plan.accuracy = 1e-8;
        let [passing, wall, _] = maxima(&plan)?;
        plan.duration_s = Some(wall.0 + 3.0 * (wall.0 - passing.0));
        let sensors = vec![Sensor::Bead(plan.sensor_bead), Sensor::Contact(experiment.beads())];
        let trace = shoot(&plan.clone().watching(sensors, Some(FINE_S)))?.trace;
        let columns = trace.ok_or("no trace")?.columns;
        let [sensor, at_wall] = &columns[..] else {
            return Err("not two columns".into());
        };
        let over = |column: &[f64]| column.iter().map(|newton| newton / passing.1).collect();
        Ok(Self {
            preset,
            speed_m_s,
            forces: [over(sensor), over(at_wall)],
            maxima_s: maxima(&plan)?.map(|maximum| maximum.0),
            wall_height: wall.1 / passing.1,
        })
    }

    /// Incident and reflected time of flight in s.
    pub(crate) fn flights_s(&self) -> [f64; 2] {
        let [passing, wall, back] = self.maxima_s;
        [wall - passing, back - wall]
    }
}

/// Times in s and heights in N of the incident, the wall's and the reflected maximum.
fn maxima(plan: &Plan) -> Result<[(f64, f64); 3], Box<dyn Error>> {
    let passage = shoot(plan)?.passage?;
    let back = passage.reflected.ok_or("no reflected pulse")?;
    Ok([passage.incident, passage.wall, back].map(|maximum| (maximum.time_s, maximum.value)))
}

//! Computed forces at both sensors, with the times of their maxima.

use hertzchain_chain::Sensor;
use hertzchain_experiment::Experiment;
use hertzchain_sim::{Plan, shoot};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Uniform};
use std::error::Error;
use std::path::Path;

/// Interval in s of computed traces.
pub(crate) const FINE_S: f64 = 1e-7;

/// A row at one speed: forces at the sensor bead and the wall over the incident maximum.
pub(crate) struct Row {
    pub name: String,
    pub speed_m_s: f64,
    pub forces: [Vec<f64>; 2],
    /// Times in s of the incident, the wall's and the reflected maximum.
    pub maxima_s: [f64; 3],
    /// Height of the wall's maximum.
    pub wall_height: f64,
}

impl Row {
    /// Of a preset's chain, with so many beads in place of its 40.
    pub(crate) fn of_preset(
        preset: &str,
        beads: Option<u64>,
        speed_m_s: f64,
    ) -> Result<Self, Box<dyn Error>> {
        let mut experiment = hertzchain_experiment::preset(preset)?;
        if let Some(beads) = beads {
            let text = experiment.text().replace("count = 40", &format!("count = {beads}"));
            experiment = Experiment::from_text(preset, &text)?;
        }
        Self::new(preset.to_owned(), &experiment, speed_m_s)
    }

    /// A chain of other length, size and losses than the presets', dry or wet, at 0.06 to 2.5 m/s.
    pub(crate) fn at_random(number: u64) -> Result<Self, Box<dyn Error>> {
        let mut rng = ChaCha8Rng::seed_from_u64(number);
        let mut between = |low: f64, high: f64| -> Result<f64, Box<dyn Error>> {
            Ok(Uniform::new(low, high)?.sample(&mut rng))
        };
        let beads = between(14.0, 70.0)?.floor();
        let sensor = between(3.0, beads / 2.0)?.floor();
        let radius_mm = between(3.0, 12.0)?;
        let young_gpa = between(100.0, 220.0)?;
        let viscosity = 3.2e4 * 10_f64.powf(between(-0.6, 0.4)?);
        let cubic = 77.0 * radius_mm / 6.35 * 10_f64.powf(between(-0.6, 0.4)?);
        let (wet, of_wet) = (between(0.0, 1.0)? < 0.6, 10_f64.powf(between(4.6, 5.1)?));
        let power = between(-0.65, -0.15)?;
        let (slow, fast) = (0.06_f64, 2.5_f64);
        let speed_m_s = match between(0.0, 1.0)? < 0.5 {
            true => between(slow.ln(), fast.ln())?.exp(),
            false => between(slow, fast)?,
        };
        let from = if wet { sensor } else { beads + 1.0 };
        let last_dry = (from - 1.0).min(beads);
        let mut text = format!(
            r#"
            [materials.dry]
            young_modulus = "{young_gpa} GPa"
            poisson_ratio = 0.3
            density = "7.97 g/cm^3"
            shear_viscosity = "{viscosity} Pa s"
            [materials.wet]
            young_modulus = "{young_gpa} GPa"
            poisson_ratio = {{ prefactor = 0.36, exponent = -0.15 }}
            shear_viscosity = {{ prefactor = "{of_wet} Pa s", exponent = {power} }}
            [striker]
            speed = "{speed_m_s} m/s"
            [[beads]]
            count = {beads}
            radius = "{radius_mm} mm"
            material = "dry"
            [[contacts]]
            from = 0
            to = {last_dry}
            laws = ["elastic_hertz", "damping_viscoelastic", {{ law = "damping_cubic", coefficient = "{cubic} kg s/m^2" }}]
            [far_end]
            kind = "half-bead"
            [sensors]
            bead = {sensor}
            "#
        );
        if wet {
            text += &format!(
                r#"
                [[contacts]]
                from = {from}
                laws = ["elastic_hertz", "damping_viscoelastic"]
                material = "wet"
                wet = true
                "#
            );
        }
        let name = format!("chain {number}");
        let experiment = Experiment::from_text(&name, &text)?;
        Self::new(name, &experiment, speed_m_s)
    }

    /// Followed until three incident times after the wall's maximum.
    fn new(name: String, experiment: &Experiment, speed_m_s: f64) -> Result<Self, Box<dyn Error>> {
        let (mut plan, _) = Plan::from_experiment(experiment, Some(speed_m_s))?;
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
            name,
            speed_m_s,
            forces: [over(sensor), over(at_wall)],
            maxima_s: maxima(&plan)?.map(|maximum| maximum.0),
            wall_height: wall.1 / passing.1,
        })
    }

    /// Writes speed, times of the maxima and forces at both sensors into a file of that folder, each
    /// as f32.
    pub(crate) fn write(&self, folder: &Path) -> std::io::Result<()> {
        let head = [self.speed_m_s].into_iter().chain(self.maxima_s);
        let values = head.chain(self.forces.iter().flatten().copied());
        let bytes: Vec<u8> = values.flat_map(|value| (value as f32).to_le_bytes()).collect();
        let name = format!("{} {:.4}.f32", self.name, self.speed_m_s);
        std::fs::write(folder.join(name), bytes)
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

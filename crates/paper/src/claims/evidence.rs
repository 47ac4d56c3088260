//! The numbers that claims are evaluated on.

use hertzchain_measure::signal::{FitError, PowerLaw, power_law};

/// Standard deviation of the striker's speed over 20 shots of the paper, in m/s.
pub(crate) const SPEED_SCATTER_M_S: f64 = 0.003;

/// Shots behind each point of the paper.
pub(crate) const SHOTS_PER_POINT: f64 = 20.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum TofBranch {
    /// From the sensor bead to the wall.
    Incident,
    /// From the wall back to the sensor bead.
    Reflected,
}

impl TofBranch {
    /// Both, the incident first.
    pub(crate) const BOTH: [Self; 2] = [Self::Incident, Self::Reflected];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Incident => "incident",
            Self::Reflected => "reflected",
        }
    }
}

/// What one shot showed. Numbers that the shot did not give are not a number.
#[derive(Clone, Debug, PartialEq)]
pub struct ShotPoint {
    pub speed_m_s: f64,
    pub tof_incident_s: f64,
    pub tof_reflected_s: f64,
    /// Peak at the sensor bead, incoming, in N.
    pub sensor_peak_n: f64,
    pub wall_peak_n: f64,
    /// Peak at the sensor bead, returning, in N.
    pub returning_peak_n: f64,
    /// Largest returning maximum beside the first, before an echo from the near
    /// end can be back, in N; 0 when there is none.
    pub second_returning_peak_n: f64,
    /// Full widths at half maximum of the incoming, wall and returning pulse in s.
    pub widths_s: [f64; 3],
    /// Velocity of the striker when it first leaves bead 1 in m/s, negative away from the chain.
    pub striker_separation_m_s: f64,
    /// Velocity of the striker at the end of the shot in m/s.
    pub striker_rebound_m_s: f64,
    /// Reflected less incident ToF, both by peaks, in s: of the shot, and with the gaps
    /// behind the pulse closed as it meets the wall.
    pub excess_s: [f64; 2],
    /// By how much beads 1 and N are farther apart than at rest, in m, once the pulse has returned.
    pub loosened_m: f64,
    /// Relative accuracy of both ToFs.
    pub accuracy_reached: f64,
    /// Relative accuracy of the sensor, wall and returning peak.
    pub peak_accuracy: f64,
    pub second_peak_accuracy_n: f64,
    /// Relative accuracy of the three widths.
    pub width_accuracy: f64,
    pub striker_accuracy_m_s: f64,
    pub excess_accuracy_s: f64,
    pub loosened_accuracy_m: f64,
}

impl ShotPoint {
    pub(crate) fn tof_s(&self, branch: TofBranch) -> f64 {
        match branch {
            TofBranch::Incident => self.tof_incident_s,
            TofBranch::Reflected => self.tof_reflected_s,
        }
    }

    pub(crate) fn tof_accuracy_s(&self, branch: TofBranch) -> f64 {
        self.accuracy_reached * self.tof_s(branch)
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    pub case: String,
    pub points: Vec<ShotPoint>,
}

impl Curve {
    pub(crate) fn speeds_m_s(&self) -> Vec<f64> {
        self.points.iter().map(|p| p.speed_m_s).collect()
    }

    pub(crate) fn tofs_s(&self, branch: TofBranch) -> Vec<f64> {
        self.points.iter().map(|p| p.tof_s(branch)).collect()
    }

    pub fn at(&self, speed_m_s: f64) -> Option<&ShotPoint> {
        let near = |p: &&ShotPoint| (p.speed_m_s - speed_m_s).abs() < 1e-9 * speed_m_s;
        self.points.iter().find(near)
    }

    /// d ln T/d ln v of a branch at every speed, from its neighbours in log–log,
    /// where the curve is nearly straight; and its absolute accuracy: that of
    /// the two ToFs over the distance of their speeds in ln v.
    fn exponents(&self, branch: TofBranch) -> Vec<(f64, f64)> {
        let exponent = |a: &ShotPoint, b: &ShotPoint| {
            let span = (b.speed_m_s / a.speed_m_s).ln();
            let rise = (b.tof_s(branch) / a.tof_s(branch)).ln();
            (rise / span, (a.accuracy_reached + b.accuracy_reached) / span)
        };
        let last = self.points.len().saturating_sub(1);
        let around = |i: usize| {
            let before = self.points.get(i.saturating_sub(1));
            match (before, self.points.get((i + 1).min(last))) {
                (Some(before), Some(after)) if before.speed_m_s < after.speed_m_s => {
                    exponent(before, after)
                }
                _ => (f64::NAN, f64::NAN),
            }
        };
        (0..self.points.len()).map(around).collect()
    }

    /// dT/dv of a branch in s²/m at every speed.
    pub(crate) fn slopes_s2_m(&self, branch: TofBranch) -> Vec<f64> {
        let slopes = self.exponents(branch).into_iter().zip(&self.points);
        slopes.map(|((exponent, _), p)| exponent * p.tof_s(branch) / p.speed_m_s).collect()
    }

    /// Relative accuracy of dT/dv at every speed: of the local exponent and of the ToF.
    pub(crate) fn slope_accuracies(&self, branch: TofBranch) -> Vec<f64> {
        let exponents = self.exponents(branch).into_iter().zip(&self.points);
        exponents.map(|((exponent, off), p)| (off / exponent).abs() + p.accuracy_reached).collect()
    }

    /// Standard error in s that the paper's points have: the scatter of the
    /// speed over 20 shots, carried through dT/dv, over √20.
    pub(crate) fn standard_errors_s(&self, branch: TofBranch) -> Vec<f64> {
        let scatter = SPEED_SCATTER_M_S / SHOTS_PER_POINT.sqrt();
        let slopes = self.slopes_s2_m(branch);
        slopes.iter().map(|slope| slope.abs() * scatter).collect()
    }

    /// Straight line in log–log through a branch, every speed weighing the same.
    pub(crate) fn power_law(&self, branch: TofBranch) -> Result<PowerLaw, FitError> {
        power_law(&self.speeds_m_s(), &self.tofs_s(branch), None)
    }

    /// The same with the weights of the paper's standard errors.
    pub(crate) fn weighted_power_law(&self, branch: TofBranch) -> Result<PowerLaw, FitError> {
        let sigmas = self.standard_errors_s(branch);
        power_law(&self.speeds_m_s(), &self.tofs_s(branch), Some(&sigmas))
    }
}

/// Wet over dry incident ToF at one speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TofRatio {
    pub speed_m_s: f64,
    pub incident: f64,
    pub reflected: f64,
    /// Relative accuracy of both.
    pub accuracy_reached: f64,
}

impl TofRatio {
    /// Absolute accuracy of the incident ratio.
    pub(crate) fn accuracy(&self) -> f64 {
        self.accuracy_reached * self.incident
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PrintedOil {
    pub case: String,
    pub kinematic_viscosity_m2_s: f64,
    pub density_kg_m3: f64,
}

impl PrintedOil {
    pub(crate) fn dynamic_viscosity_pa_s(&self) -> f64 {
        self.kinematic_viscosity_m2_s * self.density_kg_m3
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MeasuredKind {
    SensorOverWall,
    Tof(TofBranch),
    Ratio,
}

/// A measured point, read off a published figure.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Digitised {
    pub what: MeasuredKind,
    pub case: String,
    pub speed_m_s: f64,
    pub value: f64,
    pub standard_error: f64,
}

/// All that claims are evaluated on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Evidence {
    pub curves: Vec<Curve>,
    pub(crate) oils: Vec<PrintedOil>,
    /// Viscosity over Young modulus of the dry balls, η/Y in s.
    pub viscosity_over_modulus_s: f64,
    /// Measured points; the paper prints none.
    pub(crate) digitised: Vec<Digitised>,
}

impl Evidence {
    pub(crate) fn curve(&self, case: &str) -> Option<&Curve> {
        self.curves.iter().find(|curve| curve.case == case)
    }

    pub(crate) fn oil(&self, case: &str) -> Option<&PrintedOil> {
        self.oils.iter().find(|oil| oil.case == case)
    }

    /// Wet over dry ToFs at the speeds that both curves have.
    pub(crate) fn ratios(&self, case: &str) -> Vec<TofRatio> {
        let (Some(wet), Some(dry)) = (self.curve(case), self.curve("dry")) else {
            return Vec::new();
        };
        let ratio = |w: &ShotPoint| {
            let d = dry.at(w.speed_m_s)?;
            Some(TofRatio {
                speed_m_s: w.speed_m_s,
                incident: w.tof_incident_s / d.tof_incident_s,
                reflected: w.tof_reflected_s / d.tof_reflected_s,
                accuracy_reached: w.accuracy_reached + d.accuracy_reached,
            })
        };
        wet.points.iter().filter_map(ratio).collect()
    }
}

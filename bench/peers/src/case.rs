//! The shots: the paper's chain under its laws, in units in which general
//! integrators like it best.

/// Beads of the paper's chain, the striker not counted.
pub const BEADS: usize = 40;
/// Contacts: 0 under the striker, 40 at the wall.
pub const CONTACTS: usize = BEADS + 1;
/// The bead with the sensor.
pub const SENSOR: usize = 7;

const YOUNG_PA: f64 = 213e9;
const POISSON: f64 = 0.3;
const RADIUS_M: f64 = 6.35e-3;
const MASS_KG: f64 = 8.54e-3;
const ETA_PA_S: f64 = 3.2e4;
const CUBIC_KG_S_M2: f64 = 77.0;

/// Which laws act where.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Case {
    /// Hertz everywhere.
    Hertz,
    /// Hertz and viscoelastic everywhere.
    HertzViscoelastic,
    /// Hertz, viscoelastic and cubic everywhere: the measure.
    Dry,
    /// Contacts from the sensor to the wall wet with pump oil.
    Pump,
    /// The same with gear oil.
    Gear,
    /// The same with motor oil.
    Motor,
}

impl Case {
    /// All of them, the measure first.
    pub const ALL: [Self; 6] = [
        Self::Dry,
        Self::Hertz,
        Self::HertzViscoelastic,
        Self::Pump,
        Self::Gear,
        Self::Motor,
    ];

    /// Its name in tables and for the Python side.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hertz => "hertz",
            Self::HertzViscoelastic => "hertz-viscoelastic",
            Self::Dry => "dry",
            Self::Pump => "pump",
            Self::Gear => "gear",
            Self::Motor => "motor",
        }
    }

    /// Effective material of the wet contacts: Y in Pa, η in Pa s, ν.
    pub fn oil(self, speed_m_s: f64) -> Option<(f64, f64, f64)> {
        let row = |young_pa, (eta, eta_power), (nu, nu_power)| {
            let eta_pa_s: f64 = eta * speed_m_s.powf(eta_power);
            Some((young_pa, eta_pa_s, nu * speed_m_s.powf(nu_power)))
        };
        match self {
            Self::Motor => row(193e9, (66177.1, -0.206), (0.360, -0.165)),
            Self::Gear => row(225e9, (107_299.0, -0.640), (0.390, -0.127)),
            Self::Pump => row(216e9, (81405.3, -0.302), (0.314, -0.274)),
            Self::Hertz | Self::HertzViscoelastic | Self::Dry => None,
        }
    }

    fn has_damping(self) -> bool {
        self != Self::Hertz
    }

    fn has_cubic(self) -> bool {
        !matches!(self, Self::Hertz | Self::HertzViscoelastic)
    }
}

/// One shot with mass, striker speed and dry stiffness 1. Lengths are in
/// (m v0² / K)^{2/5}, times in that over v0.
#[derive(Clone, Debug)]
pub struct Shot {
    /// K of each contact.
    pub stiff: [f64; CONTACTS],
    /// (3/2) A K of each contact.
    pub damping: [f64; CONTACTS],
    /// B of each contact.
    pub cubic: [f64; CONTACTS],
    /// The unit of time in s.
    pub time_s: f64,
}

impl Shot {
    /// K, (3/2) A K and B of a contact.
    #[inline(always)]
    pub fn law(&self, contact: usize) -> (f64, f64, f64) {
        (
            self.stiff[contact],
            self.damping[contact],
            self.cubic[contact],
        )
    }

    /// Of a case at a striker speed.
    pub fn new(case: Case, speed_m_s: f64) -> Self {
        let stiff = stiffness(YOUNG_PA, POISSON);
        let damping = |stiff, relaxation_s: f64| match case.has_damping() {
            true => 1.5 * relaxation_s * stiff,
            false => 0.0,
        };
        let dry = (
            stiff,
            damping(stiff, relaxation_s(YOUNG_PA, ETA_PA_S, POISSON)),
        );
        let wet = case.oil(speed_m_s).map(|(young, eta, nu)| {
            let stiff = stiffness(young, nu);
            (stiff, damping(stiff, relaxation_s(young, eta, nu)))
        });
        let length_m = (MASS_KG * speed_m_s * speed_m_s / stiff).powf(0.4);
        let time_s = length_m / speed_m_s;
        let of = |contact: usize| match wet {
            Some(wet) if contact >= SENSOR => (wet.0, wet.1, 0.0),
            _ if case.has_cubic() => (dry.0, dry.1, CUBIC_KG_S_M2),
            _ => (dry.0, dry.1, 0.0),
        };
        let force = MASS_KG * length_m / (time_s * time_s);
        let per_contact = |f: &dyn Fn((f64, f64, f64)) -> f64| {
            std::array::from_fn(|contact| f(of(contact)) / force)
        };
        Self {
            stiff: per_contact(&|c| c.0 * length_m.powf(1.5)),
            damping: per_contact(&|c| c.1 * length_m.sqrt() * speed_m_s),
            cubic: per_contact(&|c| c.2 * speed_m_s.powi(3)),
            time_s,
        }
    }
}

/// K of two equal balls in N/m^{3/2}.
fn stiffness(young_pa: f64, poisson: f64) -> f64 {
    young_pa * (2.0 * RADIUS_M).sqrt() / (3.0 * (1.0 - poisson * poisson))
}

/// A in s, both viscosities equal.
fn relaxation_s(young_pa: f64, eta_pa_s: f64, nu: f64) -> f64 {
    let shear = 4.0 / 3.0 * (1.0 - nu + nu * nu) + (1.0 - 2.0 * nu).powi(2);
    (1.0 + nu) / (1.0 - nu) * shear * eta_pa_s / young_pa
}

/// The speeds of an ensemble, evenly spread over 0.4 to 0.6 m/s. A smaller
/// ensemble is a part of the full one.
pub fn speeds_m_s(count: usize) -> Vec<f64> {
    let full = 1000;
    let stride = (full / count.clamp(1, full)).max(1);
    let picked = (0..full).skip(stride / 2).step_by(stride).take(count);
    picked
        .map(|i| 0.4 + 0.2 * (i as f64 + 0.5) / full as f64)
        .collect()
}

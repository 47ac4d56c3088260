//! What a bead is made of, and what two touching bodies share.

/// An isotropic viscoelastic solid.
///
/// `poisson_ratio` may lie above 1/2 (an effective number of a wet contact);
/// laws that need it below 1 say so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young modulus Y in Pa.
    pub young_modulus_pa: f64,
    /// Poisson ratio ν, dimensionless.
    pub poisson_ratio: f64,
    /// Shear viscosity η1 in Pa s.
    pub shear_viscosity_pa_s: f64,
    /// Bulk viscosity η2 in Pa s.
    pub bulk_viscosity_pa_s: f64,
    /// Yield strength in Pa, if it is known.
    pub yield_strength_pa: Option<f64>,
}

impl Material {
    /// A body that does not yield: D = 0, A = 0.
    pub const RIGID: Self = Self {
        young_modulus_pa: f64::INFINITY,
        poisson_ratio: 0.0,
        shear_viscosity_pa_s: 0.0,
        bulk_viscosity_pa_s: 0.0,
        yield_strength_pa: None,
    };

    /// An elastic material without viscosity.
    pub const fn elastic(young_modulus_pa: f64, poisson_ratio: f64) -> Self {
        Self {
            young_modulus_pa,
            poisson_ratio,
            shear_viscosity_pa_s: 0.0,
            bulk_viscosity_pa_s: 0.0,
            yield_strength_pa: None,
        }
    }

    /// Contact compliance D = (1 − ν²)/Y in 1/Pa; 0 for a rigid body.
    pub fn compliance_per_pa(&self) -> f64 {
        (1.0 - self.poisson_ratio * self.poisson_ratio) / self.young_modulus_pa
    }

    /// Viscoelastic relaxation time of [Goldobin2015] in s,
    /// A = (1/Y) (1+ν)/(1−ν) [ (4/3) η1 (1−ν+ν²) + η2 (1−2ν)² ].
    pub fn relaxation_time_s(&self) -> f64 {
        let nu = self.poisson_ratio;
        let shear = 4.0 / 3.0 * self.shear_viscosity_pa_s * (1.0 - nu + nu * nu);
        let bulk = self.bulk_viscosity_pa_s * (1.0 - 2.0 * nu).powi(2);
        (1.0 + nu) / (1.0 - nu) * (shear + bulk) / self.young_modulus_pa
    }

    /// Relaxation time of [Brilliantov1996] in s,
    /// A = (1/3) (3η2 − η1)²/(3η2 + 2η1) · (1−ν²)(1−2ν)/(Y ν²).
    pub fn relaxation_time_1996_s(&self) -> f64 {
        let nu = self.poisson_ratio;
        let (shear, bulk) = (self.shear_viscosity_pa_s, self.bulk_viscosity_pa_s);
        if shear == 0.0 && bulk == 0.0 {
            return 0.0;
        }
        let viscosity = (3.0 * bulk - shear).powi(2) / (3.0 * bulk + 2.0 * shear) / 3.0;
        viscosity * (1.0 - nu * nu) * (1.0 - 2.0 * nu) / (self.young_modulus_pa * nu * nu)
    }
}

/// What a contact law may know of the two bodies it joins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeadPair {
    /// The body on the striker's side.
    pub left: Material,
    /// The body on the wall's side.
    pub right: Material,
    /// Reduced radius R* = R1 R2/(R1 + R2) in m; R1 against a plane.
    pub radius_m: f64,
    /// Reduced mass m1 m2/(m1 + m2) in kg; m1 against a fixed body.
    pub mass_kg: f64,
}

impl BeadPair {
    /// Hertz stiffness K = (4/3) √R*/(D1 + D2) in N/m^{3/2} [Hertz1881].
    pub fn hertz_stiffness(&self) -> f64 {
        let compliance = self.left.compliance_per_pa() + self.right.compliance_per_pa();
        4.0 / 3.0 * self.radius_m.sqrt() / compliance
    }

    /// Yield strength of the weaker body in Pa, where one is known.
    pub fn yield_strength_pa(&self) -> Option<f64> {
        let known = [self.left, self.right].into_iter().filter_map(|body| body.yield_strength_pa);
        known.reduce(f64::min)
    }

    /// Compliance-weighted mean (A1 D1 + A2 D2)/(D1 + D2) of a relaxation
    /// time in s, as unlike bodies share one [Goldobin2015].
    pub fn mean_relaxation_time_s(&self, of: fn(&Material) -> f64) -> f64 {
        let (left, right) = (self.left.compliance_per_pa(), self.right.compliance_per_pa());
        let weigh = |material: &Material, compliance: f64| {
            if compliance == 0.0 { 0.0 } else { of(material) * compliance }
        };
        (weigh(&self.left, left) + weigh(&self.right, right)) / (left + right)
    }
}

//! A row of beads as numbers, and as an experiment file.

use std::fmt::Write;

/// Gravity in m/s².
pub(crate) const GRAVITY: f64 = 9.80665;

/// An isotropic viscoelastic solid; its bulk viscosity equals the shear viscosity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Material {
    pub young_pa: f64,
    pub poisson: f64,
    pub viscosity_pa_s: f64,
}

/// A ball, with the index of its material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ball {
    pub radius_m: f64,
    pub mass_kg: f64,
    pub material: usize,
}

/// One term of a contact force, by the names of `hertzchain laws`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Law {
    ElasticHertz,
    ElasticPower { stiffness: f64, exponent: f64 },
    ElasticPlastic { yield_pa: f64 },
    Viscoelastic,
    Brilliantov1996,
    Cubic { coefficient: f64 },
    CubicUngated { coefficient: f64 },
    KuwabaraKono { coefficient: f64 },
    Tsuji { ratio: f64 },
    Linear { coefficient: f64 },
    Power { coefficient: f64, rate: f64, overlap: f64 },
}

/// What the last bead leans on, of the same material as the last bead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Far {
    HalfBead,
    Plane,
    Stop { mass_kg: f64 },
    PlaneStop { mass_kg: f64 },
}

/// What pushes bead 1: a force at rest, and the stiffness of a spring or 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Push {
    pub force_n: f64,
    pub stiffness_n_m: f64,
}

/// One chain with its striker.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    pub title: String,
    pub materials: Vec<Material>,
    pub striker: Ball,
    pub speed_m_s: f64,
    pub beads: Vec<Ball>,
    /// First contact and laws of each section.
    pub sections: Vec<(usize, Vec<Law>)>,
    pub far: Far,
    pub push: Option<Push>,
    pub incline_deg: f64,
    /// Contact and gap in m.
    pub gaps: Vec<(usize, f64)>,
    pub clipped: bool,
    pub sensor: usize,
}

impl Law {
    fn toml(&self) -> String {
        let table = |name: &str, keys: String| format!("{{ law = \"{name}\", {keys} }}");
        match *self {
            Self::ElasticHertz => "\"elastic_hertz\"".into(),
            Self::Viscoelastic => "\"damping_viscoelastic\"".into(),
            Self::Brilliantov1996 => "\"damping_brilliantov_1996\"".into(),
            Self::ElasticPower { stiffness, exponent } => table(
                "elastic_power",
                format!("stiffness = \"{stiffness:?} N/m^{exponent}\", exponent = {exponent:?}"),
            ),
            Self::ElasticPlastic { yield_pa } => {
                table("elastic_plastic_thornton", format!("yield_pressure = \"{yield_pa:?} Pa\""))
            }
            Self::Cubic { coefficient } => {
                table("damping_cubic", format!("coefficient = \"{coefficient:?} kg s/m^2\""))
            }
            Self::CubicUngated { coefficient } => table(
                "damping_cubic_ungated",
                format!("coefficient = \"{coefficient:?} kg s/m^2\""),
            ),
            Self::KuwabaraKono { coefficient } => table(
                "damping_kuwabara_kono",
                format!("coefficient = \"{coefficient:?} N s/m^1.5\""),
            ),
            Self::Tsuji { ratio } => table("damping_tsuji", format!("damping_ratio = {ratio:?}")),
            Self::Linear { coefficient } => {
                table("damping_linear", format!("coefficient = \"{coefficient:?} N s/m\""))
            }
            Self::Power { coefficient, rate, overlap } => table(
                "damping_power",
                format!(
                    "coefficient = \"{coefficient:?} N/m^{overlap}/(m/s)^{rate}\", \
                     rate_exponent = {rate:?}, overlap_exponent = {overlap:?}"
                ),
            ),
        }
    }
}

impl Ball {
    fn toml(&self, text: &mut String) {
        let Self { radius_m, mass_kg, material } = self;
        let _ = writeln!(
            text,
            "radius = \"{radius_m:?} m\"\nmass = \"{mass_kg:?} kg\"\nmaterial = \"m{material}\""
        );
    }
}

impl Row {
    /// The experiment file.
    pub(crate) fn toml(&self) -> String {
        let mut text = format!("title = \"{}\"\n", self.title);
        if self.clipped {
            text += "tension = \"clipped\"\n";
        }
        for (index, material) in self.materials.iter().enumerate() {
            let Material { young_pa, poisson, viscosity_pa_s } = material;
            let _ = writeln!(
                text,
                "[materials.m{index}]\nyoung_modulus = \"{young_pa:?} Pa\"\n\
                 poisson_ratio = {poisson:?}\nshear_viscosity = \"{viscosity_pa_s:?} Pa s\""
            );
        }
        let _ = writeln!(text, "[striker]\nspeed = \"{:?} m/s\"", self.speed_m_s);
        self.striker.toml(&mut text);
        for group in self.beads.chunk_by(|one, other| one == other) {
            let _ = writeln!(text, "[[beads]]\ncount = {}", group.len());
            group[0].toml(&mut text);
        }
        self.contacts(&mut text);
        self.ends(&mut text);
        let _ = writeln!(text, "[sensors]\nbead = {}", self.sensor);
        text
    }

    fn contacts(&self, text: &mut String) {
        let firsts = self.sections.iter().skip(1).map(|(first, _)| *first - 1);
        let lasts = firsts.chain([self.beads.len()]);
        for ((first, laws), last) in self.sections.iter().zip(lasts) {
            let laws: Vec<String> = laws.iter().map(Law::toml).collect();
            let laws = laws.join(", ");
            let _ = writeln!(text, "[[contacts]]\nfrom = {first}\nto = {last}\nlaws = [{laws}]");
        }
        for (contact, gap_m) in &self.gaps {
            let _ = writeln!(text, "[[gaps]]\ncontact = {contact}\ngap = \"{gap_m:?} m\"");
        }
    }

    fn ends(&self, text: &mut String) {
        let (kind, mass_kg) = match self.far {
            Far::HalfBead => ("half-bead", None),
            Far::Plane => ("plane", None),
            Far::Stop { mass_kg } => ("stop", Some(mass_kg)),
            Far::PlaneStop { mass_kg } => ("plane-stop", Some(mass_kg)),
        };
        let _ = writeln!(text, "[far_end]\nkind = \"{kind}\"");
        if let Some(mass_kg) = mass_kg {
            let _ = writeln!(text, "mass = \"{mass_kg:?} kg\"");
        }
        if let Some(Push { force_n, stiffness_n_m }) = self.push {
            let (kind, stiffness) = match stiffness_n_m == 0.0 {
                true => ("constant", String::new()),
                false => ("spring", format!("\nstiffness = \"{stiffness_n_m:?} N/m\"")),
            };
            let _ = writeln!(
                text,
                "[near_end]\npush = \"{kind}\"\nforce = \"{force_n:?} N\"{stiffness}"
            );
        }
        if self.incline_deg > 0.0 {
            let _ = writeln!(
                text,
                "[track]\nincline = \"{:?} deg\"\ngravity = \"{GRAVITY} m/s^2\"",
                self.incline_deg
            );
        }
    }
}

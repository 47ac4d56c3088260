//! The ends of the chain, deviations from rest, sensors, solver and liquid of a file.

use crate::bodies::Materials;
use crate::keys::{
    MOST_BEADS, OIL, OIL_TEMPERATURE, QUARTER_TURN, Quantity, SPEED, Text, choice, not_negative,
    positive,
};
use crate::report::{FileProblem, brief};
use crate::values::{TableView, Units, record};
use hertzchain_chain::laws::Row;
use hertzchain_chain::{Gap, Initial, Motion, Push};
use std::ops::Range;
use std::path::Path;

choice! {
    /// Method that integrates the motion.
    Method {
        "adaptive" => Adaptive: "An embedded pair that chooses its step by the accuracy.",
        "rk4" => Rk4: "Classical Runge–Kutta with a fixed step, as in the paper.",
        "verlet" => Verlet: "Velocity Verlet with a fixed step, as in discrete-element codes.",
    }
}

/// Solver and its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solver {
    /// Method.
    pub method: Method,
    /// Relative accuracy asked for.
    pub accuracy: f64,
    /// Step of a fixed-step method in s; `None` lets the program decide.
    pub step_s: Option<f64>,
    /// Duration of a shot in s; `None` until the reflected pulse has passed
    /// the sensor.
    pub duration_s: Option<f64>,
}

impl Solver {
    /// The accuracy when a file names none.
    pub const DEFAULT_ACCURACY: f64 = 1e-6;

    pub(crate) fn read(root: &TableView<'_>) -> Result<Self, FileProblem> {
        let table = root.table("solver");
        let number = |key| table.map_or(Ok(None), |t| t.quantity(key));
        let method = table.and_then(|t| Method::from_name(t.text("method")?));
        let method = method.unwrap_or_default();
        let step_s = number("step")?;
        if let (Some(table), Method::Adaptive, Some(_)) = (table, method, step_s) {
            let message = "the adaptive method chooses its own steps";
            let label = "expected no `step`, or method = \"rk4\" or \"verlet\"";
            return Err(table.problem("step", message, label));
        }
        Ok(Self {
            method,
            accuracy: number("accuracy")?.unwrap_or(Self::DEFAULT_ACCURACY),
            step_s,
            duration_s: number("duration")?,
        })
    }
}

/// Room temperature in K.
const ROOM_K: f64 = 298.15;

record! {
    /// A liquid: its viscosity at its temperature, for the laws of films and for reports; its
    /// surface and volume, for bridges.
    Liquid "[liquid]"
    name: String = name "liquid".to_owned(), Text, "name of the liquid";
    kinematic_viscosity_m2_s: Option<f64> = kinematic_viscosity None, positive("m^2/s"), "kinematic viscosity";
    kinematic_viscosity_40_m2_s: Option<f64> = kinematic_viscosity_40 None, OIL, "the same at 40 °C, by ASTM D341 with that at 100 °C";
    kinematic_viscosity_100_m2_s: Option<f64> = kinematic_viscosity_100 None, OIL, "the same at 100 °C";
    temperature_k: f64 = temperature ROOM_K, Quantity("K", OIL_TEMPERATURE), "temperature; default 25 degC";
    density_kg_m3: Option<f64> = density None, positive("kg/m^3"), "density, with two viscosities at 40 °C";
    pressure_viscosity_per_pa: Option<f64> = pressure_viscosity None, not_negative("1/Pa"), "pressure–viscosity coefficient α";
    surface_tension_n_m: Option<f64> = surface_tension None, not_negative("N/m"), "surface tension γ";
    contact_angle_rad: Option<f64> = contact_angle None, Quantity("rad", QUARTER_TURN), "contact angle on the bodies; default 0 deg";
    volume_m3: Option<f64> = volume None, not_negative("m^3"), "volume in each wet contact";
}

impl Liquid {
    /// Advice where a law needs a liquid.
    pub(crate) fn suffices(row: &Row) -> &'static str {
        let of_bridge = row.info.parameters.iter().any(|p| p.name == "surface_tension");
        match of_bridge {
            true => "or give `surface_tension` and `volume` in [liquid]",
            false => {
                "or give the oil in [liquid]: `kinematic_viscosity_40`, `kinematic_viscosity_100`, \
                 `density` and `pressure_viscosity` (0 for an oil that pressure does not thicken)"
            }
        }
    }

    /// What it gives to the parameter of a law with this name.
    pub fn value(&self, parameter: &str) -> Option<f64> {
        match parameter {
            "viscosity" => self.dynamic_viscosity_pa_s(),
            "pressure_viscosity" => self.pressure_viscosity_per_pa,
            "surface_tension" => self.surface_tension_n_m,
            "contact_angle" => self.contact_angle_rad,
            "volume" => self.volume_m3,
            _ => None,
        }
    }

    /// Dynamic viscosity in Pa s at the liquid's temperature T.
    ///
    /// With ν at 40 and 100 °C it is ρ ν(T): log log(ν + 0.7), ν in mm²/s, is linear in log T
    /// [Walther1931, ASTM D341], and ρ, given at 40 °C, falls by 6.5·10⁻⁴ of itself a kelvin. Else it is the one ν times ρ.
    pub fn dynamic_viscosity_pa_s(&self) -> Option<f64> {
        /// Of mineral oils and poly-α-olefins, 1/K.
        const EXPANSION: f64 = 6.5e-4;
        let density = self.density_kg_m3?;
        let pair = self.kinematic_viscosity_40_m2_s.zip(self.kinematic_viscosity_100_m2_s);
        let found = match pair {
            None => self.kinematic_viscosity_m2_s? * density,
            Some((at40, at100)) => {
                let level = |m2_s: f64| (1e6 * m2_s + 0.7).log10().log10();
                let fall = (level(at100) - level(at40)) / (373.15_f64 / 313.15).log10();
                let here = level(at40) + fall * (self.temperature_k / 313.15).log10();
                let mm2_s = 10f64.powf(10f64.powf(here)) - 0.7;
                1e-6 * mm2_s * density * (1.0 - EXPANSION * (self.temperature_k - 313.15))
            }
        };
        (found > 0.0 && found.is_finite()).then_some(found)
    }

    /// The liquid of a file or of a case.
    pub(crate) fn read_from(root: &TableView<'_>) -> Result<Option<Self>, FileProblem> {
        let Some(table) = root.table("liquid") else { return Ok(None) };
        let liquid = Self::read(Some(&table))?;
        let both = ["kinematic_viscosity_40", "kinematic_viscosity_100"];
        let (message, key) = match both.map(|key| table.has(key)) {
            [true, true] if table.has("kinematic_viscosity") => {
                ("this viscosity has no temperature, and two others have", "kinematic_viscosity")
            }
            [true, true] if liquid.thickens_with_heat() => {
                ("this oil is not thinner at 100 °C than at 40 °C", both[1])
            }
            [true, false] => ("the viscosity at 100 °C is missing", both[0]),
            [false, true] => ("the viscosity at 40 °C is missing", both[1]),
            [false, false] if table.has("kinematic_viscosity") && table.has("temperature") => {
                ("one viscosity does not say what it is at this temperature", "temperature")
            }
            _ => return Ok(Some(liquid)),
        };
        let label = "expected `kinematic_viscosity` alone, or the larger at 40 °C and the smaller at 100 °C";
        Err(table.problem(key, message, label))
    }

    fn thickens_with_heat(&self) -> bool {
        self.kinematic_viscosity_100_m2_s >= self.kinematic_viscosity_40_m2_s
    }
}

/// Numbers of beads, contacts or bodies with their places.
type Indices = Vec<(usize, Range<usize>)>;

/// Sensors of a file.
#[derive(Clone, Debug)]
pub(crate) struct Sensors {
    /// The sensor bead n of the ToF.
    pub(crate) bead: usize,
    pub(crate) span: Range<usize>,
    pub(crate) beads: Indices,
    pub(crate) contacts: Indices,
    pub(crate) positions: Indices,
    pub(crate) velocities: Indices,
    /// Where the paper's channel is asked for.
    pub(crate) channel: Option<Range<usize>>,
}

impl Sensors {
    pub(crate) fn read(root: &TableView<'_>, beads: usize) -> Result<Self, FileProblem> {
        let usual = if beads >= 8 { 7 } else { 1 };
        let table = root.table("sensors");
        let list = |key| table.map_or(Ok(Vec::new()), |t| t.counts(key));
        let bead = table.map_or(Ok(None), |t| t.count("bead"))?;
        let channel = table.filter(|t| t.flag("channel"));
        Ok(Self {
            bead: bead.unwrap_or(usual),
            span: table.map_or(root.span(), |t| t.span_of("bead")),
            beads: list("beads")?,
            contacts: list("contacts")?,
            positions: list("positions")?,
            velocities: list("velocities")?,
            channel: channel.map(|t| t.span_of("channel")),
        })
    }
}

/// Gaps with their places in the file, one a contact; `first` and `last` are the chain's contacts.
pub(crate) fn gaps(
    root: &TableView<'_>,
    (first, last): (usize, usize),
) -> Result<Vec<(Gap, Range<usize>)>, FileProblem> {
    let mut gaps = Vec::new();
    for table in root.tables("gaps") {
        let ends = ["from", "to"].into_iter().find(|key| table.has(key));
        let (contacts, span) = match (table.count("contact")?, ends) {
            (Some(contact), None) => (contact..=contact, table.span_of("contact")),
            (None, Some(end)) => {
                let from = table.count("from")?.unwrap_or(first);
                (from..=table.count("to")?.unwrap_or(last), table.span_of(end))
            }
            (given, _) => {
                let label = "expected `contact`, or `from` and `to`";
                let message = match given {
                    Some(_) => "this gap has both a contact and a range of contacts",
                    None => "this gap has no contact",
                };
                return Err(FileProblem::new(&table.span(), message, label));
            }
        };
        // Contacts beyond the longest chain are outside of any.
        if contacts.is_empty() || contacts.end() - contacts.start() > MOST_BEADS as usize {
            let message = format!("no contact is from {} to {}", contacts.start(), contacts.end());
            return Err(FileProblem::new(&span, message, "expected `to` at or after `from`"));
        }
        let gap_m = table.needed("gap")?;
        gaps.extend(contacts.map(|contact| (Gap { contact, gap_m }, span.clone())));
    }
    Ok(gaps)
}

/// Initial deviations with their places in the file.
pub(crate) fn initial(root: &TableView<'_>) -> Result<Vec<(Initial, Range<usize>)>, FileProblem> {
    let initial = |table: &TableView<'_>| {
        if !table.has("displacement") && !table.has("velocity") {
            let message = "this bead is neither displaced nor moving";
            let label = "expected `displacement` or `velocity`, or no such table";
            return Err(FileProblem::new(&table.span(), message, label));
        }
        let initial = Initial {
            bead: table.count("bead")?.unwrap_or(0),
            displacement_m: table.quantity("displacement")?.unwrap_or(0.0),
            velocity_m_s: table.quantity("velocity")?.unwrap_or(0.0),
        };
        Ok((initial, table.span_of("bead")))
    };
    root.tables("initial").iter().map(initial).collect()
}

/// Shape and material of body 0 or of a half-bead, as far as given.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct BodyShape {
    pub(crate) radius_m: Option<f64>,
    pub(crate) mass_kg: Option<f64>,
    pub(crate) material: Option<usize>,
    pub(crate) span: Range<usize>,
}

impl BodyShape {
    fn read(table: &TableView<'_>, materials: &Materials) -> Result<Self, FileProblem> {
        Ok(Self {
            radius_m: table.quantity("radius")?,
            mass_kg: table.quantity("mass")?,
            material: materials.find(table)?,
            span: table.span(),
        })
    }
}

/// The cause of the chain's motion.
#[derive(Clone, Debug)]
pub(crate) enum Near {
    Striker {
        shape: BodyShape,
        speed_m_s: f64,
        speed_span: Range<usize>,
    },
    Driven {
        shape: BodyShape,
        motion: Motion,
    },
    /// Beads that start displaced or moving, as the file says here.
    Free {
        span: Range<usize>,
    },
}

impl Near {
    pub(crate) fn read(
        root: &TableView<'_>,
        materials: &Materials,
        folder: &Path,
    ) -> Result<Self, FileProblem> {
        match (root.table("striker"), root.variant("driven")) {
            (Some(striker), Some((_, driven))) => {
                let message = "there are a striker and a driven end";
                let problem = FileProblem::new(&driven.span(), message, "expected one of the two");
                Err(problem.also(&striker.span(), "the striker is here"))
            }
            (Some(striker), None) => Ok(Self::Striker {
                shape: BodyShape::read(&striker, materials)?,
                speed_m_s: striker.needed("speed")?,
                speed_span: striker.span_of("speed"),
            }),
            (None, Some((tag, table))) => Ok(Self::Driven {
                shape: BodyShape::read(&table, materials)?,
                motion: motion(tag, &table, folder)?,
            }),
            (None, None) if root.has("initial") => Ok(Self::Free {
                span: root.tables("initial").first().map_or(0..0, TableView::span),
            }),
            (None, None) => {
                let label = "expected [striker], [driven] or [[initial]]";
                Err(root.problem("beads", "nothing sets the chain in motion", label))
            }
        }
    }

    /// Speed of the striker in m/s, if there is one.
    pub(crate) const fn speed_m_s(&self) -> Option<f64> {
        match self {
            Self::Striker { speed_m_s, .. } => Some(*speed_m_s),
            Self::Driven { .. } | Self::Free { .. } => None,
        }
    }

    /// Shape of body 0, if there is one.
    pub(crate) const fn shape(&self) -> Option<&BodyShape> {
        match self {
            Self::Striker { shape, .. } | Self::Driven { shape, .. } => Some(shape),
            Self::Free { .. } => None,
        }
    }

    /// Its place in the file.
    pub(crate) fn span(&self) -> Range<usize> {
        match self {
            Self::Striker { shape, .. } | Self::Driven { shape, .. } => shape.span.clone(),
            Self::Free { span } => span.clone(),
        }
    }
}

/// The motion of `[driven]`, no faster than a striker may be.
fn motion(tag: &str, table: &TableView<'_>, folder: &Path) -> Result<Motion, FileProblem> {
    let amplitude_m = table.quantity("amplitude")?.unwrap_or(1.0);
    if amplitude_m == 0.0 {
        let message = "an amplitude of 0 sets nothing in motion";
        return Err(table.problem("amplitude", message, "expected a length, such as \"1 um\""));
    }
    let motion = match tag {
        "sine" => Motion::Sine { amplitude_m, frequency_hz: table.needed("frequency")? },
        "pulse" => Motion::Pulse { amplitude_m, duration_s: table.needed("duration")? },
        _ => motion_table(table, folder)?,
    };
    let speed_m_s = motion.largest_speed_m_s();
    let limits = SPEED.within(table.units, "m/s");
    if limits.hold(speed_m_s) {
        return Ok(motion);
    }
    let speed = table.units.with_unit(&brief(speed_m_s), "m/s");
    let keys = ["frequency", "duration", "times", "file"];
    let key = keys.into_iter().find(|key| table.has(key)).unwrap_or("motion");
    let message = format!("this motion reaches a speed of {speed}");
    Err(table.problem(key, message, format!("expected a largest speed {}", limits.words)))
}

/// Measured motion: points in the experiment file, or in a CSV file beside it.
fn motion_table(table: &TableView<'_>, folder: &Path) -> Result<Motion, FileProblem> {
    let (times_s, positions_m, key) = match (table.text("file"), table.has("times")) {
        (Some(_), true) => {
            let message = "the motion stands both here and in a file";
            let label = "expected `file`, or `times` and `positions`";
            return Err(table.problem("file", message, label));
        }
        (Some(file), false) => {
            let (times, positions) = motion_file(table, &folder.join(file))?;
            (times, positions, "file")
        }
        (None, _) => {
            let positions = table.quantities("positions")?;
            (table.quantities("times")?, positions, "times")
        }
    };
    let (message, label) = if times_s.len() != positions_m.len() {
        let message = "there are not as many positions as times";
        (message, "expected one position a time")
    } else if times_s.len() < 2 {
        ("a motion needs at least two points", "expected more points")
    } else if times_s.windows(2).any(|pair| pair[0] >= pair[1]) {
        let label = "expected each time to be later than the one before";
        ("the times do not increase", label)
    } else if positions_m.windows(2).all(|pair| pair[0] == pair[1]) {
        let message = "this motion sets nothing in motion";
        (message, "expected positions that differ")
    } else {
        return Ok(Motion::Table { times_s, positions_m });
    };
    Err(table.problem(key, message, label))
}

/// The two columns of a CSV file, whose first line names them with their units.
fn motion_file(table: &TableView<'_>, path: &Path) -> Result<(Vec<f64>, Vec<f64>), FileProblem> {
    /// Larger files are a mistake.
    const MOST_BYTES: u64 = 64 << 20;
    let header = match table.units {
        Units::Si => "time_s,position_m",
        Units::Dimensionless => "time,position",
    };
    let wrong = |what: String| {
        let label = format!("expected a readable CSV file with the columns {header}");
        table.problem("file", format!("{}{what}", path.display()), label)
    };
    let unreadable = |e: std::io::Error| wrong(format!(" can't be read: {e}"));
    let size = std::fs::metadata(path).map_err(unreadable)?;
    if !size.is_file() || size.len() > MOST_BYTES {
        return Err(wrong(" is not a file of at most 64 MiB".to_owned()));
    }
    let text = std::fs::read_to_string(path).map_err(unreadable)?;
    let mut lines = text.lines().map(str::trim).zip(1..);
    if lines.next().map(|(first, _)| first) != Some(header) {
        return Err(wrong(format!(":1: the first line is not {header}")));
    }
    let number = |text: &str| text.trim().parse().ok().filter(|v: &f64| v.is_finite());
    let pair = |(line, at): (&str, u64)| {
        let pair = line.split_once(',').and_then(|(time, at)| Some((number(time)?, number(at)?)));
        pair.ok_or_else(|| wrong(format!(":{at}: `{line}` is not two numbers")))
    };
    lines.filter(|(line, _)| !line.is_empty()).map(pair).collect()
}

/// The push on bead 1.
pub(crate) fn push(root: &TableView<'_>) -> Result<Push, FileProblem> {
    let Some((tag, table)) = root.variant("near_end") else {
        return Ok(Push::None);
    };
    let force_n = table.needed("force")?;
    Ok(match tag {
        "spring" => Push::Spring { force_n, stiffness_n_m: table.needed("stiffness")? },
        _ => Push::Constant { force_n },
    })
}

/// The end that bead N leans on.
#[derive(Clone, Debug)]
pub(crate) enum Far {
    /// A half-bead or a plane, fixed or on a stop of this mass.
    Wall {
        is_plane: bool,
        shape: BodyShape,
        stop_kg: Option<f64>,
    },
    Periodic {
        force_n: f64,
    },
    Free,
}

impl Far {
    /// A half-bead like bead N when the file is silent.
    pub(crate) fn read(root: &TableView<'_>, materials: &Materials) -> Result<Self, FileProblem> {
        let Some((tag, table)) = root.variant("far_end") else {
            let shape = BodyShape::default();
            return Ok(Self::Wall { is_plane: false, shape, stop_kg: None });
        };
        Ok(match tag {
            "periodic" => Self::Periodic { force_n: table.quantity("force")?.unwrap_or(0.0) },
            "free" => Self::Free,
            _ => Self::Wall {
                is_plane: tag.starts_with("plane"),
                shape: BodyShape::read(&table, materials)?,
                stop_kg: table.quantity("mass")?,
            },
        })
    }

    /// Shape of a wall.
    pub(crate) const fn shape(&self) -> Option<&BodyShape> {
        match self {
            Self::Wall { shape, .. } => Some(shape),
            Self::Periodic { .. } | Self::Free => None,
        }
    }

    /// Mass of a stop of finite mass in kg.
    pub(crate) const fn stop_kg(&self) -> Option<f64> {
        match self {
            Self::Wall { stop_kg, .. } => *stop_kg,
            Self::Periodic { .. } | Self::Free => None,
        }
    }
}

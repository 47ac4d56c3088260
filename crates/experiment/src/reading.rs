//! Readings: what the paper leaves open, one named switch each, and what each changes.
//!
//! The first option of a switch is its default and changes nothing in the
//! file; every other option changes what it says and nothing else.

use crate::contacts::SectionSpec;
use crate::keys::{Choice, Fields, choice, table};
use crate::report::UnknownName;
use crate::settings::Far;
use crate::spec::Spec;
use crate::values::TableView;
use hertzchain_chain::laws::find;
use hertzchain_chain::{Push, Tension};

/// One switch and its options, the default first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Switch {
    /// Key in `[reading]`.
    pub name: &'static str,
    /// What it decides.
    pub about: &'static str,
    /// Its options as written in a file.
    pub options: &'static [&'static str],
}

/// Declares all switches: the enums, the struct, the keys and their names.
macro_rules! switches {
    ($($about:literal $field:ident: $Type:ident { $($options:tt)+ })+) => {
        $(choice! {
            #[doc = concat!("Switch: ", $about, ".")]
            $Type { $($options)+ }
        })+

        /// One choice of every switch.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub struct Reading {
            $(#[doc = concat!("Decides: ", $about, ".")] pub $field: $Type,)+
        }

        const SWITCHES: &[Switch] = &[$(Switch {
            name: stringify!($field),
            about: $about,
            options: $Type::NAMES,
        },)+];

        pub(crate) static READING: Fields = table! { "[reading]";
            $($field: Choice($Type::NAMES), $about;)+
        };

        impl Reading {
            /// The option of a switch, as written in a file.
            pub fn get(&self, switch: &str) -> Option<&'static str> {
                match switch {
                    $(stringify!($field) => Some(self.$field.name()),)+
                    _ => None,
                }
            }

            /// This reading with one switch set.
            ///
            /// # Errors
            /// An unknown switch or option, with those that exist.
            pub fn with(mut self, switch: &str, option: &str) -> Result<Self, UnknownName> {
                match switch {
                    $(stringify!($field) => self.$field = $Type::from_name(option).ok_or_else(|| {
                        let what = format!("option `{option}` of the switch `{switch}`");
                        UnknownName::new(what, option, $Type::NAMES.to_vec())
                    })?,)+
                    _ => {
                        let names = SWITCHES.iter().map(|s| s.name).collect();
                        return Err(UnknownName::new(format!("switch `{switch}`"), switch, names));
                    }
                }
                Ok(self)
            }
        }
    };
}

switches! {
    "preload on bead 1"
    preload: PreloadReading {
        "none" => None: "No more than the file says.",
        "spring" => Spring: "A spring of 0.24 N and 100 N/m that never pulls.",
        "constant" => Constant: "A constant force of 0.24 N.",
    }
    "incline of the track"
    incline: InclineReading {
        "0 deg" => Level: "No more than the file says.",
        "0.5 deg" => Half: "Half a degree.",
        "1 deg" => One: "One degree.",
    }
    "cubic damping on dry contacts when others are wet"
    dry_cubic_beside_wet: DryCubicReading {
        "with" => With: "The dry contacts keep all their laws.",
        "without" => Without: "The dry contacts lose the cubic law.",
    }
    "the contact before the sensor bead when those after it are wet"
    contact_6: Contact6Reading {
        "dry" => Dry: "Dry, as the file says.",
        "wet" => Wet: "Wet: the wet section begins one contact earlier.",
    }
    "whether all contacts are wet"
    wet_everywhere: WetEverywhereReading {
        "no" => No: "Only those that the file says.",
        "yes" => Yes: "All, from the striker to the wall.",
    }
    "when the cubic law acts"
    cubic_gate: CubicGateReading {
        "closed" => Closed: "While the contact is closed.",
        "always" => Always: "Always, also across gaps.",
    }
    "whether a closed contact may pull"
    tension: TensionReading {
        "allowed" => Allowed: "As the file says; allowed unless it says otherwise.",
        "clipped" => Clipped: "The force is cut at 0.",
    }
    "whether the striker is one of the counted beads"
    striker: StrikerReading {
        "beside" => Beside: "The striker comes beside the beads.",
        "within" => Within: "The striker is one of them: the chain has one bead less.",
    }
    "from where the sensor bead is counted"
    sensor_counted_from: SensorReading {
        "bead-1" => BeadOne: "From the first bead of the chain.",
        "striker" => Striker: "From the striker: sensor and wet contacts begin one earlier.",
    }
    "whether the half-bead is one of the counted beads"
    half_bead: HalfBeadReading {
        "beside" => Beside: "The half-bead comes beside the beads.",
        "within" => Within: "The half-bead is one of them: the chain has one bead less.",
    }
    "what holds the half-bead"
    stop: StopReading {
        "rigid" => Rigid: "As the file says.",
        "4.5 kg" => Heavy: "A stop of 4.5 kg, free to move.",
    }
    "shape of the wall contact"
    wall_shape: WallShapeReading {
        "sphere" => Sphere: "Sphere on half-bead, as the file says.",
        "plane" => Plane: "Sphere on plane.",
    }
    "the wall contact when others are wet"
    wall_liquid: WallLiquidReading {
        "wet" => Wet: "As the file says.",
        "dry" => Dry: "Dry: the laws of the dry contacts.",
    }
    "Poisson ratios above 1/2"
    poisson: PoissonReading {
        "as-printed" => AsPrinted: "Taken as they are.",
        "bounded" => Bounded: "Bounded at 1/2.",
    }
    "bulk viscosity of all materials"
    bulk_viscosity: BulkViscosityReading {
        "equal" => Equal: "As the file says: equal to the shear viscosity unless given.",
        "zero" => Zero: "Zero.",
    }
    "where a pulse is timed"
    pick: Pick {
        "peak" => Peak: "At its largest maximum.",
        "flank-10" => Flank10: "Where it passes 10 % of the peak on the rising flank.",
        "flank-50" => Flank50: "Where it passes 50 % of the peak on the rising flank.",
        "cross-correlation" => CrossCorrelation: "By the lag of the largest cross-correlation.",
    }
}

/// Force of the spring assembly that the paper gives, in N.
pub const PRELOAD_N: f64 = 0.24;

/// Stiffness of the preload spring in N/m. The paper prints none; this soft
/// one loses a tenth of the force over 0.24 mm.
const SPRING_STIFFNESS_N_M: f64 = 100.0;

/// Mass of the paper's end structure in kg.
const STOP_MASS_KG: f64 = 4.5;

impl Reading {
    /// Every switch with its options, the default first.
    pub const fn switches() -> &'static [Switch] {
        SWITCHES
    }

    /// The switches that are not at their default, with their options.
    pub fn changes(&self) -> Vec<(&'static str, &'static str)> {
        let option = |switch: &Switch| Some((switch.name, self.get(switch.name)?));
        let changed = |(name, option): &(&str, &str)| Self::default().get(name) != Some(option);
        SWITCHES.iter().filter_map(option).filter(changed).collect()
    }

    /// The reading of a checked file.
    pub(crate) fn read(root: &TableView<'_>) -> Self {
        let table = root.table("reading");
        let option = |switch: &Switch| Some((switch.name, table?.text(switch.name)?));
        let given = SWITCHES.iter().filter_map(option);
        given.fold(Self::default(), |reading, (name, option)| {
            reading.with(name, option).unwrap_or(reading)
        })
    }

    /// The experiment as written, in this reading.
    pub(crate) fn apply(&self, written: &Spec) -> Spec {
        let mut spec = Spec { reading: *self, ..written.clone() };
        self.apply_to_bodies(&mut spec);
        self.apply_to_ends(&mut spec);
        self.apply_to_sections(&mut spec);
        self.apply_to_laws(&mut spec);
        spec
    }

    /// Materials, and which bodies belong to the counted ones.
    fn apply_to_bodies(&self, spec: &mut Spec) {
        for material in &mut spec.materials.0 {
            if self.poisson == PoissonReading::Bounded {
                material.largest_poisson_ratio = 0.5;
            }
            material.without_bulk_viscosity = self.bulk_viscosity == BulkViscosityReading::Zero;
        }
        spec.beads_less = usize::from(self.striker == StrikerReading::Within)
            + usize::from(self.half_bead == HalfBeadReading::Within);
        if self.sensor_counted_from == SensorReading::Striker {
            spec.sensors.bead = spec.sensors.bead.saturating_sub(1);
        }
    }

    fn apply_to_ends(&self, spec: &mut Spec) {
        let force_n = PRELOAD_N;
        let stiffness_n_m = SPRING_STIFFNESS_N_M;
        match self.preload {
            PreloadReading::None => {}
            PreloadReading::Spring => spec.push = Push::Spring { force_n, stiffness_n_m },
            PreloadReading::Constant => spec.push = Push::Constant { force_n },
        }
        match self.incline {
            InclineReading::Level => {}
            InclineReading::Half => spec.incline_rad = 0.5f64.to_radians(),
            InclineReading::One => spec.incline_rad = 1f64.to_radians(),
        }
        if self.tension == TensionReading::Clipped {
            spec.tension = Tension::Clipped;
        }
        if let Far::Wall { is_plane, stop_kg, .. } = &mut spec.far {
            *is_plane |= self.wall_shape == WallShapeReading::Plane;
            if self.stop == StopReading::Heavy {
                *stop_kg = Some(STOP_MASS_KG);
            }
        }
    }

    fn apply_to_sections(&self, spec: &mut Spec) {
        let Some(wet) = spec.sections.iter().position(|section| section.wet) else {
            return;
        };
        let dry = spec.sections.iter().find(|section| !section.wet).cloned();
        let earlier = usize::from(self.contact_6 == Contact6Reading::Wet)
            + usize::from(self.sensor_counted_from == SensorReading::Striker);
        begin_earlier(&mut spec.sections, wet, earlier);
        if self.wet_everywhere == WetEverywhereReading::Yes
            && let Some(section) = spec.sections.iter().find(|section| section.wet)
        {
            let (from, to) = (0, None);
            spec.sections = vec![SectionSpec { from, to, ..section.clone() }];
        }
        if let (WallLiquidReading::Dry, Some(dry)) = (self.wall_liquid, dry) {
            dry_wall(spec, dry);
        }
    }

    fn apply_to_laws(&self, spec: &mut Spec) {
        let some_wet = spec.sections.iter().any(|section| section.wet);
        let without = some_wet && self.dry_cubic_beside_wet == DryCubicReading::Without;
        let ungated = find("damping_cubic_ungated");
        let is_cubic = |name| name == "damping_cubic" || name == "damping_cubic_ungated";
        for section in &mut spec.sections {
            if without && !section.wet {
                section.laws.retain(|law| !is_cubic(law.name()));
            }
            let gated = section.laws.iter_mut().filter(|law| law.name() == "damping_cubic");
            if let (CubicGateReading::Always, Some(row)) = (self.cubic_gate, ungated) {
                gated.for_each(|law| law.row = row);
            }
        }
    }
}

/// Moves the beginning of a section toward the striker.
fn begin_earlier(sections: &mut Vec<SectionSpec>, at: usize, by: usize) {
    let begin = sections[at].from.saturating_sub(by);
    sections[at].from = begin;
    for section in &mut sections[..at] {
        section.to = section.to.map(|to| to.min(begin.saturating_sub(1)));
    }
    let mut index = 0;
    sections.retain(|section| {
        index += 1;
        index > at || section.from < begin
    });
}

/// The wall contact gets the laws of a dry section.
fn dry_wall(spec: &mut Spec, dry: SectionSpec) {
    let contact = spec.bead_count();
    let Some(last) = spec.sections.last_mut().filter(|last| last.wet) else {
        return;
    };
    if last.from >= contact {
        spec.sections.pop();
    } else {
        last.to = Some(contact - 1);
    }
    spec.sections.push(SectionSpec { from: contact, to: None, ..dry });
}

impl std::fmt::Display for Reading {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let changes = self.changes().into_iter();
        let texts: Vec<String> =
            changes.map(|(name, option)| format!("{name} = {option}")).collect();
        f.write_str(if texts.is_empty() { "default reading" } else { "" })?;
        f.write_str(&texts.join(", "))
    }
}

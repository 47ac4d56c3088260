//! Readings: what the paper leaves open, one named switch each.
//!
//! The first option of a switch is its default and changes nothing in the
//! file; every other option changes what it says and nothing else.

use crate::keys::{Key, Kind, Need};
use crate::nearest;

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

/// A switch or an option that does not exist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no {what}; expected one of: {expected}{hint}")]
pub struct SwitchError {
    what: String,
    expected: String,
    hint: String,
}

impl SwitchError {
    fn new(what: String, given: &str, known: &[&str]) -> Self {
        let near = nearest::of(given, known.iter().copied());
        Self {
            what,
            expected: known.join(", "),
            hint: near.map_or(String::new(), |word| format!("; did you mean `{word}`?")),
        }
    }
}

/// Declares all switches: the enums, the struct, the keys and their names.
macro_rules! switches {
    ($(
        $about:literal
        $field:ident: $Type:ident {
            $first_text:literal => $First:ident: $first_doc:literal,
            $($text:literal => $Option:ident: $doc:literal,)+
        }
    )+) => {
        $(
            #[doc = concat!("Switch: ", $about, ".")]
            #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
            pub enum $Type {
                #[doc = $first_doc]
                #[default]
                $First,
                $(#[doc = $doc] $Option,)+
            }

            impl $Type {
                fn text(self) -> &'static str {
                    match self {
                        Self::$First => $first_text,
                        $(Self::$Option => $text,)+
                    }
                }

                fn from_text(text: &str) -> Option<Self> {
                    match text {
                        $first_text => Some(Self::$First),
                        $($text => Some(Self::$Option),)+
                        _ => None,
                    }
                }
            }
        )+

        /// One choice of every switch.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub struct Reading {
            $(#[doc = concat!("Decides: ", $about, ".")] pub $field: $Type,)+
        }

        const SWITCHES: &[Switch] = &[$(Switch {
            name: stringify!($field),
            about: $about,
            options: &[$first_text, $($text,)+],
        },)+];

        /// The keys of `[reading]`.
        pub(crate) static KEYS: &[Key] = &[$(Key {
            name: stringify!($field),
            kind: Kind::Choice(&[$first_text, $($text,)+]),
            need: Need::Never,
            about: $about,
        },)+];

        impl Reading {
            /// The option of a switch, as written in a file.
            pub fn get(&self, switch: &str) -> Option<&'static str> {
                match switch {
                    $(stringify!($field) => Some(self.$field.text()),)+
                    _ => None,
                }
            }

            /// This reading with one switch set.
            ///
            /// # Errors
            /// An unknown switch or option, with those that exist.
            pub fn with(mut self, switch: &str, option: &str) -> Result<Self, SwitchError> {
                match switch {
                    $(stringify!($field) => {
                        let options = [$first_text, $($text,)+];
                        let what = || format!("option `{option}` of the switch `{switch}`");
                        self.$field = $Type::from_text(option)
                            .ok_or_else(|| SwitchError::new(what(), option, &options))?;
                    })+
                    _ => {
                        let names = SWITCHES.iter().map(|s| s.name).collect::<Vec<_>>();
                        let what = format!("switch `{switch}`");
                        return Err(SwitchError::new(what, switch, &names));
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
        "spring" => Spring: "A spring of 0.24 N and [`SPRING_STIFFNESS_N_M`] that never pulls.",
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
pub const SPRING_STIFFNESS_N_M: f64 = 100.0;

/// Mass of the paper's end structure in kg.
pub const STOP_MASS_KG: f64 = 4.5;

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
}

impl std::fmt::Display for Reading {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let changes = self.changes();
        if changes.is_empty() {
            return f.write_str("default reading");
        }
        let texts = changes
            .iter()
            .map(|(name, option)| format!("{name} = {option}"));
        f.write_str(&texts.collect::<Vec<_>>().join(", "))
    }
}

//! What stands around the chain. No law and no shot uses it.

use crate::finding::Problem;
use crate::view::View;

/// The apparatus around a chain, as a file describes it: for drawings and
/// reports, without any effect on what is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Rig {
    /// What the beads are made of, in words.
    pub beads: Option<String>,
    /// The parts that the file names, in the order of [`RigPartKind::ALL`].
    pub parts: Vec<RigPart>,
}

/// Declares the kinds of parts with their keys in `[rig]`, from the launcher to the far end.
macro_rules! kinds {
    ($($Kind:ident $key:literal $about:literal;)+) => {
        /// What a part is for.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum RigPartKind {
            $(#[doc = $about] $Kind,)+
        }

        impl RigPartKind {
            /// Every kind, from the launcher to the far end.
            pub const ALL: [Self; [$($key),+].len()] = [$(Self::$Kind),+];

            /// Its key in `[rig]`.
            pub const fn key(self) -> &'static str {
                match self {
                    $(Self::$Kind => $key,)+
                }
            }
        }
    };
}

kinds! {
    Actuator "actuator" "Launches the striker.";
    Repositioner "repositioner" "Brings the striker back to its place.";
    Photogate "photogate" "Measures the striker's speed.";
    Springs "springs" "Hold bead 1.";
    Sensor "sensor" "Force sensors in the sensor bead and at the wall.";
    Recorder "recorder" "What the sensors are wired to.";
    Stop "stop" "What the far end is fixed to.";
    EndStructure "end_structure" "Carries the stop.";
    Bar "bar" "A separate mass against noise.";
}

/// One part of the apparatus.
#[derive(Clone, Debug, PartialEq)]
pub struct RigPart {
    /// What it is for.
    pub kind: RigPartKind,
    /// What it is called; the kind's own name unless the file has one.
    pub name: String,
    /// Mass in kg.
    pub mass_kg: Option<f64>,
    /// Length in m.
    pub length_m: Option<f64>,
    /// Force on bead 1 in N; of springs.
    pub force_n: Option<f64>,
    /// Bits of a sample; of a recorder.
    pub bits: Option<usize>,
    /// Samples a second in Hz; of a recorder.
    pub rate_hz: Option<f64>,
}

impl Rig {
    /// A part, if the file names it.
    pub fn part(&self, kind: RigPartKind) -> Option<&RigPart> {
        self.parts.iter().find(|part| part.kind == kind)
    }

    pub(super) fn read(root: &View<'_>) -> Result<Option<Self>, Problem> {
        let Some(table) = root.table("rig") else {
            return Ok(None);
        };
        let part = |kind: RigPartKind| Some(RigPart::read(kind, &table.table(kind.key())?));
        let parts = RigPartKind::ALL.into_iter().filter_map(part);
        Ok(Some(Self {
            beads: table.text("beads").map(str::to_owned),
            parts: parts.collect::<Result<_, _>>()?,
        }))
    }
}

impl RigPart {
    fn read(kind: RigPartKind, table: &View<'_>) -> Result<Self, Problem> {
        let name = table.text("name").map(str::to_owned);
        let quantity = |key| match table.fields.key(key) {
            Some(_) => table.quantity(key),
            None => Ok(None),
        };
        Ok(Self {
            kind,
            name: name.unwrap_or_else(|| kind.key().replace('_', " ")),
            mass_kg: quantity("mass")?,
            length_m: quantity("length")?,
            force_n: quantity("force")?,
            bits: match kind {
                RigPartKind::Recorder => table.count("bits")?,
                _ => None,
            },
            rate_hz: quantity("rate")?,
        })
    }
}

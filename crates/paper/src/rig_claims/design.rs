//! Which rigs are tried.

use hertzchain_experiment::Experiment;
use hertzchain_sim::rig::RigError;

/// Something that the paper does not state of its rig.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Factor {
    pub name: &'static str,
    /// Its number in the experiment file.
    pub path: &'static str,
    /// Unit in which it is shown.
    pub unit: &'static str,
    /// SI units in that unit.
    pub si: f64,
    /// What is tried, from low to high, in SI.
    pub levels: [f64; 3],
    /// Which of them the paper's preset has.
    pub usual: usize,
}

/// All of them. Friction and push are tried at a quarter and four times of what
/// the preset has, gaps at a tenth and ten times; radii spread by 0.02 %, as in a
/// good lot of balls for bearings, and by ten times that.
pub(crate) static FACTORS: [Factor; 4] = [
    Factor {
        name: "friction",
        path: "track.friction",
        unit: "",
        si: 1.0,
        levels: [0.0125, 0.05, 0.2],
        usual: 1,
    },
    Factor {
        name: "push",
        path: "near_end.force",
        unit: " N",
        si: 1.0,
        levels: [0.06, 0.24, 0.96],
        usual: 1,
    },
    Factor {
        name: "gaps as laid",
        path: "campaign.laying.gap_scatter",
        unit: " µm",
        si: 1e-6,
        levels: [0.5e-6, 5e-6, 50e-6],
        usual: 1,
    },
    Factor {
        name: "spread of radii",
        path: "campaign.laying.radius_spread",
        unit: " %",
        si: 1e-2,
        levels: [0.0, 2e-4, 2e-3],
        usual: 0,
    },
];

const PUSH: usize = 1;

/// Way in m by which the springs are pressed, whatever their force: 0.24 N at 100 N/m.
const PRESSED_M: f64 = 2.4e-3;

impl Factor {
    pub(crate) fn usual(&self) -> f64 {
        self.levels[self.usual]
    }

    /// A value in SI as it is shown: `friction 0.2`.
    pub(crate) fn text(&self, value: f64) -> String {
        format!("{} {}", self.name, self.amount(value))
    }

    fn amount(&self, value: f64) -> String {
        // Ten digits: products with units are not exact.
        let shown = (value / self.si * 1e10).round() / 1e10;
        format!("{shown}{}", self.unit)
    }
}

/// One rig: a value in SI for each of [`FACTORS`], and what is on its contacts.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TriedRig {
    pub name: String,
    pub values: [f64; 4],
    /// Number of the case of the experiment, from 0.
    pub case: usize,
}

impl TriedRig {
    pub(crate) fn usual() -> Self {
        Self {
            name: "as the preset".to_owned(),
            values: FACTORS.map(|factor| factor.usual()),
            case: 0,
        }
    }

    /// As the paper's preset, with another of its cases.
    pub(crate) fn with_case(case: usize, name: &str) -> Self {
        Self { name: format!("as the preset, {name}"), case, ..Self::usual() }
    }

    /// As the preset but for one factor, by its place.
    pub(crate) fn but(factor: usize, value: f64) -> Self {
        let mut rig = Self::usual();
        if let (Some(factor), Some(at)) = (FACTORS.get(factor), rig.values.get_mut(factor)) {
            *at = value;
            rig.name = factor.text(value);
        }
        rig
    }

    /// Every factor at its lowest or highest level; the name has them in this order.
    pub(crate) fn corner(high: [bool; 4]) -> Self {
        let value = |at: usize| FACTORS[at].levels[if high[at] { 2 } else { 0 }];
        let values = [0, 1, 2, 3].map(value);
        let names = FACTORS.iter().zip(values);
        let names: Vec<String> = names.map(|(factor, value)| factor.amount(value)).collect();
        Self { name: names.join(", "), values, case: 0 }
    }
}

/// Rigs, and what each of them does.
#[derive(Clone, Debug)]
pub struct RigDesign {
    /// What all rigs have in common: a chain with a push and a `[campaign]`.
    pub experiment: Experiment,
    pub(crate) rigs: Vec<TriedRig>,
    /// How many of the file's speeds, in equal ratios.
    pub speeds: usize,
    /// Shots of a series that count.
    pub shots: usize,
    /// Shots before them: without taps they show the laying.
    pub first: usize,
}

impl RigDesign {
    /// Rigs about that of an experiment, the preset `paper`: itself, one factor at
    /// a time, no push at all, and eight corners (those with an even number of high
    /// levels, so that no effect of one factor is mixed with that of two); all with the
    /// first case, which is dry, and itself with each of the others.
    pub fn about(experiment: Experiment) -> Self {
        let mut rigs = vec![TriedRig::usual()];
        for (at, factor) in FACTORS.iter().enumerate() {
            let other = factor.levels.iter().filter(|level| **level != factor.usual());
            rigs.extend(other.map(|level| TriedRig::but(at, *level)));
        }
        rigs.push(TriedRig::but(PUSH, 0.0));
        let corners = (0..16u32).filter(|bits| bits.count_ones() % 2 == 0);
        rigs.extend(
            corners.map(|bits| TriedRig::corner([0, 1, 2, 3].map(|at| bits >> at & 1 == 1))),
        );
        let cases = experiment.cases().into_iter().enumerate().skip(1);
        rigs.extend(cases.map(|(case, name)| TriedRig::with_case(case, name)));
        Self { experiment, rigs, speeds: 20, shots: 8, first: 2 }
    }

    /// The experiment of a rig with so many taps, exact speeds and shortest records.
    pub(super) fn experiment(&self, rig: &TriedRig, taps: usize) -> Result<Experiment, RigError> {
        let factors = FACTORS.iter().map(|factor| factor.path).zip(rig.values);
        let rest = [
            ("near_end.stiffness", rig.values[PUSH] / PRESSED_M),
            ("campaign.speed_count", self.speeds as f64),
            ("campaign.shots", (self.first + self.shots) as f64),
            ("campaign.taps", taps as f64),
            ("campaign.actuator.spread", 0.0),
            ("campaign.recorder.record", SHORTEST_S),
            ("campaign.recorder.before", 0.0),
        ];
        let all: Vec<(&str, f64)> = factors.chain(rest).collect();
        Ok(self.experiment.set(&all)?)
    }

    pub(super) fn taps(&self) -> usize {
        self.experiment.campaign().taps
    }
}

/// Length of records that is not read, in s.
const SHORTEST_S: f64 = 1e-4;

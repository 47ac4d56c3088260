//! From a name to a place in the experiment.

use super::Settings;
use crate::InferError;
use hertzchain_experiment::{Experiment, NamedNumber};

/// Short names: what each stands for, and the end of its path.
const SHORT_NAMES: [(&str, &str, &str); 17] = [
    ("Y", "Young modulus", "young_modulus"),
    ("nu", "Poisson ratio", "poisson_ratio"),
    ("eta", "viscosity", "shear_viscosity"),
    ("eta1", "shear viscosity", "shear_viscosity"),
    ("eta2", "bulk viscosity", "bulk_viscosity"),
    ("K", "Hertz stiffness", "elastic_hertz.stiffness"),
    ("A", "relaxation time", "damping_viscoelastic.relaxation_time"),
    ("B", "cubic damping", "damping_cubic.coefficient"),
    (
        "preload",
        "push on bead 1; give it one by a table [near_end] with `push` and `force`",
        "near_end.force",
    ),
    (WALL_GAIN, "sensitivity of the wall's sensor over that of the bead's", ""),
    (SENSOR_GAIN, "sensitivity of the bead's sensor with its amplifier", ""),
    ("low_pass", "corner of the amplifier's low-pass", LOW_PASS),
    (DELAYS[0].0, "common delay of incident times", ""),
    (DELAYS[1].0, "common delay of reflected times", ""),
    (
        DELAYS[2].0,
        "delay of the wall's channel behind the bead's, added to incident times and taken from reflected",
        "",
    ),
    (SPEED_SCALE, "true speeds over those of the table", ""),
    (RADIUS_ERROR, "common error of all radii", ""),
];

/// The corner of the amplifier's low-pass.
pub(super) const LOW_PASS: &str = "campaign.amplifier.low_pass";

/// Numbers of the instruments, not of the chain.
const WALL_GAIN: &str = "wall_gain";
const SENSOR_GAIN: &str = "sensor_gain";
const SPEED_SCALE: &str = "speed_scale";
const RADIUS_ERROR: &str = "radius_error";

/// Delays, and what a delay of 1 s adds to incident and reflected times.
const DELAYS: [(&str, [f64; 2]); 3] =
    [("delay", [1.0, 0.0]), ("reflected_delay", [0.0, 1.0]), ("skew", [1.0, -1.0])];

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Target {
    /// A number of the file.
    Number(String),
    /// A number that the file gives as a power law of speed.
    Scaled { prefactor: String, exponent: String },
    /// Sensitivity of the wall's sensor over that of the bead's.
    WallGain,
    /// Sensitivity of the bead's sensor with its amplifier in V/N.
    SensorGain,
    /// Added to incident and reflected times, times these.
    Delay([f64; 2]),
    /// True speeds over those of the table.
    SpeedScale,
    /// Added to all radii: their paths, and radii in m.
    Radii(Vec<(String, f64)>),
}

impl Target {
    /// The path of the number, or of the law whose prefactor it is.
    pub(super) fn path(&self) -> Option<&str> {
        match self {
            Self::Number(path) => Some(path),
            Self::Scaled { prefactor, .. } => prefactor.strip_suffix(".prefactor"),
            _ => None,
        }
    }

    /// Puts a value in its place.
    pub(super) fn set(&self, value: f64, settings: &mut Settings) {
        match self {
            Self::Number(path) => settings.numbers.push((path.clone(), value)),
            Self::Scaled { prefactor, exponent } => {
                settings.numbers.push((prefactor.clone(), value));
                settings.numbers.push((exponent.clone(), 0.0));
            }
            Self::WallGain => settings.wall_gain = value,
            Self::SensorGain => settings.sensor_gain_v_n = Some(value),
            Self::SpeedScale => settings.speed_scale = value,
            Self::Delay(shares) => {
                let pairs = settings.delays_s.iter_mut().zip(shares);
                pairs.for_each(|(sum, share)| *sum += share * value);
            }
            Self::Radii(all) => {
                let moved = |(path, radius_m): &(String, f64)| (path.clone(), radius_m + value);
                settings.numbers.extend(all.iter().map(moved));
            }
        }
    }
}

pub(super) struct Found {
    pub(super) target: Target,
    pub(super) unit: String,
    /// Value, or prefactor and exponent, where the file gives them.
    pub(super) given: Option<(f64, f64)>,
}

/// The number of a short name, a path or an end of one.
pub(super) fn find(experiment: &Experiment, name: &str) -> Result<Found, InferError> {
    if let Some((target, unit, usual)) = of_rig(experiment, name) {
        return Ok(Found { target, unit: unit.to_owned(), given: Some((usual, 0.0)) });
    }
    let (owner, last) = match name.rsplit_once('.') {
        None => (None, name),
        Some((owner, last)) => (Some(owner), last),
    };
    let short = SHORT_NAMES.iter().find(|(short, _, _)| *short == last);
    match short {
        Some((short, what, end)) => of_short(experiment, name, owner, (short, what, end)),
        None => {
            let place =
                experiment.place(name).map_err(|error| InferError::from(error).about(name))?;
            of_place(name, place)
        }
    }
}

/// Friction between beads and track.
const FRICTION: &str = "track.friction";

fn of_place(name: &str, place: NamedNumber) -> Result<Found, InferError> {
    if place.path == FRICTION {
        return InferError::input(format!(
            "{name} can't be fitted: the wave knows no friction, which acts between shots alone and decides how beads come \
             to lie. No data that a fit takes can determine it; what it leaves behind are loads (preload, near_end.force, or \
             --own of `gauge`)"
        ));
    }
    match place.is_count {
        true => InferError::input(format!("{name} counts something and can't vary continuously")),
        false => Ok(Found {
            given: place.value.map(|value| (value, 0.0)),
            unit: plain(place.unit),
            target: Target::Number(place.path),
        }),
    }
}

/// A number of the rig that no path leads to, with its unit and usual value.
fn of_rig(experiment: &Experiment, name: &str) -> Option<(Target, &'static str, f64)> {
    let delay = DELAYS.iter().find(|(delay, _)| *delay == name);
    Some(match name {
        WALL_GAIN => (Target::WallGain, "", 1.0),
        SENSOR_GAIN => {
            let amplifier = &experiment.campaign().amplifier;
            (Target::SensorGain, "V/N", amplifier.sensitivity_c_n * amplifier.gain_v_c)
        }
        SPEED_SCALE => (Target::SpeedScale, "", 1.0),
        RADIUS_ERROR => {
            let radii = experiment.places().into_iter().filter(|p| p.path.ends_with(".radius"));
            (Target::Radii(radii.filter_map(|p| Some((p.path, p.value?))).collect()), "m", 0.0)
        }
        _ => (Target::Delay(delay?.1), "s", 0.0),
    })
}

/// No unit is no text here, not "1".
fn plain(unit: String) -> String {
    if unit == "1" { String::new() } else { unit }
}

/// The number that a short name means, of an owner or of the only one.
fn of_short(
    experiment: &Experiment,
    name: &str,
    owner: Option<&str>,
    (short, what, end): (&str, &str, &str),
) -> Result<Found, InferError> {
    let places = experiment.places();
    let ends = [format!(".{end}"), format!(".{end}.prefactor")];
    let own = |place: &&NamedNumber| {
        let path = place.path.as_str();
        let contact = path.starts_with("contacts[") || path.starts_with("materials.");
        path == end || contact && ends.iter().any(|end| path.ends_with(end.as_str()))
    };
    let owners = owner.map(|owner| owner_paths(experiment, owner));
    let used = experiment.used_materials();
    let of_owner = |place: &&NamedNumber| match &owners {
        // Of the chain: materials of other cases are not meant.
        None => {
            let path = place.path.strip_prefix("materials.");
            path.is_none_or(|path| used.iter().any(|name| path.starts_with(&format!("{name}."))))
        }
        Some(owners) => owners.iter().any(|owner| place.path.starts_with(owner)),
    };
    let fitting: Vec<&NamedNumber> = places.iter().filter(own).filter(of_owner).collect();
    let given = fitting.iter().filter(|place| place.value.is_some());
    let given: Vec<&NamedNumber> = given.copied().collect();
    let place = match (&given[..], &fitting[..]) {
        ([only], _) | ([], [only]) => *only,
        ([], []) => {
            return InferError::input(format!("{name}: this experiment has no {what}"));
        }
        ([], several) | (several, _) => {
            let clear = |place: &&NamedNumber| clear_name(&place.path, short);
            return Err(InferError::Ambiguous {
                name: name.to_owned(),
                candidates: several.iter().map(clear).collect(),
            });
        }
    };
    match place.path.strip_suffix(".prefactor") {
        None => of_place(name, place.clone()),
        Some(stem) => {
            let exponent = format!("{stem}.exponent");
            let own = places.iter().find(|other| other.path == exponent);
            let own = own.and_then(|place| place.value).unwrap_or(0.0);
            Ok(Found {
                target: Target::Scaled { prefactor: place.path.clone(), exponent },
                unit: plain(place.unit.clone()),
                given: place.value.map(|value| (value, own)),
            })
        }
    }
}

/// Beginnings of the paths of an owner: a material, a section by its index, or
/// the wet or dry section with its effective material.
fn owner_paths(experiment: &Experiment, owner: &str) -> Vec<String> {
    let wet = match owner {
        "wet" => true,
        "dry" => false,
        _ if owner.starts_with("contacts[") || owner.starts_with("materials.") => {
            return vec![format!("{owner}.")];
        }
        _ => return vec![format!("materials.{owner}.")],
    };
    let sections = experiment.sections().iter().enumerate();
    let sections = sections.filter(|(_, section)| section.wet == wet);
    let paths = sections.flat_map(|(at, section)| {
        let material = experiment.effective_material(section);
        let material = material.map(|name| format!("materials.{name}."));
        std::iter::once(format!("contacts[{at}].")).chain(material)
    });
    paths.collect()
}

/// A short name that leads to this path alone.
fn clear_name(path: &str, short: &str) -> String {
    let owner = path.split('.').next().unwrap_or_default();
    match owner {
        "materials" => format!("{}.{short}", path.split('.').nth(1).unwrap_or_default()),
        _ => format!("{owner}.{short}"),
    }
}

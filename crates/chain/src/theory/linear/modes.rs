//! Normal modes of a finite chain with any masses and contact stiffnesses.

use crate::chain::ChainError;
use crate::theory::{not_converged, out_of_range, require_positive};

/// These take some twenty seconds, and the work grows with the cube.
const MOST_BEADS: usize = 1000;
const MOST_SWEEPS: usize = 60;

/// What holds the ends of the chain. A fixed end has a contact to a stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// Both ends free: beads − 1 contacts; one mode is a shift.
    FreeFree,
    /// First end free, last fixed: as many contacts as beads, the last to the stop.
    FreeFixed,
    /// First end fixed, last free: as many contacts as beads, the first to the stop.
    FixedFree,
    /// Both ends fixed: beads + 1 contacts.
    FixedFixed,
    /// A ring: as many contacts as beads, the last between last and first bead.
    Periodic,
}

/// One normal mode.
#[derive(Debug, Clone, PartialEq)]
pub struct Mode {
    /// Angular frequency, rad/s; divide by 2π for hertz.
    pub angular_frequency_rad_s: f64,
    /// Displacement of each bead, normalised to Σ m u² = 1 kg m², first
    /// noticeable entry positive.
    pub shape: Vec<f64>,
}

/// Normal modes of m ü = −(∂/∂u) Σ κ_c (u_left − u_right)²/2, lowest frequency first.
///
/// The frequencies are the singular values of the matrix with one row a contact,
/// √κ_c (y_left/√m_left − y_right/√m_right), and are found without squaring it:
/// columns are turned against each other until all are orthogonal (one-sided
/// Jacobi). So even the slowest modes come to rounding, a free shift to about
/// 1e-16 of the cutoff, and rings need no special care. Equal frequencies
/// (rings) come with some orthogonal pair of shapes.
///
/// # Errors
/// [`ChainError::Layout`] if the lists do not fit, [`ChainError::Value`]
/// for 0 or more than 1000 beads and for anything not positive and finite.
pub fn normal_modes(
    masses_kg: &[f64],
    contact_stiffnesses_n_m: &[f64],
    ends: Ends,
) -> Result<Vec<Mode>, ChainError> {
    check(masses_kg, contact_stiffnesses_n_m, ends)?;
    let mut columns = strain_columns(masses_kg, contact_stiffnesses_n_m, ends);
    orthogonalise(&mut columns)?;
    let mut modes: Vec<Mode> = columns.iter().map(|column| mode(column, masses_kg)).collect();
    modes.sort_by(|a, b| a.angular_frequency_rad_s.total_cmp(&b.angular_frequency_rad_s));
    Ok(modes)
}

fn check(masses_kg: &[f64], stiffnesses: &[f64], ends: Ends) -> Result<(), ChainError> {
    let beads = masses_kg.len();
    if !(1..=MOST_BEADS).contains(&beads) {
        let what = "number of beads for normal modes";
        return Err(out_of_range(what, beads as f64, "between 1 and 1000"));
    }
    let expected = match ends {
        Ends::FreeFree => beads - 1,
        Ends::FreeFixed | Ends::FixedFree | Ends::Periodic => beads,
        Ends::FixedFixed => beads + 1,
    };
    let given = stiffnesses.len();
    if given != expected {
        return Err(ChainError::Layout(format!(
            "{given} contact stiffnesses given, the beads and ends need {expected}"
        )));
    }
    masses_kg.iter().try_for_each(|m| require_positive("bead mass", *m))?;
    stiffnesses.iter().try_for_each(|k| require_positive("contact stiffness", *k))
}

/// A column of the strain matrix and the combination of beads it stands for.
struct ModeColumn {
    strain: Vec<f64>,
    weight: Vec<f64>,
}

fn strain_columns(masses_kg: &[f64], stiffnesses: &[f64], ends: Ends) -> Vec<ModeColumn> {
    let beads = masses_kg.len();
    // Contact on the near side of bead 0; the far contact is the next one.
    let first_is_stop = matches!(ends, Ends::FixedFree | Ends::FixedFixed);
    let near = |bead: usize| match (bead, first_is_stop) {
        (_, true) => Some(bead),
        (0, false) if ends == Ends::Periodic => Some(beads - 1),
        (0, false) => None,
        (_, false) => Some(bead - 1),
    };
    let far = |bead: usize| if first_is_stop { bead + 1 } else { bead };
    let column = |(bead, mass): (usize, &f64)| {
        let mut strain = vec![0.0; stiffnesses.len()];
        let mut add = |contact: usize, sign: f64| {
            if let (Some(entry), Some(k)) = (strain.get_mut(contact), stiffnesses.get(contact)) {
                *entry += sign * (k / mass).sqrt();
            }
        };
        add(far(bead), 1.0);
        if let Some(contact) = near(bead) {
            add(contact, -1.0);
        }
        let weight = (0..beads).map(|other| f64::from(u8::from(other == bead))).collect();
        ModeColumn { strain, weight }
    };
    masses_kg.iter().enumerate().map(column).collect()
}

fn orthogonalise(columns: &mut [ModeColumn]) -> Result<(), ChainError> {
    let mut largest = f64::INFINITY;
    for _ in 0..MOST_SWEEPS {
        largest = sweep(columns);
        if largest == 0.0 {
            return Ok(());
        }
    }
    Err(not_converged("normal modes", largest))
}

/// Turns every pair of columns once; gives the largest cosine that was worth a turn.
fn sweep(columns: &mut [ModeColumn]) -> f64 {
    let floor = rounding_floor(columns);
    let mut largest: f64 = 0.0;
    for second in 1..columns.len() {
        let (head, tail) = columns.split_at_mut(second);
        let Some(b) = tail.first_mut() else { break };
        for a in head {
            largest = largest.max(turn(a, b, floor));
        }
    }
    largest
}

/// Squared length below which a column is a rounded zero (a free shift).
fn rounding_floor(columns: &[ModeColumn]) -> f64 {
    let longest = columns.iter().map(|c| dot(&c.strain, &c.strain)).fold(0.0, f64::max);
    longest * (f64::EPSILON * columns.len() as f64).powi(2)
}

/// Rotates two columns until they are orthogonal; gives |cos| of their angle
/// before, or 0 if that was rounding.
fn turn(a: &mut ModeColumn, b: &mut ModeColumn, floor: f64) -> f64 {
    let (aa, bb) = (dot(&a.strain, &a.strain), dot(&b.strain, &b.strain));
    let ab = dot(&a.strain, &b.strain);
    let cosine = ab.abs() / (aa * bb).sqrt();
    let rounding = 4.0 * f64::EPSILON * (a.strain.len() as f64).sqrt();
    if aa.min(bb) <= floor || cosine.is_nan() || cosine <= rounding {
        return 0.0;
    }
    let zeta = (bb - aa) / (2.0 * ab);
    let tangent = zeta.signum() / (zeta.abs() + zeta.hypot(1.0));
    let c = 1.0 / tangent.hypot(1.0);
    rotate(&mut a.strain, &mut b.strain, c, c * tangent);
    rotate(&mut a.weight, &mut b.weight, c, c * tangent);
    cosine
}

fn rotate(a: &mut [f64], b: &mut [f64], cosine: f64, sine: f64) {
    for (x, y) in a.iter_mut().zip(b) {
        let old = *x;
        *x = cosine * old - sine * *y;
        *y = sine * old + cosine * *y;
    }
}

/// Eight partial sums, so that the loop need not wait for each addition.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    const LANES: usize = 8;
    let (a_blocks, b_blocks) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest = a_blocks.remainder().iter().zip(b_blocks.remainder());
    let mut sums = [0.0; LANES];
    for (x, y) in a_blocks.zip(b_blocks) {
        for (sum, (x, y)) in sums.iter_mut().zip(x.iter().zip(y)) {
            *sum += x * y;
        }
    }
    sums.iter().sum::<f64>() + rest.map(|(x, y)| x * y).sum::<f64>()
}

fn mode(column: &ModeColumn, masses_kg: &[f64]) -> Mode {
    let entries = || column.weight.iter().zip(masses_kg);
    let first = column.weight.iter().find(|y| y.abs() > 1e-8);
    let sign = first.map_or(1.0, |y| y.signum());
    Mode {
        angular_frequency_rad_s: dot(&column.strain, &column.strain).sqrt(),
        shape: entries().map(|(y, m)| sign * y / m.sqrt()).collect(),
    }
}

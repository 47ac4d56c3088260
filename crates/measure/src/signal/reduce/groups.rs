//! Which shots belong to one speed.

/// Sorts shots into groups of one speed: a new one begins wherever the next
/// higher speed is more than `gap` away.
///
/// A row of speeds each near its neighbour is one group, however long: group by
/// the speeds that were asked for if measured ones run into each other.
/// Groups come in order of speed, and hold shots' numbers in order of speed,
/// then of number. Speeds that are not finite belong to none.
#[must_use]
pub fn groups(speeds: &[f64], gap: f64) -> Vec<Vec<usize>> {
    let finite = |shot: &usize| speeds[*shot].is_finite();
    let mut order: Vec<usize> = (0..speeds.len()).filter(finite).collect();
    order.sort_by(|a, b| speeds[*a].total_cmp(&speeds[*b]));
    let same = |a: &usize, b: &usize| speeds[*b] - speeds[*a] <= gap;
    order.chunk_by(same).map(<[usize]>::to_vec).collect()
}

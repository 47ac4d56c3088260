//! Where labels with upright leaders go so that nothing crosses.
//!
//! A label may lie centred on its leader or on either side of it. If its text
//! reaches over another leader, it must lie beyond that leader's label. Of all
//! choices that allow this, the lowest stack is taken.

/// Free paper between texts, across and along.
const GAP: f64 = 5.0;
const AIR: f64 = 1.2;
/// How far a text beside its leader reaches back over it.
const BACK: f64 = 1.0;
/// Free paper between a text and another leader.
const CLEAR: f64 = 1.4;
/// More labels than this are not searched but piled up.
const MOST: usize = 8;

/// One label's place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    /// Left end of the text.
    pub(super) left: f64,
    /// Distance from the row to the near edge of the text.
    pub(super) offset: f64,
}

/// Places of all labels of one side.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Stack {
    pub(super) places: Vec<Place>,
    /// From the row to the far edge of the outermost text.
    pub(super) height: f64,
}

/// A label: x of its leader, width and height of its text.
type Size = (f64, f64, f64);

/// The lowest stack on a page of the given width.
pub(super) fn stacked(labels: &[Size], page: f64) -> Stack {
    let options: Vec<Vec<f64>> = labels.iter().map(|l| options(l, page)).collect();
    let searched = options.len() <= MOST;
    let choices = if searched {
        choices(&options)
    } else {
        Vec::new()
    };
    let stacks = choices.iter().filter_map(|lefts| stack(labels, lefts));
    let best = stacks.min_by(|a, b| cost(a, labels).total_cmp(&cost(b, labels)));
    best.unwrap_or_else(|| pile(labels, page))
}

/// Left ends that a label may have: centred, to the right, to the left.
fn options((x, width, _): &Size, page: f64) -> Vec<f64> {
    let last = (page - width).max(0.0);
    let centred = (x - 0.5 * width).clamp(0.0, last);
    let beside = [x - BACK, x + BACK - width];
    let fitting = beside
        .into_iter()
        .filter(|left| (0.0..=last).contains(left));
    std::iter::once(centred).chain(fitting).collect()
}

/// Every way to choose one option each.
fn choices(options: &[Vec<f64>]) -> Vec<Vec<f64>> {
    options.iter().fold(vec![Vec::new()], |before, own| {
        let extended = before.iter().flat_map(|chosen| {
            own.iter().map(move |left| {
                let mut more = chosen.clone();
                more.push(*left);
                more
            })
        });
        extended.collect()
    })
}

/// Low stacks first, then short leaders, then centred texts.
fn cost(stack: &Stack, labels: &[Size]) -> f64 {
    let offsets: f64 = stack.places.iter().map(|place| place.offset).sum();
    let aside = stack.places.iter().zip(labels);
    let aside: f64 = aside
        .map(|(place, (x, width, _))| (place.left + 0.5 * width - x).abs())
        .sum();
    10.0 * stack.height + offsets + 0.05 * aside
}

/// The labels at these left ends as near to the row as nothing crosses; `None`
/// if two of them reach over each other's leaders.
fn stack(labels: &[Size], lefts: &[f64]) -> Option<Stack> {
    let span = |i: usize, air: f64| (lefts[i] - air, lefts[i] + labels[i].1 + air);
    let mut offsets: Vec<Option<f64>> = vec![None; labels.len()];
    for _ in labels {
        let free = |i: &usize| {
            let (from, to) = span(*i, CLEAR);
            let under = |j: &usize| j != i && (from..=to).contains(&labels[*j].0);
            (0..labels.len())
                .filter(under)
                .all(|j| offsets[j].is_some())
        };
        let next = (0..labels.len()).filter(|i| offsets[*i].is_none());
        let i = next.into_iter().find(free)?;
        let (from, to) = span(i, GAP);
        let meets = |j: &usize| lefts[*j] < to && lefts[*j] + labels[*j].1 > from;
        let ends = (0..labels.len()).filter(meets);
        let ends = ends.filter_map(|j| Some(offsets[j]? + labels[j].2 + AIR));
        offsets[i] = Some(ends.fold(0.0, f64::max));
    }
    let offsets = offsets.into_iter().map(|offset| offset.unwrap_or(0.0));
    Some(of(labels, lefts, offsets.collect()))
}

/// One label beyond the other: nothing touches, but leaders may cross texts.
fn pile(labels: &[Size], page: f64) -> Stack {
    let lefts = labels.iter().map(|(x, width, _)| {
        let last = (page - width).max(0.0);
        (x - 0.5 * width).clamp(0.0, last)
    });
    let mut end = 0.0;
    let offsets = labels.iter().map(|(_, _, height)| {
        let offset = end;
        end += height + AIR;
        offset
    });
    of(labels, &lefts.collect::<Vec<_>>(), offsets.collect())
}

fn of(labels: &[Size], lefts: &[f64], offsets: Vec<f64>) -> Stack {
    let ends = labels.iter().zip(&offsets).map(|(l, offset)| offset + l.2);
    Stack {
        height: ends.fold(0.0, f64::max),
        places: lefts
            .iter()
            .zip(&offsets)
            .map(|(left, offset)| Place {
                left: *left,
                offset: *offset,
            })
            .collect(),
    }
}

#[cfg(test)]
#[path = "tests/stack.rs"]
mod tests;

//! Axes shared between the charts of a column or row.

use super::Panel;
use crate::chart::{Chart, Style, x_scale, y_scale};

/// Gives the charts of each column one x range and labels the lowest only.
pub(crate) fn x_axes(panels: &mut [Panel], columns: usize) {
    for column in 0..columns {
        let members: Vec<usize> = (column..panels.len()).step_by(columns).collect();
        let range = union(panels, &members, |c| {
            let scale = x_scale(c, &Style::JOURNAL);
            (scale.lo, scale.hi)
        });
        let last = members.last().copied();
        each(panels, &members, |i, chart| {
            chart.x.range = range;
            chart.x.unlabelled = Some(i) != last;
        });
    }
}

/// Gives the charts of each row one y range and labels the leftmost only.
pub(crate) fn y_axes(panels: &mut [Panel], columns: usize) {
    for first in (0..panels.len()).step_by(columns) {
        let members: Vec<usize> = (first..panels.len().min(first + columns)).collect();
        let range = union(panels, &members, |c| {
            let scale = y_scale(c, &Style::JOURNAL);
            (scale.lo, scale.hi)
        });
        each(panels, &members, |i, chart| {
            chart.y.range = range;
            chart.y.unlabelled = i != first;
        });
    }
}

fn union(
    panels: &[Panel],
    members: &[usize],
    range: impl Fn(&Chart) -> (f64, f64),
) -> Option<(f64, f64)> {
    let charts = members.iter().filter_map(|i| match panels.get(*i)? {
        Panel::Chart(chart) => Some(range(chart)),
        _ => None,
    });
    charts.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

fn each(panels: &mut [Panel], members: &[usize], mut change: impl FnMut(usize, &mut Chart)) {
    for i in members {
        if let Some(Panel::Chart(chart)) = panels.get_mut(*i) {
            change(*i, chart);
        }
    }
}

//! Axes: from a data range to positions, ticks and tick labels.

mod label;
mod linear;
mod log;
mod scale;

pub(crate) use scale::{Extent, Scale};

use crate::text::TextLine;

/// A labelled tick.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tick {
    pub(crate) value: f64,
    pub(crate) label: String,
}

/// All ticks of one axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Ticks {
    pub(crate) major: Vec<Tick>,
    pub(crate) minor: Vec<f64>,
    /// Labels are to be multiplied by this power of ten.
    pub(crate) exponent: Option<i32>,
}

impl Ticks {
    /// Those at whole numbers, for an axis that counts.
    pub(crate) fn whole(mut self) -> Self {
        self.minor.clear();
        self.major.retain(|tick| tick.value.fract() == 0.0);
        for tick in &mut self.major {
            tick.label = format!("{}", tick.value);
        }
        self
    }
}

/// The room an axis offers its labels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Room {
    /// Length of the axis, points.
    pub(crate) length: f64,
    /// Font size of the labels, points.
    pub(crate) font: f64,
    /// Labels stand side by side (an x axis) or above each other (a y axis).
    pub(crate) side_by_side: bool,
}

impl Room {
    /// More labels than this crowd an axis even if they fit.
    fn most(&self) -> usize {
        let pitch = if self.side_by_side { 3.6 } else { 2.1 } * self.font;
        ((self.length / pitch) as usize).clamp(2, 8)
    }

    /// Whether no two neighbouring labels touch.
    fn fits(&self, scale: &Scale, ticks: &[Tick]) -> bool {
        let spans: Vec<(f64, f64)> = ticks.iter().filter_map(|t| self.span(scale, t)).collect();
        spans
            .windows(2)
            .all(|w| (w[1].0 - w[0].0).abs() >= 0.5 * (w[0].1 + w[1].1))
    }

    /// Position and needed length of a label along the axis.
    fn span(&self, scale: &Scale, tick: &Tick) -> Option<(f64, f64)> {
        let position = scale.share(tick.value)? * self.length;
        let line = TextLine::new(&tick.label, self.font);
        let size = if self.side_by_side {
            line.width() + 0.8 * self.font
        } else {
            1.5 * self.font
        };
        Some((position, size))
    }
}

/// The richest set of ticks whose labels have room.
pub(crate) fn ticks(scale: &Scale, room: &Room) -> Ticks {
    if scale.log {
        log::ticks(scale, room)
    } else {
        linear::ticks(scale, room)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const X_AXIS: Room = Room {
        length: 180.0,
        font: 7.0,
        side_by_side: true,
    };
    const Y_AXIS: Room = Room {
        length: 130.0,
        font: 7.0,
        side_by_side: false,
    };

    fn labels(lo: f64, hi: f64, log: bool, room: &Room) -> Vec<String> {
        let found = ticks(&Scale { lo, hi, log }, room);
        found.major.into_iter().map(|t| t.label).collect()
    }

    #[test]
    fn log_axis_over_a_partial_decade_is_labelled_one_two_five() {
        assert_eq!(labels(0.07, 1.3, true, &X_AXIS), ["0.1", "0.2", "0.5", "1"]);
    }

    #[test]
    fn log_axis_over_many_decades_is_labelled_with_powers() {
        let found = labels(1e-9, 1e3, true, &Y_AXIS);
        assert!(found.iter().all(|l| l.starts_with("$10^{")), "{found:?}");
        assert!(found.len() >= 3);
    }

    #[test]
    fn log_axis_within_a_fraction_of_a_decade_falls_back_to_even_steps() {
        let found = labels(1.1, 1.45, true, &X_AXIS);
        assert_eq!(found[..3], ["1.10", "1.15", "1.20"]);
    }

    #[test]
    fn ratio_axis_around_one_has_even_decimals() {
        let found = labels(0.96, 1.04, false, &Y_AXIS);
        assert!(found.iter().all(|l| l.len() == 4), "{found:?}");
        assert!(found.contains(&"1.00".to_owned()) && found.contains(&"0.96".to_owned()));
    }

    #[test]
    fn large_numbers_share_a_power_of_ten() {
        let found = ticks(
            &Scale {
                lo: 0.0,
                hi: 3.2e8,
                log: false,
            },
            &X_AXIS,
        );
        assert_eq!(found.exponent, Some(8));
        assert!(found.major.iter().all(|t| t.label.len() <= 3));
    }

    #[test]
    fn negative_labels_have_a_true_minus_sign() {
        assert!(labels(-1.0, 1.0, false, &X_AXIS).contains(&"−1.0".to_owned()));
    }

    proptest! {
        #[test]
        fn linear_ticks_lie_inside_the_range_and_ascend(
            lo in -1e12_f64..1e12, span in 1e-6_f64..1e12,
        ) {
            let scale = Scale { lo, hi: lo + span.max(lo.abs() * 1e-8), log: false };
            check(&scale);
        }

        #[test]
        fn log_ticks_lie_inside_the_range_and_ascend(
            exponent in -200.0_f64..200.0, decades in 1e-3_f64..60.0,
        ) {
            let lo = 10f64.powf(exponent);
            check(&Scale { lo, hi: lo * 10f64.powf(decades), log: true });
        }
    }

    fn check(scale: &Scale) {
        for room in [X_AXIS, Y_AXIS] {
            let found = ticks(scale, &room);
            let values: Vec<f64> = found.major.iter().map(|t| t.value).collect();
            assert!(
                values.windows(2).all(|w| w[1] > w[0]),
                "{scale:?} {values:?}"
            );
            assert!((2..=12).contains(&values.len()), "{scale:?} {found:?}");
            // Positions may leave the axis by the rounding of a multiple of the step.
            let on_axis = |v: &f64| {
                scale
                    .share(*v)
                    .is_some_and(|s| (-1e-6..=1.0 + 1e-6).contains(&s))
            };
            assert!(values.iter().all(on_axis), "{scale:?} {values:?}");
            assert!(found.minor.iter().all(on_axis), "{scale:?}");
        }
    }
}

//! The colour bar beside a map.

use super::HeatMap;
use crate::axis::{Room, Scale, ticks};
use crate::chart::Style;
use crate::draw::{Colour, Paint, PathData, Point, Rect, Svg};
use crate::png_image::rgb_png;
use crate::text::{Anchor, TextLine};

const GAP: f64 = 6.0;
const BAR: f64 = 8.0;
/// Width kept for the numbers, in font sizes.
const NUMBERS: f64 = 3.2;

/// Room right of the frame for bar, numbers and label.
pub(crate) fn width(map: &HeatMap, style: &Style) -> f64 {
    let label = TextLine::new(&map.label, style.label);
    let label_height = if map.label.is_empty() {
        0.0
    } else {
        label.height()
    };
    GAP + BAR + 3.0 + NUMBERS * style.small + label_height
}

/// Draws bar, ticks, numbers and label right of `frame`.
pub(crate) fn draw_bar(svg: &mut Svg, map: &HeatMap, frame: &Rect, style: &Style) {
    let bar = Rect::sized(frame.x1 + GAP, frame.y0, BAR, frame.height());
    let shades: Vec<u8> = (0..256)
        .map(|i| map.map.colour(1.0 - f64::from(i) / 255.0))
        .flat_map(|c| [c.0, c.1, c.2])
        .collect();
    if let Some(png) = rgb_png(1, 256, &shades, None) {
        svg.image(&bar, &png);
    }
    draw_ticks(svg, map, &bar, style);
    let label = TextLine::new(&map.label, style.label).fitted(frame.height());
    let x = bar.x1 + 3.0 + NUMBERS * style.small + label.ascent();
    label.draw_turned(
        svg,
        Point::new(x, bar.centre().y),
        Anchor::CENTRE,
        Colour::BLACK,
        90.0,
    );
}

fn draw_ticks(svg: &mut Svg, map: &HeatMap, bar: &Rect, style: &Style) {
    let (lo, hi) = map.range();
    let scale = Scale { lo, hi, log: false };
    let room = Room {
        length: bar.height(),
        font: style.small,
        side_by_side: false,
    };
    let found = ticks(&scale, &room);
    let mut path = PathData::new();
    path.rect(bar);
    for tick in &found.major {
        let y = bar.y1 - scale.share(tick.value).unwrap_or(0.0) * bar.height();
        path.segment(Point::new(bar.x1 - 2.5, y), Point::new(bar.x1, y));
        let line = TextLine::new(&tick.label, style.small).fitted(NUMBERS * style.small);
        line.draw(
            svg,
            Point::new(bar.x1 + 2.5, y),
            Anchor::LEFT_MIDDLE,
            Colour::BLACK,
        );
    }
    svg.path(&path, &Paint::line(Colour::BLACK, style.frame));
    if let Some(n) = found.exponent {
        let factor = TextLine::new(&format!(r"$\times10^{{{n}}}$"), style.small);
        let at = Point::new(bar.x0, bar.y0 - 0.6 * style.small);
        factor.draw(svg, at, Anchor::LEFT, Colour::BLACK);
    }
}

//! The colour bar beside a map.

use super::HeatMap;
use crate::axis::{Room, Scale, Ticks, ticks};
use crate::chart::Style;
use crate::draw::{Colour, Paint, PathData, Point, Rect, Svg};
use crate::png_image::rgb_png;
use crate::text::{Anchor, TextLine};

const GAP: f64 = 6.0;
const BAR: f64 = 8.0;

/// Room for bar, numbers and label: right of the frame, and above it.
pub(crate) fn room(map: &HeatMap, style: &Style, height: f64) -> (f64, f64) {
    let label = TextLine::new(&map.label, style.label);
    let label_height = if map.label.is_empty() {
        0.0
    } else {
        label.height() + 3.0
    };
    let (found, widest) = numbers(map, style, height);
    let above = if found.exponent.is_some() {
        1.5 * style.small
    } else {
        0.0
    };
    (GAP + BAR + 3.0 + widest + label_height, above)
}

/// The ticks of a bar of the given height, and the width of the widest number.
fn numbers(map: &HeatMap, style: &Style, height: f64) -> (Ticks, f64) {
    let (lo, hi) = map.range();
    let room = Room {
        length: height,
        font: style.small,
        side_by_side: false,
    };
    let found = ticks(&Scale { lo, hi, log: false }, &room);
    let widths = found
        .major
        .iter()
        .map(|t| TextLine::new(&t.label, style.small).width());
    let widest = widths.fold(0.0, f64::max);
    (found, widest)
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
    let widest = draw_ticks(svg, map, &bar, style);
    let label = TextLine::new(&map.label, style.label).shrunk_to(frame.height());
    let x = bar.x1 + 6.0 + widest + label.ascent();
    label.draw_turned(
        svg,
        Point::new(x, bar.centre().y),
        Anchor::CENTRE,
        Colour::BLACK,
        90.0,
    );
}

/// Returns the width of the widest number.
fn draw_ticks(svg: &mut Svg, map: &HeatMap, bar: &Rect, style: &Style) -> f64 {
    let (lo, hi) = map.range();
    let scale = Scale { lo, hi, log: false };
    let (found, widest) = numbers(map, style, bar.height());
    let mut path = PathData::new();
    path.rect(bar);
    for tick in &found.major {
        let y = bar.y1 - scale.share(tick.value).unwrap_or(0.0) * bar.height();
        path.segment(Point::new(bar.x1 - 2.5, y), Point::new(bar.x1, y));
        let line = TextLine::new(&tick.label, style.small);
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
    widest
}

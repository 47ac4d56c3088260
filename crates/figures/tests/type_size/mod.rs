//! How small the type of a picture is when it is printed as wide as it says.

use roxmltree::{Document, Node};
use skrifa::MetadataProvider;
use skrifa::instance::{LocationRef, Size};

/// Size in points of the smallest glyph of an SVG at its own width, and that
/// width in millimetres; infinite without any text.
pub(crate) fn smallest_type(svg: &str) -> (f64, f64) {
    let document = Document::parse(svg).expect("well-formed XML");
    let root = document.root_element();
    let width_mm = root.attribute("width").expect("a width");
    let width_mm: f64 = number(width_mm.trim_end_matches("mm"));
    let box_width = root.attribute("viewBox").expect("a viewBox");
    let box_width = number(box_width.split(' ').nth(2).expect("four numbers"));
    // 72 points are an inch of 25.4 mm.
    let scale = width_mm / 25.4 * 72.0 / box_width;
    let font = skrifa::FontRef::new(ttf_noto_sans::REGULAR).expect("the font");
    let metrics = font.metrics(Size::unscaled(), LocationRef::default());
    let em = f64::from(metrics.units_per_em);
    (em * smallest(root, scale), width_mm)
}

/// Smallest scale of a glyph below a node that is itself at a scale.
fn smallest(node: Node<'_, '_>, scale: f64) -> f64 {
    let own = node.attribute("transform").map_or(1.0, scale_of);
    let scale = scale * own;
    match node.tag_name().name() {
        "use" => scale,
        "defs" => f64::INFINITY,
        _ => node.children().map(|child| smallest(child, scale)).fold(f64::INFINITY, f64::min),
    }
}

/// Product of all `scale(...)` of a transform, the smaller of two directions.
fn scale_of(transform: &str) -> f64 {
    let scales = transform.split("scale(").skip(1);
    let least = scales.map(|rest| {
        let inside = rest.split(')').next().unwrap_or_default();
        let factors = inside.split_whitespace();
        factors.map(|f| number(f).abs()).fold(f64::INFINITY, f64::min)
    });
    least.product()
}

fn number(text: &str) -> f64 {
    text.trim().parse().expect("a number")
}

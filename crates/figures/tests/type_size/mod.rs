//! How small the type of a picture is when it is printed as wide as it says.

use roxmltree::Document;

/// Size in points of the smallest text of an SVG at its own width, and that
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
    let sizes = document.descendants().filter_map(|node| node.attribute("font-size"));
    (scale * sizes.map(number).fold(f64::INFINITY, f64::min), width_mm)
}

fn number(text: &str) -> f64 {
    text.trim().parse().expect("a number")
}

//! What the legends of a picture lie on, seen in the rendered picture without them.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

/// Pixels per point.
const SCALE: f32 = 2.0;

/// How many legends an SVG has and how many pixels below them are not white.
pub(super) fn covered(svg: &str) -> (usize, usize) {
    let boxes = boxes(svg);
    let bare = svg.replace("<g id=\"legend", "<g display=\"none\" id=\"legend");
    let page = rendered(&parsed(&bare));
    let under = |[left, top, right, bottom]: &[f32; 4]| {
        let pixels = |from: f32, to: f32| (from * SCALE) as u32..=(to * SCALE) as u32;
        let rows = pixels(*top, *bottom);
        let all = rows.flat_map(|y| pixels(*left, *right).map(move |x| (x, y)));
        let seen = all.filter_map(|(x, y)| page.pixel(x, y));
        seen.filter(|p| [p.red(), p.green(), p.blue()] != [255; 3]).count()
    };
    (boxes.len(), boxes.iter().map(under).sum())
}

fn parsed(svg: &str) -> Tree {
    Tree::from_str(svg, &Options::default()).expect("valid SVG")
}

fn rendered(tree: &Tree) -> Pixmap {
    let size = tree.size().to_int_size().scale_by(SCALE).expect("a size");
    let mut page = Pixmap::new(size.width(), size.height()).expect("a page");
    resvg::render(tree, Transform::from_scale(SCALE, SCALE), &mut page.as_mut());
    page
}

/// Left, top, right and bottom of every legend in pixels.
fn boxes(svg: &str) -> Vec<[f32; 4]> {
    // Pages in millimetres have viewBoxes in points; resvg takes 96 pixels for an inch.
    let unit = if svg.contains("viewBox") { 96.0 / 72.0 } else { 1.0 };
    let written = svg.split("data-box=\"").skip(1);
    let numbers = written.map(|rest| rest.split(['"', ' ']).take(4));
    numbers
        .map(|four| {
            let four: Vec<f32> = four.map(|n| unit * n.parse::<f32>().expect("a number")).collect();
            [four[0], four[1], four[2], four[3]]
        })
        .collect()
}

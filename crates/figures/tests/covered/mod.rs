//! What the legends of a picture lie on, seen in the rendered picture without them.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Group, Node, Options, Tree};

/// Pixels per point.
const SCALE: f32 = 2.0;

/// How many legends an SVG has and how many pixels below them are not white.
pub(super) fn covered(svg: &str) -> (usize, usize) {
    let mut boxes = Vec::new();
    collect(parsed(svg).root(), &mut boxes);
    let bare = svg.replace("<g id=\"legend", "<g display=\"none\" id=\"legend");
    let page = rendered(&parsed(&bare));
    let under = |[left, top, right, bottom]: &[f32; 4]| {
        let pixels = |from: f32, to: f32| (from * SCALE) as u32..=(to * SCALE) as u32;
        let rows = pixels(*top, *bottom);
        let all = rows.flat_map(|y| pixels(*left, *right).map(move |x| (x, y)));
        let seen = all.filter_map(|(x, y)| page.pixel(x, y));
        seen.filter(|p| [p.red(), p.green(), p.blue()] != [255; 3])
            .count()
    };
    (boxes.len(), boxes.iter().map(under).sum())
}

fn parsed(svg: &str) -> Tree {
    Tree::from_str(svg, &Options::default()).expect("valid SVG")
}

fn rendered(tree: &Tree) -> Pixmap {
    let size = tree.size().to_int_size().scale_by(SCALE).expect("a size");
    let mut page = Pixmap::new(size.width(), size.height()).expect("a page");
    resvg::render(
        tree,
        Transform::from_scale(SCALE, SCALE),
        &mut page.as_mut(),
    );
    page
}

/// Left, top, right and bottom of every legend.
fn collect(group: &Group, boxes: &mut Vec<[f32; 4]>) {
    if group.id().starts_with("legend") {
        let b = group.abs_bounding_box();
        boxes.push([b.left(), b.top(), b.right(), b.bottom()]);
    }
    for child in group.children() {
        if let Node::Group(inner) = child {
            collect(inner, boxes);
        }
    }
}

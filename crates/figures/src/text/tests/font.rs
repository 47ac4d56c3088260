use super::*;

#[test]
fn digits_have_equal_width_so_tick_labels_line_up() {
    let widths: Vec<f64> = ('0'..='9').map(|c| Glyph::new(Face::Regular, c).advance).collect();
    assert!(widths.iter().all(|w| *w == widths[0]));
}

#[test]
fn every_character_of_the_markup_table_is_in_the_font() {
    for (name, c) in super::super::markup::SYMBOLS {
        for style in [Face::Regular, Face::Italic] {
            assert!(GLYPHS.contains_key(&(style.letter(), u32::from(*c))), "\\{name}");
        }
    }
}

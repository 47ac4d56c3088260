use super::*;

#[test]
fn counts_keep_their_word_where_nothing_else_has_a_unit() {
    let style = Style::brief(Units::Dimensionless);
    assert_eq!(style.quantity(0.84, "beads/s"), "0.84 beads per unit time");
    assert_eq!(style.quantity(5.0, "beads"), "5 beads");
    assert_eq!(style.quantity(5.0, "m/s"), "5");
}

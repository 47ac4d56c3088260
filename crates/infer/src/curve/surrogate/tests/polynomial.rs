use super::*;

#[test]
fn terms_are_all_products_up_to_a_degree() {
    // (d + p)!/(d! p!) of them.
    assert_eq!(terms(2, 3).len(), 10);
    assert_eq!(terms(8, 4).len(), 495);
    assert!(terms(MOST_PARAMETERS, FIRST_DEGREE).len() <= MOST_TERMS);
    assert!(terms(MOST_PARAMETERS + 1, FIRST_DEGREE).len() > MOST_TERMS);
}

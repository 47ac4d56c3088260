use super::*;

#[test]
fn a_matrix_is_its_root_squared_and_a_singular_one_has_none() {
    let root = cholesky(&[vec![4.0, 2.0], vec![2.0, 10.0]]);
    assert_eq!(root, Some(vec![vec![2.0], vec![1.0, 3.0]]));
    assert_eq!(cholesky(&[vec![1.0, 1.0], vec![1.0, 1.0]]), None);
}

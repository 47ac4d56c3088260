use super::ranges;

#[test]
fn numbers_are_told_as_slurm_takes_them() {
    assert_eq!(ranges(&[2, 5, 6, 7, 9, 10]), "2,5-7,9-10");
    assert_eq!(ranges(&[1]), "1");
    assert_eq!(ranges(&[]), "");
}

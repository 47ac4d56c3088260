use super::*;

#[test]
fn parts_hold_every_place_once() {
    for (count, of) in [(10, 3), (2, 5), (0, 1), (7, 7)] {
        let mut places: Vec<usize> = Shard::all(of).flat_map(|part| part.places(count)).collect();
        places.sort_unstable();
        assert_eq!(places, (0..count).collect::<Vec<_>>());
        let third = Shard::new(of, of).unwrap();
        assert!(third.places(count).all(|place| third.holds(place)));
    }
}

#[test]
fn parts_are_written_as_they_are_read() {
    let part: Shard = " 2/ 5".parse().unwrap();
    assert_eq!((part.to_string(), part.number(), part.of()), ("2/5".to_owned(), 2, 5));
    for text in ["0/3", "4/3", "3", "a/b", "1/0", ""] {
        assert!(text.parse::<Shard>().is_err(), "{text}");
    }
}
#[test]
fn numbers_are_told_as_slurm_takes_them() {
    assert_eq!(ranges(&[2, 5, 6, 7, 9, 10]), "2,5-7,9-10");
    assert_eq!(ranges(&[1]), "1");
    assert_eq!(ranges(&[]), "");
}

use super::*;

#[test]
fn every_contact_belongs_to_one_group() {
    for wet_contacts in [
        None,
        Some((0, 40)),
        Some((7, 40)),
        Some((3, 5)),
        Some((50, 60)),
    ] {
        let rig = RigDrawing {
            beads: 40,
            striker_ratio: Some(1.0),
            wet_contacts,
            ..RigDrawing::default()
        };
        let found = groups(&rig);
        assert_eq!(found.first().map(|g| g.0), Some(0));
        assert_eq!(found.last().map(|g| g.1), Some(40));
        assert!(found.windows(2).all(|w| w[1].0 == w[0].1 + 1), "{found:?}");
    }
}

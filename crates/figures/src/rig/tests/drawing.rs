use super::*;

#[test]
fn beads_never_leave_the_drawing() {
    for beads in [1, 2, 5, 10, 20, 40, 1000, 1_000_000] {
        for sensor_bead in [None, Some(1), Some(7), Some(beads / 2), Some(beads)] {
            let rig = RigDrawing {
                beads,
                sensor_bead,
                actuator: "actuator".into(),
                photogate: "gate".into(),
                springs: "springs".into(),
                stop: "stop".into(),
                end_structure: "structure".into(),
                bar: "bar".into(),
                wall_sensor: true,
                striker_ratio: Some(1.0),
                ..RigDrawing::default()
            };
            let drawing = Drawing::new(&rig);
            assert!(drawing.back + APART + BAR < WIDTH, "{beads} {sensor_bead:?}");
            assert!(drawing.diameter >= SMALLEST, "{beads} {sensor_bead:?}");
            assert!(drawing.beads.windows(2).all(|w| w[1].0 > w[0].0));
        }
    }
}

#[test]
fn long_rows_keep_both_ends_and_the_sensor() {
    let rig = RigDrawing { beads: 500, sensor_bead: Some(200), ..RigDrawing::default() };
    let drawing = Drawing::new(&rig);
    for bead in [1, 199, 200, 201, 500] {
        assert!(drawing.bead(bead).is_some(), "{bead}");
    }
    assert_eq!(drawing.elisions.len(), 2);
}

#[test]
fn every_contact_belongs_to_one_group() {
    for wet_contacts in [None, Some((0, 40)), Some((7, 40)), Some((3, 5)), Some((50, 60))] {
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

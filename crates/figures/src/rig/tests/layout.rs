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
            let layout = Layout::new(&rig);
            assert!(layout.back + APART + BAR < WIDTH, "{beads} {sensor_bead:?}");
            assert!(layout.diameter >= SMALLEST, "{beads} {sensor_bead:?}");
            assert!(layout.beads.windows(2).all(|w| w[1].0 > w[0].0));
        }
    }
}

#[test]
fn long_rows_keep_both_ends_and_the_sensor() {
    let rig = RigDrawing {
        beads: 500,
        sensor_bead: Some(200),
        ..RigDrawing::default()
    };
    let layout = Layout::new(&rig);
    for bead in [1, 199, 200, 201, 500] {
        assert!(layout.bead(bead).is_some(), "{bead}");
    }
    assert_eq!(layout.elisions.len(), 2);
}

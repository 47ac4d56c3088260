use super::*;

#[test]
fn every_kind_reads_minus_one_or_its_largest() {
    let read = |kind, bytes: &[u8], big| StoredNumber::plain(kind, big).scaled(bytes);
    for (kind, width) in [
        (NumberKind::I8, 1),
        (NumberKind::I16, 2),
        (NumberKind::I24, 3),
        (NumberKind::I32, 4),
        (NumberKind::I64, 8),
    ] {
        assert_eq!(read(kind, &vec![0xff; width], false), [-1.0], "{kind:?}");
    }
    assert_eq!(read(NumberKind::U8, &[255], false), [255.0]);
    assert_eq!(read(NumberKind::U16, &[1, 0], true), [256.0]);
    assert_eq!(read(NumberKind::F32, &1.5_f32.to_be_bytes(), true), [1.5]);
    assert_eq!(read(NumberKind::F64, &1.5_f64.to_le_bytes(), false), [1.5]);
}

#[test]
fn half_precision_is_what_its_bits_say() {
    // Ends of its range, by hand from the standard's form.
    for (bits, value) in [
        (0x3c00, 1.0),
        (0xc000, -2.0),
        (0x7bff, 65504.0),
        (0x0400, 2.0_f64.powi(-14)),
        (0x0001, 2.0_f64.powi(-24)),
        (0x3555, 0.333_251_953_125),
        (0xfc00, f64::NEG_INFINITY),
    ] {
        assert_eq!(half(bits), value, "{bits:x}");
    }
    assert!(half(0x7e00).is_nan());
    let read = StoredNumber::plain(NumberKind::F16, true).scaled(&[0x3c, 0x00]);
    assert_eq!(read, [1.0]);
}

#[test]
fn interleaved_channels_come_apart() {
    let bytes: Vec<u8> = (0..6_i16).flat_map(i16::to_le_bytes).collect();
    let second = StoredChannel::run(StoredNumber::plain(NumberKind::I16, false), 2, 3, 4);
    let read = second.read(&mut io::Cursor::new(bytes), 0, 0..3).unwrap();
    assert_eq!(read, [1.0, 3.0, 5.0]);
}

use super::*;

#[test]
fn utf_16_is_told_by_its_mark_or_by_its_zeros() {
    let little: Vec<u8> = "0.1\t0.25\r\n"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    let big: Vec<u8> = "\u{feff}µ"
        .encode_utf16()
        .flat_map(u16::to_be_bytes)
        .collect();
    assert_eq!(Encoding::of(&little), Encoding::Utf16Little);
    assert_eq!(Encoding::of(&big), Encoding::Utf16Big);
    assert_eq!(Encoding::of("0.1,0.2,µ".as_bytes()), Encoding::Bytes);
    assert_eq!(Encoding::Utf16Little.decoded(&little).0, b"0.1\t0.25\r\n");
    assert_eq!(Encoding::Utf16Big.decoded(&big).0, "µ".as_bytes());
}

#[test]
fn letters_of_two_halves_wait_for_the_other() {
    let bytes: Vec<u8> = "a😀".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_eq!(
        Encoding::Utf16Little.decoded(&bytes[..4]),
        (b"a".to_vec(), 2)
    );
    assert_eq!(Encoding::Utf16Little.decoded(&bytes), ("a😀".into(), 6));
}

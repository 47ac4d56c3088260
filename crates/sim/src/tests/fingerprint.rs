use super::*;

/// SHA-256 of "abc" as FIPS 180-2 prints it.
#[test]
fn the_hash_is_sha_256_and_is_read_back() {
    let printed = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
    let hash = Fingerprint::of_bytes(b"abc");
    assert_eq!(hash.to_string(), printed);
    assert_eq!(Fingerprint::from_hex(printed), Some(hash));
    assert_eq!(hash.short(), &printed[..16]);
    assert!(Fingerprint::from_hex(&printed[1..]).is_none());
    assert!(Fingerprint::from_hex(&printed.replace('b', "x")).is_none());
}

#[test]
fn lists_of_inputs_that_run_together_differ() {
    let of = |parts: [&str; 2]| Fingerprint::of("test", &parts);
    assert_ne!(of(["one", "two"]), of(["onet", "wo"]));
    assert_eq!(of(["one", "two"]), of(["one", "two"]));
    assert_ne!(of(["a\", \"b", "c"]), of(["a", "b\", \"c"]));
    let of = |number: f64| Fingerprint::of("test", &number);
    assert_ne!(of(0.0), of(-0.0));
    assert_ne!(of(0.1), of(0.1_f64.next_up()));
}

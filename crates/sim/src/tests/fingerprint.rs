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
    let of = |parts: [&str; 2]| {
        let inputs = Inputs::of("test").text("a", parts[0]).text("b", parts[1]);
        inputs.fingerprint()
    };
    assert_ne!(of(["one", "two"]), of(["onet", "wo"]));
    assert_eq!(of(["one", "two"]), of(["one", "two"]));
    let zeros = [0.0, -0.0].map(|zero| Inputs::of("test").numbers("a", &[zero]).fingerprint());
    assert_ne!(zeros[0], zeros[1]);
}

use super::super::parsed;
use super::*;
use clap::Args;

/// Whether options given otherwise, and read again from their words, give the same
/// words; each of them stands there.
fn again<A: Args>(
    verb: &'static str,
    places: &[&str],
    given: &[&str],
    words: fn(&A) -> Vec<String>,
) {
    let read = |options: &[String]| -> Vec<String> {
        let places = places.iter().map(|word| (*word).to_owned());
        let all: Vec<String> = options.iter().cloned().chain(places).collect();
        words(&parsed::<A>(verb, &all).unwrap())
    };
    let given: Vec<String> = given.iter().map(|word| (*word).to_owned()).collect();
    let told = read(&given);
    assert_eq!(read(&told), told);
    for word in &given {
        assert!(told.contains(word), "{word} is not in {told:?}");
    }
}

const COMMON: [&str; 12] = [
    "--case=wet",
    "--use=incident,returning-ratio",
    "--speed-error=0.003",
    "--tof-error=0.0000002",
    "--ratio-error=0.01",
    "--set=incline=0.5deg",
    "--set=beads=30",
    "--accuracy=0.000001",
    "--free=eta,wet.K:power",
    "--start=eta=2e4",
    "--bounds=eta=1e4:1e5",
    "--prior=eta=3.2e4*/1.1",
];

#[test]
fn options_come_back_from_their_words() {
    let of_fit = [
        "--scale=eta=1e3",
        "--shots=list.csv",
        "--rate=1000000",
        "--channel=1",
        "--channel=wall",
        "--most-shots=7",
        "--method=posterior",
        "--against=hertz=Y,nu",
        "--against=hertz-viscoelastic=eta",
        "--steps=300",
        "--direct",
        "--robust",
        "--starts=20",
        "--seed=18446744073709551615",
    ];
    again::<Fit>(
        "fit",
        &["data.csv"],
        &[&COMMON[..], &of_fit].concat(),
        Fit::words,
    );
    let of_design = [
        "--target=eta",
        "--speeds=log:0.1:1:5",
        "--preloads=0.1,0.5",
        "--sensors=3,9",
        "--costs=sensor=10,preload=2",
        "--picks=3",
    ];
    again::<Design>(
        "design",
        &["data.csv"],
        &[&COMMON[..], &of_design].concat(),
        Design::words,
    );
    let of_gauge = [
        "--wet-case=pump",
        "--dry-case=dry",
        "--dry-free=steel.eta,dry.B",
        "--own=near_end.force",
        "--form=power",
        "--accuracy=0.000001",
    ];
    again::<Gauge>(
        "gauge",
        &["wet.csv", "--dry=dry.csv"],
        &of_gauge,
        Gauge::words,
    );
}

use super::*;

const ROW: &str = "title = \"row\"\n[materials.steel]\nyoung_modulus = \"200 GPa\"\npoisson_ratio = 0.3\n\
    density = \"7.8 g/cm^3\"\n[striker]\nspeed = \"0.5 m/s\"\n[[beads]]\ncount = 20\nradius = \"5 mm\"\n\
    material = \"steel\"\n[[contacts]]\nlaws = [\"elastic_hertz\"]\n";

fn row(name: &str, text: &str) -> Experiment {
    Experiment::from_text(name, text).unwrap()
}

#[test]
fn comments_blanks_and_places_do_not_matter() {
    let plain = row("row.toml", ROW).canonical_text();
    let commented = ROW.replace("count = 20", "# twenty of them\n\n  count   =  20");
    assert_eq!(row("/elsewhere/other.toml", &commented).canonical_text(), plain);
}

#[test]
fn numbers_readings_and_cases_do() {
    let plain = row("row.toml", ROW);
    let other = row("row.toml", &ROW.replace("0.3", "0.31"));
    assert_ne!(other.canonical_text(), plain.canonical_text());
    let set = plain.set(&[("poisson_ratio", 0.31)]).unwrap();
    assert_eq!(set.canonical_text(), other.canonical_text());
    let dry = crate::preset("dry").unwrap();
    let clipped = dry.with_reading(&crate::Reading {
        tension: crate::reading::TensionReading::Clipped,
        ..dry.reading()
    });
    assert_ne!(clipped.unwrap().canonical_text(), dry.canonical_text());
    let paper = crate::preset("paper").unwrap();
    let of = |case: &str| paper.case(case).unwrap().unwrap().canonical_text();
    assert_ne!(of("dry"), of("pump"));
}

//! gauge at the command line.

use crate::common::{curve, file, folder, json, refused, run, with_errors};
use std::path::Path;

#[test]
fn the_gauge_knows_its_oils_and_says_when_it_does_not() {
    let folder = folder("gauge");
    let (dry, pump) = (curve(&folder, "dry"), curve(&folder, "pump"));
    let found = json(&with_errors(&["gauge", &pump, "--dry", &dry, "--json"]));
    assert!(
        found["verdict"].as_str().unwrap().starts_with("Of the known oils only pump oil"),
        "{found}"
    );
    // A dry chain's curve is that of no oil.
    let found = json(&with_errors(&["gauge", &dry, "--dry", &dry, "--json", "--use", "incident"]));
    assert!(found["verdict"].as_str().unwrap().starts_with("None of these"), "{found}");
    assert!(found["to_add"].as_str().unwrap().contains("reflected"));
}

/// A dry row of softer beads than the model's: no viscosity makes up for that.
#[test]
fn a_dry_curve_that_is_not_its_models_is_told_before_all_else() {
    let folder = folder("gauge-doubt");
    let pump = curve(&folder, "pump");
    let softer = String::from_utf8(run(&["presets", "dry"]).stdout).unwrap();
    assert!(softer.contains("\"213 GPa\""));
    let softer = file(&folder, "softer.toml", &softer.replace("213 GPa", "200 GPa"));
    let out = folder.join("softer");
    let out = out.to_str().unwrap();
    let sweep = ["sweep", &softer, "--speeds", "log:0.1:1.2:6", "--out", out];
    assert!(run(&sweep).status.success());
    let reported = |dry: &str| {
        let gauge = [
            "gauge",
            &pump,
            "--dry",
            dry,
            "--use",
            "incident",
            "-p",
            "pump",
            "--dry-preset",
            "dry",
        ];
        String::from_utf8(run(&with_errors(&gauge)).stdout).unwrap()
    };
    let text = reported(&format!("{out}/sweep.csv"));
    let first = text.lines().next().unwrap();
    assert!(first.starts_with("warning: of the dry curve"), "{text}");
    assert!(first.contains("the model does not follow the data"), "{text}");
    let second = text.lines().nth(1).unwrap();
    assert!(second.contains("check that --dry names"), "{text}");
    // Under the verdict, where a long table ends, it is said again.
    let last = text.lines().last().unwrap();
    assert!(last.starts_with("warning: see the first lines"), "{text}");
    let text = reported(&curve(&folder, "dry"));
    assert!(!text.contains("warning"), "{text}");
}

/// A row of six, with a film or without.
const ROW: &str = "[materials.steel]\nyoung_modulus = \"213 GPa\"\npoisson_ratio = 0.3\n\
    shear_viscosity = \"3.2e4 Pa s\"\n\
    [liquid]\nkinematic_viscosity = \"120 cSt\"\ndensity = \"870 kg/m^3\"\npressure_viscosity = \"16 1/GPa\"\n\
    [striker]\nspeed = \"0.3 m/s\"\n\
    [[beads]]\ncount = 6\nradius = \"6.35 mm\"\nmass = \"8.54 g\"\nmaterial = \"steel\"\n\
    [[contacts]]\nto = 1\nlaws = [\"elastic_hertz\", \"damping_viscoelastic\"]\n\
    [[contacts]]\nfrom = 2\nwet = true\nlaws = [\"elastic_hertz\", \"damping_viscoelastic\", \"film_entrained\"]\n\
    [near_end]\npush = \"constant\"\nforce = \"0.24 N\"\n[far_end]\nkind = \"half-bead\"\n[sensors]\nbead = 2\n";

/// Models of the wet and the dry row, each with its curve at three speeds.
fn film_rows(folder: &Path) -> [[String; 2]; 2] {
    let without = ROW.replace(", \"film_entrained\"", "").replace("wet = true\n", "");
    [("wet", ROW), ("dry", &without)].map(|(name, text)| {
        let model = file(folder, &format!("{name}.toml"), text);
        let out = folder.join(name).to_str().unwrap().to_owned();
        let sweep = ["sweep", &model, "--speeds", "0.3,0.5,1", "--accuracy", "1e-5", "--out", &out];
        assert!(run(&sweep).status.success());
        [model, format!("{out}/sweep.csv")]
    })
}

#[test]
fn the_gauge_frees_a_films_viscosity_in_place_of_k_and_a() {
    let folder = folder("gauge-film");
    let [[wet, wet_table], [dry, dry_table]] = film_rows(&folder);
    let out = folder.join("out").to_str().unwrap().to_owned();
    let gauge = ["gauge", &wet_table, "--dry", &dry_table, "-m", &wet, "--dry-model", &dry];
    let film =
        ["--film", "viscosity", "--dry-free", "eta", "--use", "incident", "--json", "-o", &out];
    let found = json(&with_errors(&[&gauge[..], &film].concat()));
    let parameters = found["film"]["parameters"].as_array().unwrap();
    let viscosity = parameters.iter().find(|of| of["name"] == "viscosity").unwrap();
    let contacts = found["contacts"].as_array().unwrap();
    assert_eq!(contacts.len(), 3);
    for of in contacts.iter().map(|row| &row["film"]).chain([viscosity]) {
        let [value, error] = ["value", "standard_error"].map(|key| of[key].as_f64().unwrap());
        // The tables are the model's own: 1e-5 of a time against its error.
        assert!((value - 120e-6 * 870.0).abs() < 0.2 * error, "{of}");
        assert_eq!(of["unit"], "Pa s");
    }
    assert_eq!(found["oils"].as_array().unwrap().len(), 0);
    assert!(found["verdict"].as_str().unwrap().starts_with("One film"), "{found}");
    // Three wet times, one viscosity and at most one more number; nothing was scanned.
    let freedom = found["film"]["freedom"].as_u64().unwrap();
    assert!((1..3).contains(&freedom), "{found}");
    assert!(found.get("scanned_s").is_none(), "{found}");
    let table = std::fs::read_to_string(format!("{out}/contacts.csv")).unwrap();
    assert!(table.lines().nth(1).unwrap().contains("viscosity"), "{table}");
    let summary = std::fs::read_to_string(format!("{out}/summary.csv")).unwrap();
    assert!(summary.contains("film_probability"), "{summary}");
    let figure = std::fs::read_to_string(format!("{out}/contacts.svg")).unwrap();
    assert!(figure.contains("all speeds together") && figure.contains("viscosity (Pa s)"));
    let power = ["--film", "viscosity:power"];
    refused(&with_errors(&[&gauge[..], &power].concat()));
    let oils = ["--film", "viscosity", "--oils", "oils.csv"];
    let message = refused(&with_errors(&[&gauge[..], &oils].concat()));
    assert!(message.contains("'--film <NAMES>' cannot be used with '--oils <FILE>'"), "{message}");
}

//! What every picture must be: well-formed, complete on the page, the same
//! every time, and not empty.

use crate::covered::covered;
use crate::type_size::smallest_type;
use hertzchain_figures::inference::{Corner, ProfileCurve, SingularValues, profile_figure};
use hertzchain_figures::{
    Chart, ClaimVerdict, Colour, ColourMap, Dash, Figure, HeatMap, Marker, RigDrawing, RigEnd,
    Series, VerdictMatrix,
};
use proptest::prelude::*;
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Group, Node, Options, Tree};

fn wave() -> Chart {
    let x: Vec<f64> = (0..300).map(|i| f64::from(i) * 4.0).collect();
    let y: Vec<f64> = x.iter().map(|x| (x / 90.0).sin()).collect();
    Chart::new("Time (µs)", r"$F_{\mathrm{wall}}$ (N)")
        .with(Series::line("model", &x, &y))
        .with(Series::points("data", &x[..20], &y[..20]).y_error(&[0.1; 20]))
        .h_line(0.5, "half")
        .v_line(600.0, "wall peak")
}

fn every_kind() -> Vec<Figure> {
    let heat = HeatMap {
        colours: ColourMap::Diverging,
        label: "$v$ (m/s)".into(),
        ..HeatMap::new(3, 2, &[0.0, 1.0, 2.0, -1.0, f64::NAN, 4.0])
    };
    let verdicts = vec![ClaimVerdict::Holds, ClaimVerdict::NotDecidable];
    let table = VerdictMatrix {
        columns: vec!["default".into(), "preload 0.24 N".into()],
        rows: vec![("Motor oil lengthens the ToF".into(), verdicts)],
        ..VerdictMatrix::default()
    };
    let rig = RigDrawing {
        beads: 40,
        sensor_bead: Some(7),
        wet_contacts: Some((7, 40)),
        ..RigDrawing::default()
    };
    vec![
        Figure::single_column(60.0).panel(wave()),
        Figure::single_column(60.0).panel(wave().note("a note")),
        Figure::double_column(90.0)
            .columns(2)
            .letters()
            .share_x()
            .panel(wave().title("a"))
            .panel(wave())
            .panel(wave()),
        Figure::single_column(60.0).panel(Chart::new("Time", "Bead").heat(heat)),
        table.figure(),
        rig.figure(),
        Figure::single_column(50.0),
        Figure::single_column(50.0).panel(Chart::new("", "")),
    ]
    .into_iter()
    .chain(of_fits())
    .collect()
}

/// Pictures of fits, also of next to nothing.
fn of_fits() -> Vec<Figure> {
    let samples = |count: u32| -> Vec<Vec<f64>> {
        let wave = |k: f64| (0..count).map(move |i| (k * f64::from(i)).sin()).collect();
        vec![wave(1.0), wave(1.7)]
    };
    let labels = [r"$\eta$ (Pa s)".to_owned(), "$B$".to_owned()];
    let corner = |samples: &[Vec<f64>]| {
        Corner {
            labels: &labels,
            samples,
            marks: &[0.1, -0.2],
            covariance: &[vec![0.3, -0.1], vec![-0.1, 0.2]],
        }
        .figure()
    };
    let profile = ProfileCurve {
        label: "$B$",
        values: &[60.0, 70.0, 80.0, 95.0],
        rise: &[4.1, 0.7, 0.1, 4.4],
        best: 76.0,
        standard_error: Some(8.0),
        levels: &[(1.0, "68 %"), (3.84, "95 %")],
    };
    let values =
        |values, directions| SingularValues { names: &labels, values, directions, floor: 1e-3 };
    vec![
        corner(&samples(500)),
        corner(&samples(1)),
        corner(&[Vec::new(), Vec::new()]),
        profile_figure(&[profile]),
        profile_figure(&[profile, profile, profile]),
        profile_figure(&[]),
        values(&[100.0, 0.0], &[vec![0.8, 0.6], vec![-0.6, 0.8]]).figure(),
        values(&[], &[]).figure(),
    ]
}

/// Every text group lies on the page; so does everything else that is drawn.
fn check(svg: &str) {
    roxmltree::Document::parse(svg).expect("well-formed XML");
    let tree = Tree::from_str(svg, &Options::default()).expect("valid SVG");
    // Sizes are written to a hundredth of a point, glyph outlines overshoot by a little.
    let slack = 0.6;
    let (width, height) = (tree.size().width() + slack, tree.size().height() + slack);
    each_group(tree.root(), &mut |group| {
        if group.id().starts_with('t') {
            let b = group.abs_bounding_box();
            let on_page = b.left() >= -slack
                && b.top() >= -slack
                && b.right() <= width
                && b.bottom() <= height;
            assert!(on_page, "text {} at {b:?} on a page of {width} x {height}", group.id());
        }
    });
}

/// Many named curves that leave no free paper: noise from edge to edge.
fn crowded(names: usize) -> Chart {
    let x: Vec<f64> = (0..400).map(f64::from).collect();
    (0..names).fold(Chart::new("Time (µs)", "Force (N)"), |chart, n| {
        let y: Vec<f64> = x.iter().map(|x| (x * (1.3 + n as f64)).sin()).collect();
        chart.with(Series::line(&format!("contact {n}"), &x, &y))
    })
}

#[test]
fn legends_of_crowded_and_filled_charts_cover_nothing() {
    let x = [0.0, 1.0, 2.0];
    let filled = Chart::new("Time (µs)", "Share")
        .y_range(0.0, 1.0)
        .with(Series::band("lower", &x, &[0.0; 3], &[0.4; 3]))
        .with(Series::band("upper", &x, &[0.4; 3], &[1.0; 3]));
    let heat = HeatMap::new(2, 1, &[-1.0, 1.0]);
    let map = Chart::new("Time (µs)", "Bead").heat(heat);
    let map = map.with(Series::line("front", &[0.0, 1.0], &[0.0, 1.0]));
    let mut charts = vec![filled, map, wave().note("a note")];
    charts.extend([1, 4, 9].map(crowded));
    charts.extend([1, 4, 9].map(|names| crowded(names).y_range(-0.9, 0.9)));
    for chart in charts {
        let figure = Figure::single_column(70.0).letters().panel(chart.clone());
        assert_eq!(covered(&figure.svg_outlined()), (1, 0), "{chart:?}");
        let both = Figure::single_column(110.0).share_x();
        let both = both.panel(chart.clone()).panel(chart.clone());
        assert_eq!(covered(&both.svg_outlined()), (2, 0), "{chart:?}");
    }
}

/// Nothing is smaller than journals ask for, 6 points at the printed width.
fn check_legible(svg: &str) {
    let (smallest, _) = smallest_type(svg);
    // Page sizes are written with two decimals.
    assert!(smallest > 6.0 - 5e-3, "{smallest} points");
}

#[test]
fn every_kind_of_picture_is_legible_as_wide_as_a_column() {
    for figure in every_kind() {
        let svg = figure.svg();
        check_legible(&svg);
        let (_, width_mm) = smallest_type(&svg);
        assert!([85.0, 175.0].contains(&width_mm), "{width_mm} mm wide");
    }
}

#[test]
fn small_type_is_noticed() {
    let svg = Figure::single_column(60.0).panel(wave()).svg();
    let (whole, _) = smallest_type(&svg);
    let half = svg.replacen("width=\"85mm\"", "width=\"42.5mm\"", 1);
    // Rounding of the quotient.
    assert!((smallest_type(&half).0 - 0.5 * whole).abs() < 1e-9);
    assert!(whole < 7.1, "the tick labels are seen: {whole}");
}

fn each_group(group: &Group, visit: &mut impl FnMut(&Group)) {
    visit(group);
    for child in group.children() {
        if let Node::Group(inner) = child {
            each_group(inner, visit);
        }
    }
}

#[test]
fn every_kind_of_picture_is_well_formed_with_all_text_on_the_page() {
    for figure in every_kind() {
        check(&figure.svg_outlined());
    }
}

/// No two texts touch.
fn check_apart(svg: &str) {
    let tree = Tree::from_str(svg, &Options::default()).expect("valid SVG");
    let mut texts = Vec::new();
    each_group(tree.root(), &mut |group| {
        if group.id().starts_with('t') {
            texts.push((group.id().to_owned(), group.abs_bounding_box()));
        }
    });
    for (i, (a, first)) in texts.iter().enumerate() {
        for (b, second) in &texts[..i] {
            let apart = first.right() < second.left()
                || second.right() < first.left()
                || first.bottom() < second.top()
                || second.bottom() < first.top();
            assert!(apart, "{a} at {first:?} touches {b} at {second:?}");
        }
    }
}

#[test]
fn texts_of_a_picture_do_not_touch() {
    for figure in every_kind() {
        check_apart(&figure.svg_outlined());
    }
}

#[test]
fn a_covered_curve_is_noticed() {
    let curve = "<path d=\"M0 50H100\" stroke=\"#000000\"/>";
    let picture = |y: u32| {
        let (svg, xml) = ("<svg xmlns=\"http://www.w3.org/2000/svg\"", "</svg>");
        let legend = format!(
            "<g id=\"legend1\" data-box=\"0 {y} 30 {}\"><rect y=\"{y}\" width=\"30\" height=\"20\"/></g>",
            y + 20
        );
        format!(
            "{svg} width=\"100\" height=\"100\"><rect width=\"100\" height=\"100\" fill=\"#fff\"/>{curve}{legend}{xml}"
        )
    };
    assert_eq!(covered(&picture(10)), (1, 0));
    assert!(covered(&picture(40)).1 > 20);
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    for (a, b) in every_kind().iter().zip(&every_kind()) {
        assert_eq!(a.svg_outlined(), b.svg_outlined());
        assert_eq!(a.svg(), b.svg());
    }
    let png = |i: usize| every_kind()[i].png(100.0).expect("renders");
    assert_eq!(png(3), png(3));
}

#[test]
fn text_of_an_svg_is_text_unless_outlines_are_asked_for() {
    let figure = Figure::single_column(60.0).panel(wave());
    let svg = figure.svg();
    let document = roxmltree::Document::parse(&svg).expect("well-formed XML");
    let texts = document.descendants().filter(|n| n.has_tag_name("text"));
    let texts: Vec<String> = texts
        .map(|n| n.descendants().filter(|n| n.is_text()).filter_map(|n| n.text()).collect())
        .collect();
    assert!(
        texts.contains(&"Time (µs)".to_owned()) && texts.contains(&"Fwall (N)".to_owned()),
        "{texts:?}"
    );
    assert!(!figure.svg_outlined().contains("<text "));
}

#[test]
fn every_kind_of_picture_is_a_pdf_whose_table_points_at_its_objects() {
    for figure in every_kind() {
        let pdf = figure.pdf();
        let text = String::from_utf8_lossy(&pdf);
        assert!(text.starts_with("%PDF-1.5") && text.ends_with("%%EOF\n"));
        let (_, table) = text.rsplit_once("xref\n0 ").expect("a table");
        let entries = table.lines().filter(|line| line.ends_with(" 00000 n "));
        for (i, entry) in entries.enumerate() {
            let at: usize = entry[..10].parse().expect("an offset");
            assert!(pdf[at..].starts_with(format!("{} 0 obj\n", i + 1).as_bytes()), "{entry}");
        }
    }
    let map = every_kind()[3].pdf();
    assert!(String::from_utf8_lossy(&map).contains("/I0 Do Q"));
}

fn decoded(png: &[u8]) -> (u32, u32, Vec<u8>, Option<u32>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().expect("a PNG");
    let mut data = vec![0; reader.output_buffer_size().expect("fits in memory")];
    let info = reader.next_frame(&mut data).expect("a picture");
    let dpm = reader.info().pixel_dims.map(|d| d.xppu);
    (info.width, info.height, data, dpm)
}

#[test]
fn png_has_the_size_and_resolution_asked_for_and_is_not_blank() {
    let (width, height, data, per_metre) = decoded(&every_kind()[0].png(300.0).expect("renders"));
    // 85 mm and 60 mm at 300 dots per 25.4 mm.
    assert_eq!((width, height), (1004, 709));
    assert_eq!(per_metre, Some(11811));
    let dark = data.chunks_exact(3).filter(|p| p.iter().all(|c| *c < 100)).count();
    assert!(dark > 5000, "{dark} dark pixels");
    assert!(data.chunks_exact(3).filter(|p| **p == [255, 255, 255]).count() > 400_000);
}

#[test]
fn a_png_shows_what_its_svg_does() {
    for figure in every_kind() {
        let (width, height, data, _) = decoded(&figure.png(96.0).expect("renders"));
        let tree = Tree::from_str(&figure.svg_outlined(), &Options::default()).expect("valid SVG");
        let mut page = Pixmap::new(width, height).expect("a page");
        let (across, down) =
            (width as f32 / tree.size().width(), height as f32 / tree.size().height());
        resvg::render(&tree, Transform::from_scale(across, down), &mut page.as_mut());
        let own = data.chunks_exact(3).map(|p| f64::from(p[1]));
        let pairs = own.zip(page.pixels().iter().map(|p| f64::from(p.green())));
        let apart: f64 = pairs.map(|(a, b)| (a - b).abs()).sum();
        // Numbers of the SVG are cut to a hundredth of a point.
        let mean = apart / f64::from(width * height);
        assert!(mean < 1.5, "{mean} of 255 levels apart");
    }
}

#[test]
fn impossible_sizes_are_errors() {
    let figure = Figure::single_column(60.0);
    for dpi in [0.0, -5.0, f64::NAN, f64::INFINITY, 1e9] {
        assert!(figure.png(dpi).is_err(), "{dpi}");
    }
}

#[test]
fn a_million_points_make_a_small_file() {
    let x: Vec<f64> = (0..1_000_000).map(f64::from).collect();
    let y: Vec<f64> = x.iter().map(|x| (x * 0.37).sin() * (x / 1e5).cos()).collect();
    let line = Figure::single_column(60.0)
        .panel(Chart::new("n", "y").with(Series::line("", &x, &y)))
        .svg_outlined();
    assert!(line.len() < 150_000, "{}", line.len());
}

#[test]
fn map_colours_reach_the_png() {
    let heat = HeatMap { colours: ColourMap::Diverging, ..HeatMap::new(2, 1, &[-1.0, 1.0]) };
    let png = Figure::single_column(60.0)
        .panel(Chart::new("x", "y").heat(heat))
        .png(150.0)
        .expect("renders");
    let (_, _, data, _) = decoded(&png);
    for end in [0.0, 1.0] {
        let Colour(r, g, b) = ColourMap::Diverging.colour(end);
        let share = data.chunks_exact(3).filter(|p| **p == [r, g, b]).count() as f64
            / (data.len() as f64 / 3.0);
        assert!(share > 0.2, "{share}");
    }
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -1e3_f64..1e3,
        2 => prop::num::f64::ANY,
        1 => Just(f64::NAN),
        1 => Just(0.0),
    ]
}

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(number(), 0..40)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn charts_of_any_numbers_stay_on_the_page(
        x in numbers(), y in numbers(), error in numbers(), upper in numbers(),
        logs in any::<(bool, bool)>(), range in any::<Option<(f64, f64)>>(),
        label in "[ -~µ]{0,60}", size in (20.0_f64..200.0, 15.0_f64..150.0),
    ) {
        let mut chart = Chart::new(&label, &label)
            .title(&label)
            .with(Series::band("band", &x, &y, &upper))
            .with(Series::line(&label, &x, &y).dash(Dash::Dotted))
            .with(Series::points("points", &x, &y).marker(Marker::Diamond).y_error(&error).x_error(&upper))
            .h_line(error.first().copied().unwrap_or(1.0), &label)
            .v_line(upper.first().copied().unwrap_or(1.0), &label)
            .note(&label);
        if logs.0 { chart = chart.x_log() }
        if logs.1 { chart = chart.y_log() }
        if let Some((a, b)) = range { chart = chart.x_range(a, b) }
        let figure = Figure::new(size.0.max(45.0), size.1.max(35.0)).letters();
        let figure = figure.panel(chart);
        check(&figure.svg_outlined());
        check_legible(&figure.svg());
    }

    #[test]
    fn maps_of_any_numbers_stay_on_the_page(
        values in numbers(), columns in 0_usize..9, rows in 0_usize..9, edges in (number(), number()),
    ) {
        let heat = HeatMap { x_edges: edges, label: "value".into(), ..HeatMap::new(columns, rows, &values) };
        check(&Figure::single_column(60.0).panel(Chart::new("x", "y").heat(heat)).svg_outlined());
    }

    #[test]
    fn rigs_of_any_kind_keep_their_labels_on_the_page(
        beads in 0_usize..2000, sensor_bead in any::<Option<usize>>(), small in 0_usize..60,
        wet in any::<Option<(u8, u8)>>(), flags in any::<[bool; 6]>(), end in 0_usize..3, metres in number(),
    ) {
        let named = |flag: bool, name: &str| if flag { name.to_owned() } else { String::new() };
        let rig = RigDrawing {
            beads,
            sensor_bead: sensor_bead.map(|n| if flags[0] { small } else { n }),
            bead_label: named(flags[5], "AISI 316, $R$ = 6.35 mm, $m$ = 8.54 g"),
            striker_ratio: flags[1].then_some(metres),
            striker_label: named(flags[2], "$v_0$"),
            sensor_label: named(flags[3], "piezo disc"),
            wet_contacts: wet.map(|(a, b)| (a.into(), b.into())),
            liquid: named(flags[4], "motor oil SAE 0W-30"),
            incline_deg: metres,
            far_end: [RigEnd::HalfBead, RigEnd::Plane, RigEnd::Open][end],
            wall_sensor: flags[3],
            actuator: named(flags[5], "voice-coil actuator"),
            repositioner: named(flags[2], "ball repositioner"),
            photogate: named(flags[0], "photogate"),
            springs: named(flags[1], "two-spring assembly, $F$ = 0.24 N"),
            recorder: named(flags[4], "charge amplifier, 16-bit ADC"),
            stop: named(flags[0], "steel stop"),
            end_structure: named(flags[4], "end structure, 4.5 kg"),
            bar: named(flags[2], "bar against noise, 6 kg"),
        };
        let figure = rig.figure();
        let svg = figure.svg_outlined();
        check(&svg);
        check_apart(&svg);
        check_legible(&figure.svg());
    }

    #[test]
    fn tables_of_any_shape_stay_on_the_page(
        columns in prop::collection::vec("[ -~]{0,40}", 0..50), claims in prop::collection::vec("[ -~]{0,160}", 0..30),
    ) {
        let names: Vec<&str> = columns.iter().map(String::as_str).collect();
        let cells = [ClaimVerdict::Fails, ClaimVerdict::InPart, ClaimVerdict::Holds];
        let rows = claims.iter().map(|c| (c.clone(), cells.to_vec())).collect();
        let columns = names.iter().map(|name| (*name).into()).collect();
        let figure = VerdictMatrix { columns, rows, ..VerdictMatrix::default() }.figure();
        check(&figure.svg_outlined());
        check_legible(&figure.svg());
    }
}

use super::*;
use crate::claims::claims;

fn row(reading: Reading, verdict: ClaimVerdict, claims: usize) -> ReadingRow {
    ReadingRow { reading, verdicts: vec![verdict; claims], values: vec![0.0; claims] }
}

/// A scan of two readings, in a product of one switch, with no room for others.
fn made_up(left_out: Vec<SwitchOptions>) -> ReadingScan {
    let claims: Vec<Claim> = claims().unwrap().into_iter().map(|j| j.claim).collect();
    let wet = Reading::default().with("wet_everywhere", "yes").unwrap();
    let default = row(Reading::default(), ClaimVerdict::Fails, claims.len());
    let single = row(wet, ClaimVerdict::Holds, claims.len());
    ReadingScan {
        product_of: vec![("wet_everywhere", vec!["no", "yes"])],
        left_out,
        product: vec![default.clone(), single.clone()],
        single: vec![single],
        search: Vec::new(),
        flipped_by_rounding: vec![2],
        flipped_in_closest: vec![0, 3],
        default,
        claims,
    }
}

#[test]
fn claims_that_rounding_flips_are_marked_wherever_the_page_names_them() {
    let scan = made_up(Vec::new());
    let page = scan_markdown(&scan);
    let (marked, id) = (format!("{}†", scan.claims[2].id), &scan.claims[2].id);
    assert_eq!(page.matches(&**id).count(), page.matches(&marked).count());
    // Gained in the tables and below, side by side, and its price.
    assert!(page.matches(&marked).count() > 3, "{page}");
    assert!(page.contains("† marks 1 "), "{page}");
    let other = format!("{}†", scan.claims[0].id);
    assert!(!page.contains(&other));
}

#[test]
fn the_closest_reading_is_scored_without_what_rounding_leaves_open_too() {
    let scan = made_up(Vec::new());
    let (page, all) = (scan_markdown(&scan), scan.claims.len());
    // The default reading meets nothing, the closest everything but two.
    let listed = format!("(‡ below, 2 claims; † in the default reading): {} against 0.", all - 2);
    assert!(page.contains(&listed), "{page}");
    assert_eq!(page.matches("| ‡ holds |").count(), 2);
}

#[test]
fn a_part_of_the_product_is_not_called_full() {
    let page = scan_markdown(&made_up(Vec::new()));
    assert!(page.contains("\n## Full product\n") && !page.contains("more than were asked"));
    let left_out = vec![
        ("wall_shape", vec!["sphere", "plane"]),
        ("incline", vec!["0 deg", "0.5 deg", "1 deg"]),
    ];
    let page = scan_markdown(&made_up(left_out));
    assert!(page.contains("\n## Part of the full product\n"), "{page}");
    assert!(page.contains("The full product has 12; the other 10 are more than were asked for"));
    assert!(page.contains("wall_shape (2), incline (3)"));
}

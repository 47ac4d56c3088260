use super::*;

/// Comparisons, so many of them met, not met and open comparisons.
fn counts(yes: usize, no: usize, open: usize) -> Comparisons {
    let mut counts = Comparisons::default();
    for (count, margin) in [(yes, 1.0), (no, -1.0), (open, 0.1)] {
        (0..count).for_each(|_| counts.add(margin, margin, 0.5, String::new));
    }
    counts
}

#[test]
fn a_claim_holds_in_part_when_at_least_half_of_its_comparisons_are_met() {
    for (yes, no, verdict) in [
        (31, 0, ClaimVerdict::Holds),
        (30, 1, ClaimVerdict::InPart),
        (16, 15, ClaimVerdict::InPart),
        (15, 15, ClaimVerdict::InPart),
        (15, 16, ClaimVerdict::Fails),
        (6, 25, ClaimVerdict::Fails),
        (1, 30, ClaimVerdict::Fails),
        (0, 31, ClaimVerdict::Fails),
        (0, 0, ClaimVerdict::NotDecidable),
    ] {
        assert_eq!(counts(yes, no, 0).finding().verdict, verdict, "{yes} of {yes} + {no}");
    }
}

#[test]
fn open_comparisons_leave_a_verdict_open_only_if_they_could_change_it() {
    for (yes, no, open, verdict) in [
        (30, 0, 1, ClaimVerdict::NotDecidable),
        (0, 30, 1, ClaimVerdict::Fails),
        (20, 10, 1, ClaimVerdict::InPart),
        (15, 15, 1, ClaimVerdict::NotDecidable),
        (15, 14, 1, ClaimVerdict::InPart),
        (0, 0, 3, ClaimVerdict::NotDecidable),
    ] {
        let found = counts(yes, no, open).finding();
        assert_eq!(found.verdict, verdict, "{yes} {no} {open}");
        // Exact numbers with these signs meet every open one.
        assert_eq!(found.leaning, counts(yes + open, no, 0).finding().verdict);
    }
}

//! One slip about the unit system of a file is one mistake, however many
//! quantities it makes wrong.

use crate::document::Node;
use crate::finding::Problem;
use crate::value::{HAS_NONE, HAS_ONE, Units};

/// The problems of a file, with one in place of all about units where no
/// quantity at all suits the file's unit system.
pub(crate) fn gathered(
    problems: Vec<Problem>,
    fitting: usize,
    units: Units,
    tree: &Node,
) -> Vec<Problem> {
    let about_units = |problem: &Problem| match units {
        Units::Si => problem.says(HAS_NONE),
        Units::Dimensionless => problem.says(HAS_ONE),
    };
    let (slips, mut others): (Vec<Problem>, Vec<Problem>) =
        problems.into_iter().partition(about_units);
    match slips.first() {
        Some(first) if fitting == 0 && slips.len() > 1 => {
            others.insert(0, slip(first, slips.len(), units, tree));
            others
        }
        _ => {
            others.extend(slips);
            others.sort_by_key(Problem::start);
            others
        }
    }
}

fn slip(first: &Problem, count: usize, units: Units, tree: &Node) -> Problem {
    match (units, tree.get("units")) {
        (Units::Dimensionless, Some(node)) => {
            let message =
                format!("this file is dimensionless, but its {count} quantities have units");
            Problem::new(
                &node.span,
                message,
                "expected \"SI\", or plain numbers throughout",
            )
            .beside(first.place(), "the first quantity with a unit")
        }
        _ => {
            let message = format!("none of the {count} quantities of this file has a unit");
            let label = "the first: expected a unit, as in \"6.35 mm\"";
            Problem::new(first.place(), message, label)
                .help("where plain numbers are meant, write units = \"dimensionless\" at the top")
        }
    }
}
